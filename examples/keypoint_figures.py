"""Figures 3.1 to 3.5 of the thesis: key points of triangles; and two for docs/keypoints.md.

    python -m examples.keypoint_figures [FOLDER]       (needs the extra `plot`)

3.1 to 3.4 show the tracers of `npchip.host.vision.keypoints` step by step. For 3.5 random triangles
are drawn, and ``asm/keypoints.s`` finds their key points on the emulated chip. The thesis shows its
figures without coordinates: the triangles are ours.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np

from examples.keypoint_page import raised_frame
from npchip import Chip, assemble
from npchip.host.vision.keypoints import REVERSAL, Point, Step, key_points, object_mask, trace_edges
from npchip.host.vision.polygons import (
    Mask,
    hinged,
    random_convex_polygon,
    random_triangle,
    random_triangles,
    raster,
)
from npchip.host.vision.shapes import UNIT, distance, scaled, side_lengths

mpl.use("Agg")

from matplotlib import pyplot as plt
from matplotlib.colors import to_rgb

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

ROOT = Path(__file__).parents[1]
FIGURES = ROOT / "docs" / "figures"
PAPER, OBJECT, EDGE, KEY, SPECIAL = "#ffffff", "#dddddd", "#8c8c8c", "#a50f15", "#f2c80f"
INK, FAINT = "#111111", "#e8e8e8"
TURNS = ("#2166ac", "#1a9850", "#e08214", "#762a83")
MOVES = ((-1, 0), (0, 1), (1, 0), (0, -1))

ACUTE = np.array([[1.8, 20.1], [21.1, 24.7], [16.1, 2.7]])
STRAIGHT = np.array([[1.5, 7.5], [20.5, 7.5], [12.1, 26.3]])
OBTUSE = np.array([[2.1, 2.7], [6.5, 22.1], [21.1, 26.9]])


def main(folder: Path = FIGURES) -> None:
    """Write all figures into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    figures = {
        "figure-3.1.png": figure_3_1,
        "figure-3.2.png": figure_3_2,
        "figure-3.3.png": figure_3_3,
        "figure-3.4.png": figure_3_4,
        "figure-3.5.png": figure_3_5,
        "raised-pixel.png": raised_pixel,
        "same-sides.png": same_sides,
    }
    style: Any = {"font.size": 9, "axes.titlesize": 9, "axes.edgecolor": "#999999"}
    for name, draw in figures.items():
        with plt.rc_context(style):
            figure = draw()
            figure.savefig(folder / name, dpi=100, metadata={"Software": None})
            plt.close(figure)


# ---- one figure each


def figure_3_1() -> Figure:
    """The priorities of the edge tracer, and its steps by the turn that they make."""
    figure, (rule, way) = plt.subplots(
        1, 2, figsize=(9, 3.9), width_ratios=(1, 2.7), layout="constrained"
    )
    paint(rule, np.ones((3, 3), bool), {EDGE: [Point(1, 1)]})
    rule.set_title("where the next step may lead")
    rule.annotate(
        "", (1, 1.25), (1, 2.2), arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 1.5}
    )
    for number, (name, direction) in enumerate((("left", 3), ("up", 0), ("right", 1), ("down", 2))):
        down, right = MOVES[direction]
        rule.text(
            1 + 0.98 * right + (0.12 if name == "down" else 0),
            1 + 0.98 * down,
            f"{number + 1}\n{name}",
            color=TURNS[number],
            ha="left" if name == "down" else "center",
            va="center",
            weight="bold",
        )

    mask = raster(ACUTE, (24, 30))
    (steps,) = trace_edges(mask)
    points = key_points(steps)
    paint(way, mask, {EDGE: visited(steps), KEY: points})
    headings = [1, *(step.direction for step in steps[:-1])]
    for number, turn in enumerate((3, 0, 1, 2)):
        chosen = [
            step
            for step, heading in zip(steps, headings, strict=True)
            if (step.direction - heading) % 4 == turn
        ]
        arrows(way, chosen, TURNS[number])
    way.set_title("the steps round an acute triangle, and its key points")
    return figure


