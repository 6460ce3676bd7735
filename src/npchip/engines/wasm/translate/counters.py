"""Numbers the counters of a module, and assigns them to the addresses of the program.

Counters have 64 bits and come in this order: the executions of each block, and of the steps under
each guard; for a profile also how often each block's branch was taken, and two for each block that
add up the active NPs before its step and after it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from npchip.engines.rows import ACTIVE, ENTERED, EXECUTED, TAKEN
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.engines.wasm.translate.summary import Summary


@dataclass(frozen=True)
class Counters:
    """Numbers of the counters. Counter k counts the executions of block k.

    Attributes:
        guards: counters of each block's guards, by the index of the step.
        branches: first counter of the branches. Counter `branches` + k is that of block k.
        masks: first counter of active NPs. Those of block k begin at `masks` + 2 k.
        count: number of counters.
        profile: whether branches and active NPs are counted.
    """

    guards: Sequence[Mapping[int, int]]
    branches: int
    masks: int
    count: int
    profile: bool

    def steps(self, block: Block) -> Iterator[tuple[int, Step, int]]:
        """Yield the steps of a block with their indices and the counters of their executions."""
        counter, end = block.number, 0
        for index, step in enumerate(block.steps):
            if index == end:
                counter = block.number
            yield index, step, counter
            if step.guards:
                counter, end = self.guards[block.number][index], index + 1 + step.guards


def plan(executed: Sequence[Summary | None], *, profile: bool) -> Counters:
    """Number the counters of a program."""
    guards: list[dict[int, int]] = []
    end = len(executed)
    for done in executed:
        indices = () if done is None else done.guards
        guards.append({index: end + number for number, index in enumerate(indices)})
        end += len(indices)
    masks = end + len(executed)
    return Counters(guards, end, masks, masks + 2 * len(executed) if profile else end, profile)


CounterRow = tuple[int, int, int, int]
"""A row of `npchip.engines.rows`, the address, and a counter and a factor: the term to add."""
CounterRows = Mapping[tuple[int, ...], Sequence[CounterRow]]
"""Terms of the tables of `npchip.engines.counts.Counts`, by call stack."""


def counter_rows(blocks: Sequence[Block], counters: Counters, lanes: int) -> CounterRows:
    """Return the terms that the counters of a profile add to its tables.

    Args:
        blocks: the program's blocks, of one step each.
        counters: numbers of the counters.
        lanes: number of NPs.
    """
    found: dict[tuple[int, ...], list[CounterRow]] = {}
    for block in blocks:
        address, stack, depth = block.first.place
        if block.first.decoded is None:
            continue
        number, mask = block.number, counters.masks + 2 * block.number
        rows = found.setdefault(stack, [])
        rows.append((EXECUTED, address, number, 1))
        rows.append((ACTIVE, address, mask, 1) if depth else (ACTIVE, address, number, lanes))
        rows.append((ENTERED, address, mask + 1, 1))
        if block.first.decoded.form.flow is not None:
            taken = counters.branches + number if len(block.after) == 2 else number
            rows.append((TAKEN, address, taken, 1))
    return found
