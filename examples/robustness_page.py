"""Write docs/robustness.md: how far programs and cameras hold, from the sweeps in examples/sweeps.

    python -m examples.robustness_page [FILE]

Runs ``following.yaml``, ``followed.yaml``, ``corners.yaml``, ``distances.yaml`` and
``misalignment.yaml``, which take some minutes; ``python -m examples.sweep_figures`` draws them. The
same figures come out everywhere.
"""

from __future__ import annotations

from itertools import takewhile
from textwrap import fill
from typing import TYPE_CHECKING, Final, NamedTuple

from examples.measure import spread, swept, table, write_page
from examples.sweeps.robustness import BACKGROUND, CONTRAST, PATHS, POSES, TRIANGLES

if TYPE_CHECKING:
    import pandas as pd

AXES: Final = {"noise": "noise_rms", "pattern": "fixed_pattern", "light": "light"}
"""Columns of the axes, by the names of the machines that have them."""
TITLES: Final = {"noise": "noise, LSB rms", "pattern": "fixed pattern, LSB", "light": "light ×"}


class Question(NamedTuple):
    """A question about a program: up to which disturbance does it work?

    Attributes:
        sweep: the sweep.
        column: the column that is judged.
        limit: it holds up to this value, or from this value on.
        rising: whether more is better.
        threshold: the column of its setting.
        digits: digits behind the point.
        default: the program's own setting.
        program: the program; "" where the sweep has only one.
    """

    sweep: str
    column: str
    limit: float
    rising: bool
    threshold: str
    digits: int
    default: int
    program: str = ""

    @property
    def name(self) -> str:
        """The program's name."""
        return self.program or "orientation"

    def rows(self, machine: str) -> pd.DataFrame:
        """Return the runs along an axis."""
        found = swept(self.sweep, machine=machine)
        return found[found["program"] == self.program] if self.program else found

    def settings(self) -> list[int]:
        """Return the thresholds."""
        return list(dict.fromkeys(self.rows("noise")[self.threshold].tolist()))

    def values(self, machine: str) -> list[float]:
        """Return the values along an axis."""
        return list(dict.fromkeys(self.rows(machine)[AXES[machine]].tolist()))

    def judged(self, machine: str, setting: int, value: float) -> pd.Series[float]:
        """Return what is judged, for every seed."""
        rows = self.rows(machine)
        rows = rows[(rows[self.threshold] == setting) & (rows[AXES[machine]] == value)]
        found: pd.Series[float] = rows[self.column]
        return found

    def holds(self, machine: str, setting: int, value: float) -> bool:
        """Return whether it holds with every seed; what is not found at all does not."""
        found = self.judged(machine, setting, value)
        good = found >= self.limit if self.rising else found <= self.limit
        return bool(good.all())

    def held(self, setting: int, machine: str) -> list[float]:
        """Return the values along an axis at which a setting holds."""
        return [v for v in self.values(machine) if self.holds(machine, setting, v)]

    def best(self, machine: str) -> int:
        """Return the setting that holds at most values; of several the one with the best mean."""

        def key(setting: int) -> tuple[int, float]:
            held = self.held(setting, machine)
            means = [self.judged(machine, setting, value).mean() for value in held]
            mean = sum(means) / max(1, len(means))
            return len(held), mean if self.rising else -mean

        return max(self.settings(), key=key)

    def best_of_all(self) -> int:
        """Return the setting that holds at most values of all axes."""
        return max(
            self.settings(), key=lambda setting: sum(len(self.held(setting, m)) for m in AXES)
        )


FOLLOWING: Final = (
    Question("following", "error_rms", 2, False, "THRESHOLD", 1, 128, "tracking"),
    Question("following", "error_rms_ahead_1", 2, False, "THRESHOLD", 1, 32, "trajectory"),
    Question("following", "error_rms_ahead_1", 2, False, "THRESHOLD", 1, 32, "trajectory_robust"),
    Question("followed", "rms", 2, False, "threshold", 1, 24, "follow"),
    Question("followed", "rms", 2, False, "threshold", 1, 24, "follow_many"),
)
CORNERS: Final = (
    Question("corners", "within_3", 0.9, True, "threshold", 2, 128, "keypoints"),
    Question("corners", "within_3", 0.9, True, "threshold", 2, 128, "keypoints_farthest"),
)
DISTANCE: Final = Question("distances", "rms", 400, False, "threshold", 0, 44)
QUESTIONS: Final = (*FOLLOWING, *CORNERS, DISTANCE)