def figure_3_2() -> Figure:
    """A side that is entirely straight: the reversal is the special key point."""
    figure, axes = plt.subplots(figsize=(6.4, 5), layout="constrained")
    mask = raster(STRAIGHT, (24, 30))
    (steps,) = trace_edges(mask)
    points = key_points(steps, REVERSAL)
    turned = [
        Point(step.row, step.col)
        for before, step in zip([steps[-1], *steps], steps, strict=False)
        if (step.direction - before.direction) % 4 == 2
    ]
    paint(axes, mask, {EDGE: visited(steps), KEY: points, SPECIAL: turned})
    arrows(axes, steps, INK)
    axes.set_title("a straight side; yellow: the tracer reverses its direction")
    return figure


def figure_3_3() -> Figure:
    """An obtuse triangle: two sides with the same two directions."""
    figure, axes = plt.subplots(figsize=(6.4, 5), layout="constrained")
    mask = raster(OBTUSE, (24, 30))
    (steps,) = trace_edges(mask)
    points = key_points(steps)
    paint(axes, mask, {EDGE: visited(steps), KEY: points})
    arrows(axes, steps, INK)
    without = set(key_points(steps, REVERSAL))
    axes.set_title("an obtuse triangle; circled: found by the lengths of the runs")
    for point in set(points) - without:
        axes.plot(point.col, point.row, "o", ms=20, mfc="none", mec=KEY, mew=1.5)
    return figure


def figure_3_4() -> Figure:
    """Two objects: the way of the scan tracer, and where the edge tracer takes over."""
    figure, axes = plt.subplots(figsize=(8, 6.4), layout="constrained")
    _, mask = random_triangles(np.random.default_rng(8), 2, (20, 24), (30, 40))
    traces = trace_edges(mask)
    paint(axes, mask, {EDGE: [point for steps in traces for point in visited(steps)]})
    for steps in traces:
        arrows(axes, steps, KEY)
        axes.plot(steps[0].col, steps[0].row, "o", ms=9, mfc="none", mec=INK, mew=1.2)
    for row in range(len(mask)):  # the scan stops only at the first pixel of each object
        axes.annotate(
            "",
            (mask.shape[1] - 0.6, row),
            (-0.4, row),
            arrowprops={"arrowstyle": "->", "color": INK, "lw": 0.5, "alpha": 0.6},
        )
    axes.set_title("scan tracer (black), edge tracer (red), marked pixels (grey); circles: starts")
    return figure


def figure_3_5() -> Figure:
    """Draw the key points that asm/keypoints.s finds in random triangles and in the photograph."""
    rng = np.random.default_rng(35)
    masks = [raster(random_triangle(rng, "acute")) for _ in range(2)]
    masks += [raster(random_triangle(rng, "obtuse")) for _ in range(2)]
    masks += [random_triangles(rng, count)[1] for count in (2, 3)]
    frames = np.where(np.array(masks), 200, 30).astype(np.uint8)
    photo = np.load(ROOT / "examples" / "clips" / "shapes_photo.npy")
    figure, axes = plt.subplots(2, 4, figsize=(11, 4.9), layout="constrained")
    left, right = axes[:, :3], axes[:, 3]
    show_run(left.ravel(), frames, 128)
    show_run(right, photo, 190)
    figure.suptitle("asm/keypoints.s on the emulated chip: edges grey, key points white")
    return figure


