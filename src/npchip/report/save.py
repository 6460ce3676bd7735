"""``--save DIR``: the run as ``run.json`` and one ``.npy`` for every plane or picture output."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING

import numpy as np

from npchip.base.errors import InputError
from npchip.base.files import make_directory, write_bytes
from npchip.report.jsonform import array_outputs, to_document, to_text

if TYPE_CHECKING:
    from pathlib import Path

    from npchip.run.result import RunResult


def array_files(result: RunResult) -> dict[str, str]:
    """File name for every output whose frames are planes or pictures, by output.

    Raises:
        InputError: NP253, an output's name (from an assembled file) cannot be a file's name.
    """
    names = array_outputs(result)
    for name in names:
        if not re.fullmatch(r"\w[\w.]*", name):
            raise InputError("NP253", f"output {name!r} cannot be saved: it is no file name")
    return {name: f"{name}.npy" for name in names}


def save(result: RunResult, clock_hz: int, directory: Path) -> None:
    """Write `result` into `directory`, which is created if missing.

    Each ``.npy`` is uint8 of shape (T, rows, columns), zeros where a frame sent nothing.

    Raises:
        InputError: NP250, something cannot be written; NP253 as `array_files`.
    """
    make_directory(directory)
    files = array_files(result)
    for name, file in files.items():
        buffer = io.BytesIO()
        np.save(buffer, np.ma.filled(result.outputs[name], 0), allow_pickle=False)
        write_bytes(directory / file, buffer.getvalue())
    text = to_text(to_document(result, clock_hz, files))
    write_bytes(directory / "run.json", text.encode())
