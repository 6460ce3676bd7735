"""docs/speed.md: its figures are those of one computer and one hour, its rows those of all."""

from __future__ import annotations

import re
from pathlib import Path

from benchmarks.arrays import PROGRAMS as DRAWING
from benchmarks.arrays import SHAPES
from benchmarks.hard import PROGRAMS as HARD
from benchmarks.many import CASES
from benchmarks.noise import CONVERSION
from benchmarks.page import NEEDED, page
from benchmarks.pictures import DRAWN
from examples.measure import PROGRAMS

FIGURES = r"one core of .*?\)\.|[\d.]+ us in|converts: [\d.]+ of"
PAGE = Path(__file__).parents[2] / "docs" / "speed.md"
COMMIT = "7312c71"
LATER = {
    "digits",
    "follow",
    "follow_large",
    "follow_many",
    "follow_many_large",
    "polygons",
    "tracking_large",
    "trajectory_large",
    "trajectory_mixed_large",
    "trajectory_nonlinear_large",
    "trajectory_robust_large",
}
"""Programs that the commit which the page compares with does not have."""


def made_up() -> dict[str, dict[str, dict[str, float]]]:
    """Tables as the benchmarks return them."""
    engine = {
        "wasm frames/s": 500_000.0,
        "wasm instructions/s": 9e8,
        "cycles per frame": 2_000.0,
        "reference frames/s": 400.0,
    }
    noise = {"ideal": 2.0, "noisy": 7.0, "reference": 6_000.0, "times of ideal": 3.5}
    large = {
        "wasm frames/s": 1_500.0,
        "reference frames/s": 22.0,
        "ratio": 68.0,
        "ready ms": 30.0,
        "ns per NP": 140.0,
        "times of the chip's": 0.9,
    }
    compared = {"a": 9e5, "b": 6e5, "c": 1.5, "d": 30.0, "e": 33.0, "f": 1.1}
    ready = {"assemble ms": 4.0, "compile and one frame ms": 31.0, "total ms": 35.0}
    return {
        "trajectory": {"npchip (wasm)": {"frames/s": 600_000.0, "times of npchip": 1.0}},
        "pictures": {
            f"{name}, {way}": {"frames/s": 1e5, "times of npchip": 1.0}
            for name, others in DRAWN.items()
            for way in ("steady state", "cold start", *others)
        },
        "engines": dict.fromkeys(PROGRAMS, engine),
        "noise": {
            CONVERSION: {"compiled": 2.5, "NumPy": 40.0, "part of NumPy": 0.0625},
            **dict.fromkeys(PROGRAMS, noise),
        },
        "arrays": {
            f"{name}, {rows} x {cols} NPs": large for name in DRAWING for rows, cols in SHAPES
        },
        "ready": dict.fromkeys(PROGRAMS, ready),
        "hard": {name: {"words": 502.0, **ready, "compiled": 1.0} for name in HARD},
        "start-up": {"npchip run, 300 frames": {"ms": 240.0, "times of import": 1.8}},
        "growth": {
            "1,000 frames": {"us per frame": 1.5, "peak MB": 120.0},
            "8 x 10 NPs": {"us per frame": 1.6, "ns per frame and NP": 20.0},
        },
        "many": {
            f"{name}, {count} x {frames:,} frames": {
                "at once, ms": 600.0,
                "one chip, in turn, ms": 1_000.0,
                "one chip, in turn, times": 1.67,
                "two processes, ms": 500.0,
            }
            for name, count, frames in CASES
        },
        "against": {
            **dict.fromkeys(PROGRAMS, compared),
            "geometric mean": {"c": 1.5, "f": 1.1},
            "lowest": {"c": 1.0, "f": 0.9},
        },
    }


def shape(text: str) -> list[str]:
    """A page without what differs between computers and moments."""
    return re.sub(FIGURES, "", re.sub(r"\s+", " ", text)).split("## ")


def test_the_chip_is_compared_at_its_clock() -> None:
    """2,000 cycles a frame at 10 MHz are 5,000 frames a second: a hundredth of 500,000."""
    assert "| `trajectory` | 500,000 | 100 | 900 | 400 |" in page(made_up(), COMMIT).splitlines()


def test_a_comparison_shows_both_commits() -> None:
    lines = page(made_up(), COMMIT).splitlines()
    assert "| `trajectory` | 900,000 | 600,000 | 1.50 | 30.0 | 33.0 | 1.10 |" in lines
    assert "| geometric mean |  |  | 1.50 |  |  | 1.10 |" in lines
    assert "| `trajectory`, 16 x 50,000 frames | 600 | 1,000 | 1.67 | 2.00 |" in lines


def test_a_picture_names_its_program_and_who_draws_it() -> None:
    lines = page(made_up(), COMMIT).splitlines()
    assert "| `edges`, OpenCV's Sobel | 100,000 | 1.00 |" in lines
    assert "| `imaging`, 60 x 80 | 1,500 | 22 | 68.0 | 30.0 | 140 | 0.90 |" in lines


def test_the_page_is_one_that_the_benchmarks_have_written() -> None:
    assert set(made_up()) == set(NEEDED)
    written, made = shape(PAGE.read_text(encoding="utf-8")), shape(page(made_up(), COMMIT))
    assert [part.split(" | ")[0] for part in written] == [part.split(" | ")[0] for part in made]
    for part, later in ((written, LATER), (made, set())):
        for name in PROGRAMS:
            assert " ".join(part).count(f"| `{name}` |") == (3 if name in later else 4), name
        assert all(" ".join(part).count(f"| {name} |") == 1 for name in HARD)
