"""The differences between a recorded run and a new one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from npchip.testing.golden import Cell, Entry, Plane, Row

MAX_LINES = 10
"""Most differences or mistakes shown for a program; a mistake has several lines."""
_ITEMS = 12


class Difference(NamedTuple):
    """A difference between two runs, as text.

    Attributes:
        where: the frame, or empty for the whole run.
        what: an output or a measure.
        expected: the recorded value.
        found: the new value.
        note: the change of a number, or the first pixel that differs.
    """

    where: str
    what: str
    expected: str
    found: str
    note: str = ""


def compare(expected: Entry, found: Entry, *, extra: bool = True) -> list[Difference]:
    """Return the differences: of the whole run, then outputs by frame, then cycles by frame.

    Args:
        expected: the recorded run.
        found: the new run. Cycles are compared if both have them.
        extra: count an output that was not recorded as a difference.
    """
    differences = _whole_run(expected, found, extra=extra)
    if expected.words is not None and found.words is not None:
        if expected.words != found.words:
            differences.append(_number("", "words", expected.words, found.words))
        if expected.cycles != found.cycles:
            differences.append(_number("in total", "cycles", expected.cycles, found.cycles))
        elif expected.instructions != found.instructions:  # else the cycles tell enough
            pair = (expected.instructions or 0, found.instructions or 0)
            differences.append(_number("in total", "instructions", *pair))
    return differences + _frame_by_frame(expected, found)


def _whole_run(expected: Entry, found: Entry, *, extra: bool) -> list[Difference]:
    words = (("status", expected.status, found.status), ("error", expected.error, found.error))
    differences = [Difference("", what, shown(a), shown(b)) for what, a, b in words if a != b]
    if len(expected.frames) != len(found.frames):
        differences.append(_number("", "frames", len(expected.frames), len(found.frames)))
    missing = [name for name in expected.names if name not in found.names]
    new = [name for name in found.names if name not in expected.names and extra]
    differences += [Difference("", name, "an output", "no such output") for name in missing]
    return differences + [Difference("", name, "no such output", "an output") for name in new]


def _frame_by_frame(expected: Entry, found: Entry) -> list[Difference]:
    columns = [
        (name, expected.names.index(name), found.names.index(name))
        for name in expected.names
        if name in found.names
    ]
    rows: list[tuple[int | str, Row, Row]] = [("setup", expected.setup, found.setup)]
    both = zip(expected.frames, found.frames, strict=False)
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
    delta = found - expected
    note = f"{delta:+,}, {100 * delta / expected:+.1f} %" if expected else f"{delta:+,}"
    return Difference(where, what, shown(expected), shown(found), note)


def _cells(where: str, name: str, expected: Cell, found: Cell) -> Difference:
    if isinstance(expected, Plane) and isinstance(found, Plane):
        size, other = (expected.rows, expected.cols), (found.rows, found.cols)
        if size == other:
            pairs = zip(expected.data, found.data, strict=True)
            differing = [at for at, (a, b) in enumerate(pairs) if a != b]
            first = differing[0]
            row, column = divmod(first, expected.cols)
            note = f"at [{row}, {column}]"
            if len(differing) > 1:
                note += f", the first of {len(differing):,} that differ"
            return Difference(where, name, str(expected.data[first]), str(found.data[first]), note)
    return Difference(where, name, shown(expected), shown(found))


def table(differences: Sequence[Difference]) -> list[str]:
    """Return the first differences as lines with aligned columns."""
    rows = [(f"golden: {where}".rstrip(), *rest) for where, *rest in differences]
    shown = rows[:MAX_LINES]
    where, what, expected, found = (
        max((len(row[column]) for row in shown), default=0) for column in range(4)
    )
    return [
        f"{a:<{where}}  {b:<{what}}  expected {c:>{expected}}  found {d:>{found}}  {e}".rstrip()
        for a, b, c, d, e in rows
    ]


def shown(value: Any) -> str:
    """Return a value as text: with separators of thousands, long lists abridged."""
    if value is None:
        return "null"
    if isinstance(value, Plane):
        return f"{value.rows} x {value.cols} values"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        more = f", ... ({len(value)} items)" if len(value) > _ITEMS else ""
        return f"[{', '.join(map(str, value[:_ITEMS]))}{more}]"
    first, last = getattr(value, "first", None), getattr(value, "last", None)
    return f"{first}" if first is not None and first == last else str(value)


def frame_name(frame: int | str) -> str:
    """Return ``frame 3``, ``the setup`` or ``total``."""
    return f"frame {frame}" if isinstance(frame, int) else {"setup": "the setup"}.get(frame, frame)
