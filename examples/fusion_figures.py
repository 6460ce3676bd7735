"""Figures 2.9, 2.11, 2.12 and 2.14 to 2.16 of the thesis: two cameras, computed.

    python -m examples.fusion_figures [FOLDER]       (needs the extra `plot`)

`npchip.host.vision.fusion` computes all in the setting that was fitted to table 2.1. The thesis
states neither its cameras nor its path: both are decisions. The explaining figures 2.6 to 2.8, 2.10
and 2.13 are drawn by ``fusion_diagrams.py``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib import pyplot as plt

from examples.drawing import BLUE, FAINT, GREEN, INK, RED, save_as_asked
from npchip.host.vision.fusion import locate
from npchip.host.vision.fusion.experiment import SETTINGS, Experiment

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SETTING = SETTINGS["thesis"]
RIG = SETTING.rig
SHARE: Final = np.linspace(0, 1, 20)[:, None]
PATH: Final = np.array([2.4, 5.4, -0.9]) * (1 - SHARE) + np.array([5.6, 3.2, 1.1]) * SHARE
SEEN = RIG.camera1.observe(PATH), RIG.camera2.observe(PATH)
COLORS = {"lut": FAINT, "vector": BLUE, "improved-dx": GREEN, "improved-fdx": RED}
NAMES = {
    "lut": "lookup table",
    "vector": "vector-based",
    "improved-dx": "improved, dx",
    "improved-fdx": "improved, fdx",
}


def positions(name: str) -> np.ndarray:
    """Positions of the path by an algorithm in Q format, metres."""
    return locate(RIG, *SEEN, name, SETTING.form).points


def figure_2_9() -> Figure:
    """Draw the centres that a camera sees of a fast object, and the offsets of one place."""
    figure, axes = plt.subplots(figsize=(4.6, 4.4), layout="constrained")
    _frame(axes, 0)
    rows, cols = SEEN[0].T
    axes.plot(cols, rows, "o", color=BLUE, ms=5, label="tracked centre")
    row, col = rows[-3], cols[-3]
    axes.plot(79.5, 79.5, "+", color=INK, ms=10)
    _measure(axes, (79.5, row), (col, row), "c1h", (0, 7))
    _measure(axes, (col, 79.5), (col, row), "c1v", (8, 0))
    axes.axhline(79.5, color=FAINT, lw=0.8, ls=":")
    axes.axvline(79.5, color=FAINT, lw=0.8, ls=":")
    axes.legend(loc="lower left", frameon=False)
    return figure


def figure_2_11() -> Figure:
    """Both views, and the middles of the cells that the table knows."""
    figure, panels = plt.subplots(1, 2, figsize=(8.2, 4.4), layout="constrained")
    for number, axes in enumerate(panels):
        _frame(axes, number)
        rows, cols = SEEN[number].T
        axes.plot(cols, rows, "o", color=BLUE, ms=4, label="tracked centre")
        middles = (SEEN[number] // RIG.cell + 0.5) * RIG.cell - 0.5
        axes.plot(middles[:, 1], middles[:, 0], "*", color=RED, ms=8, label="middle of its cell")
    _legend(figure, panels[0])
    return figure


def figure_2_12() -> Figure:
    """The plane, and what a table of 10 x 10 entries makes of the path."""
    figure, axes = plt.subplots(figsize=(5.4, 5), layout="constrained")
    _plane(axes, 0, 1)
    axes.set_aspect("equal", adjustable="box")
    _views(axes)
    points = positions("lut")
    axes.plot(*points[:, :2].T, "o", mfc="none", color=RED, ms=6, label="lookup table")
    axes.plot(*PATH[:, :2].T, "-", color=GREEN, lw=1.4, label="path")
    for found, true in zip(points, PATH, strict=True):
        axes.plot([found[0], true[0]], [found[1], true[1]], color=RED, lw=0.5)
    axes.set(xlim=(-0.5, 8), ylim=(-0.5, 8))
    axes.legend(loc="upper right", frameon=False)
    return figure


def figure_2_14() -> Figure:
    """Distances fdx and fdy of one place from the middles of its cells."""
    figure, panels = plt.subplots(1, 2, figsize=(8.2, 4.9), layout="constrained")
    k = 12
    for number, (axes, name) in enumerate(zip(panels, ("fdx", "fdy"), strict=True)):
        _frame(axes, number)
        rows, cols = SEEN[number].T
        axes.plot(cols, rows, "o", color=BLUE, ms=3.5, alpha=0.45, label="tracked centre")
        axes.plot(cols[k], rows[k], "o", color=BLUE, ms=6)
        middle = (cols[k] // RIG.cell + 0.5) * RIG.cell - 0.5
        axes.axvline(middle, color=RED, lw=1, ls="--", label="middle of its cells")
        pixels = abs(cols[k] - middle)
        axes.plot([middle, cols[k]], [rows[k]] * 2, color=RED, lw=2.5, solid_capstyle="butt")
        axes.text(
            max(middle, cols[k]) + 3,
            rows[k],
            f"{name} = {pixels:g}",
            color=RED,
            va="center",
            bbox={"color": "white", "pad": 1},
        )
        near = 20 + pixels
        axes.set(xlim=(middle - near, middle + near), ylim=(rows[k] + near, rows[k] - near))
        for axis, place in ((axes.xaxis, middle), (axes.yaxis, rows[k])):
            lines = axis.get_ticklocs()  # lines out of view would count as parts of the panel
            seen = abs(lines - place) <= near
            axis.set_ticks(lines[seen], [f"{line + 0.5:g}" for line in lines[seen]])
    _legend(figure, panels[0])
    return figure


def figure_2_15() -> Figure:
    """Path and positions in the three planes."""
    figure, panels = plt.subplots(1, 3, figsize=(10, 3.9), layout="constrained")
    exact, improved = positions("vector"), positions("improved-fdx")
    for axes, (a, b), name in zip(panels, ((0, 1), (0, 2), (1, 2)), "abc", strict=True):
        _plane(axes, a, b)
        axes.plot(PATH[:, a], PATH[:, b], color=GREEN, lw=1.2, label="path")
        axes.plot(improved[:, a], improved[:, b], "o", mfc="none", color=RED, ms=7,
                  label="improved lookup table")  # fmt: skip
        axes.plot(exact[:, a], exact[:, b], "x", color=BLUE, ms=5, label="vector-based")
        axes.set_title(f"({name}) {'xyz'[a]}, {'xyz'[b]} plane", loc="left")
    _legend(figure, panels[0], 3)
    return figure


def figure_2_16() -> Figure:
    """Errors of each sample: of this path, over many paths, and by direction."""
    figure = plt.figure(figsize=(10, 6.4), layout="constrained")
    top, bottom = figure.subfigures(2, 1)
    left, right = top.subplots(1, 2)
    experiment = Experiment.draw(SETTING, 1000, 1)
    for name, color in COLORS.items():
        errors = np.linalg.norm(positions(name) - PATH, axis=1)
        left.plot(range(1, 21), errors, "-o", color=color, ms=3, label=NAMES[name])
        many = experiment.locate(name, SETTING.form).points - experiment.truth
        many_rms = np.sqrt((many**2).sum(axis=-1).mean(axis=0))
        right.plot(range(1, 21), many_rms, "-o", color=color, ms=3)
    left.set_title("distance to the truth, this path", loc="left")
    right.set_title("RMS over 1,000 paths", loc="left")
    for axis, axes in enumerate(bottom.subplots(1, 3)):
        for name in ("vector", "improved-dx", "improved-fdx"):
            error = positions(name)[:, axis] - PATH[:, axis]
            axes.plot(range(1, 21), error, "-o", color=COLORS[name], ms=3)
        axes.axhline(0, color=FAINT, lw=0.8)
        axes.set_title(f"error in {'xyz'[axis]}, this path", loc="left")
        _samples(axes)
    for axes in (left, right):
        axes.set_ylim(0)
        _samples(axes)
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4,
                  frameon=False)  # fmt: skip
    return figure


def _samples(axes: Axes) -> None:
    axes.set(xlabel="sample", ylabel="metres", xticks=[1, 5, 10, 15, 20])
    axes.spines[["top", "right"]].set_visible(False)


def _frame(axes: Axes, number: int) -> None:
    """The frame of camera 1 or 2 with its 10 x 10 cells."""
    camera = (RIG.camera1, RIG.camera2)[number]
    axes.set(xlim=(-0.5, camera.cols - 0.5), ylim=(camera.rows - 0.5, -0.5))
    lines = np.arange(0, camera.cols + 1, RIG.cell) - 0.5
    axes.set_xticks(lines, ["" if k % 2 else f"{line + 0.5:g}" for k, line in enumerate(lines)])
    axes.set_yticks(lines, ["" if k % 2 else f"{line + 0.5:g}" for k, line in enumerate(lines)])
    axes.grid(color="#e4e4e4", lw=0.7)
    axes.tick_params(length=0, labelcolor=FAINT)
    axes.set_aspect("equal")
    axes.set_title(f"camera {number + 1}, looks along {camera.looks}", loc="left")


def _plane(axes: Axes, a: int, b: int) -> None:
    axes.set(xlabel=f"{'xyz'[a]}, metres", ylabel=f"{'xyz'[b]}, metres")
    axes.set_aspect("equal", adjustable="datalim")
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#eeeeee", lw=0.7)


def _views(axes: Axes) -> None:
    """Both cameras, and what they see, from above."""
    wide = RIG.camera1.cols / 2 / RIG.camera1.ratio
    (x1, y1, _), (x2, y2, _) = RIG.camera1.position, RIG.camera2.position
    far = 20.0
    axes.fill([x1, x1 - wide * far, x1 + wide * far], [y1, far, far], color=BLUE, alpha=0.07, lw=0)
    axes.fill([x2, far, far], [y2, y2 - wide * far, y2 + wide * far], color=RED, alpha=0.07, lw=0)
    for place, name, side in (((x1, y1), "camera 1", (8, 2)), ((x2, y2), "camera 2", (4, 10))):
        axes.plot(*place, "s", color=INK, ms=7)
        axes.annotate(name, place, xytext=side, textcoords="offset points")


def _measure(
    axes: Axes,
    a: tuple[float, float],
    b: tuple[float, float],
    name: str,
    side: tuple[float, float],
) -> None:
    """An arrow with two heads and a name beside it."""
    style = {"arrowstyle": "<->", "color": RED, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", a, b, arrowprops=style)
    middle = (a[0] + b[0]) / 2 + side[0], (a[1] + b[1]) / 2 + side[1]
    axes.text(*middle, name, color=RED, ha="center", va="center")


def _legend(figure: Figure, axes: Axes, columns: int = 2) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False)


DRAWN: Final = {
    "figure-2.9": figure_2_9,
    "figure-2.11": figure_2_11,
    "figure-2.12": figure_2_12,
    "figure-2.14": figure_2_14,
    "figure-2.15": figure_2_15,
    "figure-2.16": figure_2_16,
}

if __name__ == "__main__":
    save_as_asked(DRAWN)
