"""Figures 2.1 to 2.5 of the thesis: the simulation of 2.1.3 and runs on the emulated chip.

    python -m examples.trajectory_figures [FOLDER]       (needs the extra `plot`)

2.1 explains equation 2.1. 2.2 is the thesis's simulation, computed by `npchip.host.vision.tracks`.
For 2.3 to 2.5 a moving light is drawn, and the programs of ``asm/`` follow it on the emulated
chip. The thesis shows its figures without numbers: paths, speeds and the light are decisions.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.lines import Line2D

from examples.drawing import FAINT, GREEN, INK, RED, save_as_asked
from npchip import Chip, assemble
from npchip.host.vision.motion import MARGIN, bouncing, uniform
from npchip.host.vision.prediction import FRAME, linear_predictor, second_order_predictor
from npchip.host.vision.tracks import follow

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from npchip.host.vision.motion import Path as Motion
    from npchip.host.vision.prediction import Predictor

ROOT = Path(__file__).parents[1]


# ---- 2.1: what the equations say


def figure_2_1() -> Figure:
    """Position against time: displacements v, v + a and, predicted, v + 2a."""
    figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    v, a = 1.6, 1.0
    times = np.arange(4)
    places = np.cumsum([1, v, v + a, v + 2 * a])
    fine = np.linspace(-0.3, 3.15, 200)
    curve = np.polynomial.Polynomial.fit(times, places, 2)
    axes.plot(fine, curve(fine), color=FAINT, lw=1.2, zorder=1)
    names = ("v", "v + a", "v + 2a")
    for k, name in enumerate(names):
        color = RED if k == 2 else GREEN
        axes.plot([k, k + 1], [places[k]] * 2, color=FAINT, lw=1, ls=":")
        axes.annotate(
            "",
            (k + 1, places[k + 1]),
            (k + 1, places[k]),
            arrowprops={"arrowstyle": "->", "color": color, "lw": 1.8, "shrinkA": 0, "shrinkB": 5},
        )
        middle = (places[k] + places[k + 1]) / 2
        axes.text(k + 1.06, middle, name, color=color, style="italic", size=12, va="center")
    axes.plot(times[:3], places[:3], "o", color=GREEN, ms=8, label="known centres")
    axes.plot(times[3:], places[3:], "X", color=RED, ms=10, label="predicted")
    labels = ["x(k–2)", "x(k–1)", "x(k)", "x(k+1)"]
    for k, label in enumerate(labels):
        axes.text(k - 0.06, places[k] + 0.25, label, ha="right", va="bottom")
    axes.set_xticks(times, ["k–2", "k–1", "k", "k+1"])
    axes.set_yticks([])
    axes.set(xlim=(-0.55, 3.75), ylim=(0.3, 12.4), xlabel="frame", ylabel="position")
    axes.legend(loc="lower right", frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.text(
        -0.45,
        12.1,
        "(2.1a)   v = x(k–1) – x(k–2), the older displacement\n"
        "(2.1b)   a = x(k) – x(k–1) – v, its change; the newer one is v + a\n"
        "(2.1c)   x(k+1) = x(k) + v + 2a",
        va="top",
        linespacing=1.5,
    )
    return figure


# ---- 2.2: the simulation


def figure_2_2() -> Figure:
    """Uniform and bouncing motion: true paths with rounded centres, and what is predicted."""
    figure, panels = plt.subplots(2, 2, figsize=(8, 7.2), layout="constrained")
    straight = _longest(uniform)
    ball = _longest(lambda rng: bouncing(rng, frames=40, gravity=(0.8, 0.9)))
    _path(panels[0, 0], straight, "uniform linear motion: path and centres")
    _predictions(panels[0, 1], straight, linear_predictor(), "predicted, first order")
    _path(panels[1, 0], ball, "bouncing ball: path and centres")
    _predictions(panels[1, 1], ball, second_order_predictor(threshold=4), "predicted, second order")
    return figure


def _longest(make: Callable[[np.random.Generator], Motion]) -> Motion:
    """Draw 30 paths and take the one that covers most: it is the best to look at."""
    rng = np.random.default_rng(1)
    return max(
        (make(rng) for _ in range(30)), key=lambda m: float(np.prod(np.ptp(m.centers, axis=0)))
    )


def _grid(axes: Axes, title: str) -> None:
    axes.set(xlim=(-0.5, FRAME[1] - 0.5), ylim=(FRAME[0] - 0.5, -0.5), title=title)
    axes.set_aspect("equal")
    axes.set_xticks(range(0, 81, 8), [str(x) if x % 16 == 0 else "" for x in range(0, 81, 8)])
    axes.set_yticks(range(0, 65, 8), [str(y) if y % 16 == 0 else "" for y in range(0, 65, 8)])
    axes.grid(color="#e8e8e8", lw=0.6)
    axes.tick_params(length=0, labelcolor=FAINT)


def _path(axes: Axes, motion: Motion, title: str) -> None:
    _grid(axes, title)
    _true(axes, motion)
    rows, cols = motion.rounded().T
    axes.plot(cols, rows, "o", color=GREEN, ms=4, label="centre, rounded")
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.07), ncols=3, frameon=False, columnspacing=1.2
    )


def _true(axes: Axes, motion: Motion) -> None:
    if motion.impacts.any():
        axes.axhline(FRAME[0] - 1 - MARGIN, color=FAINT, lw=1)
        axes.text(1, FRAME[0] - MARGIN, "ground", color=FAINT, size=8, va="top")
    rows, cols = motion.centers.T
    axes.plot(cols, rows, color=GREEN, lw=1.2, label="true path")


def _predictions(axes: Axes, motion: Motion, predictor: Predictor, title: str) -> None:
    """Predictions of frames 2 on.

    At an inflection there is none, and that of the inflection's own frame is a dummy point: as in
    the thesis it is not shown.
    """
    _grid(axes, title)
    _true(axes, motion)
    track = follow(motion, predictor)
    turned = np.atleast_1d(track.inflections.any(axis=1))
    rows, cols = track.predicted[1:-1][~turned[1:-1] & ~turned[2:]].T
    axes.plot(cols, rows, "x", color=RED, ms=6, mew=1.6, label="predicted centre")
    if turned.any():
        rows, cols = track.centers[turned].T
        axes.plot(cols, rows, "s", mfc="none", mec=INK, ms=9, label="inflection")
    axes.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.07), ncols=3, frameon=False, columnspacing=1.2
    )


# ---- 2.3 to 2.5: a light before the emulated chip


def light(centers: NDArray[np.float64], radius: float = 2.5) -> NDArray[np.uint8]:
    """A light on dark ground: uint8, shape (T, 64, 80); centres float64, shape (T, 2)."""
    rows, cols = np.ogrid[: FRAME[0], : FRAME[1]]
    clip = [
        20 + 220 * np.clip(radius + 0.5 - np.hypot(rows - y, cols - x), 0, 1) for y, x in centers
    ]
    return np.round(clip).astype(np.uint8)


def figure_2_3() -> Figure:
    """First order on the chip: straight to the right, straight and slanting, and a turn."""
    k = np.arange(13.0)
    flat = np.stack([36 + 0 * k, 8 + 5.2 * k], 1)
    slanting = np.stack([54 - 3.6 * k, 6 + 5.4 * k], 1)
    angle = np.linspace(0, 1.35 * np.pi, 13)
    turning = np.stack([34 - 20 * np.cos(angle), 36 + 27 * np.sin(angle)], 1)
    figure, panels = plt.subplots(3, 4, figsize=(9, 6.1), layout="constrained")
    for row, path in zip(panels, (flat, slanting, turning), strict=True):
        _strip(row, path, "trajectory", {}, [3, 6, 9, 12])
    return _captioned(figure)


def figure_2_4() -> Figure:
    """Second order along the columns: faster, slower, and back, where calculation stops."""
    speeds = np.array([1, 3, 5, 7, 9, 10, 9, 7, 5, 3, 1, -3, -6, -9])
    cols = 6 + np.concatenate([[0], np.cumsum(speeds)])
    path = np.stack([np.linspace(26, 40, len(cols)), cols], 1)
    options = {"AXIS": 1, "DIRECTION": 0}
    figure, panels = plt.subplots(2, 4, figsize=(9, 4.3), layout="constrained")
    _strip(panels.ravel(), path, "trajectory_mixed", options, [3, 4, 6, 7, 9, 11, 13, 14])
    return _captioned(figure)


def figure_2_5() -> Figure:
    """Second order along the rows: a light is accelerated upwards."""
    k = np.arange(12.0)
    path = np.stack([58 + 0.6 * k - 0.5 * k**2, 20 + 3.2 * k], 1)
    options = {"AXIS": 0, "DIRECTION": 1}
    figure, panels = plt.subplots(2, 4, figsize=(9, 4.3), layout="constrained")
    _strip(panels.ravel(), path, "trajectory_mixed", options, [4, 5, 6, 7, 8, 9, 10, 11])
    return _captioned(figure)


def _strip(
    panels: NDArray[np.object_],
    path: NDArray[np.float64],
    name: str,
    options: dict[str, int],
    frames: list[int],
) -> None:
    """Run a program on a light and draw some frames: inverted, as in the thesis."""
    clip = light(path)
    sent = Chip(assemble(ROOT / "asm" / f"{name}.s", defines=options)).run(clip).outputs
    valid = np.asarray(sent["valid"]) > 0
    rows, cols, next_rows, next_cols = (
        np.asarray(sent[f"{kind}_{axis}"])
        for kind in ("center", "predicted")
        for axis in ("row", "col")
    )
    turned = np.atleast_1d(sent["inflection"] if "inflection" in sent else 0 * rows).astype(bool)
    for axes, k in zip(panels, frames, strict=True):
        axes.imshow(255 - clip[k] * 0.6, cmap="gray", vmin=0, vmax=255)  # paler than the lines
        past = np.flatnonzero(valid[: k + 1])
        axes.plot(cols[past], rows[past], "-o", color=GREEN, lw=1.4, ms=2.6)
        axes.set_title(f"frame {k}", loc="left", pad=2)
        if turned[k]:
            axes.plot(cols[k], rows[k], "s", mfc="none", mec=INK, ms=9)
            axes.set_title("moves back: stopped", loc="right", pad=2, size=8)
        else:
            axes.plot([cols[k], next_cols[k]], [rows[k], next_rows[k]], color=RED, lw=1.6)
            axes.plot(next_cols[k], next_rows[k], "X", color=RED, ms=6, mew=0, clip_on=False)
        axes.set(xticks=[], yticks=[], xlim=(-0.5, 79.5), ylim=(63.5, -0.5))


def _captioned(figure: Figure) -> Figure:
    handles = [
        Line2D([], [], color=GREEN, marker="o", ms=4, label="past path"),
        Line2D([], [], color=RED, marker="X", ms=6, label="predicted"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=2, frameon=False)
    return figure


DRAWN = {
    "figure-2.1": figure_2_1,
    "figure-2.2": figure_2_2,
    "figure-2.3": figure_2_3,
    "figure-2.4": figure_2_4,
    "figure-2.5": figure_2_5,
}

if __name__ == "__main__":
    save_as_asked(DRAWN)
