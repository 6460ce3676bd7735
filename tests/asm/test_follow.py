"""asm/follow.s: number for number what its integer model gives, on clips, scenes and arrays.

Quick runs take 40 random scenes; ``pytest -m long`` takes 1,000.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import Chip, load_machine
from npchip.assembler import AssemblyError
from npchip.host.vision.follow import Follower, Sighting
from tests.support.clips import bundled_clips, synthetic_clip
from tests.support.profiles import THOROUGH, parts
from tests.support.programs import assembled, chip_with

if TYPE_CHECKING:
    from numpy.typing import NDArray

CHUNK = 10  # random scenes to a test
SCENES = 1_000 if THOROUGH else 300
DISTANCES = (1, 2, 4, 8)


def assert_exact(chip: Chip, frames: NDArray[np.uint8], ahead: int = 1) -> int:
    """Compare all outputs of all frames with the model; return in how many an object is seen."""
    chip.reset()
    result = chip.run(frames)
    assert result.status == "frames-exhausted", result.error
    assert set(result.outputs) == set(Sighting._fields)
    model = Follower(ahead=ahead)
    expected = np.array([model.step(frame) for frame in frames])
    for column, name in enumerate(Sighting._fields):
        assert result.outputs[name].tolist() == expected[:, column].tolist(), name
    return int(expected[:, 0].sum())


def noisy(frames: NDArray[np.uint8], rms: float, light: float) -> NDArray[np.uint8]:
    noise = np.random.default_rng(24).normal(0, rms, frames.shape)
    return np.clip(np.rint(frames * light + noise), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("clip", bundled_clips())
def test_real_clips(clip: str) -> None:
    assert_exact(chip_with("follow"), bundled_clips()[clip])


def test_a_moving_camera_shows_no_object() -> None:
    frames = bundled_clips()["city_night"]
    assert assert_exact(chip_with("follow"), frames) < len(frames) / 4


@pytest.mark.parametrize("ahead", DISTANCES)
@pytest.mark.parametrize(("rms", "light"), [(0, 0.6), (10, 1)])
def test_the_mouse_in_noise_and_little_light(ahead: int, rms: float, light: float) -> None:
    frames = noisy(bundled_clips()["mouse_run"], rms, light)
    chip = chip_with("follow", "default", {"AHEAD": ahead})
    assert assert_exact(chip, frames, ahead) >= 0.9 * len(frames)


@pytest.mark.parametrize("first", parts(4, SCENES // CHUNK))
def test_random_scenes(first: int) -> None:
    for seed in range(first * CHUNK, first * CHUNK + CHUNK):
        ahead = DISTANCES[seed % len(DISTANCES)]
        chip = chip_with("follow", "default", {"AHEAD": ahead})
        assert_exact(chip, synthetic_clip(seed, frames=12), ahead)


def test_random_scenes_show_objects() -> None:
    """The quick scenes reach new tracks, misses and dropped tracks."""
    seen = [
        assert_exact(chip_with("follow"), synthetic_clip(seed, frames=12)) for seed in range(40)
    ]
    assert sum(count > 0 for count in seen) >= 10
    assert any(0 < count < 9 for count in seen)


@pytest.mark.parametrize("frames", [8, pytest.param(30, marks=pytest.mark.long)])
def test_the_reference_engine_agrees(frames: int) -> None:
    chip = Chip(assembled("follow"), engine="reference")
    assert assert_exact(chip, bundled_clips()["coin_slide"][:frames]) == frames - 5


def test_the_conservative_machine_agrees() -> None:
    assert assert_exact(chip_with("follow", "conservative"), bundled_clips()["coin_slide"]) == 25


@pytest.mark.parametrize("shape", [(2, 2), (2, 28), (28, 2), (5, 3)])
def test_other_arrays(shape: tuple[int, int]) -> None:
    rows, cols = shape
    machine = replace(load_machine("default"), name="other", np_rows=rows, np_cols=cols)
    for seed in (3, 8, 24):
        assert_exact(chip_with("follow", machine), synthetic_clip(seed, 8 * rows, 8 * cols))


@pytest.mark.parametrize("shape", [(1, 10), (29, 10), (8, 1), (8, 29)])
def test_arrays_that_do_not_fit_are_refused(shape: tuple[int, int]) -> None:
    rows, cols = shape
    machine = replace(load_machine("default"), name="other", np_rows=rows, np_cols=cols)
    with pytest.raises(AssemblyError, match="a place and the square about it have 8 bits"):
        assembled("follow", machine)


def test_an_unknown_distance_is_refused() -> None:
    with pytest.raises(AssemblyError, match="AHEAD must be 1, 2, 4 or 8"):
        assembled("follow", "default", {"AHEAD": 3})
