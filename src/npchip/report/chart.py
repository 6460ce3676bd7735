"""A comparison as a chart, a bar for each column and a colour for each task. Needs Matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from matplotlib.figure import Figure

from npchip.report.comparison import Column, labels, used_tasks
from npchip.report.figure import INK, bars, beside, write

COLORS: Final = {
    "sampling": "#0072B2",
    "compute": "#E69F00",
    "memory": "#56B4E9",
    "reduction": "#D55E00",
    "flow": "#999999",
    "output": "#009E73",
    "other": "#CC79A7",
}
"""Colours of the tasks, by Okabe and Ito, distinct for any colour vision."""
_LIGHT: Final = ("compute", "memory")
_NARROWEST: Final = 0.07
"""Shortest labelled part of a bar, relative to the longest bar."""


def draw(columns: Sequence[Column], path: Path) -> None:
    """Draw the mean cycles of a frame, divided by task, and write the chart.

    Args:
        columns: the columns, at least one.
        path: a file name that ends in ``.png`` or ``.svg``.

    Raises:
        InputError: NP250, `path` cannot be written.
    """
    write(lambda: _figure(columns), path)


def _figure(columns: Sequence[Column]) -> Figure:
    figure = Figure(figsize=(8, 1.5 + 0.55 * len(columns)), layout="constrained")
    axes = figure.add_subplot()
    places = range(len(columns))
    ends = [0.0] * len(columns)
    longest = max(column.cycles for column in columns)
    for task in used_tasks(columns):
        widths = [column.cycles * column.share(task) for column in columns]
        drawn = axes.barh(
            places, widths, left=ends, height=0.62, label=task, color=COLORS[task], zorder=2
        )
        written = [
            f"{100 * column.share(task):.0f} %" if width > _NARROWEST * longest else ""
            for column, width in zip(columns, widths, strict=True)
        ]
        ink = INK if task in _LIGHT else "white"
        axes.bar_label(drawn, written, label_type="center", color=ink, fontsize=8.5)
        ends = [end + width for end, width in zip(ends, widths, strict=True)]
    for place, column in zip(places, columns, strict=True):
        beside(axes, place, column.cycles, f"{column.cycles:,.0f}")
    shown = [label.replace(", ", "\n") for label in labels(columns)]
    bars(axes, shown, [column.cycles for column in columns], 1.12, _title(columns))
    per_frame = any(column.result.frames for column in columns)
    axes.set_xlabel("cycles per frame, mean" if per_frame else "cycles")
    figure.legend(loc="outside upper center", ncols=7, frameon=False, handlelength=1)
    return figure


def _title(columns: Sequence[Column]) -> str:
    """Return the machine or program that all columns share."""
    first = columns[0]
    if all(column.machine.name == first.machine.name for column in columns):
        return f"machine {first.machine.name}"
    return first.program if all(c.program == first.program for c in columns) else ""
