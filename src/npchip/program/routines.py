"""The routines of a program: what each reaches before it returns, and where its callers go on.

Unlike in the graph of places a routine is looked at once, whoever has called it, and the open
calls are not told apart. Behind a call flow goes on only if the routine can return.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field

from npchip.program.graph import RESET, Place, Words, word_at


@dataclass(eq=False)
class Routine:
    """A routine, as it is called with so many masked regions open.

    Attributes:
        entry: where it begins. No place of a routine has a stack.
        places: those that are reached from its entry before it returns.
        callers: return addresses of its calls, and the routines that these belong to.
        behind: where its callers go on, by the open masked regions where it returns.
    """

    entry: Place
    places: set[Place] = field(default_factory=set)
    callers: list[tuple[int, Routine]] = field(default_factory=list)
    behind: dict[int, dict[Place, None]] = field(default_factory=dict)


Arrive = Callable[[Routine, Place, int], bool]
"""Returns whether a place that a routine reaches for the first time is followed; it is also told
the address of the instruction that leads there, -1 where execution begins."""


class Finder:
    """Finds the routines of a program.

    Args:
        words: the program.
        mask_depth: how many masked regions may be open.
        entry: where execution begins; its stack holds callers of the routine that is under way.
        arrive: decides what is followed.

    Attributes:
        own: what is reached without a call.
        called: the routines that are called, by their entries.
        returns: by place of a return for each routine that ends there `Routine.behind`.
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
        """Go on behind calls of routines that never return, as if they did."""
        while stuck := [routine for routine in self.called.values() if not routine.behind]:
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
        """Follow all ways that lead on from a place."""
        address, _, depth = place
        word = word_at(self._words, address)
        behind = None if word is None else word.form.depth_after(depth, self._mask_depth)
        if word is None or behind is None:
            return
        flow, target = word.form.flow, word.target
        match flow and flow.name, target:
            case "jump", int(target):
                self._work.append((routine, Place(target, (), behind), address))
            case "call", int(target):
                self._call(routine, Place(target, (), behind), address)
            case "ret", _:
                self._return(routine, behind)
                self.returns.setdefault(place, []).append(routine.behind[behind])
        if flow is None or flow.guard is not None or (flow.name == "call" and target is None):
            self._work.append((routine, Place(address + 1, (), behind), address))

    def _call(self, routine: Routine, entry: Place, address: int) -> None:
        called = self.called.setdefault(entry, Routine(entry))
        caller = address + 1, routine
        called.callers.append(caller)
        self._work.append((called, entry, address))
        for depth in called.behind:
            self._resume(called, depth, caller)

    def _return(self, routine: Routine, depth: int) -> None:
        if depth not in routine.behind:
            routine.behind[depth] = {}
            for caller in routine.callers:
                self._resume(routine, depth, caller)

    def _resume(self, routine: Routine, depth: int, caller: tuple[int, Routine]) -> None:
        """Go on where a routine has been called from."""
        address, outer = caller
        place = Place(address, (), depth)
        routine.behind[depth][place] = None
        self._work.append((outer, place, address - 1))


Routines = Mapping[int, AbstractSet[int]]
"""For each entry, 0 being the program's own, the addresses that are reached before it returns."""


def find_routines(words: Words, mask_depth: int) -> Routines:
    """Return the routines of a program whose masks nest.

    Args:
        words: the program.
        mask_depth: how many masked regions may be open.
    """
    finder = Finder(words, mask_depth)
    found: dict[int, set[int]] = {}
    for routine in (finder.own, *finder.called.values()):
        addresses = found.setdefault(routine.entry.address, set())
        addresses.update(place.address for place in routine.places if place.address < len(words))
    return found
