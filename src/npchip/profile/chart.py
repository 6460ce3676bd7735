"""A profile as a picture: cycles by label and task, and of every frame. Needs Matplotlib."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from npchip.profile.tasks import sum_by_task
from npchip.profile.text import percent
from npchip.report.chart import COLORS
from npchip.report.figure import FAINT, INK, bars, beside, write

if TYPE_CHECKING:
    from npchip.profile.model import Profile

_MOST_BARS: Final = 20
_OTHERS: Final = "other labels"


def draw(profile: Profile, path: Path) -> None:
    """Draw a profile and write the picture.

    Args:
        profile: the profile.
        path: a file name that ends in ``.png`` or ``.svg``.

    Raises:
        InputError: NP250, `path` cannot be written.
    """
    write(lambda: _figure(profile), path)


def _figure(profile: Profile) -> Figure:
    by_label = _bars(profile)
    several = profile.frames is not None and profile.frames.count > 1
    heights = [1.2 + 0.32 * len(by_label), 2.0] if several else [1.2 + 0.32 * len(by_label)]
    figure = Figure(figsize=(8, sum(heights) + 0.4), layout="constrained")
    grid = figure.add_gridspec(len(heights), 1, height_ratios=heights)
    _labels(profile, by_label, figure.add_subplot(grid[0]))
    if several:
        _frames(profile, figure.add_subplot(grid[1]))
    figure.legend(loc="outside upper center", ncols=7, frameon=False, handlelength=1)
    return figure


def _bars(profile: Profile) -> dict[str, dict[str, int]]:
    """Return the cycles by task of each label, in program order; small labels are one bar."""
    by_label: dict[str, dict[str, int]] = {}
    for label in profile.labels:
        words = profile.words[label.address : label.address + label.words]
        tasks = sum_by_task((profile.decoded[word.address], word.cycles) for word in words)
        if any(tasks.values()):
            by_label[label.name] = tasks
    largest = sorted(by_label, key=lambda name: -sum(by_label[name].values()))[:_MOST_BARS]
    bars = {name: tasks for name, tasks in by_label.items() if name in largest}
    rest: Counter[str] = Counter()
    for name in by_label.keys() - bars.keys():
        rest.update(by_label[name])
    return bars | ({_OTHERS: rest} if rest else {})


def _labels(profile: Profile, by_label: dict[str, dict[str, int]], axes: Axes) -> None:
    places = range(len(by_label))
    ends = np.zeros(len(by_label))
    for task, color in COLORS.items():
        widths = np.array([tasks.get(task, 0) for tasks in by_label.values()], float)
        if widths.any():
            axes.barh(places, widths, left=ends, height=0.68, label=task, color=color, zorder=2)
            ends += widths
    for place, end in zip(places, ends.tolist(), strict=True):
        beside(axes, place, end, percent(profile.share(int(end))), fontsize=9)
    result = profile.result
    title = f"{result.program}, machine {result.machine}: {profile.cycles:,} cycles"
    bars(axes, list(by_label), ends.tolist(), 1.1, title)
    axes.set_xlabel("cycles of the whole run")


def _frames(profile: Profile, axes: Axes) -> None:
    assert profile.frames is not None
    result = profile.result
    cycles = result.complete_cycles
    numbers = result.first_frame + np.arange(len(cycles))
    axes.plot(numbers, cycles, color=INK, linewidth=1, drawstyle="steps-mid", zorder=2)
    axes.axhline(profile.frames.median, color=FAINT, linewidth=1, linestyle="--", zorder=1)
    axes.set_ylim(0, 1.1 * profile.frames.most or 1)
    axes.annotate(
        "median",
        (1, profile.frames.median),
        xycoords=("axes fraction", "data"),
        xytext=(0, 3),
        textcoords="offset points",
        ha="right",
        color="#888888",
        fontsize=8,
    )
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel("frame")
    axes.set_ylabel("cycles")
    axes.yaxis.set_major_formatter("{x:,.0f}")
    axes.spines[["top", "right"]].set_visible(False)
