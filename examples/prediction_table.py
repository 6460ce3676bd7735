"""Write docs/prediction.md: trajectory programs on the emulated chip, and the simulation.

    python -m examples.prediction_table [FILE]

The figures are those of the sweeps ``prediction.yaml`` and ``inflections.yaml``, which run here;
``python -m examples.sweep_figures`` draws them. The same numbers come out on every machine.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from examples.measure import ROOT, spread, swept, table, write_page
from examples.sweeps.predictors import NEVER, PATHS
from npchip import assemble
from npchip.host.vision.motion import MOTIONS, RADIUS
from npchip.host.vision.tracks import PREDICTORS, WARM_UP

if TYPE_CHECKING:
    import pandas as pd

ROBUST = "two-frame baseline"

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
the sweeps [`prediction.yaml`](../examples/sweeps/prediction.yaml) and
[`inflections.yaml`](../examples/sweeps/inflections.yaml), {sets} sets of {paths} random
paths of each motion. Figures are means over the sets ± their standard deviation.

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

![Errors of four predictors on the chip](figures/prediction.svg)

*Means over the sets; the bars are their standard deviation.*

The four columns are `trajectory.s`, `trajectory_nonlinear.s` with `INFLECTION` = {never} (never)
and 3, and `trajectory_robust.s`. `trajectory_mixed.s` is second order in one axis and first order
in the other.

**`trajectory_robust.s` over all motions with |a| ≤ 3 together: {robust8} pixels**
({robust32} with the default `THRESHOLD` of 32, which misses a disc that hardly moves now and
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


def shown(motion: str) -> str:
    """Return the name of a motion with its bars escaped."""
    return motion.replace("|", "\\|")


def errors(where: str, motion: str) -> list[str]:
    """Return the cells of a motion, one for each predictor."""
    return [
        spread(swept("prediction", where=where, motion=motion, predictor=kind)["rms"], 2)
        for kind in PREDICTORS
    ]


def chip_table() -> str:
    """Return the errors measured on the chip."""
    rows = [[shown(motion), *errors("chip", motion)] for motion in MOTIONS]
    return table(["RMS, pixels", *PREDICTORS], rows)


def simulation_table() -> str:
    """Return the errors of the simulation beside those of the prototypes."""
    rows = []
    for motion in MOTIONS:
        known = [f"{value:.2f}" for value in PROTOTYPES.get(motion, ())] or ["–", "–"]
        robust = "0.71–0.84" if motion.startswith(("linear", "|a|")) else "–"
        rows.append([shown(motion), *errors("simulation", motion), *known, robust])
    heads = [f"prototype: {kind}" for kind in ("first", "second", "two-frame baseline")]
    return table(["RMS, pixels", *PREDICTORS, *heads], rows)


def inflection_table() -> str:
    """Return how inflections tell bounces: on the chip, in the simulation, in the prototypes."""
    rows = []
    found = swept("inflections").groupby(["where", "inflection"], sort=False)
    for (where, inflection), sets in found:
        name = "emulated chip" if where == "chip" else where
        percent = [f"{spread(100 * sets[what], 0)} %" for what in ("found", "suppressed")]
        alarms, error = spread(sets["false_alarms"], 2), spread(sets["rms"], 2)
        value = "never" if inflection == NEVER else str(inflection)
        rows.append([name, value, percent[0], alarms, percent[1], error])
    for threshold, text in PROTOTYPE_INFLECTIONS.items():
        rows.append(["prototype", str(threshold or "never"), *text.strip("| ").split(" | ")])
    return table(["", "INFLECTION", "found", "false alarms", "withheld", "RMS, pixels"], rows)


def robust(predictor: str) -> str:
    """Return the error of the robust program over all motions of constant acceleration up to 3."""
    rows = swept("prediction", where="chip", predictor=predictor)
    rows = rows[rows["motion"].str.startswith(("linear", "|a|"))]

    def together(sets: pd.DataFrame) -> float:
        total = (sets["mean_square"] * sets["predictions"]).sum()
        return float(np.sqrt(total / sets["predictions"].sum()))

    return spread([together(sets) for _, sets in rows.groupby("seed")], 2)


def document() -> str:
    """Return the text of docs/prediction.md."""
    return TEXT.format(
        sets=swept("prediction")["seed"].nunique(),
        paths=PATHS,
        radius=RADIUS,
        never=NEVER,
        chip=chip_table(),
        robust8=robust(ROBUST),
        robust32=robust(f"{ROBUST}, default"),
        simulation=simulation_table(),
        inflections=inflection_table(),
        words=len(assemble(ROOT / "asm" / "trajectory_nonlinear.s").words),
    )


if __name__ == "__main__":
    assert WARM_UP == 4  # "from the fifth centre on"
    write_page("prediction.md", document)
