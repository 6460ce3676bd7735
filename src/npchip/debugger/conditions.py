"""Conditions on which a run stops, the watch for several along a run, and the stop itself."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from npchip.assembler.expressions import COMPARISONS, Op
from npchip.debugger.values import Cell, Value, Writers

if TYPE_CHECKING:
    from npchip import Chip


@dataclass(frozen=True)
class Compare:
    """``value op number``; of a cell in any NP, or in all, active or not."""

    value: Value
    op: Op
    number: int
    quantifier: Literal["any", "all"] | None = None

    def holds(self, chip: Chip) -> bool:
        """Return whether it holds now."""
        compare = COMPARISONS[self.op]
        if isinstance(self.value, Cell):
            found = compare(self.value.plane(chip), self.number)
            return bool(found.any() if self.quantifier == "any" else found.all())
        return bool(compare(self.value.value(chip), self.number))

    def triggers(self, writers: Writers) -> frozenset[int]:
        """Return the addresses of the instructions that may change the answer."""
        return writers.of(self.value)


@dataclass(frozen=True)
class MaskEmpty:
    """``mask empty``: no NP is active."""

    def holds(self, chip: Chip) -> bool:
        """Return whether it holds now."""
        return not chip.active.any()

    def triggers(self, writers: Writers) -> frozenset[int]:
        """Return the addresses of the instructions that may change the answer."""
        return writers.of(Cell("active"))


Test = Compare | MaskEmpty
"""What is true or not at every moment."""


@dataclass(frozen=True)
class Sent:
    """``output PORT``: something was sent to a port; by an active NP, a byte that compares so."""

    port: int
    op: Op | None = None
    number: int = 0

    def seen(self, chip: Chip) -> bool:
        """Return whether the last instruction, which sent to the port, has sent such a byte."""
        if self.op is None:
            return True
        send = chip.sends[-1]
        found = COMPARISONS[self.op](send.data.astype(int), self.number)
        return bool((found if send.active is None else found & send.active).any())


@dataclass(frozen=True)
class Changes:
    """``value changes``: an instruction has given it another value, of a cell in any NP."""

    value: Value

    def reading(self, chip: Chip) -> Any:
        """Return the value now, to be compared later."""
        if isinstance(self.value, Cell):
            return self.value.plane(chip).copy()
        return self.value.value(chip)


@dataclass(frozen=True)
class Condition:
    """A place or an event on which a run stops.

    Attributes:
        text: as it was written.
        places: stop in front of these addresses; empty for an event.
        test: must hold there; without places, stop when it becomes true.
        event: stop when it happens.
        triggers: addresses whose instructions can make an event happen or a test become true.
    """

    text: str
    places: frozenset[int]
    test: Test | None
    event: Sent | Changes | None
    triggers: frozenset[int]


class Monitor:
    """Watches for one condition along a run; knows how things were before."""

    def __init__(self, condition: Condition) -> None:
        self.condition = condition
        self._before: Any = None

    def begin(self, chip: Chip) -> None:
        """Take what is there for granted: only what changes from here on counts."""
        condition = self.condition
        if isinstance(condition.event, Changes):
            self._before = condition.event.reading(chip)
        elif condition.test is not None and not condition.places:
            self._before = condition.test.holds(chip)

    def arrives(self, chip: Chip) -> bool:
        """Return whether to stop in front of an address that is one of the places."""
        test = self.condition.test
        return test is None or test.holds(chip)

    def happens(self, chip: Chip) -> bool:
        """Return whether an instruction at one of the triggers has just made it happen."""
        condition = self.condition
        if isinstance(condition.event, Sent):
            return condition.event.seen(chip)
        before = self._before
        self.begin(chip)
        if isinstance(condition.event, Changes):
            return not np.array_equal(before, self._before)
        return bool(self._before and not before)


Reason = Literal[
    "step",
    "breakpoint",
    "frame",
    "place",
    "halted",
    "frames-exhausted",
    "cycle-limit",
    "trap",
    "outputs",
    "interrupted",
    "start",
]


@dataclass(frozen=True)
class Stop:
    """The reason for which a session has stopped.

    Attributes:
        reason: ``place`` is where somebody wanted to go; ``outputs`` cannot be read.
        message: a sentence.
        numbers: breakpoints that were hit.
    """

    reason: Reason
    message: str
    numbers: tuple[int, ...] = ()


class Watch:
    """Conditions along one run.

    Args:
        chip: the chip that runs.
        conditions: with the numbers that stand for them.
    """

    def __init__(self, chip: Chip, conditions: Iterable[tuple[int, Condition]]) -> None:
        self._chip = chip
        self._monitors = [(number, Monitor(condition)) for number, condition in conditions]
        self._places: dict[int, list[tuple[int, Monitor]]] = {}
        self._events: dict[int, list[tuple[int, Monitor]]] = {}
        for number, monitor in self._monitors:
            for address in monitor.condition.places:
                self._places.setdefault(address, []).append((number, monitor))
            for address in monitor.condition.triggers:
                self._events.setdefault(address, []).append((number, monitor))
        self._relevant = np.array(sorted({*self._places, *self._events}), np.intp)

    def begin(self) -> None:
        """Count only what changes from here on."""
        for _, monitor in self._monitors:
            monitor.begin(self._chip)

    def after(self, address: int) -> list[int]:
        """Return the numbers of the conditions that stop after the instruction at `address`."""
        chip = self._chip
        events, places = self._events.get(address), self._places.get(chip.pc)
        found = [number for number, item in events or () if item.happens(chip)]
        return found + [number for number, item in places or () if item.arrives(chip)]

    def stops_at(self, address: int) -> bool:
        """Return whether a condition may stop in front of an address."""
        return address in self._places

    def touched(self, executions: NDArray[Any]) -> bool:
        """Return whether an instruction that matters was executed, given how often each was."""
        return bool(executions[self._relevant].any())
