"""Figures 3.8, 3.9 and 3.12 to 3.17 of the thesis, and the effect of wrong angles."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from npchip.host.vision.orientation.dataset import DataSet
from npchip.host.vision.orientation.experiment import least_squares
from npchip.host.vision.orientation.models import (
    Estimator,
    rms,
    side_lengths,
    train_model,
)
from npchip.host.vision.orientation.network import Split, split
from npchip.host.vision.orientation.pictures import render
from npchip.host.vision.orientation.scene import (
    Floats,
    position_of,
    spherical,
    yaw_and_pitch,
)
from npchip.report.figure import INK, write

_STYLE: Final[Any] = {"font.size": 9, "axes.titlesize": 9, "axes.edgecolor": "#999999"}
_BLUE, _RED, _YELLOW = "#0072B2", "#D55E00", "#E69F00"
_SHOWN: Final = 100
"""Number of test samples in the curves; the errors in the titles are those of all samples."""

_DISTANCE: Final = 1_500.0
"""Radial distance of the cameras in 3.8, 3.9 and 3.14, in mm; the thesis gives none."""

_PITCHES: Final = {"3.8": -67.0, "3.9": -48.0, "3.14": -54.0}
_COMPARED: Final = {
    "3.13": ("sides", "side lengths in random order"),
    "3.15": ("vertices", "vertices"),
    "3.16": ("spherical", "spherical"),
    "3.17": ("hybrid", "hybrid: radial distance from the network, angles known"),
}


def file_name(name: str) -> str:
    """Return the usual file name of a figure: plots are SVG, pictures PNG."""
    if name in _PITCHES:
        return f"figure-{name}.png"
    return "sensitivity.svg" if name == "sensitivity" else f"figure-{name}.svg"


def draw(name: str, path: Path, data: DataSet | None, seed: int = 0) -> None:
    """Draw one figure and write it.

    Args:
        name: number of the figure, or ``sensitivity``.
        path: a file name that ends in ``.png`` or ``.svg``.
        data: training data, if the figure shows networks.
        seed: seed of the training.

    Raises:
        InputError: NP250, `path` cannot be written.
    """
    write(lambda: _figure(name, data, seed), path, style=_STYLE, dpi=100, Software=None)


def _figure(name: str, data: DataSet | None, seed: int) -> Figure:
    if name in _PITCHES:
        return _pictures(_PITCHES[name], highlight=name == "3.14")
    assert data is not None
    if name == "3.12":
        return _regression(data, seed)
    if name == "sensitivity":
        return _sensitivity(data, seed)
    return _comparison(data, seed, *_COMPARED[name])


def _pictures(pitch: float, *, highlight: bool) -> Figure:
    yaws = (45, 135) if highlight else (45, 135, 225, 315)
    positions = np.array([position_of(yaw, pitch, _DISTANCE) for yaw in yaws])
    figure = Figure(figsize=(2.6 * len(yaws), 3), layout="constrained")
    panels = figure.subplots(1, len(yaws))
    for axes, yaw, picture in zip(
        panels, yaws, render(positions, highlight=highlight), strict=True
    ):
        axes.imshow(picture, cmap="gray", vmin=0, vmax=255)
        axes.set(xticks=(0, 50, 99), yticks=(0, 50, 99), title=f"pitch {pitch:g}°, yaw {yaw}°")
    return figure


@lru_cache(maxsize=8)
def _trained(model: str, data: DataSet, seed: int) -> tuple[Estimator, Split]:
    parts = split(len(data), seed)
    return train_model(model, data, parts, seed=seed), parts


def _tested(model: str, data: DataSet, seed: int) -> tuple[Floats, Floats]:
    """Return true and estimated positions of the test set."""
    estimator, parts = _trained(model, data, seed)
    true, seen = data.positions[parts.test], data.vertices[parts.test]
    return true, estimator(seen, yaw_and_pitch(true))


def _regression(data: DataSet, seed: int) -> Figure:
    """Draw 3.12: outputs against targets."""
    true, found = _tested("sides", data, seed)
    figure = Figure(figsize=(9, 3.4), layout="constrained")
    for axes, name, target, output in zip(
        figure.subplots(1, 3), "xyz", true.T, found.T, strict=True
    ):
        low, high = target.min(), target.max()
        slope, offset = np.polyfit(target, output, 1)
        axes.plot(target, output, "o", ms=3, mfc="none", mec=INK, mew=0.6)
        axes.plot([low, high], [low, high], ":", color=INK, lw=1, label="output = target")
        ends = np.array([low, high])
        axes.plot(ends, slope * ends + offset, color=_BLUE, lw=1.5, label="fit")
        correlation = np.corrcoef(target, output)[0, 1]
        axes.set(xlabel=f"target {name}, mm", ylabel="output, mm", title=f"R = {correlation:.2f}")
        axes.legend(frameon=False)
    figure.suptitle(f"side lengths in random order: {_rms_text(found - true)}")
    return figure


def _comparison(data: DataSet, seed: int, model: str, title: str) -> Figure:
    """Draw 3.13 or 3.15 to 3.17: targets, outputs and errors of some test samples."""
    true, found = _tested(model, data, seed)
    names: Sequence[str] = ("x, mm", "y, mm", "z, mm")
    text = _rms_text(found - true)
    if model == "spherical":
        estimator, parts = _trained(model, data, seed)
        true = spherical(data.positions[parts.test])
        found = estimator.network(side_lengths(data.vertices[parts.test]))
        true, found = (values * (1, 180 / np.pi, 180 / np.pi) for values in (true, found))
        names = ("radial distance, mm", "polar angle, degrees", "azimuth, degrees")
        radial, polar, azimuth = rms(found - true)
        text = f"RMS {radial:.0f} mm, {polar:.1f}°, {azimuth:.0f}°"
    figure = Figure(figsize=(9, 6), layout="constrained")
    for axes, name, target, output in zip(
        figure.subplots(3, 1, sharex=True), names, true.T, found.T, strict=True
    ):
        _curves(axes, target[:_SHOWN], output[:_SHOWN])
        axes.set_ylabel(name)
    axes.set_xlabel(f"the first {_SHOWN} of {len(true)} test samples")
    figure.axes[0].legend(loc="upper center", bbox_to_anchor=(0.5, 1.3), ncols=3, frameon=False)
    figure.suptitle(f"{title}: {text}")
    return figure


def _curves(axes: Axes, target: Floats, output: Floats) -> None:
    axes.plot(target, color=_BLUE, lw=1, label="target")
    axes.plot(output, color=_RED, lw=1, label="output")
    axes.plot(output - target, color=_YELLOW, lw=1, label="error")
    axes.axhline(0, color="#dddddd", lw=0.8, zorder=0)
    axes.margins(x=0.01)


def _sensitivity(data: DataSet, seed: int) -> Figure:
    """Draw the total error of the hybrid model and of least squares with wrong angles."""
    hybrid, parts = _trained("hybrid", data, seed)
    true, seen = data.positions[parts.test], data.vertices[parts.test]
    _, nearest = least_squares(data, parts)
    degrees = np.arange(0, 5.01, 0.5)
    noise = np.random.default_rng((seed, 3)).normal(size=(len(true), 2))
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.subplots()
    for name, estimate, color in (
        ("hybrid network", hybrid, _BLUE),
        ("least squares", nearest, _RED),
    ):
        for which, weights, style in (
            ("compass", (1, 0), "-"),
            ("pitch", (0, 1), "--"),
            ("both", (1, 1), ":"),
        ):
            totals = [
                np.linalg.norm(
                    rms(estimate(seen, yaw_and_pitch(true) + size * noise * weights) - true)
                )
                for size in degrees
            ]
            axes.plot(degrees, totals, style, color=color, label=f"{name}, {which}")
    axes.set(
        xlabel="standard deviation of the angle's error, degrees",
        ylabel="total RMS error, mm",
        xlim=(0, 5),
    )
    axes.set_ylim(bottom=0)
    axes.grid(color="#eeeeee")
    axes.legend(frameon=False)
    return figure


def _rms_text(errors: Floats) -> str:
    x, y, z = rms(errors)
    return f"RMS {x:.0f}, {y:.0f}, {z:.0f} mm along x, y, z"
