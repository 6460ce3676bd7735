"""Figures 2.6 to 2.8, 2.10 and 2.13 of the thesis: what the equations of two cameras mean.

python -m examples.fusion_diagrams [FOLDER]       (needs the extra `plot`)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib import pyplot as plt

from examples.drawing import BLUE, FAINT, GREEN, INK, RED, save_as_asked

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ONE, TWO = np.array([4.0, 0.0]), np.array([0.0, 4.0])
OBJECT = np.array([5.1, 5.3])
ALPHA, BETA = r"$\alpha$", r"$\beta$"
SAME = f"{BETA}/{ALPHA}"
FORMULA = f"{SAME} = b/a.  {ALPHA} is n pixels long:\nb/a = ratio/n,  ratio = n·{SAME}"


def figure_2_6() -> Figure:
    """Two cameras in space: a straight path and a curved one, and the rays to one place."""
    figure = plt.figure(figsize=(5.6, 5), layout="constrained")
    axes = figure.add_subplot(projection="3d")
    t = np.linspace(0, 1, 40)
    straight = np.stack([2.6 + 3 * t, 5.2 - 2 * t, -0.6 + 1.5 * t])
    curved = np.stack([2.8 + 3 * t, 3 + 2.6 * t, -0.8 + 7 * t - 6 * t**2])
    axes.plot(*straight, color=INK, lw=1.6, label="linear motion")
    axes.plot(*curved, color=GREEN, lw=1.6, label="non-linear motion")
    place = straight[:, 26]
    for camera, name, away in (
        ((4, 0, 0), "camera 1", (0, 1, 0)),
        ((0, 4, 0), "camera 2", (1, 0, 0)),
    ):
        axes.plot(*np.transpose([camera, place]), color=RED, lw=1)
        axes.scatter(*camera, marker="s", s=45, color=INK, depthshade=False)
        axes.quiver(*camera, *away, color=INK, length=1.1, arrow_length_ratio=0.25)
        axes.text(camera[0] + 0.1, camera[1] - 0.1, 0.4, name)
    axes.scatter(*place, s=40, color=RED, depthshade=False)
    axes.text(place[0] + 0.3, place[1] + 0.2, place[2] - 0.35, "p(x, y, z)", color=RED)
    axes.set(xlabel="x", ylabel="y", zlabel="z", xlim=(0, 6), ylim=(0, 6), zlim=(-1, 2))
    axes.set_box_aspect((6, 6, 3.4))
    axes.view_init(elev=26, azim=-118)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_ticklabels([])
    figure.legend(loc="outside upper right", frameon=False)
    return figure


def figure_2_7() -> Figure:
    """The same from above: c1, c2, the vectors to p, and what both cameras see."""
    figure, axes = _above()
    wide, far = 0.625, 20
    for place, along, side in ((ONE, (0, 1), (1, 0)), (TWO, (1, 0), (0, 1))):
        ends = [place + far * (np.array(along) + k * wide * np.array(side)) for k in (-1, 1)]
        axes.fill(*np.transpose([place, *ends]), color=BLUE, alpha=0.08, lw=0)
    _cameras(axes)
    for place, name, side in ((ONE, "v1(a1, b1, c1)", (6, -8)), (TWO, "v2(a2, b2, c2)", (-38, 14))):
        _arrow(axes, place, OBJECT, RED)
        axes.annotate(
            name, (place + OBJECT) / 2, xytext=side, textcoords="offset points", color=RED
        )
    _object(axes)
    axes.text(5.3, 7.2, "seen by both", color=BLUE, ha="center")
    return figure


def figure_2_8() -> Figure:
    """A pinhole, from the side: the same ratio in the camera and before it."""
    figure, axes = plt.subplots(figsize=(6.4, 2.9), layout="constrained")
    beta, alpha, b = 2.0, 0.8, 5.5
    a = alpha * b / beta
    axes.plot([-beta, b], [0, 0], color=FAINT, lw=1, ls=":")
    axes.plot([-beta, -beta], [-1.2, 1.2], color=INK, lw=2)
    axes.plot([b, b], [-2.6, 2.6], color=INK, lw=1, ls="--")
    axes.plot([-beta, b], [-alpha, a], color=RED, lw=1.4)
    axes.plot(0, 0, "o", color=INK, ms=6)
    for x, y, name, side in (
        (0, 0, "o, pinhole", (4, -14)),
        (-beta, 0, "oi", (-16, 4)),
        (-beta, -alpha, "p", (-13, -6)),
        (b, 0, "os", (6, -12)),
        (b, a, "s", (6, 2)),
    ):
        axes.annotate(name, (x, y), xytext=side, textcoords="offset points")
    for ends, name, side in (
        (((-beta, 0.25), (0, 0.25)), BETA, (0, 4)),
        (((-beta + 0.22, 0), (-beta + 0.22, -alpha)), ALPHA, (4, -4)),
        (((0, 0.25), (b, 0.25)), "b", (0, 4)),
        (((b - 0.22, 0), (b - 0.22, a)), "a", (-11, -4)),
    ):
        _double(axes, *map(np.array, ends), name, side)
    axes.text(-beta, 1.35, "frame", ha="center")
    axes.text(b, 2.7, "scene", ha="center")
    axes.text(0.6, -2.4, FORMULA, size=10)
    axes.set(xlim=(-3, 7), ylim=(-2.8, 3.2))
    axes.axis("off")
    return figure


def figure_2_10() -> Figure:
    """Similar triangles: a1, b1 from camera 1 to the object, a2, b2 from camera 2."""
    figure, axes = _above()
    _cameras(axes)
    for place in (ONE, TWO):
        axes.plot(*np.transpose([place, OBJECT]), color=RED, lw=1.2)
    x, y = OBJECT
    axes.plot([ONE[0], ONE[0], x], [0, y, y], color=FAINT, lw=0.9, ls="--")
    axes.plot([0, x, x], [TWO[1], TWO[1], y], color=FAINT, lw=0.9, ls="--")
    _double(axes, np.array([4.0, y + 0.35]), np.array([x, y + 0.35]), "a1 = t1·b1", (0, 5))
    _double(axes, np.array([3.65, 0.0]), np.array([3.65, y]), "b1 = y – y1", (-36, -22))
    _double(axes, np.array([x + 0.35, 4.0]), np.array([x + 0.35, y]), "a2 = t2·b2", (33, -4))
    _double(axes, np.array([0.0, 3.75]), np.array([x, 3.75]), "b2 = x – x2", (-30, 14))
    _object(axes)
    return figure


def figure_2_13() -> Figure:
    """The table's place, then the ray of camera 1 at its y, then the ray of camera 2."""
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    place, table = np.array([6.0, 5.6]), np.array([4.8, 4.75])
    t1, t2 = (place[0] - ONE[0]) / place[1], (place[1] - TWO[1]) / place[0]
    gray = np.array([ONE[0] + t1 * table[1], table[1]])
    black = np.array([gray[0], TWO[1] + t2 * gray[0]])
    for camera in (ONE, TWO):
        axes.plot(*np.transpose([camera, place]), color=RED, lw=1.4)
        axes.plot(*np.transpose([camera, table]), color=BLUE, lw=1)
    for start, end in ((table, gray), (gray, black)):
        style = {"arrowstyle": "->", "color": INK, "lw": 1.3, "shrinkA": 5, "shrinkB": 5}
        axes.annotate("", end, start, arrowprops=style)
    for at, color, name, side in (
        (place, RED, "p(x, y, z)", (9, 4)),
        (table, BLUE, "entry of the table", (6, -16)),
        (gray, "#888888", "1: x on the ray of camera 1", (14, -3)),
        (black, INK, "2: y on the ray of camera 2", (36, -13)),
    ):
        axes.plot(*at, "o", color=color, ms=8, zorder=4)
        axes.annotate(name, at, xytext=side, textcoords="offset points", color=color)
    _double(axes, np.array([table[0], 5.85]), np.array([place[0], 5.85]), "dx", (0, 4))
    _double(axes, np.array([4.55, table[1]]), np.array([4.55, place[1]]), "dy", (-10, -14))
    axes.text(5.66, 4.32, "from camera 1", color=RED, size=8)
    axes.text(3.5, 5.02, "from camera 2", color=RED, rotation=15, size=8)
    axes.set(xlim=(3.4, 7.6), ylim=(4.2, 6.1), xlabel="x", ylabel="y", xticks=[], yticks=[])
    axes.set_aspect("equal")
    axes.spines[["top", "right"]].set_visible(False)
    return figure


