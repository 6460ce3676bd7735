"""Score a program that follows one object or several against a file of true places.

    python -m examples.score_track PROGRAM CLIP.npy TRUTH.json [--ahead N] [--noise RMS] [--light X]
        [--define NAME=VALUE]

CLIP.npy is uint8 (frame, row, column); TRUTH.json has, for each object, a row and a column in every
frame (npchip.host.vision.truth). Say with ``--ahead`` how many frames ahead the program predicts;
for `follow.s`, ``--define AHEAD=N`` sets it.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from examples.measure import ROOT
from npchip import Chip, assemble
from npchip.host.vision.truth import (
    ManyScore,
    Score,
    entries_of,
    places_of,
    read_truth,
    score,
    score_many,
)

SEED = 24
"""Seed of the noise: each run has the same."""


def altered(frames: NDArray[np.uint8], noise: float, light: float) -> NDArray[np.uint8]:
    """Return a clip with less light, and then noise of this rms in LSB."""
    added = np.random.default_rng(SEED).normal(0, noise, frames.shape)
    return np.clip(np.rint(frames * light + added), 0, 255).astype(np.uint8)


def main(arguments: list[str] | None = None) -> None:
    """Print the score."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", help="name of a program of asm/, or a source file")
    parser.add_argument("clip", type=Path)
    parser.add_argument("truth", type=Path)
    parser.add_argument("--ahead", type=int, default=1, help="frames; default 1")
    parser.add_argument("--noise", type=float, default=0, help="rms in LSB; default 0")
    parser.add_argument("--light", type=float, default=1, help="factor; default 1")
    parser.add_argument("--define", action="append", default=[], metavar="NAME=VALUE")
    options = parser.parse_args(arguments)

    bundled = ROOT / "asm" / f"{options.program}.s"
    source = bundled if bundled.exists() else Path(options.program)
    defines = {name: int(value) for name, _, value in (d.partition("=") for d in options.define)}
    frames = np.load(options.clip)
    frames = altered(frames, options.noise, options.light)
    result = Chip(assemble(source, "default", defines)).run(frames)
    truth = read_truth(options.truth)
    found: Score | ManyScore
    if "count" in result.outputs:
        found = score_many(truth, entries_of(result.outputs), options.ahead)
        print(f"seen       {found.seen:.0%} of the frames of all objects")
        print(f"identity   {found.switches} switches")
    else:
        found = score(truth, *places_of(result.outputs), options.ahead)
        print(f"valid      {found.valid:.0%} of the frames with a moving object")
    print(f"prediction rms {found.rms:.2f} px, median {found.median:.2f} px")
    print(f"stays      rms {found.stays_rms:.2f} px, median {found.stays_median:.2f} px")


if __name__ == "__main__":
    main()
