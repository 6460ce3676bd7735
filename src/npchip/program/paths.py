"""Least and most cycles between two places.

A loop takes a number of complete passes and then a partial one. Each pass has a shortest and a
longest path. The number of passes is proven by abstract execution, or stated by ``.loop`` above
the header.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from typing import Literal, NamedTuple

from npchip.program.graph import Edge, Place
from npchip.program.loops import AbstractExecution, Passes, components

Why = Literal["proven", "stated", "unbounded", "several entries"]
_ORDER: tuple[Why, ...] = ("proven", "stated", "unbounded", "several entries")


class CycleRange(NamedTuple):
    """Least and most cycles; the most may be `math.inf`."""

    least: int
    most: float

    def then(self, other: CycleRange) -> CycleRange:
        """Return the cycles of one after the other."""
        return CycleRange(self.least + other.least, self.most + other.most)

    def times(self, least: int, most: float) -> CycleRange:
        """Return the cycles of `least` to `most` repetitions."""
        return CycleRange(self.least * least, self.most * most if most and self.most else 0)

    def or_(self, other: CycleRange | None) -> CycleRange:
        """Return the cycles of one or the other."""
        if other is None:
            return self
        return CycleRange(min(self.least, other.least), max(self.most, other.most))


def union(ranges: Iterable[CycleRange]) -> CycleRange | None:
    """Return the smallest range that holds all; None if there are none."""
    found = list(ranges)
    return reduce(CycleRange.or_, found) if found else None


@dataclass(eq=False)
class Loop:
    """Bounds of the passes of a loop.

    Attributes:
        address: address of its header.
        least, most: passes each time it is entered; the most may be `math.inf`.
        why: ``proven`` from the program, ``stated`` by ``.loop``, ``several entries`` (it is
            also entered elsewhere than at its header), or ``unbounded``.
    """

    address: int
    least: int
    most: float
    why: Why


@dataclass(eq=False)
class Paths:
    """Computes the shortest and the longest paths of a program.

    Args:
        execution: the program.
        costs: cycles of each word.
        stated: least and most passes of loops, by the address of the header.

    Attributes:
        loops: loops found so far, by the address of the header.
    """

    execution: AbstractExecution
    costs: Sequence[int]
    stated: Mapping[int, tuple[int, int]]
    loops: dict[int, Loop] = field(default_factory=dict)

    def leaving(
        self, start: Place, inside: Iterable[Place], *, once: bool = False
    ) -> dict[Edge, CycleRange]:
        """Return the cycles from `start`, included, to each edge that leaves `inside`.

        Args:
            start: one of `inside`.
            inside: the places that a path may use.
            once: whether an edge back to `start` leaves, too.
        """
        nodes = self.execution.reached(start, inside)
        return self._region(start, nodes, start if once else None)

    def _region(
        self, start: Place, nodes: frozenset[Place], cut: Place | None
    ) -> dict[Edge, CycleRange]:
        """Do as `leaving` with the places `nodes`; an edge to `cut` leaves, too."""
        execution = self.execution
        arrive: dict[Place, CycleRange] = {start: CycleRange(0, 0)}
        leaving: dict[Edge, CycleRange] = {}

        def pass_on(edge: Edge, cycles: CycleRange) -> None:
            after = edge[1]
            if after in nodes and after != cut:
                arrive[after] = cycles.or_(arrive.get(after))
            else:
                leaving[edge] = cycles.or_(leaving.get(edge))

        def inner(place: Place) -> Iterator[Place]:
            return (way for way in execution.after[place] if way in nodes and way != cut)

        for part in components(start, inner):
            place = part[0]
            entries = [place for place in part if place in arrive]
            if not entries:
                continue  # after an endless loop
            if len(part) == 1 and place not in inner(place):
                for after in execution.after[place]:
                    cost = self.costs[place.address]
                    pass_on((place, after), arrive[place].then(CycleRange(cost, cost)))
            elif len(entries) == 1:
                for edge, cycles in self._loop(entries[0], frozenset(part)).items():
                    pass_on(edge, arrive[entries[0]].then(cycles))
            else:
                for place in entries:
                    self._note(place.address, 1, math.inf, "several entries")
                least = min(arrive[place].least for place in entries)
                for place in part:
                    for after in execution.after[place]:
                        if after not in part:
                            pass_on((place, after), CycleRange(least, math.inf))
        return leaving

    def _loop(self, header: Place, nodes: frozenset[Place]) -> dict[Edge, CycleRange]:
        """Return the cycles from the entry of a loop to each edge that leaves it."""
        leaving = self._region(header, nodes, header)
        around = union(cycles for edge, cycles in leaving.items() if edge[1] == header)
        assert around is not None
        passes = self._passes(header, nodes, [edge for edge in leaving if edge[1] != header])
        return {
            edge: around.times(each.first - 1, each.last - 1).then(leaving[edge])
            for edge, each in passes.items()
        }

    def _passes(
        self, header: Place, nodes: frozenset[Place], exits: list[Edge]
    ) -> dict[Edge, Passes]:
        """Return the passes in which each edge that leaves a loop can be taken."""
        known: dict[Edge, Passes] = {}
        if nodes <= self.execution.loops.get(header, frozenset()):  # else it is another loop
            known = self.execution.passes[header]
        proven = {edge: known.get(edge, Passes(1, math.inf)) for edge in exits}
        least, most = self.stated.get(header.address, (1, math.inf))
        found = {
            edge: Passes(max(each.first, least), min(each.last, most))
            for edge, each in proven.items()
            if each.first <= most and each.last >= least
        }
        if found:
            fewest = min(each.first for each in found.values())
            longest = max(each.last for each in found.values())
            why: Why = "unbounded"
            if longest < math.inf:
                bounded = all(each.last < math.inf for each in proven.values())
                why = "proven" if bounded and found == proven else "stated"
            self._note(header.address, fewest, longest, why)
        return found

    def _note(self, header: int, least: int, most: float, why: Why) -> None:
        known = self.loops.setdefault(header, Loop(header, least, most, why))
        known.least = min(known.least, least)
        known.most = max(known.most, most)
        known.why = max(known.why, why, key=_ORDER.index)
