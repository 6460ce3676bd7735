"""HTML with small pictures, for a chip, a run and a frame in Jupyter."""

from __future__ import annotations

import base64
import io
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

if TYPE_CHECKING:
    from npchip.run.chip import Chip
    from npchip.run.result import FrameRecord, RunResult, Value

_FIRST, _LAST = 12, 4
_ITEMS = 12
_CELL = "padding:2px 8px;text-align:right"
_HEAD = "padding:2px 8px;text-align:right;font-weight:bold"


class Picture:
    """A frame, a plane or a mask that shows itself in a notebook.

    Args:
        array: uint8 or bool, shape (rows, columns); true is white.
        scale: screen pixels for one value of the array.

    Raises:
        ValueError: the array has another type or shape.
    """

    def __init__(self, array: NDArray[Any], scale: int = 4) -> None:
        array = np.asarray(array)
        if array.ndim != 2 or array.dtype not in (np.uint8, np.bool_):
            raise ValueError(
                f"expected uint8 or bool of shape (rows, columns), "
                f"found {array.dtype} {array.shape}"
            )
        self._array = array.astype(np.uint8) * 255 if array.dtype == np.bool_ else array
        self._scale = scale

    def _repr_html_(self) -> str:
        return picture(self._array, self._scale)


def picture(array: NDArray[Any], scale: int) -> str:
    """Return an ``img`` element with an array, uint8 of shape (rows, columns), as PNG."""
    buffer = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(array, np.uint8)).save(buffer, "PNG")
    data = base64.b64encode(buffer.getvalue()).decode()
    rows, columns = array.shape
    return (
        f'<img src="data:image/png;base64,{data}" width="{columns * scale}" '
        f'height="{rows * scale}" alt="{rows} x {columns} values" '
        'style="image-rendering:pixelated;vertical-align:middle;border:1px solid #888">'
    )


def chip_html(chip: Chip) -> str:
    """Return HTML of a chip: its position, the exposed frame, registers, flags and activity."""
    program = chip.program
    place = program.place(chip.pc)
    line = f" &nbsp; <code>{escape(place.text.strip())}</code>" if place else ""
    frame = f"frame {chip.frames_taken - 1}" if chip.frames_taken else "before the first frame"
    head = (
        f"<b>{escape(program.name)}</b> on machine {escape(chip.machine.name)}: {frame}, "
        f"{chip.cycles:,} cycles, pc {chip.pc}{line}"
    )
    exposed = chip.frame
    names: dict[int, list[str]] = {}
    for name, number in program.registers.items():
        names.setdefault(number, []).append(name)
    planes: list[tuple[str, NDArray[Any]]] = [
        (" ".join([f"r{number}", *names.get(number, [])]), plane)
        for number, plane in enumerate(chip.registers)
    ]
    planes += [*chip.flags.items(), ("active", chip.active)]
    parts = [] if exposed is None else [_figure("exposed frame", picture(exposed, 3), "")]
    for name, plane in planes:
        grey = plane.astype(np.uint8) * (255 if plane.dtype == np.bool_ else 1)
        least, most = int(plane.min()), int(plane.max())
        span = f"{least} to {most}" if least < most else f"all {most}"
        parts.append(_figure(name, picture(grey, 6), span))
    row = "display:flex;flex-wrap:wrap;gap:10px;align-items:flex-end"
    return f'<div>{head}<div style="{row}">{"".join(parts)}</div></div>'


def _figure(name: str, image: str, below: str) -> str:
    return (
        '<div style="text-align:center;font-size:80%">'
        f"<div>{escape(name)}</div>{image}<div>{escape(below)}</div></div>"
    )


def result_html(result: RunResult) -> str:
    """Return HTML of a run: status, outputs and cycles; of a long run, only both ends."""
    count = result.frames
    head = (
        f"<b>{escape(result.program)}</b> on machine {escape(result.machine)}: {count} frames, "
        f"{result.cycles:,} cycles, {escape(result.status)}"
    )
    if result.error:
        head += f"<br><b>{escape(str(result.error))}</b>"
    shown = list(range(count))
    if count > _FIRST + _LAST + 1:
        shown = [*range(_FIRST), -1, *range(count - _LAST, count)]
    rows = [["frame", *map(escape, result.outputs), "cycles"]]
    for k in shown:
        if k < 0:
            rows.append(["…"] * len(rows[0]))
            continue
        values = [_value(result.value(name, k)) for name in result.outputs]
        rows.append([str(result.first_frame + k), *values, f"{int(result.frame_cycles[k]):,}"])
    return f"<div>{head}{_table(rows)}</div>"


def frame_html(record: FrameRecord) -> str:
    """Return HTML of a frame: its outputs and cycles."""
    rows = [["output", "value"]]
    rows += [[escape(name), _value(value)] for name, value in record.outputs.items()]
    rows += [["cycles", f"{record.cycles:,}"]]
    return _table(rows)


def _table(rows: list[list[str]]) -> str:
    lines = []
    for index, row in enumerate(rows):
        style = _CELL if index else _HEAD
        lines.append("<tr>" + "".join(f'<td style="{style}">{cell}</td>' for cell in row) + "</tr>")
    return f"<table>{''.join(lines)}</table>"


def _value(value: Value) -> str:
    if value is None:
        return "–"
    if isinstance(value, np.ndarray):
        return picture(value, 6 if value.shape[1] < 40 else 2)
    if isinstance(value, list) and len(value) > _ITEMS:
        return f"{', '.join(map(str, value[:_ITEMS]))}, … ({len(value)})"
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)
