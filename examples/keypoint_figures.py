"""Figures 3.1 to 3.5 of the thesis: key points of triangles; and those of two other pages.

    python -m examples.keypoint_figures [FOLDER]       (needs the extra `plot`)

3.1 to 3.4 show the tracers of `npchip.host.vision.keypoints` step by step. For 3.5 random triangles
are drawn, and ``asm/keypoints.s`` finds their key points on the emulated chip. The thesis shows its
figures without coordinates: the triangles are ours.
"""

from __future__ import annotations

import pathlib
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from examples.drawing import save_as_asked
from examples.keypoint_page import raised_frame
from npchip import Chip, assemble
from npchip.host.vision.keypoints import REVERSAL, Point, Step, key_points, object_mask, trace_edges
from npchip.host.vision.polygons import (
    Mask,
    hinged,
    random_convex_polygon,
    random_regular_polygon,
    random_triangle,
    random_triangles,
    raster,
)
from npchip.host.vision.shapes import UNIT, distance, scaled, side_lengths
from npchip.host.vision.signs import stop_sign

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

ROOT = pathlib.Path(__file__).parents[1]
PAPER, OBJECT, EDGE, KEY, SPECIAL = "#ffffff", "#dddddd", "#8c8c8c", "#a50f15", "#f2c80f"
INK, FAINT = "#111111", "#e8e8e8"
TURNS = ("#2166ac", "#1a9850", "#e08214", "#762a83")
MOVES = ((-1, 0), (0, 1), (1, 0), (0, -1))

ACUTE = np.array([[1.8, 20.1], [21.1, 24.7], [16.1, 2.7]])
STRAIGHT = np.array([[1.5, 7.5], [20.5, 7.5], [12.1, 26.3]])
OBTUSE = np.array([[2.1, 2.7], [6.5, 22.1], [21.1, 26.9]])


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
    single = [random_triangle(rng, kind) for kind in ("acute", "acute", "obtuse", "obtuse")]
    several = [random_triangles(rng, count) for count in (2, 3)]
    masks = [*map(raster, single), *(mask for _, mask in several)]
    corners = [*single, *(np.concatenate(shapes) for shapes, _ in several)]
    frames = np.where(np.array(masks), 200, 30).astype(np.uint8)
    photo = np.load(ROOT / "examples" / "clips" / "shapes_photo.npy")
    figure, axes = plt.subplots(2, 4, figsize=(11, 5.2), layout="constrained")
    left, right = axes[:, :3], axes[:, 3]
    found = show_run(left.ravel(), frames, 128)
    show_run(right, photo, 190)
    for axis, true, points in zip(left.ravel(), corners, found, strict=True):
        axis.plot(true[:, 1], true[:, 0], "+", color=SPECIAL, ms=9, mew=1.2)
        apart = np.linalg.norm(true[:, None] - points, axis=2).min(axis=1)
        axis.set_title(f"{axis.get_title()}\nat most {apart.max():.1f} pixels from the vertex")
    figure.suptitle(
        "asm/keypoints.s on the emulated chip: edges grey, key points white, true vertices yellow"
    )
    return figure


def show_run(
    axes: Iterable[Axes], frames: NDArray[np.uint8], threshold: int
) -> list[NDArray[np.int64]]:
    """Draw what the chip sends for each frame; return the key points of each, shape (n, 2)."""
    program = assemble(ROOT / "asm" / "keypoints.s", defines={"THRESHOLD": threshold})
    result = Chip(program).run(frames)
    points = []
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
        points.append(sent)
    return points


def raised_pixel() -> Figure:
    """A pixel on an edge, below and above the threshold (3.3.4)."""
    frame = raised_frame()
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    for axes, threshold in zip(panels, (100, 160), strict=True):
        show_run([axes], frame[np.newaxis], threshold)
        axes.set(xlim=(20, 65), ylim=(44, 14))
        axes.set_title(f"THRESHOLD {threshold}: {axes.get_title().partition(';')[0]}")
    return figure


def outlines() -> Figure:
    """Corners that asm/polygons.s finds, on the emulated chip."""
    rng = np.random.default_rng(23)
    ring, square = (
        random_regular_polygon(rng, sides, (size, size)) for sides, size in ((6, 30), (4, 9))
    )
    middle = ring.mean(axis=0)
    square += middle - square.mean(axis=0)
    eight = random_convex_polygon(rng, 8)
    hole = (ring - middle) * 0.65 + middle
    nested = raster(ring) & ~raster(hole) | raster(square)
    signs = [stop_sign(rng, ground) for ground in ("trees", "sky")]
    shown = [
        (
            "a ring with a square in it",
            np.where(nested, 200, 30),
            128,
            0,
            np.vstack([ring, square]),
        ),
        ("a sign before trees", signs[0][0], 90, 0, signs[0][1]),
        ("a sign before the sky", signs[1][0], 128, 1, signs[1][1]),
        ("an octagon", np.where(raster(eight), 200, 30), 128, 0, eight),
    ]
    figure, panels = plt.subplots(2, 2, figsize=(8.4, 7), layout="constrained")
    for axes, (title, frame, threshold, dark, true) in zip(panels.flat, shown, strict=True):
        defines = {"THRESHOLD": threshold, "DARK": dark}
        program = assemble(ROOT / "asm" / "polygons.s", defines=defines)
        result = Chip(program).run(frame[np.newaxis].astype(np.uint8))
        axes.imshow(frame, cmap="gray", vmin=0, vmax=255)
        points = np.reshape(result.value("points", 0), (-1, 2))
        counts, regular = result.value("count", 0), result.value("regular", 0)
        for found in np.split(points, np.cumsum(counts)[:-1]):
            axes.plot(*np.vstack([found, found[:1]]).T[::-1], "-s", color="#ff3b30", ms=4, lw=0.8)
        axes.plot(true[:, 1], true[:, 0], "+", color=SPECIAL, ms=9, mew=1.2)
        axes.set_title(f"{title}\ncorners {counts}, regular {regular}")
        axes.set(xticks=[], yticks=[])
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
            axes.plot(cols, rows, "o", color=KEY, ms=5, clip_on=False)
            lists = scaled(side_lengths(shape.round().astype(int).tolist(), "exact"))
            axes.set_title(f"difference {distance(first, lists)} of {UNIT}")
            axes.set(xlim=(-34, 34), ylim=(32, -32), aspect="equal")
            axes.axis("off")
    return figure


# ---- pixels and arrows


def paint(axes: Axes, mask: Mask, colors: dict[str, Sequence[Point]]) -> None:
    """Draw the pixels of an object, some of them in colors of their own."""
    rows, cols = mask.shape
    axes.set(xlim=(-0.5, cols - 0.5), ylim=(rows - 0.5, -0.5), aspect="equal", facecolor=PAPER)
    for color, points in {OBJECT: np.argwhere(mask).tolist(), **colors}.items():
        if points:
            squares = [
                Path(np.add(Path.unit_rectangle().vertices, (col - 0.5, row - 0.5)), closed=True)
                for row, col in dict.fromkeys(map(tuple, points))
            ]
            every = Path.make_compound_path(*squares)
            axes.add_patch(PathPatch(every, fc=color, lw=0, zorder=0))
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


DRAWN = {
    "figure-3.1": figure_3_1,
    "figure-3.2": figure_3_2,
    "figure-3.3": figure_3_3,
    "figure-3.4": figure_3_4,
    "figure-3.5": figure_3_5,
    "raised-pixel": raised_pixel,
    "same-sides": same_sides,
    "outlines": outlines,
}

if __name__ == "__main__":
    save_as_asked(DRAWN)
