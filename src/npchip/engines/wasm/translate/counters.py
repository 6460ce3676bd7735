"""Where a module counts what, and what the counters mean for each address.

A counter is 64 bits wide: first one for each block, its executions, then one for each guard, how
often it let the steps behind it be done. A module for profiles has more: one for each block, how
often the wire of its branch was set, and one for each mask whose NPs are counted. Where NPs
differ these are counted in four parts of 32 bits, as vectors add; the host carries them over
before they can be full (`Session`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from npchip.engines.rows import ACTIVE, ENTERED, EXECUTED, TAKEN
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.engines.wasm.translate.summary import Summary


@dataclass(frozen=True)
class Counters:
    """Numbers of the counters.

    Attributes:
        guards: for each block its guards' counters, by the index of the step; block k itself is
            counted in counter k.
        branches: the first counter of branches; they are numbered as blocks.
        masks: for each block the first counter of its masks; empty without a profile.
        plain: how many counters there are that are none of masks.
        count: how many there are.
    """

    guards: Sequence[Mapping[int, int]]
    branches: int
    masks: Sequence[int]
    plain: int
    count: int

    def wire(self, block: int) -> int:
        """The counter of a branch."""
        return self.branches + block

    def steps(self, block: Block) -> Iterator[tuple[int, Step, int]]:
        """The steps of a block with their indices and the counters of their executions."""
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
        places = () if done is None else done.guards
        guards.append({place: end + number for number, place in enumerate(places)})
        end += len(places)
    if not profile:
        return Counters(guards, end, (), end, end)
    branches, masks = end, []
    plain = end = branches + len(executed)
    for done in executed:
        masks.append(end)
        end += 0 if done is None else done.masks
    return Counters(guards, branches, masks, plain, end)


CounterRow = tuple[int, int, int, int]
"""A row of `npchip.engines.rows`, the address, and what to add to it: a counter times a sign."""
CounterRows = Mapping[tuple[int, ...], Sequence[CounterRow]]
"""By call stack: how counters become the tables of `npchip.engines.counts.Counts`."""


def counter_rows(
    blocks: Sequence[Block], executed: Sequence[Summary | None], counters: Counters, lanes: int
) -> CounterRows:
    """Return what the counters of a profile add to its tables.

    Args:
        blocks: the program's blocks.
        executed: what they do, with `Summary.reach`.
        counters: where they count.
        lanes: NPs.
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
                rows += [
                    (TAKEN, address, what, sign)
                    for what, sign in _taken(block.number, index, step, counters)
                ]
            for row, terms in (
                (ACTIVE, done.reach[index]),
                (ENTERED, done.entered.get(index, ())),
            ):
                for mask, sign in terms:
                    if mask < 0:
                        rows.append((row, address, block.number, sign * lanes))
                    else:
                        rows.append((row, address, counters.masks[block.number] + mask, sign))
    return found


def _taken(block: int, index: int, step: Step, counters: Counters) -> tuple[tuple[int, int], ...]:
    """How often a step of the flow is taken: counters and signs."""
    if step.guards:
        guard = counters.guards[block][index]
        return ((guard, 1),) if step.when else ((block, 1), (guard, -1))
    if step.taken is False:
        return ()
    return ((counters.wire(block) if len(step.following) == 2 else block, 1),)
