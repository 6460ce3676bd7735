"""The values along an axis: a list, or a text ``FIRST..LAST`` or ``FIRST..LAST..STEP``."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import Any, Final

Value = int | float | str
"""A value along an axis."""

MOST: Final = 1_000_000
"""Most values of an axis, and most runs of a sweep."""

_NUMBER = r"-?\d+(?:\.\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\.\.({_NUMBER})(?:\.\.({_NUMBER}))?", re.ASCII)


class AxisError(ValueError):
    """The text of a range that makes no sense; the message says what was expected."""


def is_axis(value: Any) -> bool:
    """Return whether a value of a file stands for several ones."""
    return isinstance(value, list) or (isinstance(value, str) and bool(_RANGE.fullmatch(value)))


def values(value: Any) -> tuple[Any, ...]:
    """Return the values that a list or a range stands for; one for any other value.

    Raises:
        AxisError: a range without values or of too many; a list that is empty or names one twice.
    """
    if isinstance(value, list):
        found = tuple(value)
        if not found:
            raise AxisError("expected at least one value, found an empty list")
    elif isinstance(value, str) and (match := _RANGE.fullmatch(value)):
        found = _range(value, *(Decimal(part) for part in match.groups(default="1")))
    else:
        found = (value,)
    if len({repr(item) for item in found}) < len(found):
        raise AxisError("expected different values, found one twice")
    return found


def _range(text: str, first: Decimal, last: Decimal, step: Decimal) -> tuple[int | float, ...]:
    if step <= 0 or last < first:
        raise AxisError(f"expected FIRST..LAST..STEP upwards, found {text}")
    count = int((last - first) / step) + 1  # decimal numbers, so that 0..1..0.1 has its 1
    if count > MOST:
        raise AxisError(f"expected at most {MOST:,} values, found {count:,}")
    found = [first + step * index for index in range(count)]
    whole = all(item == int(item) for item in found)
    return tuple(int(item) if whole else float(item) for item in found)
