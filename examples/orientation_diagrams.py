"""Figures 3.6, 3.7, 3.10 and 3.11 of the thesis: diagrams that explain orientation.

    python -m examples.orientation_diagrams [FOLDER]       (needs the extra `plot`)

Drawn anew, from the geometry of `npchip.host.vision.orientation.scene`. ``npchip orient plot``
draws the figures that show results.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import pyplot as plt

from examples.drawing import save_as_asked
from npchip.host.vision.orientation.scene import (
    CENTROID,
    HIGHEST,
    LOWEST,
    TRIANGLE,
    random_positions,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUE, RED, INK, FAINT = "#0072B2", "#D55E00", "#333333", "#bbbbbb"


# ---- 3.6


def figure_3_6() -> Figure:
    """The bottom-view camera and the front camera whose pitch can be changed."""
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
    for axes, title, place in (
        (panels[0], "bottom view: height = F · length / length in the picture", (0.0, 3.0)),
        (panels[1], "front view: the pitch follows the triangle", (-3.2, 2.6)),
    ):
        _side_view(axes, place)
        axes.set_title(title)
    panels[1].annotate(
        "pitch", (-1.75, 2.78), color=RED, ha="left", va="center", style="italic", size=10
    )
    turn = np.radians(np.linspace(-39, 0, 40))
    panels[1].plot(-3.2 + 1.2 * np.cos(turn), 2.6 + 1.2 * np.sin(turn), color=RED, lw=1.2)
    panels[1].plot([-3.2, -1.6], [2.6, 2.6], ":", color=FAINT)
    return figure


def _side_view(axes: Axes, place: tuple[float, float]) -> None:
    """A drone, its field of view of 53 degrees, and the triangle on the floor."""
    x, height = place
    axis = np.arctan2(-height, -x)
    half = np.arctan(0.5)
    ends = []
    for turn in (-half, half):
        slope = np.array([np.cos(axis + turn), np.sin(axis + turn)])
        ends.append(place + slope * (-height / slope[1]))
    axes.fill(*zip(place, *ends, strict=True), color="#eef4f9", zorder=0)
    for end in ends:
        axes.plot(*zip(place, end, strict=True), color=BLUE, lw=0.8)
    axes.plot([x, 0], [height, 0], "--", color=BLUE, lw=0.8)
    axes.plot([-0.9, 0.9], [0.02, 0.02], color=RED, lw=4, solid_capstyle="butt")
    axes.plot([-4.4, 4.4], [0, 0], color=INK, lw=1)
    axes.plot([x - 0.45, x + 0.45], [height + 0.2] * 2, color=INK, lw=2)
    for side in (-0.45, 0.45):
        axes.plot([x + side - 0.22, x + side + 0.22], [height + 0.32] * 2, color=INK, lw=1.5)
        axes.plot([x + side] * 2, [height + 0.2, height + 0.32], color=INK, lw=1.5)
    axes.plot(x, height, "o", color=INK, ms=7)
    axes.text(0, -0.3, "triangle", color=RED, ha="center", va="top")
    axes.set(xlim=(-4.5, 4.5), ylim=(-0.7, 3.6), aspect="equal")
    axes.set_axis_off()


# ---- 3.7


def figure_3_7() -> Figure:
    """The scene from above: the triangle, its highlighted corner, and the centroid."""
    figure, axes = plt.subplots(figsize=(4.2, 5.2), layout="constrained")
    places = TRIANGLE[:, :2] + CENTROID[:2]
    axes.fill(*places.T, color="#c8c8c8")
    corner = places[0] + 0.22 * (places - places[0])
    axes.fill(*corner.T, color="#f2c80f")
    axes.plot(*CENTROID[:2], "+", color=RED, ms=11, mew=1.6)
    axes.annotate("centroid", CENTROID[:2], xytext=(8, 6), textcoords="offset points", color=RED)
    labels = ("5: 250 mm", "13: 650 mm", "12: 600 mm")
    offsets = ((0, -10, "center", "top"), (8, 4, "left", "bottom"), (-8, 0, "right", "center"))
    for number, (text, (right, up, across, along)) in enumerate(zip(labels, offsets, strict=True)):
        middle = (places[number] + places[(number + 1) % 3]) / 2
        axes.annotate(
            text, middle, xytext=(right, up), textcoords="offset points", ha=across, va=along
        )
    axes.annotate(
        "highlighted", corner.mean(axis=0), xytext=(-12, -30), textcoords="offset points",
        ha="right", arrowprops={"arrowstyle": "-", "color": FAINT},
    )  # fmt: skip
    axes.set(xlim=(150, 880), ylim=(180, 1000), aspect="equal", xlabel="x, mm", ylabel="y, mm")
    axes.grid(color="#eeeeee")
    axes.set_axisbelow(True)
    return figure


# ---- 3.10


def figure_3_10() -> Figure:
    """The network of the side-lengths model: three sides, fifteen neurons, a position."""
    figure, axes = plt.subplots(figsize=(6.4, 4.6), layout="constrained")
    layers = [_layer(0, 3, 1.9), _layer(2, 15, 0.5), _layer(4, 3, 1.9)]
    for left, right in pairwise(layers):
        for a in left:
            for b in right:
                axes.plot(*zip(a, b, strict=True), color="#d5d5d5", lw=0.6, zorder=1)
    for layer, color in zip(layers, (BLUE, "#009E73", RED), strict=True):
        axes.scatter(*layer.T, s=150, color=color, zorder=2, edgecolor="white")
    for number, (x, y) in enumerate(layers[0][::-1], 1):
        axes.text(x - 0.15, y, f"side {number}", ha="right", va="center")
    for name, (x, y) in zip("xyz", layers[2][::-1], strict=True):
        axes.text(x + 0.15, y, f"{name} of the camera", ha="left", va="center")
    axes.text(2, 4.0, "15 neurons:\ntanh(weights · sides + bias)", ha="center", va="bottom")
    axes.text(0, -4.2, "45 weights, 15 biases", ha="left", va="top", color=INK)
    axes.text(4, -4.2, "45 weights, 3 offsets", ha="right", va="top", color=INK)
    axes.set(xlim=(-0.9, 5.5), ylim=(-4.8, 5))
    axes.set_axis_off()
    return figure


def _layer(x: float, count: int, gap: float) -> np.ndarray:
    return np.column_stack([np.full(count, x), (np.arange(count) - (count - 1) / 2) * gap])


# ---- 3.11


def figure_3_11() -> Figure:
    """The space in which camera positions are drawn, with some of them."""
    figure = plt.figure(figsize=(5.6, 5.2), layout="constrained")
    axes: Any = figure.add_subplot(projection="3d")
    low, high = LOWEST, HIGHEST
    corners = np.array(
        [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    )
    for a in corners:
        for b in corners:
            if (a != b).sum() == 1 and tuple(a) < tuple(b):
                axes.plot(*np.array([a, b]).T, color=FAINT, lw=0.9)
    places = TRIANGLE + CENTROID
    axes.plot(*places[[0, 1, 2, 0]].T, color=RED, lw=2)
    some = random_positions(120, 11)
    axes.scatter(*some.T, s=7, color=BLUE, alpha=0.7)
    camera = np.array([1250.0, -150, 2300])
    axes.plot(*np.array([camera, CENTROID]).T, "--", color=INK, lw=1)
    axes.scatter(*camera, s=40, color=INK)
    axes.text(*(camera + np.array([0, 0, 130])), "p(x, y, z)", color=INK)
    axes.set(xlabel="x, mm", ylabel="y, mm", zlabel="z, mm", zlim=(0, 3300))
    axes.zaxis.labelpad = 12
    axes.set(xticks=(-500, 500, 1500), yticks=(-500, 500, 1500))
    axes.set_box_aspect((2, 2, 3.3), zoom=0.9)
    axes.view_init(elev=18, azim=-58)
    return figure


DRAWN = {
    "figure-3.6": figure_3_6,
    "figure-3.7": figure_3_7,
    "figure-3.10": figure_3_10,
    "figure-3.11": figure_3_11,
}

if __name__ == "__main__":
    save_as_asked(DRAWN, **{"text.color": INK, "axes.edgecolor": FAINT})
