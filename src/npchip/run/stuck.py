"""The place at which a run has reached its limit."""

from __future__ import annotations

from typing import NamedTuple

from npchip.program.graph import Graph, Place, TooManyPlacesError
from npchip.program.spinning import described, loops_around
from npchip.run.chip import Chip

_MOST_LOOPS = 3


class Stuck(NamedTuple):
    """The place where a chip is.

    Attributes:
        place: file and line as errors begin with, ``"p.s:7: "``; empty without source.
        loops: the loops it is in, such as ``"in the loop of lines 6 to 8 from wait"``; or that it
            is in none.
    """

    place: str
    loops: str


def stuck(chip: Chip) -> Stuck:
    """Return where a chip is that has taken too many cycles."""
    program = chip.program
    line = program.place(chip.pc)
    place = f"{line.file}:{line.line}: " if line else ""
    at = "" if line else f"at address {chip.pc}, "
    try:
        graph = Graph(program.decoded(chip.isa), chip.machine)
        loops = loops_around(graph, Place(chip.pc, chip.stack, chip.depth))
    except TooManyPlacesError:
        return Stuck(place, f"at address {chip.pc}")
    if not loops:
        return Stuck(place, f"{at}in no loop")
    texts = dict.fromkeys(described(program, *loop, line) for loop in loops)
    return Stuck(place, f"{at}in the loop of {', in that of '.join([*texts][:_MOST_LOOPS])}")
