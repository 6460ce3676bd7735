"""A run as JSON, schema 1 of ``docs/json.md``, and as a folder with its arrays (``--save``)."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from npchip.base.errors import InputError
from npchip.base.files import make_directory, write_bytes, write_text
from npchip.base.json import in_rows

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from npchip.run.result import FrameRecord, RunResult, Value

SCHEMA = 1


def head(result: RunResult, schema: int, *blamed: str) -> dict[str, Any]:
    """Return the first keys of a document about a run.

    Args:
        result: the run.
        schema: version of the document.
        blamed: attributes of the run's error to include besides code and message.
    """
    names = ("program", "engine", "machine", "status")
    document = {"schema": schema} | {name: getattr(result, name) for name in names}
    if result.error:
        shown = ("code", "message", *blamed)
        document["error"] = {name: getattr(result.error, name) for name in shown}
    return document


def to_document(
    result: RunResult, clock_hz: int, files: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """Return a result as plain dicts, lists, strings, ints and None.

    Args:
        result: the run.
        clock_hz: the clock that the user stated.
        files: file with an output's planes or pictures of all frames, by output (`array_files`);
            the document names the file and leaves out the values.
    """
    return head(result, SCHEMA, "address", "file", "line") | {
        "instructions": result.instructions,
        "cycles": result.cycles,
        "clock_hz": clock_hz,
        "setup": _setup(result.setup),
        "frames": _frames(result, files or {}),
    }


def to_text(document: Mapping[str, Any]) -> str:
    """Return a document as strict JSON, with a line for each key and each frame."""
    return in_rows(document, ("frames",))


def array_outputs(result: RunResult) -> list[str]:
    """Return the names of the outputs whose values are planes or pictures."""
    return [
        name
        for name, column in result.outputs.items()
        if not isinstance(column, list) and column.ndim == 3
    ]


def array_files(result: RunResult) -> dict[str, str]:
    """Return the file name for each output whose values are planes or pictures, by output.

    Raises:
        InputError: NP253, an output's name (from an assembled file) cannot be a file's name.
    """
    names = array_outputs(result)
    for name in names:
        if not re.fullmatch(r"\w[\w.]*", name):
            raise InputError("NP253", f"output {name!r} cannot be saved: it is no file name")
    return {name: f"{name}.npy" for name in names}


def save(result: RunResult, clock_hz: int, directory: Path) -> None:
    """Write ``run.json`` and a ``.npy`` for each plane or picture output into a folder.

    The folder is created if it is missing. Each ``.npy`` is uint8 of shape (T, rows, columns), with
    zeros for frames that sent nothing.

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
    write_text(directory / "run.json", text)


def _setup(setup: FrameRecord) -> dict[str, Any]:
    outputs = {name: _plain(value) for name, value in setup.outputs.items()}
    form = {"cycles": int(setup.cycles), "outputs": outputs}
    return form if setup.complete else form | {"complete": False}


def _frames(result: RunResult, files: Mapping[str, str]) -> list[dict[str, Any]]:
    columns = {name: _column(result, name, files.get(name)) for name in result.outputs}
    frames: list[dict[str, Any]] = [
        {
            "index": result.first_frame + k,
            "cycles": cycles,
            "outputs": {name: column[k] for name, column in columns.items()},
        }
        for k, cycles in enumerate(result.frame_cycles.tolist())
    ]
    if frames and not result.last_complete:
        frames[-1]["complete"] = False
    return frames


def _column(result: RunResult, name: str, file: str | None) -> list[Any]:
    """Return an output of all frames, without NumPy."""
    column = result.outputs[name]
    if file is None and type(column) is np.ndarray:  # every frame has a value
        plain: list[Any] = column.tolist()
        return plain
    values = (result.value(name, k) for k in range(result.frames))
    return [
        _plain(value) if file is None or value is None else {"file": file, "index": k}
        for k, value in enumerate(values)
    ]


def _plain(value: Value) -> Any:
    """Return a value as None, an int, or lists of ints."""
    if value is None:
        return None
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [int(item) for item in value] if isinstance(value, list) else int(value)
