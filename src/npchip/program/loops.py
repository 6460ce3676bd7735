"""Abstract execution of a program with known bits.

A loop is a strongly connected component of the graph that is entered at one place, its *header*.
Without the edges back to the header, the components of its places are the inner loops. A *pass* is
one execution of the header. A loop is followed pass by pass, until no edge leads back or the
knowledge repeats. A loop that exposes frames keeps only what holds in all its passes.
"""

from __future__ import annotations

import math
from collections import defaultdict, deque
from collections.abc import Callable, Hashable, Iterable, Iterator
from functools import reduce
from typing import Final, NamedTuple, TypeVar

from npchip.isa import Isa
from npchip.program.graph import HALTED, RESET, Edge, Graph, Place, TooManyPlacesError
from npchip.program.known import Knowledge, Transfer, after_reset, meet

MOST_TRANSFERS: Final = 60_000
"""Instructions executed before loops are followed for fewer passes."""
_MOST_PASSES: Final = (70_000, 300, 0)  # the first is more than 16 bits can count
_DEEPEST: Final = 60

Sink = Callable[[Edge, Knowledge], None]
_K = TypeVar("_K", Edge, Place)


class Passes(NamedTuple):
    """First and last pass of a loop in which an edge can be taken; the last may be `math.inf`."""

    first: int
    last: float


class _OutOfBudgetError(Exception):
    """Too many instructions were executed."""


