"""Measure the programs that follow objects on clips with true places, and write docs/tracking.md.

    python -m examples.tracking_page [docs/tracking.md]
    python -m examples.tracking_page --clip CLIP.npy TRUTH.json

Figures go into the folder ``figures`` beside the page. The second form prints the table of several
objects for a clip of your own.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from textwrap import fill
from typing import Final

import numpy as np
from numpy.typing import NDArray

from examples.measure import ROOT, table
from examples.score_track import altered
from npchip import Chip, assemble, load_machine
from npchip.host.scenes import read_scene, render
from npchip.host.vision.truth import (
    ManyScore,
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
HARDER: Final = CONDITIONS | {"noise of 15": (15, 1.0)}
NEVER: Final = 255
"""No acceleration changes by as much: the second order is never restarted."""
METHODS: Final = ("`follow.s`", "the box stays", "first order", "second order", "robust")
SCENE: Final = "four"
STUDY: Final = str(ROOT / "examples" / "studies" / "rom_1024.yaml")
"""A machine with 1,024 program words, which is not the thesis's."""
CORNER_FRAMES: Final = 45
"""Frames of the scene that is drawn into a corner of the largest array."""


def run(
    program: str, frames: Frames, condition: str, machine: str = "default", **defines: int
) -> RunResult:
    """Run a program of asm/ on a clip under a condition."""
    source = assemble(ROOT / "asm" / f"{program}.s", machine, defines)
    return Chip(source, machine).run(altered(frames, *HARDER[condition]))


def study(frames: Frames, condition: str = "as it is", machine: str = STUDY) -> RunResult:
    """Run follow_many_large.s with means of 2 x 2 pixels, for which 512 words are too few."""
    return run("follow_many_large", frames, condition, machine, SMOOTH=1)


def study_words(ahead: int = 1) -> int:
    """Return the words of that program."""
    defines = {"SMOOTH": 1, "AHEAD": ahead}
    return len(assemble(ROOT / "asm" / "follow_many_large.s", STUDY, defines).words)


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


def larger() -> str:
    """Return the table of the programs for larger arrays, beside the others."""
    frames, truth = clip("mouse_run")
    rows = []
    for condition in HARDER:
        cells = []
        for program in ("follow", "follow_large"):
            sent = run(program, frames, condition).outputs
            cells.append(_seen(score(truth, *places_of(sent), 1)))
        for program in ("follow_many", "follow_many_large"):
            sent = run(program, frames, condition).outputs
            cells.append(_seen(score_many(truth, entries_of(sent), 1)))
        rows.append([condition, *cells])
    names = ("follow", "follow_large", "follow_many", "follow_many_large")
    return table(["`mouse_run`", *(f"`{name}.s`" for name in names)], rows, len(names))


def in_the_corner() -> str:
    """Say what the programs for larger arrays see in the last corner of the largest one."""
    frames, truth = clip(SCENE)
    frames = frames[:CORNER_FRAMES]
    machine = replace(load_machine("default"), name="large", np_rows=128, np_cols=160)
    shift = np.array([8 * machine.np_rows, 8 * machine.np_cols]) - frames.shape[1:]
    still = np.pad(frames[0], [(int(pixels), 0) for pixels in shift], mode="edge")
    wide = np.repeat(still[np.newaxis], len(frames), axis=0)
    wide[:, shift[0] :, shift[1] :] = frames
    there = {
        name: {frame: place + shift for frame, place in track.items() if frame < len(frames)}
        for name, track in truth.items()
    }
    many = Chip(assemble(ROOT / "asm/follow_many_large.s", machine), machine).run(wide)
    one = Chip(assemble(ROOT / "asm/follow_large.s", machine), machine).run(wide)
    small = run("follow_many_large", frames, "as it is"), run("follow_large", frames, "as it is")
    found = score_many(there, entries_of(many.outputs))
    most = [f"{result.frame_cycles.max():,}" for result in (many, *small, one)]
    return (
        f"`follow_many_large.s` sees {found.seen:.0%} of them with {found.switches} switches, "
        f"{found.rms:.1f} / {found.median:.1f} one frame ahead. Sums cross the whole array, so a "
        f"frame takes up to {most[0]} cycles there and {most[1]} on 8 × 10 NPs; `follow_large.s` "
        f"takes {most[3]} and {most[2]}"
    )


