"""Where to stop: what a condition means, and what it looks at."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from npchip.debugger.values import Cell, Value, Writers

if TYPE_CHECKING:
    from npchip import Chip

Op = Literal["==", "!=", "<", "<=", ">", ">="]
OPERATIONS: Final[Mapping[str, Callable[[Any, Any], Any]]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
}


@dataclass(frozen=True)
class Compare:
    """``value op number``; of a cell in any NP, or in all, active or not."""

    value: Value
    op: Op
    number: int
    quantifier: Literal["any", "all"] | None = None

    def holds(self, chip: Chip) -> bool:
        """Whether it holds now."""
        compare = OPERATIONS[self.op]
        if isinstance(self.value, Cell):
            found = compare(self.value.plane(chip), self.number)
            return bool(found.any() if self.quantifier == "any" else found.all())
        return bool(compare(self.value.value(chip), self.number))

    def triggers(self, writers: Writers) -> frozenset[int]:
        """Addresses of the instructions that may change the answer."""
        return writers.of(self.value)


@dataclass(frozen=True)
class MaskEmpty:
    """``mask empty``: no NP is active."""

    def holds(self, chip: Chip) -> bool:
        """Whether it holds now."""
        return not chip.active.any()

    def triggers(self, writers: Writers) -> frozenset[int]:
        """Addresses of the instructions that may change the answer."""
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
        """Whether the last instruction, which has sent to the port, has sent such a byte."""
        if self.op is None:
            return True
        send = chip.sends[-1]
        found = OPERATIONS[self.op](send.data.astype(int), self.number)
        return bool((found if send.active is None else found & send.active).any())


@dataclass(frozen=True)
class Changes:
    """``value changes``: an instruction has given it another value, of a cell in any NP."""

    value: Value

    def reading(self, chip: Chip) -> Any:
        """What is compared."""
        if isinstance(self.value, Cell):
            return self.value.plane(chip).copy()
        return self.value.value(chip)


@dataclass(frozen=True)
class Condition:
    """Where to stop.

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
        """Whether to stop in front of an address that is one of the places."""
        test = self.condition.test
        return test is None or test.holds(chip)

    def happens(self, chip: Chip) -> bool:
        """Whether an instruction at one of the triggers has just made it happen."""
        condition = self.condition
        if isinstance(condition.event, Sent):
            return condition.event.seen(chip)
        before = self._before
        self.begin(chip)
        if isinstance(condition.event, Changes):
            return not np.array_equal(before, self._before)
        return bool(self._before and not before)
