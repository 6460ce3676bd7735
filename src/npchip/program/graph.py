"""The graph of a program's places: where a program can be, and where it goes on from there.

A place holds the open calls, so that a routine is looked at for each of its callers apart and
every return has one successor.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from npchip.isa import Decoded
from npchip.machine import Machine

MAX_PLACES: Final = 4096
"""Beyond this nothing is said about a program."""

Words = Sequence[Decoded | None]
"""A program's words, taken apart; None for an undefined one, which is a trap."""


class Place(NamedTuple):
    """Where a program can be.

    Attributes:
        address: of the next instruction.
        stack: return addresses of the open calls, the newest last.
        depth: open masked regions.
    """

    address: int
    stack: tuple[int, ...] = ()
    depth: int = 0


RESET: Final = Place(0)
HALTED: Final = Place(-1)
"""Where a HALT leads."""
Edge = tuple[Place, Place]


class TooManyPlacesError(Exception):
    """The program has more places than can be looked at."""


def word_at(words: Words, address: int) -> Decoded | None:
    """Return a word; None beyond the last one, too."""
    return words[address] if address < len(words) else None


def successors(words: Words, machine: Machine, place: Place) -> tuple[Place | None, ...]:
    """Return the places that may follow one; None for a trap.

    Of a guarded jump, call, return or halt there are two: the first follows where its wire is
    set, and the second where it is not.

    Args:
        words: the program.
        machine: for the limits of its return stack and masks.
        place: any but `HALTED`.
    """
    address, stack, depth = place
    word = word_at(words, address)
    behind = None if word is None else word.form.depth_after(depth, machine.mask_depth)
    if word is None or behind is None:
        return (None,)
    flow = word.form.flow
    following = Place(address + 1, stack, behind)
    if flow is None:
        return (following,)
    after: Place | None = HALTED
    match flow.name, word.target:
        case "jump", int(target):
            after = Place(target, stack, behind)
        case "call", int(target):
            is_full = len(stack) >= machine.stack_depth
            after = None if is_full else Place(target, (*stack, address + 1), behind)
        case "ret", _:
            after = Place(stack[-1], stack[:-1], behind) if stack else None
    return (after,) if flow.guard is None else (after, following)


class Graph:
    """All places that a program can reach from reset.

    Args:
        words: the program.
        machine: for the limits of its return stack and masks.

    Attributes:
        words: the program.
        successors: of each place, as the function of that name returns them.

    Raises:
        TooManyPlacesError: there are more than `MAX_PLACES`.
    """

    def __init__(self, words: Words, machine: Machine) -> None:
        self.words = words
        self.successors: dict[Place, tuple[Place | None, ...]] = {}
        work = [RESET]
        while work:
            place = work.pop()
            if place in self.successors:
                continue
            if len(self.successors) >= MAX_PLACES:
                raise TooManyPlacesError
            self.successors[place] = successors(words, machine, place)
            work += self.following(place)[::-1]

    def following(self, place: Place) -> list[Place]:
        """Return the places that may follow one, without `HALTED`."""
        found = self.successors[place]
        return [after for after in found if after is not None and after != HALTED]

    def exposes(self, place: Place) -> bool:
        """Return whether a frame is taken at a place."""
        word = word_at(self.words, place.address)
        return word is not None and word.form.exposes
