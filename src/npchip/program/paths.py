"""Least and most cycles between two places, loops included.

Without the ways back to its header a loop has a shortest and a longest pass; so many of them, and
then a part of one, are what it takes. How many passes there can be is known from following the
program, or said by ``.loop`` above the header.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from npchip.program.graph import Edge, Place
from npchip.program.loops import Followed, Passes, components

Why = Literal["proven", "stated", "unbounded", "several entries"]
_ORDER: tuple[Why, ...] = ("proven", "stated", "unbounded", "several entries")


class CycleRange(NamedTuple):
    """Least and most cycles; the most may be `math.inf`."""

    least: int
    most: float

    def then(self, other: CycleRange) -> CycleRange:
        """One after the other."""
        return CycleRange(self.least + other.least, self.most + other.most)

    def times(self, least: int, most: float) -> CycleRange:
        """So many times."""
        return CycleRange(self.least * least, self.most * most if most and self.most else 0)

    def or_(self, other: CycleRange | None) -> CycleRange:
        """One or the other."""
        if other is None:
            return self
        return CycleRange(min(self.least, other.least), max(self.most, other.most))


@dataclass(eq=False)
class Loop:
    """What is known of a loop.

    Attributes:
        address: of its header.
        least, most: passes each time that it is entered; the most may be `math.inf`.
        why: ``proven`` from the program, ``stated`` by ``.loop``, ``several entries`` (it is
            entered elsewhere than at its header), or ``unbounded``.
    """

    address: int
    least: int
    most: float
    why: Why


@dataclass(eq=False)
class Paths:
    """Computes the shortest and the longest paths of a program.

    Args:
        followed: the program.
        costs: cycles of each word.
        stated: least and most passes of loops by the address of the header.

    Attributes:
        loops: all loops that were met, by the address of the header.
    """

    followed: Followed
    costs: Sequence[int]
    stated: Mapping[int, tuple[int, int]]
    loops: dict[int, Loop] = field(default_factory=dict)

    def leaving(
        self, start: Place, inside: Iterable[Place], *, once: bool = False
    ) -> dict[Edge, CycleRange]:
        """Cycles from `start`, included, along each way out of `inside`.

        Args:
            start: one of `inside`.
            inside: what may be passed.
            once: `start` is not passed again: a way back to it leads out too.
        """
        nodes = self.followed.reached(start, inside)
        return self._region(start, nodes, start if once else None)

    def _region(
        self, start: Place, nodes: frozenset[Place], cut: Place | None
    ) -> dict[Edge, CycleRange]:
        """See `leaving`; `nodes` are those that `start` leads to, and `cut` leads out."""
        followed = self.followed
        arrive: dict[Place, CycleRange] = {start: CycleRange(0, 0)}
        leaving: dict[Edge, CycleRange] = {}

        def pass_on(edge: Edge, cycles: CycleRange) -> None:
            after = edge[1]
            if after in nodes and after != cut:
                arrive[after] = cycles.or_(arrive.get(after))
            else:
                leaving[edge] = cycles.or_(leaving.get(edge))

        def inner(place: Place) -> Iterator[Place]:
            return (way for way in followed.after[place] if way in nodes and way != cut)

        for part in components(start, inner):
            place = part[0]
            entries = [place for place in part if place in arrive]
            if not entries:
                continue  # only behind a loop that is never left
            if len(part) == 1 and place not in inner(place):
                for after in followed.after[place]:
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
                    for after in followed.after[place]:
                        if after not in part:
                            pass_on((place, after), CycleRange(least, math.inf))
        return leaving

    def _loop(self, header: Place, nodes: frozenset[Place]) -> dict[Edge, CycleRange]:
        """Cycles from the arrival at a loop along each way out of it."""
        leaving = self._region(header, nodes, header)
        around: CycleRange | None = None
        for edge, cycles in leaving.items():
            if edge[1] == header:
                around = cycles.or_(around)
        assert around is not None
        passes = self._passes(header, nodes, [edge for edge in leaving if edge[1] != header])
        return {
            edge: around.times(each.first - 1, each.last - 1).then(leaving[edge])
            for edge, each in passes.items()
        }

    def _passes(
        self, header: Place, nodes: frozenset[Place], exits: list[Edge]
    ) -> dict[Edge, Passes]:
        """In which passes each way out of a loop can be taken."""
        known: dict[Edge, Passes] = {}
        if nodes <= self.followed.loops.get(header, frozenset()):  # else it is another loop
            known = self.followed.passes[header]
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
