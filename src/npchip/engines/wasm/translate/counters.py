"""Numbers the counters of a module, and assigns them to the addresses of the program.

Counters have 64 bits and come in this order: the executions of each block, and of the steps under
each guard; for a profile also how often each block's branch wire was set, and the active NPs of
each counted mask. Varying masks are counted in vectors of four 32-bit sums, which the host adds to
the counters before they overflow (`Session`).
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
        masks: first mask counter of each block; empty without a profile.
        plain: number of counters before those of masks.
        count: number of counters.
    """

    guards: Sequence[Mapping[int, int]]
    branches: int
    masks: Sequence[int]
    plain: int
    count: int

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
    if not profile:
        return Counters(guards, end, (), end, end)
    branches, masks = end, []
    plain = end = branches + len(executed)
    for done in executed:
        masks.append(end)
        end += 0 if done is None else done.masks
    return Counters(guards, branches, masks, plain, end)


CounterRow = tuple[int, int, int, int]
"""A row of `npchip.engines.rows`, the address, and a counter and a sign: the term to add there."""
CounterRows = Mapping[tuple[int, ...], Sequence[CounterRow]]
"""By call stack: the terms of the tables of `npchip.engines.counts.Counts`."""


def counter_rows(
    blocks: Sequence[Block], executed: Sequence[Summary | None], counters: Counters, lanes: int
) -> CounterRows:
    """Return the terms that the counters of a profile add to its tables.

    Args:
        blocks: the program's blocks.
        executed: their summaries, with `Summary.reach`.
        counters: numbers of the counters.
        lanes: number of NPs.
    """
    found: dict[tuple[int, ...], list[CounterRow]] = {}
    for block, done in zip(blocks, executed, strict=True):
        if done is None:
            continue
        for index, step, counter in counters.steps(block):
            rows = found.setdefault(step.place.stack, [])
            address = step.place.address
            rows.append((EXECUTED, address, counter, 1))
            assert step.decoded is not None
            if step.decoded.form.flow is not None:
                taken = _taken(block.number, index, step, counters)
                rows += [(TAKEN, address, number, sign) for number, sign in taken]
            entered = done.entered.get(index, ())
            for row, terms in ((ACTIVE, done.reach[index]), (ENTERED, entered)):
                for mask, sign in terms:
                    if mask < 0:
                        rows.append((row, address, block.number, sign * lanes))
                    else:
                        rows.append((row, address, counters.masks[block.number] + mask, sign))
    return found


def _taken(block: int, index: int, step: Step, counters: Counters) -> tuple[tuple[int, int], ...]:
    """Return the number of times that a branch is taken, as counters and signs."""
    if step.guards:
        guard = counters.guards[block][index]
        return ((guard, 1),) if step.when else ((block, 1), (guard, -1))
    if step.taken is False:
        return ()
    return ((counters.branches + block if len(step.following) == 2 else block, 1),)