def show_run(axes: Iterable[Axes], frames: NDArray[np.uint8], threshold: int) -> None:
    """Draw what the chip sends for each frame."""
    program = assemble(ROOT / "asm" / "keypoints.s", defines={"THRESHOLD": threshold})
    result = Chip(program).run(frames)
    for index, axis in enumerate(axes):
        sent = np.array(result.outputs["points"][index]).reshape(-1, 2)
        steps = trace_edges(object_mask(frames[index], threshold))
        picture = np.zeros((*frames[index].shape, 3))
        picture[:] = (frames[index] / 255 * 0.35)[:, :, np.newaxis]
        for trace in steps:
            for row, col in visited(trace):
                picture[row, col] = 0.65
        axis.imshow(picture)
        axis.plot(sent[:, 1], sent[:, 0], "s", ms=5, mfc="white", mec="#ff3b30", mew=1.2)
        counts = ", ".join(str(count) for count in result.outputs["count"][index])
        axis.set_title(f"{counts} key points; {result.frame_cycles[index]:,} cycles")
        axis.set_xticks([])
        axis.set_yticks([])


def raised_pixel() -> Figure:
    """A pixel on an edge, below and above the threshold (3.3.4)."""
    frame = raised_frame()
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    for axes, threshold in zip(panels, (100, 160), strict=True):
        show_run([axes], frame[np.newaxis], threshold)
        axes.set(xlim=(20, 65), ylim=(44, 14))
        axes.set_title(f"THRESHOLD {threshold}: {axes.get_title().partition(';')[0]}")
    return figure


def same_sides() -> Figure:
    """Polygons that a comparison of side lengths takes for one (3.3.3)."""
    square = np.array([[0.0, 0], [0, 30], [30, 30], [30, 0]])
    rng = np.random.default_rng(11)
    figure, panels = plt.subplots(3, 4, figsize=(8.4, 6.2), layout="constrained")
    for row, corners in zip(panels, (4, 5, 6), strict=True):
        shapes = [square] if corners == 4 else [random_convex_polygon(rng, corners)]
        while len(shapes) < 4:
            bent = hinged(rng, shapes[0])
            if bent is not None:
                shapes.append(bent)
        first = scaled(side_lengths(shapes[0].round().astype(int).tolist(), "exact"))
        for axes, shape in zip(row, shapes, strict=True):
            placed = shape - (shape.min(axis=0) + shape.max(axis=0)) / 2
            rows, cols = np.append(placed, placed[:1], axis=0).T
            axes.fill(cols, rows, fc=OBJECT, ec=EDGE)
            axes.plot(cols, rows, "o", color=KEY, ms=5)
            lists = scaled(side_lengths(shape.round().astype(int).tolist(), "exact"))
            axes.set_title(f"difference {distance(first, lists)} of {UNIT}")
            axes.set(xlim=(-34, 34), ylim=(32, -32), aspect="equal")
            axes.axis("off")
    return figure


# ---- pixels and arrows


def paint(axes: Axes, mask: Mask, colors: dict[str, Sequence[Point]]) -> None:
    """Draw the pixels of an object, some of them in colors of their own."""
    picture = np.empty((*mask.shape, 3))
    picture[:] = to_rgb(PAPER)
    picture[mask] = to_rgb(OBJECT)
    for color, points in colors.items():
        for row, col in points:
            picture[row, col] = to_rgb(color)
    axes.imshow(picture)
    rows, cols = mask.shape
    axes.set_xticks(np.arange(cols + 1) - 0.5, labels=[])
    axes.set_yticks(np.arange(rows + 1) - 0.5, labels=[])
    axes.grid(color=FAINT, lw=0.6)
    axes.tick_params(length=0)


def arrows(axes: Axes, steps: Sequence[Step], color: str) -> None:
    """Draw steps; ways there and back lie side by side."""
    if not steps:
        return
    rows, cols, directions = np.array(steps).T
    down, right = np.array(MOVES)[directions].T
    axes.quiver(
        cols - 0.16 * down,
        rows + 0.16 * right,
        0.82 * right,
        0.82 * down,
        angles="xy",
        scale_units="xy",
        scale=1,
        color=color,
        units="xy",
        width=0.11,
        headwidth=4.5,
        headlength=5,
        headaxislength=4.5,
        zorder=3,
    )


def visited(steps: Sequence[Step]) -> list[Point]:
    """Return the pixels of a trace."""
    return [Point(step.row, step.col) for step in steps]


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
