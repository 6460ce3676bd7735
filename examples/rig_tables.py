"""Tables of docs/rig.md: cameras that follow what moves, and cameras that are turned."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
from click.testing import CliRunner

from examples.measure import ROOT, spread, swept, table
from npchip.cli.main import cli
from npchip.frames import open_frames
from npchip.host.rig import watch
from npchip.host.scenes.stereo import read_space_scene
from npchip.host.vision.fusion import load_rig

if TYPE_CHECKING:
    import pandas as pd

RIGS = ROOT / "examples" / "rigs"
RIG = load_rig(RIGS / "chip.yaml")
POINTS = (0, 4, 8, 20)
BLANK = 8
"""Frames before the ball for `follow.s`."""


def following() -> str:
    """Tabulate the errors of both programs, and of their predictions, on the same frames."""
    truth = read_space_scene(RIGS / "ball.yaml").positions()
    clips = [np.stack(list(open_frames(RIGS / f"ball.{n}.gif", 64, 80))) for n in (1, 2)]
    longer = [np.concatenate([np.full((BLANK, *c.shape[1:]), 20, np.uint8), c]) for c in clips]
    rows = []
    for ahead in (1, 4):
        found = {}
        for name, pair, first in (("sighting", clips, 0), ("follow", longer, BLANK)):
            one = watch(RIG, *pair, algorithm="vector", link="host", follow=first > 0, ahead=ahead)
            assert one.predicted is not None
            found[name] = one.positions.points[first:], one.predicted[first:]
        known = np.all(
            [~np.isnan(each[:-ahead]).any(axis=1) for pair in found.values() for each in pair], 0
        )
        for name, (points, predicted) in found.items():
            errors = (
                points[:-ahead] - truth[:-ahead],
                points[:-ahead] - truth[ahead:],
                predicted[:-ahead] - truth[ahead:],
            )
            cells = [f"{np.sqrt((e[known] ** 2).sum(1).mean()):.4f}".lstrip("0") for e in errors]
            rows.append([f"`{name}.s`", f"{ahead}", f"{known.sum()}", *cells])
    head = ["both cameras run", "frames ahead", "frames", "now", "ahead: stays", "predicted"]
    return table(head, rows, 5)


def shown(*arguments: str) -> str:
    """Return the first lines that ``npchip fuse`` prints."""
    done = CliRunner().invoke(cli, ["fuse", *arguments])
    assert done.exit_code == 0, done.output
    return "\n".join(done.stdout.splitlines()[:4])


def turned_cameras() -> str:
    """Tabulate what a turned camera costs, by the number of known points."""
    rows = []
    for algorithm in ("vector", "extra-step", "reprojection"):
        for turned in ("pan", "tilt", "roll"):
            found = swept("calibration", algorithm=algorithm, turned=turned)
            cells = [cell(found, 0, 0)]
            cells += [cell(found, degrees, n) for degrees in (1, 2) for n in POINTS]
            rows.append([algorithm, turned, *cells])
    names = ["as it is", *(f"{points} points" for points in POINTS[1:])]
    head = ["straight", *(f"{degrees}°, {name}" for degrees in (1, 2) for name in names)]
    return table(["metres", "turned", *head], rows, len(head))


def cell(found: pd.DataFrame, degrees: int, points: int) -> str:
    """Return the error of a part of the sweep."""
    part = found[(found["degrees"] == degrees) & (found["points"] == points)]
    return spread(part["rms"], 4).replace("0.", ".")


def calibration_verdict() -> str:
    """Say what calibration makes up for."""

    def mean(degrees: int, points: int) -> float:
        found = swept("calibration", algorithm="vector", turned="pan")
        part = found[(found["degrees"] == degrees) & (found["points"] == points)]
        return float(part["rms"].mean())

    straight = mean(0, 0)
    return fill(
        f"A degree of pan makes the error of the vector method {mean(1, 0) / straight:.1f} times as"
        f" large, two degrees {mean(2, 0) / straight:.1f} times. Calibrated from 8 points it is"
        f" {mean(1, 8) / straight:.2f} and {mean(2, 8) / straight:.2f} times that of cameras that"
        " stand straight.",
        96,
    )
