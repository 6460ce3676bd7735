"""A recorded run and a new one: what differs, with frame, expected and found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from npchip.testing.golden import Cell, Entry, Plane, Row

_ITEMS = 12


@dataclass(frozen=True)
class Difference:
    """One line of a difference.

    Attributes:
        where: the frame, or empty for the whole run.
        what: an output or a measure.
        expected: what the golden says.
        found: what the run gave.
        note: by how much a number has changed, or which pixel differs first.
    """

    where: str
    what: str
    expected: str
    found: str
    note: str = ""


def compare(expected: Entry, found: Entry, *, extra: bool = True) -> list[Difference]:
    """List what differs: of the whole run, then outputs by frame, then cycles by frame.

    Args:
        expected: the recorded run.
        found: the new run; cycles are compared where both have them.
        extra: whether an output that was not recorded is a difference.
    """
    differences = _whole_run(expected, found, extra=extra)
    if expected.words is not None and found.words is not None:
        if expected.words != found.words:
            differences.append(_number("", "words", expected.words, found.words))
        if expected.cycles != found.cycles:
            differences.append(_number("in total", "cycles", expected.cycles, found.cycles))
        elif expected.instructions != found.instructions:  # else the cycles say enough
            pair = (expected.instructions or 0, found.instructions or 0)
            differences.append(_number("in total", "instructions", *pair))
    return differences + _frame_by_frame(expected, found)


def _whole_run(expected: Entry, found: Entry, *, extra: bool) -> list[Difference]:
    words = (("status", expected.status, found.status), ("error", expected.error, found.error))
    differences = [Difference("", what, shown(a), shown(b)) for what, a, b in words if a != b]
    if len(expected.frames) != len(found.frames):
        differences.append(_number("", "frames", len(expected.frames), len(found.frames)))
    differences += [
        Difference("", name, "an output", "no such output")
        for name in expected.names
        if name not in found.names
    ]
    if extra:
        differences += [
            Difference("", name, "no such output", "an output")
            for name in found.names
            if name not in expected.names
        ]
    return differences


def _frame_by_frame(expected: Entry, found: Entry) -> list[Difference]:
    columns = [
        (name, expected.names.index(name), found.names.index(name))
        for name in expected.names
        if name in found.names
    ]
    rows: list[tuple[int | str, Row, Row]] = [("setup", expected.setup, found.setup)]
    both = zip(expected.frames, found.frames, strict=False)  # another number is told above
    rows += [(k, a, b) for k, (a, b) in enumerate(both)]
    outputs: list[Difference] = []
    cycles: list[Difference] = []
    for frame, a, b in rows:
        where = frame_name(frame)
        outputs += [
            _cells(where, name, a.cells[i], b.cells[j])
            for name, i, j in columns
            if a.cells[i] != b.cells[j]
        ]
        if a.cycles is not None and b.cycles is not None and a.cycles != b.cycles:
            cycles.append(_number(where, "cycles", a.cycles, b.cycles))
    return outputs + cycles


def _number(where: str, what: str, expected: int, found: int) -> Difference:
    return Difference(where, what, shown(expected), shown(found), change(expected, found))


def _cells(where: str, name: str, expected: Cell, found: Cell) -> Difference:
    if isinstance(expected, Plane) and isinstance(found, Plane):
        size, other = (expected.rows, expected.cols), (found.rows, found.cols)
        if size == other:
            differing = [at for at, pair in enumerate(zip(expected.data, found.data, strict=True))
                         if pair[0] != pair[1]]  # fmt: skip
            first = differing[0]
            row, column = divmod(first, expected.cols)
            note = f"at [{row}, {column}]"
            if len(differing) > 1:
                note += f", the first of {len(differing):,} that differ"
            return Difference(where, name, str(expected.data[first]), str(found.data[first]), note)
    return Difference(where, name, _shown(expected), _shown(found))


def _shown(cell: Cell) -> str:
    return f"{cell.rows} x {cell.cols} values" if isinstance(cell, Plane) else shown(cell)


# ---- as people read it


def shown(value: Any) -> str:
    """A number with its thousands apart, ``null``, a word, a range or an abridged list."""
    if value is None:
        return "null"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        more = f", ... ({len(value)} items)" if len(value) > _ITEMS else ""
        return f"[{', '.join(map(str, value[:_ITEMS]))}{more}]"
    first, last = getattr(value, "first", None), getattr(value, "last", None)
    return f"{first}" if first is not None and first == last else str(value)


def frame_name(frame: int | str) -> str:
    """``frame 3``, ``the setup`` or ``total``."""
    return f"frame {frame}" if isinstance(frame, int) else {"setup": "the setup"}.get(frame, frame)


def change(expected: int, found: int) -> str:
    """By how much a number has changed: ``+12, +0.6 %``."""
    delta = found - expected
    return f"{delta:+,}, {100 * delta / expected:+.1f} %" if expected else f"{delta:+,}"
