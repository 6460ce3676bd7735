"""Why a run stops: conditions watched along it, and the stop itself."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from npchip.debugger.conditions import Condition, Monitor

if TYPE_CHECKING:
    from npchip import Chip

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
    """Why a session has stopped.

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
        """Only what changes from here on counts."""
        for _, monitor in self._monitors:
            monitor.begin(self._chip)

    def after(self, address: int) -> list[int]:
        """Numbers of what stops here, after the instruction at `address` was executed."""
        chip = self._chip
        events, places = self._events.get(address), self._places.get(chip.pc)
        found = [number for number, item in events or () if item.happens(chip)]
        return found + [number for number, item in places or () if item.arrives(chip)]

    def stops_at(self, address: int) -> bool:
        """Whether something may stop in front of an address."""
        return address in self._places

    def touched(self, executions: NDArray[Any]) -> bool:
        """Whether an instruction that matters is among those that were executed so often."""
        return bool(executions[self._relevant].any())
