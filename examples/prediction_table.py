"""Measure the trajectory programs on the emulated chip, and write docs/prediction.md.

    python -m examples.prediction_table [FILE] [--paths N]

A light disc is drawn along random paths (`npchip.host.vision.motion.MOTIONS`), every program
follows it on the emulated chip, and its predictions are compared with what it finds in the next
frame. The same numbers come out on every machine.
"""

from __future__ import annotations

import argparse
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from examples.measure import table
from npchip import Chip, assemble
from npchip.host.vision.motion import MOTIONS, RADIUS, discs
from npchip.host.vision.motion import Path as Motion
from npchip.host.vision.prediction import second_order_predictor
from npchip.host.vision.tracks import (
    WARM_UP,
    InflectionScore,
    Track,
    error_table,
    follow,
    follow_outputs,
    inflection_score,
    rms,
)

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[1]
PATHS, SEED = 200, 1
NEVER = 255  # no motion here changes its acceleration by as much

PROGRAMS = {
    "first order": ("trajectory", {}),
    "second order": ("trajectory_nonlinear", {"INFLECTION": NEVER}),
    "second order, restarted": ("trajectory_nonlinear", {"INFLECTION": 3}),
    "two-frame baseline": ("trajectory_robust", {}),
}

# First and second order of the prototypes. Their geometry was fitted, not stated by the thesis.
PROTOTYPES = {
    "linear": (0.71, 1.30),
    "|a| 0.05–0.3": (0.73, 1.29),
    "|a| = 1": (1.23, 1.28),
    "|a| = 2": (2.12, 1.28),
    "circular": (1.40, 1.36),
    "bouncing": (2.52, 3.34),
}
PROTOTYPE_INFLECTIONS = {None: "| – | – | – | 2.87", 3: "| 97 % | 0.02 | 10 % | 1.82"}
PROTOTYPE_INFLECTIONS[5] = "| 81 % | – | – | –"

TEXT = """\
# Trajectory prediction, measured

Choose a trajectory predictor by its measured error. `python -m examples.prediction_table` runs
{paths} random paths of each motion, seed {seed}.

Equation 2.1 of the thesis, x(k+1) = x(k) + v + 2a, is exact for a constant acceleration. But
centres are whole pixels, and the equation amplifies their rounding by √19, a straight line only by
√5. So it pays from an acceleration of about 1 pixel per frame². Over a baseline of two frames the
same parabola, (15·x(k) – 10·x(k–2) + 3·x(k–4) + 4) >> 3, amplifies the rounding by √334/8 = 2.3,
about as little as the line.

![Displacements v, v + a and v + 2a](figures/figure-2.1.svg)

The error is the distance from the prediction to the next centre, itself a whole pixel, along one
axis. It is the root mean square over all predictions from the fifth centre on; inflections, where
nothing is predicted, do not count. Bouncing counts rows only, as the columns move uniformly. a is
the acceleration in each axis, in pixels per frame².

## On the emulated chip

A light disc of radius {radius:g} moves, and the program sees only the frames. Its centre is
that of the box of all pixels that change, so it lies midway between the disc's last and present
positions. Both edges of the box are whole pixels, and their mean is rounded again. `THRESHOLD` is 8
here, low enough for the ideal sensor to notice a disc that hardly moves.

{chip}

The four columns are `trajectory.s`, `trajectory_nonlinear.s` with `INFLECTION` = {never} (never)
and 3, and `trajectory_robust.s`. `trajectory_mixed.s` is second order in one axis and first order
in the other.

**`trajectory_robust.s` over all motions with |a| ≤ 3 together: {robust8:.2f} pixels**
({robust32:.2f} with the default `THRESHOLD` of 32, which misses a disc that hardly moves now and
then). It is the worst of all at a bounce, since its baseline spans it. The rows for whole
accelerations scatter around the row for any acceleration from 0 to 3; we did not look for the
reason.

## In the simulation (thesis 2.1.3)

These are the same paths with true centres rounded to pixels, as the thesis simulates them, computed
by `npchip.host.vision.tracks`, beside the figures of the project's prototypes. *Fitted*: the thesis
states neither speeds nor radii nor gravity, so we chose ranges that bring the figures near.
Agreement shows that the equations and the settings are plausible, not that the settings are the
thesis's.

{simulation}

![Simulation of 2.1.3](figures/figure-2.2.svg)

*Figure 2.2. At an inflection nothing is predicted, and the prediction of its frame, which would lie
below the ground, is a dummy point: as in the thesis neither is shown.*

## Inflections

A change of acceleration of `INFLECTION` or more is an inflection: the program withholds the
prediction and starts the calculation again. *Found* counts bounces (from the fifth centre on) with
an inflection in the frames that the bounce changes; *false alarms* are inflections elsewhere, for
each path; *withheld* is the share of all predictions. The error is that of the remaining
predictions in the rows, without those of the frame before an impact. Counting rules are decisions.

{inflections}

On the chip the box spreads a bounce over one more frame, so it looks softer and high thresholds
miss more bounces. The default of 3 gives the smallest error in both; 4 misses a few bounces but
gives hardly any false alarms.

## The thesis's figures on the emulated chip

`python -m examples.trajectory_figures` (with the extra `plot`) and `trajectory_clips.py` draw these
figures. The thesis prints no numbers with them; paths and lights are decisions. Green: past path,
red: predicted.

Figure 2.3, `trajectory.s`: straight, straight and slanting, a turn.

![Figure 2.3](figures/figure-2.3.svg)

Figure 2.4, `trajectory_mixed.s`: along the columns the light gets faster, slower, and turns back.

![Figure 2.4](figures/figure-2.4.svg)

Figure 2.5, `trajectory_mixed.s` with `AXIS` = 0, `DIRECTION` = 1: accelerated upwards.

![Figure 2.5](figures/figure-2.5.svg)

`trajectory_nonlinear.s` on real clips does in {words} words what the thesis calls difficult in 512.

![A coin slides in](figures/nonlinear-coin_slide.png)
![A mouse runs](figures/nonlinear-mouse_run.png)
"""