# ---- what they are made of


def _above() -> tuple[Figure, Axes]:
    figure, axes = plt.subplots(figsize=(5.6, 5.4), layout="constrained")
    axes.set(xlim=(-1, 8), ylim=(-0.9, 7.6), xlabel="x", ylabel="y", xticks=[], yticks=[])
    axes.set_aspect("equal")
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def _cameras(axes: Axes) -> None:
    for place, along, name, side in (
        (ONE, (0, 1), "camera 1  c1(x1, y1, z1)", (-34, -16)),
        (TWO, (1, 0), "camera 2\nc2(x2, y2, z2)", (-26, -36)),
    ):
        axes.plot(*place, "s", color=INK, ms=9)
        _arrow(axes, place, place + 0.75 * np.array(along), INK)
        axes.annotate(name, place, xytext=side, textcoords="offset points", annotation_clip=True)


def _object(axes: Axes) -> None:
    axes.plot(*OBJECT, "o", color=RED, ms=9, zorder=5)
    axes.annotate("p(x, y, z)", OBJECT, xytext=(9, 4), textcoords="offset points", color=RED)


def _arrow(axes: Axes, a: np.ndarray, b: np.ndarray, color: str) -> None:
    style = {"arrowstyle": "-|>", "color": color, "lw": 1.3, "shrinkA": 5, "shrinkB": 4}
    axes.annotate("", b, a, arrowprops=style)


def _double(axes: Axes, a: np.ndarray, b: np.ndarray, name: str, side: tuple[float, float]) -> None:
    """An arrow with two heads, and what it measures."""
    style = {"arrowstyle": "<->", "color": INK, "lw": 0.9, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", b, a, arrowprops=style)
    axes.annotate(
        name, (a + b) / 2, xytext=side, textcoords="offset points", ha="center", style="italic"
    )


DRAWN: Final = {
    "figure-2.6": figure_2_6,
    "figure-2.7": figure_2_7,
    "figure-2.8": figure_2_8,
    "figure-2.10": figure_2_10,
    "figure-2.13": figure_2_13,
}

if __name__ == "__main__":
    save_as_asked(DRAWN)
