"""``--render``: the clip with past path, prediction and moving pixels (thesis figures 2.3-2.5).

A GIF shows every frame, a PNG up to twelve selected ones. This module selects the content;
`npchip.report.drawing` draws it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from npchip.base import files
from npchip.base.errors import InputError
from npchip.report.drawing import Scene, animation, sheet

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from npchip.program.model import Program
    from npchip.run.result import RunResult

SUFFIXES = (".png", ".gif")
_TELLING = 12


def check_suffix(path: Path) -> None:
    """Raise for a file name that `render` cannot write.

    Raises:
        InputError: NP247, the name has another suffix.
    """
    files.check_suffix(
        path, SUFFIXES, "NP247", what="pictures are", example="run.gif", option="--render "
    )


def check_program(program: Program, *, has_frames: bool) -> None:
    """Raise for a program, or a run without a clip, with nothing to draw.

    Raises:
        InputError: NP248, the outputs to draw are missing.
    """
    names = {output.name for output in program.outputs}
    if _picture_output(program) is None and not (
        has_frames and {"center_row", "center_col"} <= names
    ):
        raise InputError(
            "NP248",
            f"--render needs an output of kind picture, or outputs center_row and center_col and"
            f" --frames; {program.name} has {', '.join(sorted(names)) or 'no named outputs'}",
            hint="such as '.output picture, 0, picture' in the source",
        )


def is_animated(path: Path) -> bool:
    """Return whether `render` draws every frame, which takes long."""
    return path.suffix.lower() == ".gif"


def render(
    result: RunResult,
    program: Program,
    frames: Sequence[NDArray[np.uint8]],
    path: Path,
    on_picture: Callable[[int], object] = lambda _: None,
) -> None:
    """Draw a run and write the picture.

    Args:
        result: the run.
        program: the program; a pixel moves if it changes by its symbol ``THRESHOLD``, if any.
        frames: the clip, uint8 of shape (rows, columns) each; empty without a clip.
        path: a file name that ends in one of `SUFFIXES`.
        on_picture: function called before each frame of a GIF with the number of drawn frames.

    Raises:
        InputError: NP247 and NP248 as `check_suffix` and `check_program`; NP249, no frame was
            taken; NP250, `path` cannot be written.
    """
    check_suffix(path)
    check_program(program, has_frames=bool(len(frames)))
    if not result.frames:
        raise InputError(
            "NP249", "--render: the program took no frame, so there is nothing to draw"
        )

    def scenes() -> Iterator[Scene]:
        for k in range(result.frames):
            on_picture(k)
            yield _scene(result, program, frames, k)

    if is_animated(path):
        data = animation(scenes())
    else:
        data = sheet([_scene(result, program, frames, k) for k in telling_frames(result)])
    files.write_bytes(path, data)


def telling_frames(result: RunResult, most: int = _TELLING) -> list[int]:
    """Return up to `most` frames, evenly spread over the frames with a valid centre."""
    frames = range(result.frames)
    telling = [k for k in frames if _center(result, k)] or list(frames)
    spread = np.linspace(0, len(telling) - 1, min(most, len(telling)))
    return [telling[round(position)] for position in spread]


def _scene(
    result: RunResult, program: Program, frames: Sequence[NDArray[np.uint8]], k: int
) -> Scene:
    picture = _picture_output(program)
    background = result.value(picture, k) if picture else frames[k]
    if not isinstance(background, np.ndarray):  # this frame sent no picture
        background = np.zeros_like(result.outputs[str(picture)][k])
    path = [center for i in range(k + 1) if (center := _center(result, i))]
    threshold = program.symbols.get("THRESHOLD")
    return Scene(
        background=background,
        title=f"frame {result.first_frame + k}",
        note=f"{int(result.frame_cycles[k]):,} cycles",
        path=path if {"center_row", "center_col"} <= result.outputs.keys() else None,
        center=_center(result, k),
        predicted=_point(result, "predicted", k) if _center(result, k) else None,
        box=None
        if threshold is None or not k or not len(frames)
        else _moving(frames, k, threshold),
        shows_prediction="predicted_row" in result.outputs,
        shows_box=threshold is not None and bool(len(frames)),
    )


def _picture_output(program: Program) -> str | None:
    return next((output.name for output in program.outputs if output.kind == "picture"), None)


def _point(result: RunResult, name: str, k: int) -> tuple[int, int] | None:
    """Return the (row, column) that frame `k` sent as NAME_row and NAME_col."""
    names = (f"{name}_row", f"{name}_col")
    if not result.outputs.keys() >= {*names}:
        return None
    row, col = (result.value(each, k) for each in names)
    return (row, col) if isinstance(row, int) and isinstance(col, int) else None


def _center(result: RunResult, k: int) -> tuple[int, int] | None:
    """Return the centre of frame `k`; None if it is missing or marked invalid."""
    if "valid" in result.outputs and not result.value("valid", k):
        return None
    return _point(result, "center", k)


def _moving(
    frames: Sequence[NDArray[np.uint8]], k: int, threshold: int
) -> tuple[int, int, int, int] | None:
    """Return (top, left, bottom, right), inclusive, of the pixels that changed by `threshold`."""
    change = np.abs(frames[k].astype(np.int16) - frames[k - 1])
    rows, cols = np.nonzero(change >= threshold)
    if not len(rows):
        return None
    return int(rows.min()), int(cols.min()), int(rows.max()), int(cols.max())
