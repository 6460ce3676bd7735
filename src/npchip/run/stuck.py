"""The place at which a run has reached its limit."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.graph import Graph, Place, TooManyPlacesError
from npchip.program.model import Program
from npchip.program.spinning import described, loops_around

if TYPE_CHECKING:  # runs are judged where there is no NumPy
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
    return stuck_at(chip.program, chip.machine, chip.isa, Place(chip.pc, chip.stack, chip.depth))


def stuck_at(program: Program, machine: Machine, isa: Isa, at: Place) -> Stuck:
    """Return where a run is that has taken too many cycles.

    Args:
        program: the program.
        machine: the machine.
        isa: the program's instruction set.
        at: address of the next instruction, open calls and number of open masked regions.
    """
    address = at.address
    line = program.place(address)
    place = f"{line.file}:{line.line}: " if line else ""
    before = "" if line else f"at address {address}, "
    try:
        loops = loops_around(Graph(program.decoded(isa), machine), at)
    except TooManyPlacesError:
        return Stuck(place, f"at address {address}")
    if not loops:
        return Stuck(place, f"{before}in no loop")
    texts = dict.fromkeys(described(program, *loop, line) for loop in loops)
    return Stuck(place, f"{before}in the loop of {', in that of '.join([*texts][:_MOST_LOOPS])}")
