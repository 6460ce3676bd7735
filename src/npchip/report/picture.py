"""``--render``: the clip beside all outputs.

Past path, prediction and moving pixels are drawn in the clip (thesis figures 2.3-2.5). A GIF shows
every frame, a PNG up to twelve selected ones. This module selects the content;
`npchip.report.drawing` draws it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from npchip.base import files
from npchip.base.errors import InputError
from npchip.report.drawing import Scene, animation, sheet
from npchip.report.marks import (
    CENTER,
    frames_ahead,
    has_places,
    marks,
    names_of_places,
    shows_window,
    sights,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from npchip.program.model import Program
    from npchip.run.result import RunResult, Value

SUFFIXES = (".png", ".gif")
_TELLING = 12
_CLEAR = 128
"""Least range of a plane that is clear enough to be shown as it is."""


def check_suffix(path: Path) -> None:
    """Raise for a file name that `render` cannot write.

    Raises:
        InputError: NP247, the name has another suffix.
    """
    files.check_suffix(
        path, SUFFIXES, "NP247", what="pictures are", example="run.gif", option="--render "
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
) -> str:
    """Draw a run, write the picture, and return a line on which frames it shows.

    Args:
        result: the run.
        program: the program; a pixel moves if it changes by its symbol ``THRESHOLD``, if any.
        frames: the clip, uint8 of shape (rows, columns) each; empty without a clip.
        path: a file name that ends in one of `SUFFIXES`.
        on_picture: function called before each frame of a GIF with the number of drawn frames.

    Raises:
        InputError: NP247 as `check_suffix`; NP249, the program took no frame and sent nothing;
            NP250, `path` cannot be written.
    """
    check_suffix(path)
    if not result.frames and not _sent(result.setup.outputs):
        raise InputError(
            "NP249", "--render: the program took no frame and sent nothing: nothing is to be drawn"
        )

    def scenes() -> Iterator[Scene]:
        if not result.frames:
            yield _setup_scene(result, program)
        for k in range(result.frames):
            on_picture(k)
            yield _scene(result, program, frames, k)

    if is_animated(path):
        shown = list(range(result.frames))
        data = animation(scenes())
    else:
        shown = telling_frames(result)
        chosen = [_scene(result, program, frames, k) for k in shown]
        data = sheet(chosen or [_setup_scene(result, program)])
    files.write_bytes(path, data)
    return f"{path}: {_which(shown, result)}"


def _which(shown: Sequence[int], result: RunResult) -> str:
    """Return which frames of a run a picture shows."""
    if not result.frames:
        return "what was sent without a frame"
    if len(shown) < result.frames:
        numbers = ", ".join(str(result.first_frame + k) for k in shown)
        return f"{len(shown)} of {result.frames:,} frames, {numbers}; a .gif shows all"
    return f"{result.frames:,} frames" if result.frames > 1 else "1 frame"


def telling_frames(result: RunResult, most: int = _TELLING) -> list[int]:
    """Return up to `most` frames, evenly spread over the frames that show an object."""
    frames = range(result.frames)
    telling = [k for k in frames if sights(result, k)] or list(frames)
    spread = np.linspace(0, len(telling) - 1, min(most, len(telling)))
    return [telling[round(position)] for position in spread]


def _scene(
    result: RunResult, program: Program, frames: Sequence[NDArray[np.uint8]], k: int
) -> Scene:
    picture = None if len(frames) else _picture_output(program)
    background = frames[k] if len(frames) else None
    if picture is not None:
        background = np.asarray(np.ma.filled(result.outputs[picture][k], 0))
    boxed = result.outputs.keys() >= {*CENTER}
    threshold = program.symbols.get("THRESHOLD") if boxed else None
    values = {name: result.value(name, k) for name in result.outputs if name != picture}
    lists = [name for name, column in result.outputs.items() if isinstance(column, list)]
    shown = has_places(result.outputs)
    written = {*lists, *(names_of_places(result.outputs) if background is not None else ())}
    return Scene(
        background=background,
        title=f"frame {result.first_frame + k}",
        note=f"{int(result.frame_cycles[k]):,} cycles",
        marks=marks(result, program, k),
        box=None
        if threshold is None or not k or not len(frames)
        else _moving(frames, k, threshold),
        shows_path=shown,
        ahead=frames_ahead(result.outputs, program),
        shows_window=shown and shows_window(program),
        shows_box=threshold is not None and bool(len(frames)),
        label=picture or "clip",
        panels=_panels(values, result.outputs, program),
        values=_texts({name: values[name] for name in values if name not in written}),
        lists=_lists({name: values[name] or [] for name in lists}),
    )


def _setup_scene(result: RunResult, program: Program) -> Scene:
    """Return what a program without frames has sent."""
    sent = _sent(result.setup.outputs)
    note = f"{int(result.setup.cycles):,} cycles"
    shown = (_panels(sent, sent, program), _texts(sent), _lists(sent))
    panels, values, lists = shown
    return Scene(None, "", note, panels=panels, values=values, lists=lists)


def _sent(outputs: Mapping[str, Value]) -> dict[str, Value]:
    return {name: value for name, value in outputs.items() if value is not None}


def _panels(
    values: Mapping[str, Value], columns: Mapping[str, Any], program: Program
) -> tuple[tuple[str, NDArray[np.uint8]], ...]:
    """Return the planes and pictures among `values`.

    Pictures are shown as they are, and so are planes of clear contrast. Other planes go from the
    least to the greatest value of the run.
    """
    pictures = {output.name for output in program.outputs if output.kind == "picture"}
    panels = []
    for name, column in columns.items():
        if name not in values or not isinstance(column, np.ndarray) or column.ndim < 2:
            continue
        value = values[name]
        if not isinstance(value, np.ndarray):
            panels.append((f"{name}: nothing sent", np.zeros(column.shape[1:], np.uint8)))
            continue
        low, high = int(column.min()), int(column.max())
        if name in pictures or high - low >= _CLEAR:
            panels.append((name, value))
            continue
        if column.shape[-1] == value.shape[-1] and low < high:
            value = ((value.astype(np.uint16) - low) * 255 // (high - low)).astype(np.uint8)
        span = f"black {low}, white {high}" if low < high else f"{low} everywhere"
        panels.append((f"{name}: {span}", value))
    return tuple(panels)


def _texts(values: Mapping[str, Value]) -> tuple[tuple[str, str], ...]:
    """Return names and texts of the numbers among `values`."""
    numbers = {name: item for name, item in values.items() if item is None or isinstance(item, int)}
    return tuple((name, "-" if item is None else str(item)) for name, item in numbers.items())


def _lists(values: Mapping[str, Value]) -> tuple[tuple[str, str], ...]:
    lists = {name: item for name, item in values.items() if isinstance(item, list)}
    return tuple((name, " ".join(map(str, item))) for name, item in lists.items())


def _picture_output(program: Program) -> str | None:
    return next((output.name for output in program.outputs if output.kind == "picture"), None)


def _moving(
    frames: Sequence[NDArray[np.uint8]], k: int, threshold: int
) -> tuple[int, int, int, int] | None:
    """Return (top, left, bottom, right), inclusive, of the pixels that changed by `threshold`."""
    change = np.abs(frames[k].astype(np.int16) - frames[k - 1])
    rows, cols = np.nonzero(change >= threshold)
    if not len(rows):
        return None
    return int(rows.min()), int(cols.min()), int(rows.max()), int(cols.max())
