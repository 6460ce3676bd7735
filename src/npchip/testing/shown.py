"""How values and frames are called in a difference."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

_ITEMS = 12


def shown(value: Any) -> str:
    """A number with its thousands apart, ``null``, a word, a range or an abridged list."""
    if value is None:
        return "null"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        more = f", ... ({len(value)} items)" if len(value) > _ITEMS else ""
        return f"[{', '.join(map(str, value[:_ITEMS]))}{more}]"
    first, last = getattr(value, "first", None), getattr(value, "last", None)
    return f"{first}" if first is not None and first == last else str(value)


def frame_name(frame: int | str) -> str:
    """``frame 3``, ``the setup`` or ``total``."""
    return f"frame {frame}" if isinstance(frame, int) else {"setup": "the setup"}.get(frame, frame)


def change(expected: int, found: int) -> str:
    """By how much a number has changed: ``+12, +0.6 %``."""
    delta = found - expected
    return f"{delta:+,}, {100 * delta / expected:+.1f} %" if expected else f"{delta:+,}"