TEXT = """\
# Robustness: noise, light and misalignment

See what noise, a fixed pattern, another light and a camera that looks past its mark do to the
programs, and which setting holds longest. `python -m examples.robustness_page` runs the sweeps in
[`examples/sweeps`](../examples/sweeps) and writes this page; each table is also one command:

```text
npchip sweep examples/sweeps/following.yaml
npchip sweep examples/sweeps/followed.yaml
npchip sweep examples/sweeps/corners.yaml
npchip sweep examples/sweeps/distances.yaml
npchip sweep examples/sweeps/misalignment.yaml
```

Noise, pattern and light are those of the [sensor](machine.md#the-sensor): σ is the noise of one
conversion, so the difference of two has √2 times as much. Along the axes *pattern* and *light*, σ
is 2. Figures are means over {seeds} seeds ± their standard deviation; a seed is another chip. A
setting *holds* where every seed stays within the limit, and is bold there. All limits and scenes
are decisions.

## In short

{summary}

{advice}

## Following a ball

A disc of radius 5 and brightness 170 on 20 goes round in 90 frames, two rounds. The error is the
distance from the true centre, in pixels, RMS: that of the centre for `tracking.s`, that of the
prediction of the next frame for the others. The limit is 2 pixels; "–" is a ball that was never
found.

![Errors of the programs that follow](figures/robustness-following.svg)

*Each program with its own threshold and with the one that holds longest. The dotted line is the
limit; where nothing is found there is no point.*

{following}

A program that breaks does so all at once: where the noise of one pixel in 5,120 reaches the
threshold, the box of what moves is the whole frame, and its centre is the frame's, 20 pixels from
the ball. The fixed pattern does nothing that double sampling does not take away, until a threshold
is so low that noise clipped at 0 matters. Less light is less contrast: a threshold above it finds
nothing. `follow.s` and `follow_many.s` drop pixels that stand alone and look for the object where
it is expected, so they go on where the others break; [tracking.md](tracking.md) has them on real
video.

## Corners of triangles

Sets of {triangles} random triangles, {bright} on {background}; the part in which all three corners
are found within 3 pixels. The limit is 0.9.

![Triangles whose corners are found](figures/robustness-corners.svg)

{corners}

`keypoints_farthest.s` takes all pixels for one triangle, so one pixel of noise is a corner. It
needs no variant: at {halfway}, a little above halfway between background and object, hardly a pixel
of the background reaches the threshold up to σ 20. Object pixels that fall below it do little harm,
as their neighbours are there. We tried a variant that takes only runs of two or three pixels for
object. It cost 10 words, lost narrow tips (on one set, 8 % of the triangles with runs of two and
43 % with three), and held no longer than a better threshold; so it is not there, and no command
repeats these figures. `keypoints.s` follows the edge, and noise makes the edge ragged: no threshold
holds at σ 15.

## The distance of a drone

`orientation.s` at 64 × 80 pixels, sets of {poses} poses; the RMS error of the distance in mm. The
limit is 400 mm, at distances up to 3.3 m.

![Errors of the distance](figures/robustness-distances.svg)

{distances}

Its `THRESHOLD` of 44 is where the network was trained, with pixels of which 20 % is covered. It is
only 24 above the background, so noise of σ 8 is an object. A higher threshold holds longer and
measures a smaller triangle, thus a longer distance: {bias}

## A camera that looks past its mark

Camera 2 of table 2.1 is turned by up to 2° and the algorithms do not know. *Pan* is about the
vertical, *tilt* about the horizontal across its view, *roll* about its view. RMS distance to the
truth in metres, {paths} paths a seed, {turns} seeds.

![Errors of cameras that are turned](figures/robustness-misalignment.svg)

{misalignment}

**Half a degree of pan costs more than the choice between the exact algorithms**, and at 2° all but
the lookup table are about equally wrong. The algorithms of the thesis hardly mind tilt, as they
take the height from camera 1 alone; *reprojection* believes all four numbers.
"""