def _most(found: RunResult) -> str:
    return f"{found.frame_cycles.min():,} to {found.frame_cycles.max():,}"


def _seen(found: Score | ManyScore) -> str:
    seen = found.valid if isinstance(found, Score) else found.seen
    return f"{seen:.0%}, {found.rms:.1f} / {found.median:.1f}"


def study_table() -> str:
    """Return the table of the study, beside the program that fits."""
    rows = []
    for name in ("mouse_run", SCENE):
        frames, truth = clip(name)
        for condition in HARDER:
            found = [
                score_many(truth, entries_of(sent.outputs), 1)
                for sent in (
                    run("follow_many_large", frames, condition),
                    study(frames, condition),
                    run("follow_many", frames, condition),
                )
            ]
            cells = [f"{s.seen:.0%}, {s.switches}, {s.rms:.1f} / {s.median:.1f}" for s in found]
            rows.append([f"`{name}`", condition, *cells])
    names = ["`follow_many_large.s`", "study", "`follow_many.s`"]
    return table(["clip", "", *names], rows, len(names))


def study_camera() -> str:
    """Say in how many frames of city_night the study sees an object."""
    seen = np.asarray(study(np.load(CLIPS / "city_night.npy")).outputs["count"]) > 0
    return f"the study sees an object in {seen.mean():.0%} of its frames"


def coin() -> str:
    """Return the table of coin_slide by its truth as it was found, and in the clip's crop."""
    frames, inside = clip("coin_slide")
    truths = {
        "the clip's crop": inside,
        "the wider crop": read_truth(CLIPS / "wider" / "coin_slide.json"),
    }
    rows = []
    for ahead in (1, 4):
        sent = run("follow", frames, "as it is", AHEAD=ahead).outputs
        measured, _ = places_of(run("trajectory", frames, "as it is").outputs)
        for name, truth in truths.items():
            follow = score(truth, *places_of(sent), ahead)
            box = score(truth, measured, measured, ahead)
            rows.append([name, str(ahead), f"{follow.valid:.0%}", errors(follow), errors(box)])
    return table(["truth in", "ahead", "seen", "`follow.s`", "the box stays"], rows, 4)


def coin_shift() -> str:
    """Return by how many pixels numbers of the wider crop miss the coin in the last frame."""
    _, inside = clip("coin_slide")
    wider = read_truth(CLIPS / "wider" / "coin_slide.json")["coin"]
    last = max(wider)
    return f"{np.hypot(*(inside['coin'][last] - wider[last])):.1f}"


def moving_camera(ending: str = "") -> str:
    """Return in how many frames of city_night programs with this ending see an object."""
    frames = np.load(CLIPS / "city_night.npy")
    one = np.asarray(run(f"follow{ending}", frames, "as it is").outputs["valid"]) > 0
    many = np.asarray(run(f"follow_many{ending}", frames, "as it is").outputs["count"]) > 0
    return (
        f"`follow{ending}.s` sees one in {one.mean():.0%} of its frames, "
        f"`follow_many{ending}.s` in {many.mean():.0%}"
    )


def document() -> str:
    """Return the text of docs/tracking.md."""
    words = {
        name: len(assemble(ROOT / f"asm/{name}.s").words)
        for name in ("follow", "follow_large", "follow_many", "follow_many_large")
    }
    return TEMPLATE.read_text(encoding="utf-8").format(
        **words,
        near=one_object("mouse_run", 1),
        far=one_object("mouse_run", 4),
        clips=clips(),
        scene=several(f"`{SCENE}.yaml`", *clip(SCENE)),
        mouse=several("`mouse_run`", *clip("mouse_run")),
        camera=moving_camera(),
        larger=larger(),
        camera_large=moving_camera("_large"),
        coin=coin(),
        coin_shift=coin_shift(),
        study=study_words(),
        study_more=study_words() - 512,
        study_far=study_words(8) - 512,
        study_table=study_table(),
        study_camera=study_camera(),
        study_cycles=_most(study(clip("coin_slide")[0])),
        study_before=_most(run("follow_many_large", clip("coin_slide")[0], "as it is")),
        corner=fill(in_the_corner(), 118),
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
