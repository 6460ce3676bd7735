"""The routines of a program: the places of each, and where its callers continue.

Unlike in the graph, a routine is analysed once for all callers. The flow continues after a call
only if the routine can return.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field

from npchip.program.graph import RESET, Place, Words, word_at


@dataclass(eq=False)
class Routine:
    """A routine, called with a certain number of open masked regions.

    Attributes:
        entry: its first place. The places of a routine have no stack.
        places: places that are reached from its entry before it returns.
        callers: return addresses of its calls, each with the routine that calls.
        continuations: places where its callers continue, by the mask depth at its return.
    """

    entry: Place
    places: set[Place] = field(default_factory=set)
    callers: list[tuple[int, Routine]] = field(default_factory=list)
    continuations: dict[int, dict[Place, None]] = field(default_factory=dict)


Arrive = Callable[[Routine, Place, int], bool]
"""Decides whether to follow a place that a routine reaches for the first time.

The int is the address of the instruction before it; -1 at the start of execution.
"""


class Finder:
    """Finds the routines of a program.

    Args:
        words: the program.
        mask_depth: number of masked regions that can be open.
        entry: start of execution; its stack holds the open calls.
        arrive: decides which places are followed.

    Attributes:
        own: the places that are reached without a call.
        called: called routines by their entries.
        returns: for each place of a return the continuations of the routines that end there.
    """

    def __init__(
        self,
        words: Words,
        mask_depth: int,
        entry: Place = RESET,
        arrive: Arrive = lambda *_: True,
    ) -> None:
        self._words = words
        self._mask_depth = mask_depth
        self._arrive = arrive
        entry, stack = entry._replace(stack=()), entry.stack
        self.own = inner = Routine(entry)
        for address in reversed(stack):
            outer = Routine(entry)
            inner.callers.append((address, outer))
            inner = outer
        self.called: dict[Place, Routine] = {}
        self.returns: dict[Place, list[dict[Place, None]]] = {}
        self._work = [(self.own, entry, -1)]
        self._follow()

    def follow_all_calls(self) -> None:
        """Continue after calls of routines that never return, as if they did."""
        while stuck := [routine for routine in self.called.values() if not routine.continuations]:
            for routine in stuck:
                self._return(routine, routine.entry.depth)
            self._follow()

    def _follow(self) -> None:
        while self._work:
            routine, place, origin = self._work.pop()
            if place not in routine.places and self._arrive(routine, place, origin):
                routine.places.add(place)
                self._leave(routine, place)

    def _leave(self, routine: Routine, place: Place) -> None:
        address, _, depth = place
        word = word_at(self._words, address)
        new_depth = None if word is None else word.form.depth_after(depth, self._mask_depth)
        if word is None or new_depth is None:
            return
        flow, target = word.form.flow, word.target
        match flow and flow.name, target:
            case "jump", int(target):
                self._work.append((routine, Place(target, (), new_depth), address))
            case "call", int(target):
                self._call(routine, Place(target, (), new_depth), address)
            case "ret", _:
                self._return(routine, new_depth)
                self.returns.setdefault(place, []).append(routine.continuations[new_depth])
        if flow is None or flow.guard is not None or (flow.name == "call" and target is None):
            self._work.append((routine, Place(address + 1, (), new_depth), address))

    def _call(self, routine: Routine, entry: Place, address: int) -> None:
        called = self.called.setdefault(entry, Routine(entry))
        caller = address + 1, routine
        called.callers.append(caller)
        self._work.append((called, entry, address))
        for depth in called.continuations:
            self._resume(called, depth, caller)

    def _return(self, routine: Routine, depth: int) -> None:
        if depth not in routine.continuations:
            routine.continuations[depth] = {}
            for caller in routine.callers:
                self._resume(routine, depth, caller)

    def _resume(self, routine: Routine, depth: int, caller: tuple[int, Routine]) -> None:
        address, outer = caller
        place = Place(address, (), depth)
        routine.continuations[depth][place] = None
        self._work.append((outer, place, address - 1))


Routines = Mapping[int, AbstractSet[int]]
"""Addresses of each routine, by its entry; that of the program itself is 0."""


def find_routines(words: Words, mask_depth: int) -> Routines:
    """Return the routines of a program whose masks nest.

    Args:
        words: the program.
        mask_depth: number of masked regions that can be open.
    """
    finder = Finder(words, mask_depth)
    found: dict[int, set[int]] = {}
    for routine in (finder.own, *finder.called.values()):
        addresses = found.setdefault(routine.entry.address, set())
        addresses.update(place.address for place in routine.places if place.address < len(words))
    return found
