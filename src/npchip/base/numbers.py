"""Whole numbers as users write them."""

from __future__ import annotations


def whole_number(text: str) -> int | None:
    """Read a decimal, ``0x`` or ``0b`` number; return None for any other text."""
    try:
        # int takes ٣ for 3, and 0o17, which is no number in a source.
        return int(text.strip(), 0) if text.isascii() and "o" not in text.lower() else None
    except ValueError:
        return None