@cache
def paths_of(name: str, count: int) -> list[Motion]:
    """Random paths of a motion."""
    rng = np.random.default_rng(SEED)
    return [MOTIONS[name](rng) for _ in range(count)]


@cache
def measured(
    program: str, options: tuple[tuple[str, int], ...], motion: str, count: int
) -> list[Track]:
    """Run a program on the emulated chip along the paths of a motion."""
    chip = Chip(assemble(ROOT / "asm" / f"{program}.s", defines=dict(options)))
    tracks = []
    for path in paths_of(motion, count):
        chip.reset()
        outputs = chip.run(discs(path)).outputs
        tracks.append(follow_outputs(path, {k: v for k, v in outputs.items() if k != "picture"}))
    return tracks


def chip_errors(kind: str, motion: str, count: int, threshold: int = 8) -> list[np.ndarray]:
    """Errors of all tracks of a motion."""
    program, options = PROGRAMS[kind]
    settings = (("THRESHOLD", threshold), *options.items())
    return [track.errors() for track in measured(program, settings, motion, count)]


def shown(motion: str) -> str:
    """Return the name of a motion with its bars escaped."""
    return motion.replace("|", "\\|")


def chip_table(count: int) -> str:
    """Return the errors measured on the chip."""
    rows = [
        [shown(motion), *(f"{rms(chip_errors(kind, motion, count)):.2f}" for kind in PROGRAMS)]
        for motion in MOTIONS
    ]
    return table(["RMS, pixels", *PROGRAMS], rows)


def simulation_table(count: int) -> str:
    """Return the errors of the simulation beside those of the prototypes."""
    rows = []
    for motion, errors in error_table(count, SEED).items():
        known = [f"{value:.2f}" for value in PROTOTYPES.get(motion, ())] or ["–", "–"]
        robust = "0.71–0.84" if motion.startswith(("linear", "|a|")) else "–"
        rows.append([shown(motion), *(f"{value:.2f}" for value in errors.values()), *known, robust])
    heads = [f"prototype: {kind}" for kind in ("first", "second", "two-frame baseline")]
    return table(["RMS, pixels", *PROGRAMS, *heads], rows)


def inflection_table(count: int) -> str:
    """Return how inflections tell bounces: on the chip, in the simulation, in the prototypes."""

    def cells(score: InflectionScore) -> list[str]:
        percent = [f"{100 * value:.0f} %" for value in (score.found, score.suppressed)]
        return [percent[0], f"{score.false_alarms:.2f}", percent[1], f"{score.rms:.2f}"]

    def chip(threshold: int | None) -> InflectionScore:
        settings = (("THRESHOLD", 8), ("INFLECTION", threshold or NEVER))
        return inflection_score(measured("trajectory_nonlinear", settings, "bouncing", count), 3)

    def simulation(threshold: int | None) -> InflectionScore:
        drawn = paths_of("bouncing", count)
        return inflection_score(
            [follow(path, second_order_predictor(threshold=threshold)) for path in drawn]
        )

    sources: dict[str, Callable[[int | None], InflectionScore]] = {
        "emulated chip": chip,
        "simulation": simulation,
    }
    rows = []
    for name, score in sources.items():
        rows += [[name, str(t or "never"), *cells(score(t))] for t in (None, 3, 4, 5)]
    for threshold, text in PROTOTYPE_INFLECTIONS.items():
        rows.append(["prototype", str(threshold or "never"), *text.strip("| ").split(" | ")])
    return table(["", "INFLECTION", "found", "false alarms", "withheld", "RMS, pixels"], rows)


def robust(count: int, threshold: int) -> float:
    """Error of the robust program over all motions with constant acceleration up to 3."""
    motions = [name for name in MOTIONS if name.startswith(("linear", "|a|"))]
    return rms(
        [e for name in motions for e in chip_errors("two-frame baseline", name, count, threshold)]
    )


def document(count: int = PATHS) -> str:
    """Return the text of docs/prediction.md."""
    return TEXT.format(
        paths=count,
        seed=SEED,
        radius=RADIUS,
        never=NEVER,
        chip=chip_table(count),
        robust8=robust(count, 8),
        robust32=robust(count, 32),
        simulation=simulation_table(count),
        inflections=inflection_table(count),
        words=len(assemble(ROOT / "asm" / "trajectory_nonlinear.s").words),
    )


def main() -> None:
    """Write the document."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("file", nargs="?", type=Path, default=ROOT / "docs" / "prediction.md")
    parser.add_argument("--paths", type=int, default=PATHS)
    arguments = parser.parse_args()
    arguments.file.write_text(document(arguments.paths), encoding="utf-8")


if __name__ == "__main__":
    assert WARM_UP == 4  # "from the fifth centre on"
    main()
