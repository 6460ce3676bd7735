"""Measure the programs that follow objects on clips with true places, and write docs/tracking.md.

    python -m examples.tracking_page [docs/tracking.md]
    python -m examples.tracking_page --clip CLIP.npy TRUTH.json

Figures go into the folder ``figures`` beside the page. The second form prints the table of several
objects for a clip of your own.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from examples.measure import ROOT, table
from examples.score_track import altered
from npchip import Chip, assemble
from npchip.host.scenes import read_scene, render
from npchip.host.vision.truth import (
    Places,
    Score,
    entries_of,
    places_of,
    read_truth,
    score,
    score_many,
)
from npchip.report.picture import render as render_run
from npchip.run.result import RunResult

Frames = NDArray[np.uint8]
Truth = Mapping[str, Mapping[int, Places]]

TEMPLATE: Final = Path(__file__).with_suffix(".md")
CLIPS: Final = ROOT / "examples" / "clips"
CONDITIONS: Final = {
    "as it is": (0, 1.0),
    "noise of 2": (2, 1.0),
    "noise of 5": (5, 1.0),
    "noise of 10": (10, 1.0),
    "light × 0.6": (0, 0.6),
}
"""Noise, rms in LSB, and the factor of the light."""
NEVER: Final = 255
"""No acceleration changes by as much: the second order is never restarted."""
METHODS: Final = ("`follow.s`", "the box stays", "first order", "second order", "robust")
SCENE: Final = "four"


def run(program: str, frames: Frames, condition: str, **defines: int) -> RunResult:
    """Run a program of asm/ on a clip under a condition."""
    return Chip(assemble(ROOT / "asm" / f"{program}.s", "default", defines)).run(
        altered(frames, *CONDITIONS[condition])
    )


@cache
def clip(name: str) -> tuple[Frames, Truth]:
    """Return a bundled clip with its true places, or the scene of several objects."""
    if name != SCENE:
        return np.load(CLIPS / f"{name}.npy"), read_truth(CLIPS / "truth" / f"{name}.json")
    frames, truth = render(read_scene(ROOT / "examples" / "scenes" / f"{name}.yaml"))
    return frames, {
        str(number): {
            frame: truth.centers[frame, number]
            for frame in range(len(frames))
            if truth.visible[frame, number]
        }
        for number in range(truth.centers.shape[1])
    }


@cache
def scores(name: str, condition: str, ahead: int) -> dict[str, Score]:
    """Score all methods for one object on a clip."""
    frames, truth = clip(name)
    first = run("trajectory", frames, condition).outputs
    measured, predicted = places_of(first)
    second = run("trajectory_nonlinear", frames, condition, INFLECTION=NEVER, STEPS=ahead).outputs
    found = {
        "`follow.s`": score(
            truth, *places_of(run("follow", frames, condition, AHEAD=ahead).outputs), ahead
        ),
        "the box stays": score(truth, measured, measured, ahead),
        # a first order goes on for several frames as for one
        "first order": score(truth, measured, measured + ahead * (predicted - measured), ahead),
        "second order": score(truth, *places_of(second), ahead),
    }
    if ahead == 1:
        robust = run("trajectory_robust", frames, condition).outputs
        found["robust"] = score(truth, *places_of(robust), ahead)
    return found


def errors(found: Score | None) -> str:
    """Return root mean square and median."""
    return f"{found.rms:.1f} / {found.median:.1f}" if found else "–"


def one_object(name: str, ahead: int) -> str:
    """Return the table of one clip: a row for each condition."""
    rows = []
    for condition in CONDITIONS:
        found = scores(name, condition, ahead)
        follow = found["`follow.s`"]
        cells = [errors(found.get(method)) for method in METHODS]
        stays = f"{follow.stays_rms:.1f} / {follow.stays_median:.1f}"
        rows.append([condition, f"{follow.valid:.0%}", cells[0], stays, *cells[1:]])
    head = [f"`{name}`", "seen", METHODS[0], "its place stays", *METHODS[1:]]
    return table(head, rows, len(head) - 1)


def clips() -> str:
    """Return the table of the other clips."""
    rows = []
    for name in ("coin_slide", "ball_fall_30000fps"):
        for ahead in (1, 4):
            found = scores(name, "as it is", ahead)
            cells = [errors(found.get(method)) for method in METHODS]
            rows.append([f"`{name}`", str(ahead), f"{found['`follow.s`'].valid:.0%}", *cells])
    return table(["clip", "ahead", "seen", *METHODS], rows, len(METHODS) + 2)


def several(title: str, frames: Frames, truth: Truth) -> str:
    """Return the table of `follow_many.s` on a clip: a row for each condition."""
    rows = []
    for condition in CONDITIONS:
        near, far = (
            score_many(truth, entries_of(run("follow_many", frames, condition, AHEAD=n).outputs), n)
            for n in (1, 4)
        )
        shown = [f"{s.rms:.1f} / {s.median:.1f}" for s in (near, far)]
        stays = f"{far.stays_rms:.1f} / {far.stays_median:.1f}"
        rows.append([condition, f"{near.seen:.0%}", str(near.switches), *shown, stays])
    head = [title, "seen", "switches", "one ahead", "four ahead", "four ahead, places stay"]
    return table(head, rows, len(head) - 1)


def moving_camera() -> str:
    """Return in how many frames of city_night a program sees an object."""
    frames = np.load(CLIPS / "city_night.npy")
    one = np.asarray(run("follow", frames, "as it is").outputs["valid"]) > 0
    many = np.asarray(run("follow_many", frames, "as it is").outputs["count"]) > 0
    return (
        f"`follow.s` sees one in {one.mean():.0%} of its frames, "
        f"`follow_many.s` in {many.mean():.0%}"
    )


def document() -> str:
    """Return the text of docs/tracking.md."""
    words = {
        name: len(assemble(ROOT / f"asm/{name}.s").words) for name in ("follow", "follow_many")
    }
    return TEMPLATE.read_text(encoding="utf-8").format(
        **words,
        near=one_object("mouse_run", 1),
        far=one_object("mouse_run", 4),
        clips=clips(),
        scene=several(f"`{SCENE}.yaml`", *clip(SCENE)),
        mouse=several("`mouse_run`", *clip("mouse_run")),
        camera=moving_camera(),
    )


def pictures(folder: Path) -> None:
    """Draw what ``npchip run --render`` draws."""
    folder.mkdir(parents=True, exist_ok=True)
    for program, name, last in (("follow", "mouse_run", 70), ("follow_many", SCENE, 60)):
        frames = clip(name)[0][:last]
        source = assemble(ROOT / f"asm/{program}.s")
        render_run(Chip(source).run(frames), source, list(frames), folder / f"{program}-{name}.png")


def main() -> None:
    """Write the page, or print the table of a clip."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", nargs="?", type=Path, default=ROOT / "docs" / "tracking.md")
    parser.add_argument("--clip", nargs=2, type=Path, metavar=("CLIP.npy", "TRUTH.json"))
    options = parser.parse_args()
    if options.clip:
        frames, truth = options.clip
        print(several(frames.stem, np.load(frames), read_truth(truth)))
    else:
        options.file.write_text(document(), encoding="utf-8")
        pictures(options.file.parent / "figures")


if __name__ == "__main__":
    main()
