"""Draw sweeps with their spread: prediction, key points, tables 2.1 and 3.1, robustness.

    python -m examples.sweep_figures [FOLDER]       (needs the extra `sweep`)

Runs the sweeps as the scripts of the pages do. Points are means over seeds, bars their standard
deviation.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from examples.drawing import FAINT, save_as_asked
from examples.keypoint_page import RULES
from examples.measure import swept
from examples.robustness_page import AXES, CORNERS, DISTANCE, FOLLOWING, TITLES, Question
from npchip.host.vision.fusion.registry import ALGORITHMS
from npchip.host.vision.motion import MOTIONS
from npchip.host.vision.tracks import PREDICTORS
from npchip.report.chart import COLORS

from matplotlib.figure import Figure  # isort: skip - after the back end is chosen

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd
    from matplotlib.axes import Axes

STYLES: Final = [*zip(COLORS.values(), "osD^v<>", strict=True)]


def points(
    axes: Axes,
    places: Sequence[float],
    samples: Sequence[pd.Series[float]],
    number: int,
    label: str,
    *,
    line: str = "none",
) -> None:
    """Draw means with their standard deviations; marks are empty where colours come again."""
    again, number = divmod(number, len(STYLES))
    color, mark = STYLES[number]
    fill = "white" if again else color
    means = [sample.mean() for sample in samples]
    bars = [np.nan_to_num(sample.std()) for sample in samples]
    axes.errorbar(
        places,
        means,
        bars,
        color=color,
        marker=mark,
        mfc=fill,
        ms=4,
        ls=line,
        lw=1,
        capsize=2,
        label=label,
    )


def finished(axes: Axes, what: str, title: str = "") -> None:
    """Label an axis and lighten the rest."""
    axes.set_ylabel(what)
    axes.set_title(title, loc="left")
    axes.grid(axis="y", color="#EEEEEE")
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(color=FAINT)


def prediction() -> Figure:
    """Errors of four predictors on the emulated chip."""
    figure = Figure(figsize=(7, 3.2), layout="constrained")
    axes = figure.add_subplot()
    for number, predictor in enumerate(PREDICTORS):
        samples = [
            swept("prediction", where="chip", motion=motion, predictor=predictor)["rms"]
            for motion in MOTIONS
        ]
        places = [place + (number - 1.5) * 0.17 for place in range(len(MOTIONS))]
        points(axes, places, samples, number, predictor)
    axes.set_xticks(range(len(MOTIONS)), MOTIONS)
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False)
    finished(axes, "error, pixels rms")
    return figure


def keypoint_rules() -> Figure:
    """Triangles whose corners are found within 3 pixels, by rule."""
    figure = Figure(figsize=(7, 2.8), layout="constrained")
    axes = figure.add_subplot()
    for number, kind in enumerate(("acute", "obtuse")):
        samples = [swept("keypoints", rule=rule, kind=kind)["within_3"] for rule in RULES]
        places = [place + (number - 0.5) * 0.15 for place in range(len(RULES))]
        points(axes, places, samples, number, kind)
    axes.set_xticks(range(len(RULES)), RULES)
    axes.legend(frameon=False)
    finished(axes, "all corners within 3 pixels")
    return figure


def table_2_1() -> Figure:
    """RMS distances of table 2.1: sets of 100 paths, and the thesis's figures."""
    figure = Figure(figsize=(7, 3.4), layout="constrained")
    axes = figure.add_subplot()
    names = list(dict.fromkeys(swept("table-2.1")["algorithm"]))
    for number, (setting, label) in enumerate(
        {"thesis": "fitted to the thesis", "chip": "the chip's own size"}.items()
    ):
        samples = [swept("table-2.1", setting=setting, algorithm=name)["rms"] for name in names]
        places = [place + (number - 0.5) * 0.2 for place in range(len(names))]
        points(axes, places, samples, number, label)
    known = [(place, ALGORITHMS[name].thesis) for place, name in enumerate(names) if name != "line"]
    printed = [(place, thesis[2]) for place, thesis in known if thesis]
    axes.plot(*zip(*printed, strict=True), "k_", ms=14, label="the thesis")
    axes.set_yscale("log")
    axes.set_xticks(range(len(names)), names, rotation=30, ha="right")
    axes.legend(frameon=False)
    finished(axes, "error, metres rms")
    return figure


def table_3_1() -> Figure:
    """Total errors of table 3.1: every training, and their mean."""
    figure = Figure(figsize=(7, 3.6), layout="constrained")
    axes = figure.add_subplot()
    rows = swept("table-3.1", pictures="rendered 100x100")
    names = list(dict.fromkeys(rows["estimator"]))
    samples = [rows[rows["estimator"] == name]["total"] for name in names]
    for place, sample in enumerate(samples):
        axes.plot([place - 0.2] * len(sample), sample, ".", color=FAINT, ms=3)
    points(axes, range(len(names)), samples, 0, "mean")
    axes.set_yscale("log")
    axes.set_xticks(range(len(names)), names, rotation=30, ha="right")
    finished(axes, "total error, mm")
    return figure


def robustness(questions: Sequence[Question], what: str, *, every: bool = False) -> Figure:
    """Programs along noise, pattern and light, with two settings, or with every one; the limit."""
    figure = Figure(figsize=(7.5, 3.2), layout="constrained")
    grid = figure.subplots(1, 3, sharey=True)
    for place, (axes, (machine, title)) in enumerate(zip(grid, TITLES.items(), strict=True), 1):
        axes.axhline(questions[0].limit, color=FAINT, lw=1, ls=":")
        number = 0
        for question in questions:
            settings = dict.fromkeys([question.default, question.best_of_all()])
            for setting in question.settings() if every else settings:
                values = question.values(machine)
                samples = [question.judged(machine, setting, value) for value in values]
                points(axes, values, samples, number, f"{question.name}, {setting}", line="-")
                number += 1
        axes.set_xlabel(title)
        finished(axes, what if place == 1 else "")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    return figure


def misalignment() -> Figure:
    """Errors of algorithms that take a turned camera for a straight one."""
    figure = Figure(figsize=(7.5, 3.2), layout="constrained")
    for place, turned in enumerate(("pan", "tilt", "roll"), 1):
        axes = figure.add_subplot(1, 3, place)
        for number, name in enumerate(dict.fromkeys(swept("misalignment")["algorithm"])):
            rows = swept("misalignment", algorithm=name, turned=turned).groupby("degrees")["rms"]
            angles, samples = zip(*rows, strict=True)
            points(axes, angles, samples, number, name, line="-")
        axes.set_ylim(0.01, 0.5)
        axes.set_yscale("log")
        axes.set_xlabel(f"{turned}, degrees")
        finished(axes, "error, metres rms" if place == 1 else "")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=6, frameon=False)
    return figure


DRAWN: Final[dict[str, Callable[[], Figure]]] = {
    "prediction": prediction,
    "keypoint-rules": keypoint_rules,
    "table-2.1": table_2_1,
    "table-3.1": table_3_1,
    "robustness-following": partial(robustness, FOLLOWING, "error, pixels rms"),
    "robustness-corners": partial(robustness, CORNERS, "corners found"),
    "robustness-distances": partial(robustness, [DISTANCE], "error, mm rms", every=True),
    "robustness-misalignment": misalignment,
}

if __name__ == "__main__":
    assert AXES.keys() == TITLES.keys()
    save_as_asked(DRAWN)
