"""Known points and where two cameras see them, from a CSV file."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Final

import numpy as np

from npchip.base.errors import InputError
from npchip.base.files import read_bytes

if TYPE_CHECKING:
    from pathlib import Path

    from npchip.host.vision.fusion.camera import Floats

COLUMNS: Final = ("x", "y", "z", "row1", "col1", "row2", "col2")
MOST: Final = 100_000
"""Most points of a file."""
MOST_BYTES: Final = 1 << 24
"""Most bytes of a file."""


def read_points(path: Path) -> tuple[Floats, Floats, Floats]:
    """Read the columns of `COLUMNS`; others, such as those of ``npchip fuse --csv``, are ignored.

    Args:
        path: the file, with the names of its columns in the first line.

    Returns:
        places in metres, shape (n, 3), and their pixels in camera 1 and 2, shape (n, 2); NaN where
        a field is empty.

    Raises:
        InputError: NP527, the file cannot be read, lacks a column, or a field is no number.
    """
    try:
        text = read_bytes(path, MOST_BYTES).decode("utf-8-sig")
        lines = list(csv.reader(io.StringIO(text)))
    except (OSError, ValueError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or "it is not CSV in UTF-8"
        raise InputError("NP527", f"{path}: cannot read it: {reason}") from None
    names = [name.strip() for name in lines[0]] if lines else []
    if missing := [name for name in COLUMNS if name not in names]:
        raise InputError(
            "NP527",
            f"{path}: there is no column {', '.join(missing)} in the first line",
            hint=f"expected {','.join(COLUMNS)}",
        )
    places = [names.index(name) for name in COLUMNS]
    if len(lines) > MOST:
        raise InputError("NP527", f"{path}: more than {MOST:,} points", hint="leave some out")
    rows = []
    for line, fields in enumerate(lines[1:], 2):
        if fields:
            cells = [fields[place].strip() if place < len(fields) else "" for place in places]
            pairs = zip(COLUMNS, cells, strict=True)
            rows.append([_number(path, line, name, cell) for name, cell in pairs])
    table = np.array(rows, np.float64).reshape(-1, len(COLUMNS))
    return table[:, :3], table[:, 3:5], table[:, 5:]


def _number(path: Path, line: int, name: str, text: str) -> float:
    try:
        value = float(text or "nan")
    except ValueError:
        value = np.inf
    if np.isinf(value):
        message = f"{path}, line {line}: {name}: expected a number, found {text[:40]}"
        raise InputError("NP527", message, hint="leave it empty where a camera sees nothing")
    return value
