"""Measure how often networks are right and what they cost, and write docs/networks.md.

    python -m examples.networks_page [FILE]

Needs the pictures of ``npchip[networks]``. The same figures come out on every computer.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from examples import networks_costs
from examples.measure import CLIPS, MACHINES, clip, run, table, write_page
from npchip.host.vision.networks import accuracy, drawn, pictures, sets, training
from npchip.host.vision.networks.features import Frames
from npchip.host.vision.networks.files import bundled, load
from npchip.host.vision.networks.network import MOST_NEURONS, NONE, Network
from npchip.host.vision.networks.pictures import PictureSet
from npchip.report.table import ILLUSTRATIVE_CLOCK_HZ

SURE = (0, 100, 200, 300, 400)

TEXT = Path(__file__).with_suffix(".md")


@cache
def parts(name: str) -> pictures.Parts:
    """The pictures of a subject, as the bundled weights have seen them."""
    return pictures.split(sets.subject(name).load(), seed=1)


@cache
def network(name: str) -> Network:
    """The bundled weights."""
    return load(bundled(name))


def shares(name: str) -> str:
    """Return a table of how often a network is right on its test pictures."""
    found = accuracy.measure(network(name), parts(name).test)
    rows = []
    for condition, share in found.items():
        low, high = share.interval()
        rows.append([condition, f"{share.value:.1%}", f"{low:.1%} to {high:.1%}"])
    return table(["frames", "right", "interval"], rows, 2)


def drawn_frames() -> Frames:
    """Signs, none of which is a digit."""
    return pictures.as_frames(pictures.enlarge(drawn.signs(30).pictures))


def other_frames() -> Frames:
    """All frames of bundled clips that show no digit."""
    names = sorted({path.stem for path in CLIPS.glob("*.npy")} - {"digits_drawn"})
    return np.concatenate([clip(name) for name in names])


def sure(test: PictureSet) -> str:
    """Return a table of the share of frames that is answered, and how much of it is wrong."""
    model, frames = network("digits"), accuracy.frames_of(test, accuracy.CONDITIONS[0])
    rows = []
    for least in SURE:
        answers = model.answers(frames, sure=least)
        given = answers != NONE
        wrong = accuracy.Share(int((answers != test.labels)[given].sum()), int(given.sum()))
        others = [
            accuracy.Share(int((model.answers(seen, sure=least) != NONE).sum()), len(seen))
            for seen in (drawn_frames(), other_frames())
        ]
        cells = [given.mean(), wrong.value, *(share.value for share in others)]
        rows.append([f"{least}", *(f"{value:.1%}" for value in cells)])
    head = ["`SURE`", "digits answered", "wrong of these", "signs answered", "frames answered"]
    return table(head, rows, len(head))


def costs() -> str:
    """Words, cycles, frame rate and memory."""
    rows = []
    for machine in MACHINES:
        found = run("digits", machine)
        cycles = [int(count) for count in found.column.result.frame_cycles]
        rate = ILLUSTRATIVE_CLOCK_HZ / np.mean(cycles)
        rows.append([f"`{machine}`", f"{min(cycles):,} to {max(cycles):,}", f"{rate:,.0f}"])
    return table(["machine", "cycles per frame", "frames/s"], rows, 2)


def document() -> str:
    """Return the text of docs/networks.md."""
    digits, settings = parts("digits"), training.Settings()
    found = run("digits")
    return TEXT.read_text(encoding="utf-8").format(
        words=len(found.program.words),
        first=f"{int(found.column.result.frame_cycles[0]):>6}",
        test=len(digits.test),
        learnt=f"{len(digits.training) + len(digits.validation):,} others",
        enlarged=pictures.ENLARGED,
        digits=shares("digits"),
        none=NONE,
        drawn=len(drawn_frames()),
        frames=len(other_frames()),
        sure=sure(digits.test),
        costs=costs(),
        mhz=ILLUSTRATIVE_CLOCK_HZ // 1_000_000,
        most=MOST_NEURONS,
        bytes=len(network("digits").planes()),
        rounds=settings.rounds,
        variants=settings.variants,
        names=", ".join(drawn.SIGNS),
        signs_test=len(parts("signs").test),
        signs=shares("signs"),
        beside=networks_costs.sections(),
    )


if __name__ == "__main__":
    write_page("networks.md", document)
