"""Strict JSON: no NaN, no infinity; NumPy's arrays and scalars become plain numbers."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from typing import Any


def plain(value: Any) -> Any:
    """Return a NumPy array or scalar as lists and numbers; TypeError for any other object."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")


_strict = json.JSONEncoder(allow_nan=False, default=plain)


def one_line(value: Any) -> str:
    """Return a value on one line.

    Raises:
        ValueError: a number that is not finite.
    """
    return _strict.encode(value)


def indented(document: Any, *, ascii_only: bool = True) -> str:
    """Return a document with a line for every value; errors as for `one_line`."""
    text = json.dumps(document, indent=1, ensure_ascii=ascii_only, allow_nan=False, default=plain)
    return f"{text}\n"


def in_rows(document: Mapping[str, Any], tables: Collection[str], margin: str = " ") -> str:
    """Return a document with a line for every key, and for every item of some lists.

    Args:
        document: the document; it may hold NumPy arrays.
        tables: keys of the lists whose items have lines of their own.
        margin: the indentation of each level.

    Raises:
        ValueError: a number that is not finite.
    """
    lines = []
    for key, value in document.items():
        if key in tables and value:
            rows = f",\n{2 * margin}".join(map(one_line, value))
            lines.append(f"{one_line(key)}: [\n{2 * margin}{rows}\n{margin}]")
        else:
            lines.append(f"{one_line(key)}: {one_line(value)}")
    return f"{{\n{margin}" + f",\n{margin}".join(lines) + "\n}\n"