class AbstractExecution:
    """The result of an abstract execution.

    Args:
        graph: graph of the program.
        isa: the program's instruction set.

    Attributes:
        graph: graph of the program.
        after: for each reached place its possible successors, with `HALTED`. A branch with a
            known outcome has one.
        passes: for each header the passes in which the edges inside and out of its loop are
            taken.
        loops: for each header the places of its loop.
    """

    def __init__(self, graph: Graph, isa: Isa) -> None:
        self.graph = graph
        self._transfers = [None if word is None else Transfer(word, isa) for word in graph.words]
        self._parts: dict[tuple[Place, frozenset[Place], Place | None], list[list[Place]]] = {}
        for most in _MOST_PASSES:
            self.after: dict[Place, list[Place]] = {}
            self.passes: dict[Place, dict[Edge, Passes]] = defaultdict(dict)
            self._open: list[tuple[Place, int]] = []  # headers of the current loops, and passes
            self.loops: dict[Place, frozenset[Place]] = {}
            self._most = most
            self._budget = MOST_TRANSFERS if most else math.inf
            try:
                places = frozenset(graph.successors)
                self._region(RESET, after_reset(), places, None, lambda *_: None)
            except _OutOfBudgetError:
                continue
            break

    def _step(self, place: Place, known: Knowledge) -> Iterator[tuple[Edge, Knowledge]]:
        """Yield the edges that leave a place, with the knowledge after it."""
        reached = self.after.setdefault(place, [])
        address = place.address
        transfer = self._transfers[address] if address < len(self._transfers) else None
        if transfer is None:
            return  # a trap
        self._budget -= 1
        if self._budget < 0:
            raise _OutOfBudgetError
        known, wire = transfer.apply(known, place.depth)
        for after, excluded in zip(self.graph.successors[place], (False, True), strict=False):
            if after is None or wire is excluded:
                continue
            if after not in reached:
                reached.append(after)
            edge = place, after
            for header, number in self._open:
                first, last = self.passes[header].get(edge, (number, number))
                self.passes[header][edge] = Passes(min(first, number), max(last, number))
            yield edge, known

    def _region(
        self,
        start: Place,
        known: Knowledge,
        nodes: frozenset[Place],
        cut: Place | None,
        sink: Sink,
    ) -> None:
        """Follow the edges inside `nodes`; pass those that leave them, or lead to `cut`, on."""
        arrive = {start: known}

        def pass_on(edge: Edge, state: Knowledge) -> None:
            after = edge[1]
            if after not in nodes or after == cut:
                sink(edge, state)
            else:
                _join(arrive, after, state)

        for part in self._components(start, nodes, cut):
            entries = {place: arrive[place] for place in part if place in arrive}
            place = part[0]
            if not entries:
                continue
            if len(part) == 1 and (place == cut or place not in self.graph.following(place)):
                for edge, state in self._step(place, arrive[place]):
                    pass_on(edge, state)
            elif len(entries) == 1:
                ((header, state),) = entries.items()
                self._loop(header, state, frozenset(part), pass_on)
            else:
                self._tangle(entries, frozenset(part), pass_on)

    def _loop(self, header: Place, known: Knowledge, nodes: frozenset[Place], sink: Sink) -> None:
        """Follow a loop. The knowledge of its exits holds after any number of passes."""
        if len(self._open) >= _DEEPEST:
            raise TooManyPlacesError
        self.loops[header] = nodes & self.loops.get(header, nodes)
        most = 0 if any(map(self.graph.exposes, nodes)) else self._most
        seen: dict[Hashable, int] = {}
        exits: dict[Edge, Knowledge] = {}
        back: list[Knowledge] = []  # at the edges to another pass

        def leave(edge: Edge, state: Knowledge) -> None:
            if edge[1] == header:
                back.append(state)
            else:
                _join(exits, edge, state)

        endless, number = math.inf, 0  # the pass from which on they repeat
        while True:
            number += 1
            if number <= most:
                seen[frozenset(known.items())] = number
            back.clear()
            self._open.append((header, number))
            self._region(header, known, nodes, header, leave)
            self._open.pop()
            if not back:
                break
            found = reduce(meet, back)
            if number < most:
                endless = seen.get(frozenset(found.items()), math.inf)
            else:  # keep only what holds in all further passes
                found = meet(known, found)
                endless = max(1, most) if found == known else math.inf
            if endless < math.inf:
                break
            known = found
        passes = self.passes[header]
        for edge, each in passes.items():
            if each.last >= endless:
                passes[edge] = Passes(each.first, math.inf)
        for edge, state in exits.items():
            sink(edge, state)

    def _tangle(self, entries: dict[Place, Knowledge], nodes: frozenset[Place], sink: Sink) -> None:
        """Follow a loop with several entries, and keep only what always holds."""
        known, work = dict(entries), deque(entries)
        exits: dict[Edge, Knowledge] = {}
        while work:
            place = work.popleft()
            for edge, state in self._step(place, known[place]):
                after = edge[1]
                if after not in nodes:
                    _join(exits, edge, state)
                    continue
                new = meet(known[after], state) if after in known else state
                if new != known.get(after):
                    known[after] = new
                    work.append(after)
        for edge, state in exits.items():
            sink(edge, state)

    def _components(
        self, start: Place, nodes: frozenset[Place], cut: Place | None
    ) -> list[list[Place]]:
        key = start, nodes, cut
        if key not in self._parts:
            self._parts[key] = components(
                start,
                lambda place: (
                    way for way in self.graph.following(place) if way in nodes and way != cut
                ),
            )
        return self._parts[key]

    def reached(self, start: Place, inside: Iterable[Place]) -> frozenset[Place]:
        """Return the places that can be reached from `start` without leaving `inside`."""
        inside = set(inside)
        found, work = {start}, [start]
        while work:
            for way in self.after[work.pop()]:
                if way in inside and way not in found and way != HALTED:
                    found.add(way)
                    work.append(way)
        return frozenset(found)


def _join(found: dict[_K, Knowledge], key: _K, state: Knowledge) -> None:
    found[key] = meet(found[key], state) if key in found else state


def components(start: Place, after: Callable[[Place], Iterator[Place]]) -> list[list[Place]]:
    """Return the strongly connected components in topological order (Tarjan 1972)."""
    numbers: dict[Place, int] = {start: 0}
    low: dict[Place, int] = {start: 0}
    path, open_places = [start], {start}
    parts: list[list[Place]] = []
    work: list[tuple[Place, Iterator[Place]]] = [(start, after(start))]
    while work:
        place, rest = work[-1]
        for item in rest:
            if item not in numbers:
                numbers[item] = low[item] = len(numbers)
                path.append(item)
                open_places.add(item)
                work.append((item, after(item)))
                break
            if item in open_places:
                low[place] = min(low[place], numbers[item])
        else:
            work.pop()
            if work:
                low[work[-1][0]] = min(low[work[-1][0]], low[place])
            if low[place] == numbers[place]:
                part: list[Place] = []
                while not part or part[-1] != place:
                    part.append(path.pop())
                    open_places.discard(part[-1])
                parts.append(part)
    return parts[::-1]
