"""asm/follow_many.s: number for number what its integer model gives, and whom it follows.

Quick runs take 40 random scenes; ``pytest -m long`` takes 1,000.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import Chip, load_machine
from npchip.assembler import AssemblyError
from npchip.host.vision.follow_many import ManyFollower, Seen
from npchip.host.vision.truth import entries_of, score_many
from tests.support.clips import bundled_clips, synthetic_clip
from tests.support.profiles import THOROUGH, parts
from tests.support.programs import assembled, chip_with

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip import RunResult
    from npchip.host.vision.truth import Places

CHUNK = 10  # random scenes to a test
SCENES = 1_000 if THOROUGH else 300
DISTANCES = (1, 2, 4, 8)


def run_exact(chip: Chip, frames: NDArray[np.uint8], ahead: int = 1) -> tuple[RunResult, int]:
    """Compare all outputs of all frames with the model; return the run and how many are seen."""
    chip.reset()
    result = chip.run(frames)
    assert result.status == "frames-exhausted", result.error
    assert set(result.outputs) == {"count", *Seen._fields}
    model = ManyFollower(ahead=ahead)
    for index, frame in enumerate(frames):
        expected = model.step(frame)
        assert result.value("count", index) == len(expected)
        for column, name in enumerate(Seen._fields):
            sent = result.value(name, index)
            found = [] if sent is None else np.asarray(sent).tolist()
            assert found == [one[column] for one in expected], name
    return result, int(np.sum(result.outputs["count"]))


def marchers(
    count: int, frames: int = 40
) -> tuple[NDArray[np.uint8], dict[str, dict[int, Places]]]:
    """Return dark discs of radius 3.5 that enter one by one and cross the picture in lanes."""
    clip = np.full((frames, 64, 80), 180, np.uint8)
    y, x = np.ogrid[:64, :80]
    truth: dict[str, dict[int, Places]] = {}
    for number in range(count):
        row, speed = 8 + 15 * number, 1 + 0.5 * number
        places = {}
        for frame in range(frames):
            col = -4 + speed * (frame - 2 * number)
            clip[frame][(y - row) ** 2 + (x - col) ** 2 <= 12] = 40
            if 4 <= col <= 76:
                places[frame] = np.array([row, col])
        truth[f"disc {number}"] = places
    return clip, truth


@pytest.mark.parametrize("clip", bundled_clips())
def test_real_clips(clip: str) -> None:
    run_exact(chip_with("follow_many"), bundled_clips()[clip])


def test_a_moving_camera_shows_no_object() -> None:
    frames = bundled_clips()["city_night"]
    result, _ = run_exact(chip_with("follow_many"), frames)
    assert (np.asarray(result.outputs["count"]) > 0).mean() < 0.25


@pytest.mark.parametrize("ahead", DISTANCES)
def test_the_mouse_in_noise(ahead: int) -> None:
    frames = bundled_clips()["mouse_run"]
    noise = np.random.default_rng(24).normal(0, 10, frames.shape)
    frames = np.clip(np.rint(frames + noise), 0, 255).astype(np.uint8)
    run_exact(chip_with("follow_many", "default", {"AHEAD": ahead}), frames, ahead)


@pytest.mark.parametrize("first", parts(4, SCENES // CHUNK))
def test_random_scenes(first: int) -> None:
    for seed in range(first * CHUNK, first * CHUNK + CHUNK):
        ahead = DISTANCES[seed % len(DISTANCES)]
        chip = chip_with("follow_many", "default", {"AHEAD": ahead})
        run_exact(chip, synthetic_clip(seed, frames=12), ahead)


def test_random_scenes_show_several_objects() -> None:
    counts = set()
    for seed in range(40):
        result, _ = run_exact(chip_with("follow_many"), synthetic_clip(seed, frames=12))
        counts |= set(np.asarray(result.outputs["count"]).tolist())
    assert counts == {0, 1, 2, 3, 4}


def test_four_objects_keep_their_identity() -> None:
    frames, truth = marchers(4)
    result, _ = run_exact(chip_with("follow_many", "default", {"AHEAD": 4}), frames, 4)
    found = score_many(truth, entries_of(result.outputs), 4)
    assert found.switches == 0
    assert found.seen >= 0.9
    assert found.median <= 1
    assert found.stays_median >= 4


def test_a_fifth_object_waits() -> None:
    frames, _ = marchers(4)
    eight = np.minimum(frames, np.roll(frames, 40, axis=2))
    result, _ = run_exact(chip_with("follow_many"), eight)
    assert max(result.outputs["count"]) == 4


@pytest.mark.parametrize("frames", [8, pytest.param(30, marks=pytest.mark.long)])
def test_the_reference_engine_agrees(frames: int) -> None:
    chip = Chip(assembled("follow_many"), engine="reference")
    assert run_exact(chip, bundled_clips()["coin_slide"][:frames])[1] == frames - 6


def test_the_conservative_machine_agrees() -> None:
    chip = chip_with("follow_many", "conservative")
    assert run_exact(chip, bundled_clips()["coin_slide"])[1] == 24


@pytest.mark.parametrize("shape", [(2, 2), (2, 28), (28, 2), (5, 3)])
def test_other_arrays(shape: tuple[int, int]) -> None:
    rows, cols = shape
    machine = replace(load_machine("default"), name="other", np_rows=rows, np_cols=cols)
    for seed in (3, 8, 24):
        run_exact(chip_with("follow_many", machine), synthetic_clip(seed, 8 * rows, 8 * cols))


@pytest.mark.parametrize("shape", [(1, 10), (29, 10), (8, 1), (8, 29)])
def test_arrays_that_do_not_fit_are_refused(shape: tuple[int, int]) -> None:
    rows, cols = shape
    machine = replace(load_machine("default"), name="other", np_rows=rows, np_cols=cols)
    with pytest.raises(AssemblyError, match="a place and the square about it have 8 bits"):
        assembled("follow_many", machine)
