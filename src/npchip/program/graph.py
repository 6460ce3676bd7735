"""The control-flow graph of a program.

Its nodes are places. A place includes the open calls, so that a routine is analysed for each
caller apart and every return has one successor.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from npchip.isa import Decoded
from npchip.machine import Machine

MAX_PLACES: Final = 4096
"""Larger programs are not analysed."""

Words = Sequence[Decoded | None]
"""The decoded words of a program; None for an undefined one, which is a trap."""


class Place(NamedTuple):
    """A state of the control flow.

    Attributes:
        address: address of the next instruction.
        stack: return addresses of the open calls, the newest last.
        depth: number of open masked regions.
    """

    address: int
    stack: tuple[int, ...] = ()
    depth: int = 0


RESET: Final = Place(0)
HALTED: Final = Place(-1)
"""The successor of a HALT."""
Edge = tuple[Place, Place]


class TooManyPlacesError(Exception):
    """The program has too many places to be analysed."""


def word_at(words: Words, address: int) -> Decoded | None:
    """Return the word at an address; None for an undefined one and past the end."""
    return words[address] if address < len(words) else None


def successors(words: Words, machine: Machine, place: Place) -> tuple[Place | None, ...]:
    """Return the places that may follow a place; None for a trap.

    A guarded jump, call, return or halt has two: the first follows if its wire is set, and the
    second if it is not.

    Args:
        words: the program.
        machine: limits of the return stack and of the masks.
        place: any place but `HALTED`.
    """
    address, stack, depth = place
    word = word_at(words, address)
    new_depth = None if word is None else word.form.depth_after(depth, machine.mask_depth)
    if word is None or new_depth is None:
        return (None,)
    flow = word.form.flow
    following = Place(address + 1, stack, new_depth)
    if flow is None:
        return (following,)
    after: Place | None = HALTED
    match flow.name, word.target:
        case "jump", int(target):
            after = Place(target, stack, new_depth)
        case "call", int(target):
            is_full = len(stack) >= machine.stack_depth
            after = None if is_full else Place(target, (*stack, address + 1), new_depth)
        case "ret", _:
            after = Place(stack[-1], stack[:-1], new_depth) if stack else None
    return (after,) if flow.guard is None else (after, following)


class Graph:
    """All places that a program can reach from reset.

    Args:
        words: the program.
        machine: limits of the return stack and of the masks.

    Attributes:
        words: the program.
        successors: for each place the result of the function `successors`.

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
        """Return the places that may follow a place, without `HALTED`."""
        found = self.successors[place]
        return [after for after in found if after is not None and after != HALTED]

    def exposes(self, place: Place) -> bool:
        """Return whether the instruction at a place exposes a frame."""
        word = word_at(self.words, place.address)
        return word is not None and word.form.exposes
