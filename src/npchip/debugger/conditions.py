"""Conditions that stop a run, the watch for several of them, and the stop itself."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from npchip.assembler.expressions import COMPARISONS, Op
from npchip.debugger.values import Cell, Quantity

if TYPE_CHECKING:  # conditions are parsed where there is no NumPy
    from numpy.typing import NDArray

    from npchip import Chip


@dataclass(frozen=True)
class Compare:
    """``value op number``; for a cell, in any NP or in all, active or not."""

    value: Quantity
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


@dataclass(frozen=True)
class MaskEmpty:
    """``mask empty``: no NP is active."""

    value: ClassVar = Cell("active")

    def holds(self, chip: Chip) -> bool:
        """Return whether it holds now."""
        return not chip.active.any()


Test = Compare | MaskEmpty
"""A statement on `value` that is true or false at every moment."""


@dataclass(frozen=True)
class Sent:
    """``output PORT [op NUMBER]``: the port was sent something, or such a byte of an active NP."""

    port: int
    op: Op | None = None
    number: int = 0

    def seen(self, chip: Chip) -> bool:
        """Return whether the last instruction, which sent to the port, sent such a byte."""
        if self.op is None:
            return True
        send = chip.sends[-1]
        found = COMPARISONS[self.op](send.data.astype(int), self.number)
        return bool((found if send.active is None else found & send.active).any())


@dataclass(frozen=True)
class Changes:
    """``value changes``: an instruction changed the value; of a cell, in any NP."""

    value: Quantity

    def reading(self, chip: Chip) -> bytes | int:
        """Return the value now; of a cell, its bytes in all NPs."""
        if isinstance(self.value, Cell):
            return self.value.plane(chip).tobytes()
        return self.value.value(chip)


@dataclass(frozen=True)
class Condition:
    """A place or an event that stops a run.

    Attributes:
        text: the condition as written.
        places: addresses to stop at, before they are executed; empty for an event.
        test: must hold at a place. Without places, the run stops when it becomes true.
        event: stops the run when it happens.
        triggers: addresses of the instructions that can cause the event or make the test true.
    """

    text: str
    places: frozenset[int] = frozenset()
    test: Test | None = None
    event: Sent | Changes | None = None
    triggers: frozenset[int] = frozenset()


class _Monitor:
    """Watches for one condition, known by its number."""

    def __init__(self, number: int, condition: Condition) -> None:
        self.number = number
        self.condition = condition
        self._before: Any = None

    def begin(self, chip: Chip) -> None:
        condition = self.condition
        if isinstance(condition.event, Changes):
            self._before = condition.event.reading(chip)
        elif condition.test is not None and not condition.places:
            self._before = condition.test.holds(chip)

    def happens(self, chip: Chip) -> bool:
        """Return whether an instruction at one of the triggers has just caused the event."""
        condition = self.condition
        if isinstance(condition.event, Sent):
            return condition.event.seen(chip)
        before = self._before
        self.begin(chip)
        if isinstance(condition.event, Changes):
            return bool(before != self._before)
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
    """The reason why a session has stopped.

    Attributes:
        reason: ``place``: the target of the command is reached; ``outputs``: outputs cannot be
            read.
        message: a sentence.
        numbers: breakpoints that were hit.
    """

    reason: Reason
    message: str
    numbers: tuple[int, ...] = ()


class Watch:
    """Watches for conditions along one run.

    Args:
        chip: the chip that runs.
        conditions: conditions with their numbers.
    """

    def __init__(self, chip: Chip, conditions: Iterable[tuple[int, Condition]] = ()) -> None:
        self._chip = chip
        self._monitors = [_Monitor(number, condition) for number, condition in conditions]
        self._places: dict[int, list[_Monitor]] = defaultdict(list)
        self._events: dict[int, list[_Monitor]] = defaultdict(list)
        for monitor in self._monitors:
            for address in monitor.condition.places:
                self._places[address].append(monitor)
            for address in monitor.condition.triggers:
                self._events[address].append(monitor)
        self._relevant = sorted({*self._places, *self._events})

    def begin(self) -> None:
        """Take the present state as given, so that only later changes count."""
        for monitor in self._monitors:
            monitor.begin(self._chip)

    def after(self, address: int) -> list[int]:
        """Return the numbers of the conditions that stop after the instruction at `address`."""
        chip = self._chip
        events, places = self._events.get(address, ()), self._places.get(chip.pc, ())
        found = [item.number for item in events if item.happens(chip)]
        tests = [(item.number, item.condition.test) for item in places]
        return found + [number for number, test in tests if test is None or test.holds(chip)]

    def stops_at(self, address: int) -> bool:
        """Return whether a condition may stop before an address is executed."""
        return address in self._places

    def touched(self, executions: NDArray[Any]) -> bool:
        """Return whether a relevant instruction was executed.

        Args:
            executions: number of executions, int, shape (words,).
        """
        return bool(executions[self._relevant].any())
