"""Where a module counts what, and what the counters mean for each address.

A counter is 64 bits wide: first one for each block, its executions. A module for profiles has
more: one for each block, how often the wire of its branch was set, and one for each mask whose
NPs are counted. These the module counts in four parts of 32 bits, as vectors add; the host carries
them over before they can be full (`Session`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.engines.counts import ACTIVE, ENTERED, EXECUTED, TAKEN, Counts
from npchip.engines.wasm.executed import Executed
from npchip.engines.wasm.graph import Block

_FLOW: Final = frozenset({"jump", "call", "ret"})


@dataclass(frozen=True)
class Counters:
    """Numbers of the counters.

    Attributes:
        blocks: number of blocks; block k is counted in counter k.
        masks: for each block the first counter of its masks; empty without a profile.
        plain: how many counters there are that are none of masks.
        count: how many there are.
    """

    blocks: int
    masks: Sequence[int]
    plain: int
    count: int

    def wire(self, block: int) -> int:
        """The counter of a branch."""
        return self.blocks + block


def plan(executed: Sequence[Executed | None], *, profile: bool) -> Counters:
    """Number the counters of a program."""
    blocks = len(executed)
    if not profile:
        return Counters(blocks, (), blocks, blocks)
    masks, end = [], 2 * blocks
    for done in executed:
        masks.append(end)
        end += 0 if done is None else done.masks
    return Counters(blocks, masks, 2 * blocks, end)


class Tally:
    """Turns counters into the tables of `Counts`.

    Args:
        blocks: the program's blocks.
        executed: what they do, with `Executed.reach`.
        counters: where they count.
        lanes: NPs.
    """

    def __init__(
        self,
        blocks: Sequence[Block],
        executed: Sequence[Executed | None],
        counters: Counters,
        lanes: int,
    ) -> None:
        self._tables: list[tuple[tuple[int, ...], NDArray[np.int64]]] = []
        found: dict[tuple[int, ...], list[tuple[int, int, int, int]]] = {}
        for block, done in zip(blocks, executed, strict=True):
            if done is None:
                continue
            for index, step in enumerate(block.steps):
                rows = found.setdefault(step.place.stack, [])
                address = step.place.address
                rows.append((EXECUTED, address, block.number, 1))
                assert step.decoded is not None
                if _FLOW & step.decoded.form.effects.keys() and step.taken is not False:
                    last = len(step.following) == 2
                    counter = counters.wire(block.number) if last else block.number
                    rows.append((TAKEN, address, counter, 1))
                for row, terms in (
                    (ACTIVE, done.reach[index]),
                    (ENTERED, done.entered.get(index, ())),
                ):
                    for mask, sign in terms:
                        if mask < 0:
                            rows.append((row, address, block.number, sign * lanes))
                        else:
                            rows.append((row, address, counters.masks[block.number] + mask, sign))
        for stack, rows in found.items():
            self._tables.append((stack, np.array(rows, np.int64).T))

    def add(self, values: NDArray[np.int64], counts: Counts) -> None:
        """Add what was counted."""
        for stack, (row, address, counter, sign) in self._tables:
            np.add.at(counts.table(stack), (row, address), sign * values[counter])
