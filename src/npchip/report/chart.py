"""A comparison as a picture: a bar for each column, a colour for each task. Needs Matplotlib."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from matplotlib import rc_context
from matplotlib.figure import Figure

from npchip.base.files import write_bytes
from npchip.report.comparison import Column, labels, used_tasks

COLORS: Final = {
    "sampling": "#0072B2",
    "compute": "#E69F00",
    "memory": "#56B4E9",
    "reduction": "#D55E00",
    "flow": "#999999",
    "output": "#009E73",
    "other": "#CC79A7",
}
"""A colour for each task: Okabe and Ito's, which people with any colour vision can tell apart."""
_LIGHT: Final = ("compute", "memory")
STYLE: Final[Any] = {"font.family": "sans-serif", "font.size": 10.0, "svg.hashsalt": "npchip"}
INK, FAINT = "#333333", "#DDDDDD"
_NARROWEST: Final = 0.07
"""Part of the longest bar that a share needs to have its number written on it."""


def draw(columns: Sequence[Column], path: Path) -> None:
    """Draw mean cycles of a frame, divided by task, and write the picture.

    Args:
        columns: what is compared, at least one.
        path: ends in ``.png`` or ``.svg``.

    Raises:
        InputError: NP250, `path` cannot be written.
    """
    form = path.suffix.lower().lstrip(".")
    buffer = io.BytesIO()
    with rc_context(STYLE):
        metadata = {"Date": None} if form == "svg" else None  # the same picture every day
        _figure(columns).savefig(buffer, format=form, dpi=150, metadata=metadata)
    write_bytes(path, buffer.getvalue())


def _figure(columns: Sequence[Column]) -> Figure:
    figure = Figure(figsize=(8, 1.5 + 0.55 * len(columns)), layout="constrained")
    axes = figure.add_subplot()
    places = range(len(columns))
    ends = [0.0] * len(columns)
    longest = max(column.cycles for column in columns)
    for task in used_tasks(columns):
        widths = [column.cycles * column.share(task) for column in columns]
        bars = axes.barh(
            places, widths, left=ends, height=0.62, label=task, color=COLORS[task], zorder=2
        )
        written = [
            f"{100 * column.share(task):.0f} %" if width > _NARROWEST * longest else ""
            for column, width in zip(columns, widths, strict=True)
        ]
        ink = INK if task in _LIGHT else "white"
        axes.bar_label(bars, written, label_type="center", color=ink, fontsize=8.5)
        ends = [end + width for end, width in zip(ends, widths, strict=True)]
    for place, column in zip(places, columns, strict=True):
        axes.annotate(
            f"{column.cycles:,.0f}",
            (column.cycles, place),
            xytext=(5, 0),
            textcoords="offset points",
            va="center",
            color=INK,
        )
    axes.set_yticks(places, [_wrapped(label) for label in labels(columns)])
    axes.invert_yaxis()
    axes.set_xlim(0, 1.12 * longest or 1)
    axes.set_xlabel(
        "cycles per frame, mean" if any(column.result.frames for column in columns) else "cycles"
    )
    axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.grid(axis="x", color=FAINT, zorder=0)
    axes.tick_params(length=0)
    axes.set_title(_title(columns), loc="left", fontsize=10, color=INK)
    axes.spines[:].set_visible(False)
    figure.legend(loc="outside upper center", ncols=7, frameon=False, handlelength=1)
    return figure


def _title(columns: Sequence[Column]) -> str:
    """Say what all columns have in common, which their labels leave out."""
    first = columns[0]
    if all(column.machine.name == first.machine.name for column in columns):
        return f"machine {first.machine.name}"
    return first.program if all(c.program == first.program for c in columns) else ""


def _wrapped(label: str) -> str:
    return label.replace(", ", "\n")
