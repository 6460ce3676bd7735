"""A chart of positions in space and the two cameras. Needs Matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np
from matplotlib.figure import Figure

from npchip.report.figure import INK, write

if TYPE_CHECKING:
    from pathlib import Path

    from npchip.host.vision.fusion import Camera, Positions, Rig

_CAMERAS: Final = ("#0072B2", "#D55E00")  # by Okabe and Ito, distinct for any colour vision
_FAINT: Final = "#BBBBBB"
_MARGIN: Final = 0.08
"""Free space on each side, relative to the widest extent."""


def draw(rig: Rig, positions: Positions, path: Path) -> None:
    """Draw the path with its shadow on the floor, and the cameras with their views.

    Args:
        rig: the cameras.
        positions: positions of T frames; lines join the valid ones of successive frames.
        path: a file name that ends in ``.png`` or ``.svg``.

    Raises:
        InputError: NP250, `path` cannot be written.
    """
    write(lambda: _figure(rig, positions), path)


def _figure(rig: Rig, positions: Positions) -> Figure:
    figure = Figure(figsize=(7, 6), layout="constrained")
    axes: Any = figure.add_subplot(projection="3d")
    valid = positions.valid
    points = np.where(valid[:, None], positions.points, np.nan)  # gaps in the line
    cameras = (rig.camera1, rig.camera2)
    low, high = _limits(np.concatenate([points, [c.position for c in cameras]]))
    axes.plot(*points.T, color=INK, linewidth=0.8)
    axes.plot(points[:, 0], points[:, 1], low[2], color=_FAINT, linewidth=0.8)
    dots = axes.scatter(*points[valid].T, c=np.flatnonzero(valid), cmap="viridis", s=14)
    reach = 0.25 * float((high - low).max())
    for number, (camera, colour) in enumerate(zip(cameras, _CAMERAS, strict=True), 1):
        _camera(axes, camera, f"camera {number}", colour, reach)
    for name, first, last in zip("xyz", low, high, strict=True):
        getattr(axes, f"set_{name}lim")(first, last)
        getattr(axes, f"set_{name}label")(f"{name}, m", labelpad=8)
    axes.set_box_aspect(tuple(high - low))
    if valid.any():
        figure.colorbar(dots, ax=axes, label="frame", shrink=0.6, pad=0.1)
    axes.legend(loc="upper left", frameon=False)
    axes.set_title(f"{int(valid.sum())} positions in {len(valid)} frames", color=INK, fontsize=10)
    return figure


def _limits(points: Any) -> tuple[Any, Any]:
    """Return corners of a box around all points; each side is at least half of the longest."""
    low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
    widest = float((high - low).max()) or 1.0
    short = np.maximum(0, widest / 2 - (high - low)) / 2
    return low - short - _MARGIN * widest, high + short + _MARGIN * widest


def _camera(axes: Any, camera: Camera, name: str, colour: str, reach: float) -> None:
    """Draw a camera and the edges of its view, `reach` metres long."""
    place = np.array(camera.position)
    corners = [(-0.5, -0.5), (-0.5, camera.cols - 0.5)]
    corners += [(camera.rows - 0.5, col) for _, col in reversed(corners)]
    ends = camera.point(np.array(corners), np.full(4, reach))
    axes.scatter(*place, color=colour, s=40, marker="s", label=name, depthshade=False)
    for end in ends:
        axes.plot(*np.stack([place, end]).T, color=colour, linewidth=0.7)
    axes.plot(*np.concatenate([ends, ends[:1]]).T, color=colour, linewidth=0.7)
