"""A run as JSON: schema 1 of ``docs/json.md``, which scripts rely on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from npchip.base.json import in_rows

if TYPE_CHECKING:
    from collections.abc import Mapping

    from npchip.run.result import FrameRecord, RunResult, Value

SCHEMA = 1


def to_document(
    result: RunResult, clock_hz: int, files: Mapping[str, str] | None = None
) -> dict[str, Any]:
    """Turn a result into plain dicts, lists, strings, ints and None.

    Args:
        result: the run.
        clock_hz: the clock that the user stated.
        files: name of the file that holds an output's planes or pictures of all frames, by
            output (`npchip.report.save`); these are named instead of being written out.
    """
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "program": result.program,
        "engine": result.engine,
        "machine": result.machine,
        "status": result.status,
    }
    if result.error:
        document["error"] = {
            "code": result.error.code,
            "message": result.error.message,
            "address": result.error.address,
            "file": result.error.file,
            "line": result.error.line,
        }
    document |= {
        "instructions": result.instructions,
        "cycles": result.cycles,
        "clock_hz": clock_hz,
        "setup": _setup(result.setup),
        "frames": _frames(result, files or {}),
    }
    return document


def to_text(document: Mapping[str, Any]) -> str:
    """Write a document as strict JSON: one line for each key and for each frame."""
    return in_rows(document, ("frames",))


def array_outputs(result: RunResult) -> list[str]:
    """Names of the outputs whose values are planes or pictures."""
    return [
        name
        for name, column in result.outputs.items()
        if not isinstance(column, list) and column.ndim == 3
    ]


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
    """An output of all frames, without NumPy."""
    column = result.outputs[name]
    if file is None and type(column) is np.ndarray:  # every frame has one
        plain: list[Any] = column.tolist()
        return plain
    values = (result.value(name, k) for k in range(result.frames))
    return [
        _plain(value) if file is None or value is None else {"file": file, "index": k}
        for k, value in enumerate(values)
    ]


def _plain(value: Value) -> Any:
    """Return `value` without NumPy: None, int, list of ints or nested lists of ints."""
    if value is None:
        return None
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [int(item) for item in value] if isinstance(value, list) else int(value)
