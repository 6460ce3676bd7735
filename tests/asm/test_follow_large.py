"""asm/follow_large.s and follow_many_large.s: what their models give, on arrays of many sizes.

Quick runs take 40 random scenes; ``pytest -m long`` takes 1,000, and arrays of up to 128 x 160 NPs.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import Chip, load_machine
from npchip.assembler import AssemblyError
from npchip.host.vision.follow import Follower, Sighting
from npchip.host.vision.follow_many import ManyFollower, Seen
from npchip.host.vision.foreground import Foreground
from npchip.host.vision.truth import entries_of, score_many
from tests.asm.test_follow_many import marchers
from tests.support.clips import bundled_clips, synthetic_clip
from tests.support.profiles import THOROUGH, parts
from tests.support.programs import assembled, chip_with

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip import Machine

    Frames = NDArray[np.uint8]

PROGRAMS = ("follow_large", "follow_many_large")
CHUNK = 10  # random scenes to a test
SCENES = 1_000 if THOROUGH else 300
DISTANCES = (1, 2, 4, 8)
SIZES = [(2, 2), (29, 29), (33, 5)]
LARGEST = [(64, 80), (128, 160), (160, 128), (2, 256), (256, 2)]


def array(np_rows: int, np_cols: int) -> Machine:
    return replace(load_machine("default"), name="large", np_rows=np_rows, np_cols=np_cols)


def assert_one(chip: Chip, frames: Frames, ahead: int = 1) -> NDArray[np.int64]:
    """Compare with the model; return its outputs, (frames, outputs)."""
    chip.reset()
    result = chip.run(frames)
    assert result.status == "frames-exhausted", result.error
    assert set(result.outputs) == set(Sighting._fields)
    model = Follower(ahead=ahead, large=True)
    expected = np.array([model.step(frame) for frame in frames])
    for column, name in enumerate(Sighting._fields):
        assert result.outputs[name].tolist() == expected[:, column].tolist(), name
    return expected


def assert_many(
    chip: Chip, frames: Frames, ahead: int = 1, *, smooths: bool = False
) -> list[list[Seen]]:
    """Compare with the model; return what it sees in each frame."""
    chip.reset()
    result = chip.run(frames)
    assert result.status == "frames-exhausted", result.error
    model = ManyFollower(ahead=ahead, large=True, foreground=Foreground(smooths=smooths))
    seen = [model.step(frame) for frame in frames]
    assert result.outputs["count"].tolist() == [len(each) for each in seen]
    for column, name in enumerate(Seen._fields):
        for index, each in enumerate(seen):
            sent = [
                np.asarray(result.value(output, index) or [], np.int64)
                for output in (name, f"{name}_high")
                if output in result.outputs
            ]
            found = sum(part << 8 * k for k, part in enumerate(sent))
            assert np.array_equal(found, [one[column] for one in each]), (name, index)
    return seen


def movers(seed: int, rows: int, cols: int, frames: int = 14) -> Frames:
    """Return a noisy clip of three discs, of which one moves about the last corner."""
    rng = np.random.default_rng(seed)
    clip = np.full((frames, rows, cols), float(rng.integers(60, 160)))
    y, x = np.ogrid[:rows, :cols]
    for number in range(3):
        radius = int(rng.integers(3, 9))
        row, col = rng.uniform(4, (rows - 4, cols - 4)) if number else (rows - 9, cols - 9)
        step, brightness = rng.normal(0, 2, 2), rng.choice([0, 255])
        for index in range(2, frames):
            clip[index][(y - row) ** 2 + (x - col) ** 2 <= radius**2] = brightness
            row, col = row + step[0], col + step[1]
    return np.clip(clip + rng.normal(0, 2, clip.shape), 0, 255).astype(np.uint8)


def drifting(shape: tuple[int, int], *places: tuple[int, int]) -> Frames:
    """Return a clip of discs of radius 4 that drift to the right from these places."""
    frames = np.full((12, *shape), 100, np.uint8)
    y, x = np.ogrid[: shape[0], : shape[1]]
    for index, frame in enumerate(frames[2:]):
        for row, col in places:
            frame[(y - row) ** 2 + (x - col - index / 4) ** 2 <= 16] = 200
    return frames


@pytest.mark.parametrize("clip", bundled_clips())
def test_real_clips(clip: str) -> None:
    assert_one(chip_with("follow_large"), bundled_clips()[clip])
    assert_many(chip_with("follow_many_large"), bundled_clips()[clip])


@pytest.mark.parametrize("first", parts(4, SCENES // CHUNK))
def test_random_scenes(first: int) -> None:
    for seed in range(first * CHUNK, first * CHUNK + CHUNK):
        ahead = DISTANCES[seed % len(DISTANCES)]
        frames = synthetic_clip(seed, frames=12)
        assert_one(chip_with("follow_large", "default", {"AHEAD": ahead}), frames, ahead)
        assert_many(chip_with("follow_many_large", "default", {"AHEAD": ahead}), frames, ahead)


@pytest.mark.parametrize(
    "size", [*SIZES, *(pytest.param(s, marks=pytest.mark.long) for s in LARGEST)]
)
def test_arrays(size: tuple[int, int]) -> None:
    machine, (rows, cols) = array(*size), (8 * number for number in size)
    most = 0
    for seed, ahead in ((1, 1), (2, 8)):
        frames = movers(seed, rows, cols)
        one, many = (chip_with(name, machine, {"AHEAD": ahead}) for name in PROGRAMS)
        found, seen = assert_one(one, frames, ahead), assert_many(many, frames, ahead)
        assert found[:, 0].sum() >= 3
        most = max(most, *found[:, 1], *(each.row for frame in seen for each in frame))
    assert most >= rows - 20


def test_objects_256_pixels_apart_are_not_one() -> None:
    """Eight bits of a place would see the other object in the square about the first."""
    frames = drifting((264, 272), (20, 8), (20, 264), (4, 136), (260, 136))
    machine = array(33, 34)
    found = assert_one(chip_with("follow_large", machine), frames)
    assert found[3:, 0].all()
    assert found[:, 5].max() < 70
    seen = assert_many(chip_with("follow_many_large", machine), frames)
    assert len({(each.row >> 7, each.col >> 7) for each in seen[-1]}) == len(seen[-1]) == 4
    assert max(each.area for each in seen[-1]) < 70


def test_four_objects_keep_their_identity() -> None:
    frames, truth = marchers(4)
    chip = chip_with("follow_many_large", "default", {"AHEAD": 4})
    assert_many(chip, frames, 4)
    chip.reset()
    found = score_many(truth, entries_of(chip.run(frames).outputs), 4)
    assert found.switches == 0
    assert found.seen >= 0.9
    assert found.median <= 1


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_longest_forms_fill_the_program_rom(name: str) -> None:
    assert [len(assembled(name, "default", {"AHEAD": n}).words) for n in DISTANCES] == [
        505,
        508,
        510,
        512,
    ]


def test_a_moving_camera_shows_no_object() -> None:
    frames = bundled_clips()["city_night"]
    seen = assert_one(chip_with("follow_large"), frames)[:, 0]
    assert seen.mean() < 0.25


def test_the_reference_engine_agrees() -> None:
    machine, frames = array(3, 34), drifting((24, 272), (12, 8), (12, 262))[:8]
    one, many = (Chip(assembled(name, machine), machine, engine="reference") for name in PROGRAMS)
    assert assert_one(one, frames)[3:, 0].all()
    assert max(each.col for each in assert_many(many, frames)[-1]) > 255


def test_the_conservative_machine_agrees() -> None:
    frames = bundled_clips()["coin_slide"]
    assert assert_one(chip_with("follow_large", "conservative"), frames)[:, 0].sum() == 25
    seen = assert_many(chip_with("follow_many_large", "conservative"), frames)
    assert sum(map(len, seen)) == 24


@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("size", [(1, 10), (8, 1)])
def test_arrays_that_do_not_fit_are_refused(name: str, size: tuple[int, int]) -> None:
    with pytest.raises(AssemblyError, match="sums over all NPs need a neighbour"):
        assembled(name, array(*size))
