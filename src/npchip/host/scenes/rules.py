"""Rules for the settings of a scene, checked for every scene."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import MISSING, Field, dataclass, field, fields
from numbers import Real
from typing import Any, Literal

from npchip.base.errors import InputError
from npchip.base.suggest import shown

WRONG_TYPE, OUT_OF_RANGE = "NP283", "NP284"


@dataclass(frozen=True)
class Rule:
    """Kind, bounds and meaning of a setting.

    Attributes:
        kind: a number, a whole number, a pair (row, column), a list of such pairs, or a point in
            space (x, y, z).
        low, high: bounds of each number.
        text: meaning, one phrase for the help.
        step: divisor of a whole number or of both in a pair; 0 for none.
        shortest, longest: bounds of the length of a list.
    """

    kind: Literal["number", "whole", "pair", "pairs", "triple"]
    low: float
    high: float
    text: str
    step: int = 0
    shortest: int = 3
    longest: int = 64

    def __str__(self) -> str:
        bounds = f"from {self.low:g} to {self.high:g}"
        number = "whole number" if self.kind == "whole" else "number"
        multiple = f" in multiples of {self.step}" if self.step else ""
        return {
            "pair": f"[row, column], each {bounds}{multiple}",
            "triple": f"[x, y, z], each {bounds}",
            "pairs": f"{self.shortest} to {self.longest} pairs [row, column], each {bounds}",
        }.get(self.kind, f"a {number} {bounds}{multiple}")

    def check(self, value: Any, place: str) -> Any:
        """Return `value` as int, float, pair or tuple of pairs.

        Raises:
            InputError: NP283 another type, NP284 out of range; the message begins with `place`.
        """
        if self.kind in {"pair", "triple"}:
            return self._several(value, place, 2 if self.kind == "pair" else 3)
        if self.kind != "pairs":
            return self._number(value, value, place)
        if not _is_list(value):
            raise self._error(WRONG_TYPE, value, place)
        if not self.shortest <= len(value) <= self.longest:
            message = f"{place}: expected {self}, found {len(value)} of them"
            raise InputError(OUT_OF_RANGE, message)
        return tuple(self._several(item, place, 2) for item in value)

    def read(self, text: str) -> Any:
        """Parse the text of an option: ``5``, ``20,10`` or ``0,0 0,5 5,0``, without a check."""
        if self.kind == "pairs":
            return [_numbers(pair) for pair in text.split()]
        numbers = _numbers(text)
        return numbers if self.kind == "pair" or len(numbers) != 1 else numbers[0]

    def _several(self, value: Any, place: str, count: int) -> tuple[Any, ...]:
        if not _is_list(value) or len(value) != count:
            raise self._error(WRONG_TYPE, value, place)
        return tuple(self._number(item, value, place) for item in value)

    def _number(self, number: Any, whole: Any, place: str) -> int | float:
        """Check one number; messages show `whole`."""
        real = isinstance(number, Real) and not isinstance(number, bool)
        if not real or (self._counts and number != number // 1):
            raise self._error(WRONG_TYPE, whole, place)
        if not self.low <= number <= self.high or (self.step and number % self.step):
            raise self._error(OUT_OF_RANGE, whole, place)
        return int(number) if self._counts else float(number)

    @property
    def _counts(self) -> bool:
        return self.kind == "whole" or self.step > 0

    def _error(self, code: str, found: Any, place: str) -> InputError:
        return InputError(code, f"{place}: expected {self}, found {shown(found)}")


def setting(rule: Rule, default: Any = MISSING) -> Any:
    """Make a dataclass field that follows `rule`; it is required without a default."""
    return field(default=default, metadata={"rule": rule})


def settings(kind: type[Any]) -> Mapping[str, Field[Any]]:
    """Return the fields of a dataclass that follow a rule, by name."""
    return {item.name: item for item in fields(kind) if "rule" in item.metadata}


def rule_of(item: Field[Any]) -> Rule:
    """Return the rule that a field of `settings` follows."""
    rule = item.metadata["rule"]
    assert isinstance(rule, Rule)
    return rule


class Checked:
    """Base of the dataclasses of a scene, whose settings follow their rules."""

    def __post_init__(self) -> None:
        """Check and convert the settings.

        Raises:
            InputError: NP283 or NP284; the message names class and setting.
        """
        for name, item in settings(type(self)).items():
            place = f"{type(self).__name__}.{name}"
            value = rule_of(item).check(getattr(self, name), place)
            object.__setattr__(self, name, value)  # the dataclasses are frozen


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple) or hasattr(value, "__array__")


def _numbers(text: str) -> list[Any]:
    return [_number(part) for part in re.split(r"[,\s]+", text.strip())]


def _number(text: str) -> Any:
    """Parse a number; return any other text, which `Rule.check` refuses."""
    for kind in (int, float) if text.isascii() else ():
        try:
            return kind(text)
        except ValueError:
            continue
    return text
