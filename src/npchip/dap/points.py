"""Breakpoints of all kinds, with hit counts and log points."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from operator import eq, ge, gt, le, lt
from typing import Any, Final, NamedTuple

from npchip.base.errors import NpchipError
from npchip.dap.arguments import wrong
from npchip.debugger.conditions import Condition, Stop, Test
from npchip.debugger.language import parse_condition, parse_test, parse_value
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, Quantity

_HITS: Final = re.compile(r"\s*(==|=|>=|>|<=|<|%)?\s*(\d{1,12})\s*", re.ASCII)
_COUNTS: Final[Mapping[str, Callable[[int, int], bool]]] = {
    "==": eq,
    "=": eq,
    ">=": ge,
    ">": gt,
    "<=": le,
    "<": lt,
    "%": lambda count, number: number > 0 and count % number == 0,
}
_HOLE: Final = re.compile(r"\{([^{}]*)\}")


class Spec(NamedTuple):
    """A breakpoint as a client asks for it.

    Attributes:
        kind: the reason of its stops.
        text: where or when it stops, in the language of the debugger.
        test: what must hold too; nothing for always.
        hits: at which of its hits it stops; nothing for all.
        log: what to say instead of a stop; nothing for a stop.
    """

    kind: str
    text: str
    test: str = ""
    hits: str = ""
    log: str = ""


@dataclass
class Point:
    """A breakpoint of the client.

    Attributes:
        spec: as the client asks for it.
        number: its number in the debugger, which the client knows too.
        error: why it makes no sense in this program.
        condition: what the debugger stops at.
        test: what must hold there too.
        wanted: tells from the number of a hit whether it counts.
        log: texts and quantities to say instead of a stop.
        moments: when it was hit.
    """

    spec: Spec
    number: int = 0
    error: str = ""
    condition: Condition | None = None
    test: Test | None = None
    wanted: Callable[[int], bool] = lambda _number: True
    log: Sequence[str | Quantity] = ()
    moments: set[int] = field(default_factory=set)


class Hit(NamedTuple):
    """A stop at breakpoints, as the client is told: the points that count, and their messages."""

    points: list[Point]
    unknown: bool
    said: list[str]


class Points:
    """The breakpoints of a client, in the debugger.

    Args:
        debugger: the debugger.

    Attributes:
        on: False to stop at none.
    """

    def __init__(self, debugger: Debugger) -> None:
        self._debugger = debugger
        self._groups: dict[str, list[Point]] = {}
        self.on = True

    def set(self, group: str, specs: Sequence[Spec]) -> list[Point]:
        """Replace the breakpoints of a group; those that stay keep their hits.

        Args:
            group: such as a file.
            specs: the breakpoints.
        """
        kept = {point.spec: point for point in self._groups.get(group, ())}
        points = [
            kept.pop(spec) if spec in kept else self._made(spec) for spec in dict.fromkeys(specs)
        ]
        for point in kept.values():
            if point.number in self._debugger.breakpoints:
                del self._debugger.breakpoints[point.number]
        for point in points:
            if point.number not in self._debugger.breakpoints:  # new, or deleted by a command
                self._add(point)
        self._groups[group] = points
        found = {point.spec: point for point in points}
        return [found[spec] for spec in specs]

    def _made(self, spec: Spec) -> Point:
        names, point = self._debugger.names, Point(spec)
        try:
            point.condition = parse_condition(spec.text, names)
            if spec.test.strip():
                point.test = parse_test(spec.test, names)
            if point.condition.places and point.condition.test is None:
                text = f"{spec.text} if {spec.test}" if point.test else spec.text
                point.condition = replace(point.condition, text=text, test=point.test)
            point.wanted = _counted(spec.hits)
            point.log = [
                parse_value(part, names) if index % 2 else part
                for index, part in enumerate(_HOLE.split(spec.log))
            ]
        except NpchipError as fault:
            hint = f"; {fault.hint}" if fault.hint else ""
            point.error = f"{fault.message}{hint} [{fault.code}]"
        return point

    def _add(self, point: Point) -> None:
        if point.condition is None or point.error:
            added = self._debugger.add_broken(point.spec.text, point.error)
        else:
            added = self._debugger.add_condition(point.condition, enabled=self.on)
        point.number = added.number

    def hit(self, stop: Stop, *, back: bool) -> Hit:
        """Count a stop of the debugger at breakpoints; return what the client is told of it.

        Log points say nothing on the way back.
        """
        debugger = self._debugger
        known = {point.number: point for points in self._groups.values() for point in points}
        found = Hit([], any(number not in known for number in stop.numbers), [])
        for point in (known[number] for number in stop.numbers if number in known):
            if point.test is not None and not point.test.holds(debugger.chip):
                continue
            point.moments.add(debugger.time)
            if not point.wanted(sum(moment <= debugger.time for moment in point.moments)):
                continue
            if not point.spec.log:
                found.points.append(point)
            elif not back:
                found.said.append("".join(self._shown(part) for part in point.log))
        return found

    def _shown(self, part: str | Quantity) -> str:
        if isinstance(part, str):
            return part
        chip = self._debugger.chip
        if not isinstance(part, Cell):
            return str(part.value(chip))
        plane = part.plane(chip)
        least, most = int(plane.min()), int(plane.max())
        return str(least) if least == most else f"{least} to {most}"

    def forget(self, time: int) -> None:
        """Forget the hits after a time, which an edit has changed."""
        for points in self._groups.values():
            for point in points:
                point.moments = {moment for moment in point.moments if moment <= time}


def _counted(text: str) -> Callable[[int], bool]:
    if not text.strip():
        return lambda _number: True
    found = _HITS.fullmatch(text)
    if not found:
        raise wrong("hit count", "a number, after ==, >=, >, <=, < or % if wanted", text)
    compare, wanted = _COUNTS[found[1] or "=="], int(found[2])
    return lambda number: compare(number, wanted)


def described(point: Point, more: Mapping[str, Any]) -> dict[str, Any]:
    """Return a breakpoint as the protocol has it."""
    if point.error:
        return {"id": point.number, "verified": False, "message": point.error, **more}
    return {"id": point.number, "verified": True, **more}
