"""Values as messages show them, and suggestions for misspelt words."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


def near_miss(word: str, known: Iterable[str]) -> str | None:
    """Return the known word nearest to `word`, or None if none is near."""
    from difflib import get_close_matches  # noqa: PLC0415 - few runs meet a misspelt word

    return next(iter(get_close_matches(word, list(known), n=1)), None)


def suggestion(word: Any, known: Iterable[str]) -> str | None:
    """Return a hint with the known word nearest to `word`, or None if none is near."""
    near = near_miss(str(word)[:80], known)
    return f"did you mean '{near}'?" if near else None


def shown(value: Any) -> str:
    """Return a value as messages show it, in at most 60 characters."""
    if value is None:
        return "nothing"
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) > 10**20:
        return "a number of more than 20 digits"  # str() refuses some
    if isinstance(value, tuple):
        value = list(value)
    elif hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
