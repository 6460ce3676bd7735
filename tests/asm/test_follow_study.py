"""A study: asm/follow_many_large.s with means of 2 x 2 pixels, on a machine with 1,024 words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import pytest

from examples.studies.rewritten import LARGE
from examples.studies.study import FOLDER
from npchip import Chip, load_machine
from npchip.assembler import AssemblyError
from tests.asm.test_follow_large import CHUNK, DISTANCES, SCENES, assert_many
from tests.support.clips import bundled_clips, synthetic_clip
from tests.support.profiles import parts
from tests.support.programs import assembled, chip_with

if TYPE_CHECKING:
    from npchip import Machine

NAME = "follow_many_large"
CYCLES = {LARGE[0]: (10_916, 18_486), LARGE[1]: (15_640, 27_604)}
"""Least and most in a frame of coin_slide."""


def machine(file: str = LARGE[0]) -> Machine:
    return load_machine(FOLDER / file)


def chip(ahead: int = 1) -> Chip:
    return chip_with(NAME, machine(), {"SMOOTH": 1, "AHEAD": ahead})


def test_it_is_no_program_for_512_words() -> None:
    with pytest.raises(AssemblyError, match="the program has 538 words: 26 more than the ROM's"):
        assembled(NAME, "default", {"SMOOTH": 1})


def test_its_words() -> None:
    assert [len(chip(ahead).program.words) for ahead in DISTANCES] == [538, 541, 543, 545]


@pytest.mark.parametrize("file", LARGE)
def test_its_cycles(file: str) -> None:
    ran_on = chip_with(NAME, machine(file), {"SMOOTH": 1})
    assert_many(ran_on, bundled_clips()["coin_slide"], smooths=True)
    ran_on.reset()
    cycles = ran_on.run(bundled_clips()["coin_slide"]).frame_cycles
    assert (cycles.min(), cycles.max()) == CYCLES[file]


@pytest.mark.parametrize("clip", bundled_clips())
def test_real_clips(clip: str) -> None:
    assert_many(chip(), bundled_clips()[clip], smooths=True)


@pytest.mark.parametrize("first", parts(4, SCENES // CHUNK))
def test_random_scenes(first: int) -> None:
    for seed in range(first * CHUNK, first * CHUNK + CHUNK):
        ahead = DISTANCES[seed % len(DISTANCES)]
        assert_many(chip(ahead), synthetic_clip(seed, frames=12), ahead, smooths=True)


@pytest.mark.parametrize("engine", ["wasm", "reference"])
def test_both_engines_agree(engine: Literal["wasm", "reference"]) -> None:
    ran_on = Chip(assembled(NAME, machine(), {"SMOOTH": 1}), machine(), engine)
    assert any(assert_many(ran_on, bundled_clips()["coin_slide"][:10], smooths=True))
