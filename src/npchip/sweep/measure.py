"""Measures of a run, for its row: cycles, scalar outputs, and errors against the truth."""

from __future__ import annotations

import json
from math import fsum, sqrt
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.host.scenes.output import truth_path
from npchip.program.model import Position, Program
from npchip.run.result import RunResult

Columns = dict[str, NDArray[np.int64]]
"""Columns of all frames of a run; a masked array where some frame sent nothing."""


class Truth(NamedTuple):
    """The place of the object in each frame, (T, 2), and whether it is seen, (T,)."""

    centers: NDArray[np.float64]
    visible: NDArray[np.bool_]


def truth_of(clip: Path, first: int | None = None) -> Truth | None:
    """Return the truth beside a clip, of its first object; None if there is none.

    Raises:
        InputError: NP651 the file is no truth.
    """
    path = truth_path(clip)
    if not path.is_file():
        return None
    try:
        frames = json.loads(path.read_text("utf-8"))["frames"][:first]
        objects = [frame["objects"][0] for frame in frames]
        centers = np.array([item["center"] for item in objects], np.float64).reshape(-1, 2)
        visible = np.array([item["visible"] for item in objects], np.bool_)
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise InputError(
            "NP651",
            f"{path}: not the truth about a clip: {error or type(error).__name__}",
            hint="docs/scenes.md shows its form; without the file there are no error columns",
        ) from None
    return Truth(centers, visible)


def row_of(result: RunResult, program: Program, truth: Truth | None) -> dict[str, Any]:
    """Return the columns of a run but for its axes, in their order."""
    cycles = result.complete_cycles
    good = result.status in {"halted", "frames-exhausted"}
    error = str(result.error) if result.error else None
    if result.status == "cycle-limit":
        error = f"error: frame {result.frames - 1} reached the limit of cycles [NP321]"
    row: dict[str, Any] = {
        "status": result.status,
        "error": None if good else error,
        "frames": result.frames,
        "cycles_mean": int(cycles.sum()) / len(cycles) if len(cycles) else None,
        "cycles_max": int(cycles.max()) if len(cycles) else None,
        "words": len(program.words),
        "instructions": result.instructions,
    }
    if truth is not None:
        for position in program.positions:
            row |= _errors(result, position, truth)
    for name, values in columns_of(result).items():
        if name == "cycles":
            continue
        sent = np.ma.compressed(values)
        row[f"{name}_mean"] = int(sent.sum()) / len(sent) if len(sent) else None
        row[f"{name}_last"] = int(sent[-1]) if len(sent) else None
    return row


def columns_of(result: RunResult) -> Columns:
    """Return the cycles and the scalar outputs of every frame."""
    found: Columns = {"cycles": result.frame_cycles}
    for name, values in result.outputs.items():
        if getattr(values, "ndim", 0) == 1:  # an integer each
            found[name] = values
    return found


def _errors(result: RunResult, position: Position, truth: Truth) -> dict[str, Any]:
    """Return how far from the truth a place is, in pixels, and how many frames say so."""
    count = max(0, min(result.frames, len(truth.visible) - position.ahead))
    row, col = (np.ma.asarray(result.outputs[name])[:count] for name in position[:2])
    there = slice(position.ahead, position.ahead + count)
    centers, counts = truth.centers[there], truth.visible[there].copy()
    counts &= ~(np.ma.getmaskarray(row) | np.ma.getmaskarray(col))
    if "valid" in result.outputs:  # the programs of asm/ say so where they have no place
        counts &= np.ma.filled(np.ma.asarray(result.outputs["valid"])[:count], 0) != 0
    rows, cols = (
        np.ma.getdata(item)[counts] - axis[counts]
        for item, axis in zip((row, col), centers.T, strict=True)
    )
    squares = (rows * rows + cols * cols).tolist()
    ahead = f"_ahead_{position.ahead}" if position.ahead else ""
    return {
        f"error_rms{ahead}": sqrt(fsum(squares) / len(squares)) if squares else None,
        f"error_median{ahead}": sqrt(median(squares)) if squares else None,
        f"error_frames{ahead}": len(squares),
    }