def seeds() -> int:
    """Return the number of seeds of the programs' sweeps."""
    return int(swept("following")["sensor.seed"].nunique())


def shown(question: Question, machine: str, setting: int, value: float) -> str:
    """Return a cell; bold where it holds."""
    found = question.judged(machine, setting, value)
    if found.isna().all():
        return "–"
    text = spread(found.dropna(), question.digits).replace(" ± nan", "")
    return f"**{text}**" if question.holds(machine, setting, value) else text


def measured(question: Question) -> str:
    """Return the tables of a program: a row a threshold, a column a value."""
    parts = []
    for machine, title in TITLES.items():
        values = question.values(machine)
        rows = [
            [str(setting), *(shown(question, machine, setting, value) for value in values)]
            for setting in question.settings()
        ]
        head = [f"`{question.name}.s`: {title}", *(f"{value:g}" for value in values)]
        parts.append(table(head, rows, len(values)))
    return "\n\n".join(parts)


def extent(question: Question, setting: int, machine: str) -> str:
    """Return the values at which a setting holds, as ends."""
    values, held = question.values(machine), question.held(setting, machine)
    if not held:
        return "nowhere"
    if machine != "light":  # up to the first value at which it does not hold
        return f"{max(takewhile(held.__contains__, values), default=0):g}"
    assert held == [value for value in values if min(held) <= value <= max(held)]
    return f"{min(held):g}–{max(held):g}"


def summary() -> str:
    """Return for each program how far it holds with its best settings."""
    rows = []
    for question in QUESTIONS:
        cells = [f"{extent(question, question.best(m), m)} (with {question.best(m)})" for m in AXES]
        rows.append([f"`{question.name}.s`", *cells, str(question.best_of_all())])
    head = ["program", "σ up to", "pattern up to", "light", "`THRESHOLD` that holds longest"]
    return table(head, rows)


def advice() -> str:
    """Say what follows from the summary."""
    return fill(
        "The columns name the threshold that holds furthest along that axis alone; the last one"
        " holds at most points of all three. **Put the threshold halfway between background and"
        " object**, or between 0 and its contrast for a program that takes differences. Lower ones"
        " find fainter objects, and noise; with less light it has to come down with the object.",
        100,
    )


def bias() -> str:
    """Say what a threshold costs without noise."""
    means = {each: DISTANCE.judged("noise", each, 0).mean() for each in DISTANCE.settings()}
    parts = [f"{mean:.0f} mm with {setting}" for setting, mean in means.items()]
    return f"without noise {', '.join(parts)}."


def misalignment() -> str:
    """Return the table of cameras that are turned."""
    angles = (0, 0.5, 1, 1.5, 2)
    rows = []
    for algorithm in dict.fromkeys(swept("misalignment")["algorithm"]):
        for turned in ("pan", "tilt", "roll"):
            found = swept("misalignment", algorithm=algorithm, turned=turned)
            cells = [spread(found[found["degrees"] == angle]["rms"], 4) for angle in angles]
            rows.append([algorithm, turned, *(each.replace("0.", ".") for each in cells)])
    return table(["metres", "turned", *(f"{angle:g}°" for angle in angles)], rows, len(angles))


def document() -> str:
    """Return the text of docs/robustness.md."""
    return TEXT.format(
        seeds=seeds(),
        summary=summary(),
        advice=advice(),
        following="\n\n".join(map(measured, FOLLOWING)),
        corners="\n\n".join(map(measured, CORNERS)),
        distances=measured(DISTANCE),
        bias=bias(),
        misalignment=misalignment(),
        triangles=TRIANGLES,
        poses=POSES,
        paths=PATHS,
        turns=swept("misalignment")["seed"].nunique(),
        background=BACKGROUND,
        bright=BACKGROUND + CONTRAST,
        halfway=CORNERS[1].best("noise"),
    )


if __name__ == "__main__":
    write_page("robustness.md", document)
