"""A sweep as a picture: lines with their spread, or heat maps where two axes have numbers."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from npchip.base.errors import InputError
from npchip.report.chart import COLORS
from npchip.report.figure import FAINT, INK, write
from npchip.sweep.model import Definition
from npchip.sweep.plan import FIXED

_WANTED: Final = ("error_rms", "cycles_mean")
_LABELS: Final = {"error_rms": "error, pixels rms", "cycles_mean": "cycles of a frame, mean"}
_MOST_PANELS: Final = 8
_LINES: Final = ("-", "--", ":", "-.")
_MARKS: Final = "osD^v<>P"


def draw(definition: Definition, folder: Path, path: Path) -> None:
    """Draw the table in a folder and write the picture.

    Args:
        definition: the sweep.
        folder: where its tables are.
        path: a file name that ends in ``.png`` or ``.svg``.

    Raises:
        InputError: NP652 nothing in the table can be drawn; NP250, `path` cannot be written.
    """
    table = pd.read_parquet(folder / "runs.parquet")
    what = _what(definition, table)
    table = table[table[what].notna()]
    axes = _axes(definition, table)
    make = _heat_maps if len(axes) > 1 else _lines
    write(lambda: make(table, axes, what), path)


def _what(definition: Definition, table: pd.DataFrame) -> str:
    """Return the column to draw: errors, else cycles; the first number of an experiment."""
    names = list(_WANTED)
    if definition.experiment:
        known = {*FIXED, "machine", *definition.define, *_machine_axes(definition)}
        names = [name for name in table.columns if name not in known]
    for name in names:
        if (
            name in table
            and pd.api.types.is_numeric_dtype(table[name])
            and table[name].notna().any()
        ):
            return name
    raise InputError(
        "NP652",
        f"{definition.file}: the table has nothing to draw",
        hint="runs.csv says in its column 'error' why the runs failed",
    )


def _machine_axes(definition: Definition) -> list[str]:
    return list(dict.fromkeys(name for chip in definition.machines for name in chip.axes))


def _axes(definition: Definition, table: pd.DataFrame) -> list[str]:
    """Return the axes with several numbers, the one with most values first, two at most."""
    names = [*definition.define, *_machine_axes(definition)]
    if definition.experiment:
        names = [name for name in names if name != "seed"]  # what is drawn is the spread over it
    counts = {
        name: table[name].nunique()
        for name in names
        if name in table and pd.api.types.is_numeric_dtype(table[name])
    }
    found = [name for name, count in counts.items() if count > 1]
    return sorted(found, key=lambda name: -counts[name])[:2]


def _groups(table: pd.DataFrame) -> Iterator[tuple[str, pd.DataFrame]]:
    """Yield the rows of each program on each machine."""
    names = [name for name in ("program", "machine") if name in table]
    several = [name for name in names if len(table[name].unique()) > 1]
    if not several:
        yield "", table
        return
    for key, rows in table.groupby(several, sort=False):
        yield ", ".join(map(str, key)), rows


def _lines(table: pd.DataFrame, axes: list[str], what: str) -> Figure:
    figure = Figure(figsize=(7, 4.2), layout="constrained")
    plot = figure.add_subplot()
    style = zip(cycle(COLORS.values()), cycle(_LINES), cycle(_MARKS), strict=False)
    for (name, rows), (color, line, mark) in zip(_groups(table), style, strict=False):
        if axes:
            found = rows.groupby(axes[0])[what].agg(["mean", "std"])
            spread = found["std"].fillna(0)
            plot.fill_between(
                found.index, found["mean"] - spread, found["mean"] + spread, color=color, alpha=0.2
            )
            plot.plot(
                found.index, found["mean"], line, color=color, marker=mark, label=name or None
            )
        else:
            mean, spread = rows[what].mean(), np.nan_to_num(rows[what].std())
            plot.errorbar([name or what], [mean], [spread], color=color, marker=mark, capsize=4)
    if axes:
        plot.set_xlabel(axes[0])
        if plot.get_legend_handles_labels()[1]:
            plot.legend(frameon=False, fontsize=9)
    _finish(plot, what)
    plot.set_title("mean and standard deviation over clips and seeds", loc="left", fontsize=10)
    return figure


def _finish(plot: Axes, what: str) -> None:
    plot.set_ylabel(_LABELS.get(what, what))
    plot.set_ylim(bottom=min(0, plot.get_ylim()[0]))
    plot.grid(color=FAINT)
    plot.set_axisbelow(True)
    plot.spines[["top", "right"]].set_visible(False)


def _heat_maps(table: pd.DataFrame, axes: list[str], what: str) -> Figure:
    groups = list(_groups(table))[:_MOST_PANELS]
    columns = min(2, len(groups))
    lines = -(-len(groups) // columns)
    figure = Figure(figsize=(4.5 * columns, 3.4 * lines), layout="constrained")
    across, down = axes
    low, high = table[what].groupby([table[across], table[down]]).mean().agg(["min", "max"])
    image: Any = None
    panels: list[Axes] = []
    for number, (name, rows) in enumerate(groups, 1):
        plot = figure.add_subplot(lines, columns, number)
        panels.append(plot)
        grid = rows.pivot_table(index=down, columns=across, values=what, aggfunc="mean")
        image = plot.imshow(
            grid.to_numpy(), origin="lower", aspect="auto", vmin=low, vmax=high, cmap="cividis"
        )
        plot.set_xticks(range(len(grid.columns)), grid.columns, rotation=90, fontsize=8)
        plot.set_yticks(range(len(grid.index)), grid.index, fontsize=8)
        plot.set_xlabel(across)
        plot.set_ylabel(down)
        plot.set_title(name, loc="left", fontsize=10, color=INK)
    figure.colorbar(image, ax=panels, label=_LABELS.get(what, what))
    return figure
