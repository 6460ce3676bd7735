"""Where the lanes of a plane come from when it is read one NP away."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from npchip.engines.wasm.executed import DIRECTIONS
from npchip.engines.wasm.layout import VECTOR, Layout

_STEPS = {"north": (-1, 0), "south": (1, 0), "west": (0, -1), "east": (0, 1)}


@dataclass(eq=False)
class Link:
    """How one vector of neighbours is made.

    Attributes:
        sources: one or two vectors to read; none where all neighbours lie outside.
        lanes: of the first (0 to 15) and the second (16 to 31).
        inside: 255 where the neighbour is an NP.
    """

    sources: Sequence[int]
    lanes: Sequence[int]
    inside: bytes


def links(where: Layout, direction: int) -> list[Link]:
    """For each vector how its neighbours are read in a direction."""
    machine = where.machine
    rows, cols = np.indices((machine.np_rows, machine.np_cols)).reshape(2, -1)
    down, right = _STEPS[DIRECTIONS[direction]]
    rows, cols = rows + down, cols + right
    inside = (rows >= 0) & (rows < machine.np_rows) & (cols >= 0) & (cols < machine.np_cols)
    numbers = np.full(where.stride, -1)
    numbers[: where.lanes] = np.where(inside, rows * machine.np_cols + cols, -1)
    return [_link(numbers[start : start + VECTOR].tolist()) for start in where.starts]


def _link(numbers: list[int]) -> Link:
    """For lanes with these numbers (-1 for none)."""
    sources = sorted({number // VECTOR for number in numbers if number >= 0})
    assert len(sources) <= 2
    lanes = [
        0 if number < 0 else number % VECTOR + VECTOR * sources.index(number // VECTOR)
        for number in numbers
    ]
    return Link(sources, lanes, bytes(255 if number >= 0 else 0 for number in numbers))
