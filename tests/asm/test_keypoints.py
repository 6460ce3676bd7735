"""asm/keypoints*.s: bit for bit as npchip.host.vision.keypoints, on clips and random scenes.

Quick runs take dozens of random scenes; NPCHIP_PROFILE=thorough takes more than 1,000.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import pytest

from npchip import Machine, load_machine
from npchip.host.vision.keypoints import farthest_points, find_key_points, object_mask, trace_edges
from npchip.host.vision.polygons import (
    random_triangle,
    raster,
)
from npchip.host.vision.shapes import best_match, scaled, side_lengths
from tests.support.clips import bundled_clips
from tests.support.masks import drawn, rectangles, scene
from tests.support.profiles import THOROUGH
from tests.support.programs import chip_with

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]

ASM = Path(__file__).parents[2] / "asm"
NAMES = ("keypoints", "keypoints_farthest")
CHUNK = 50 if THOROUGH else 10  # scenes of a test, so that several processes share them
SCENES = 1_500 if THOROUGH else 60


@cache
def array(np_rows: int, np_cols: int) -> Machine:
    return replace(load_machine("default"), name="other", np_rows=np_rows, np_cols=np_cols)


def assert_exact(
    name: str,
    frames: Frames,
    threshold: int = 128,
    *,
    dark: bool = False,
    machine: Machine | str = "default",
) -> None:
    """Compare all outputs of all frames with the host."""
    defines = {"THRESHOLD": threshold, "DARK": int(dark)}
    result = chip_with(name, machine, defines).run(frames)
    assert result.status == "frames-exhausted", result.error
    for index, frame in enumerate(frames):
        mask = object_mask(frame, threshold, dark=dark)
        if name == "keypoints":
            found = find_key_points(mask)
            counts = [len(points) for points in found]
            assert sent(result.outputs["count"][index]) == counts
            assert result.outputs["objects"][index] == min(len(found), 255)
        else:
            found = [farthest_points(mask)]
            assert result.outputs["count"][index] == len(found[0])
        expected = [place for points in found for point in points for place in point]
        assert sent(result.outputs["points"][index]) == expected


def sent(values: list[int] | None) -> list[int]:
    return values or []


@pytest.mark.parametrize("first", range(0, SCENES, CHUNK))
@pytest.mark.parametrize("name", NAMES)
def test_random_scenes(name: str, first: int) -> None:
    masks = [scene(seed) for seed in range(first, first + CHUNK)]
    assert_exact(name, drawn(masks))


def test_scenes_are_varied() -> None:
    counts = {len(points) for seed in range(60) for points in find_key_points(scene(seed))}
    assert {2, 3, 4, 5, 6} <= counts


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("threshold", [100, 128, 160, 190, 200])
@pytest.mark.parametrize("clip", ["shapes_photo", "shapes_drawn"])
@pytest.mark.parametrize("name", NAMES)
def test_pictures_of_shapes(name: str, clip: str, threshold: int, dark: bool) -> None:
    assert_exact(name, bundled_clips()[clip], threshold, dark=dark)


@pytest.mark.parametrize("clip", ["ball_fall_30000fps", "city_night", "coin_slide", "mouse_run"])
@pytest.mark.parametrize("name", NAMES)
def test_clips(name: str, clip: str) -> None:
    frames = bundled_clips()[clip]
    assert_exact(name, frames if THOROUGH else frames[::10])


@pytest.mark.parametrize("name", NAMES)
def test_all_thresholds_of_one_ramp(name: str) -> None:
    ramp = np.linspace(0, 255, 64 * 80).astype(np.uint8).reshape(1, 64, 80)
    for threshold in (1, 2, 127, 254, 255):
        assert_exact(name, ramp, threshold)
        assert_exact(name, ramp, threshold, dark=True)


@pytest.mark.parametrize("name", NAMES)
def test_corners_and_borders(name: str) -> None:
    masks = [*rectangles(), np.eye(64, 80, dtype=bool), np.indices((64, 80)).sum(axis=0) % 2 == 0]
    assert_exact(name, drawn(masks))


def test_a_comb_has_more_key_points_than_are_kept() -> None:
    mask = np.zeros((30, 80), bool)
    mask[0] = mask[:, ::6] = True
    frame = np.zeros((64, 80), bool)
    frame[20:50] = mask
    assert len(find_key_points(frame)[0]) == 32
    assert_exact("keypoints", drawn([frame, frame.copy()]))


@pytest.mark.parametrize("name", NAMES)
def test_other_arrays(name: str) -> None:
    """Runs that are longer than 85 steps, whose triple needs more than a byte."""
    rng = np.random.default_rng(1)
    masks = [np.ones((128, 160), bool)]
    masks += [
        raster(random_triangle(rng, "obtuse", (60, 150), (128, 160)), (128, 160))
        for _ in range(12 if THOROUGH else 4)
    ]
    nearly_level = np.array([[2.5, 1.5], [3.8, 149.5], [59.5, 129.5]])
    masks.append(raster(nearly_level, (128, 160)))
    assert_exact(name, drawn(masks), machine=array(16, 20))
    masks = [np.ones((8, 8), bool), np.zeros((8, 8), bool), np.eye(8, dtype=bool)]
    assert_exact(name, drawn(masks), machine=array(1, 1))


def test_the_largest_array_of_the_tracer() -> None:
    machine = array(31, 31)
    mask = np.zeros((248, 248), bool)
    mask[0, 0] = mask[247, 247] = True  # single pixels
    mask[100:248, 200:248] = mask[2:60, :] = True
    assert_exact("keypoints", drawn([mask]), machine=machine)


@pytest.mark.parametrize("name", NAMES)
def test_double_sampling_removes_the_fixed_pattern(name: str) -> None:
    machine = load_machine("default")
    sensor = replace(machine.sensor, fixed_pattern=60, seed=3)
    frames = np.where(np.array([scene(seed) for seed in range(6)]), 150, 60).astype(np.uint8)
    assert_exact(name, frames, 100, machine=replace(machine, name="offsets", sensor=sensor))


# ---- recognise.s

DEFAULT_REFERENCE = (128, 83, 96)


def assert_recognised(
    frames: Frames,
    references: NDArray[np.uint8] | None = None,
    how: Literal["shifts", "thesis"] = "shifts",
    threshold: int = 128,
    tolerance: int = 8,
) -> list[int]:
    """Compare all outputs of recognise.s with the host; returns what matched."""
    defines = {"THRESHOLD": threshold, "TOLERANCE": tolerance, "SHIFTS": int(how == "shifts")}
    chip = chip_with("recognise", defines=defines)
    stored: list[tuple[int, ...]] = [DEFAULT_REFERENCE] * 80
    if references is not None:
        chip.load_memory(176, references)
        stored = [tuple(three) for three in references.reshape(3, 80).T.tolist()]
    known = [number for number, three in enumerate(stored) if three[0]]
    result = chip.run(frames)
    assert result.status == "frames-exhausted", result.error
    matched: list[int] = []
    for index, frame in enumerate(frames):
        found = find_key_points(object_mask(frame, threshold))
        sides: list[int] = []
        matches, distances = [], []
        for points in found:
            match = None
            nearest = 255
            if len(points) == 3:
                lengths = side_lengths(points, how)
                sides += scaled(lengths)
                nearer = best_match(lengths, [stored[number] for number in known], 255)
                assert nearer is not None
                nearest = nearer.distance
                match = best_match(lengths, [stored[number] for number in known], tolerance)
            matches.append(known[match.number] if match else 255)
            distances.append(nearest)
        assert result.outputs["objects"][index] == len(found)
        assert sent(result.outputs["count"][index]) == [len(points) for points in found]
        assert sent(result.outputs["sides"][index]) == sides
        assert sent(result.outputs["match"][index]) == matches
        assert sent(result.outputs["distance"][index]) == distances
        matched += matches
    return matched


def random_references(seed: int, present: float) -> NDArray[np.uint8]:
    """Scaled sides of random triangles for some of the NPs; 0 for the others."""
    rng = np.random.default_rng(seed)
    references = np.zeros((3, 80), np.uint8)
    for number in range(80):
        if rng.random() < present:
            corners = random_triangle(rng, "acute" if rng.random() < 0.5 else "obtuse")
            references[:, number] = scaled(side_lengths([(int(r), int(c)) for r, c in corners]))
    references[0, 79] = max(references[0, 79], 1)  # at least one
    return references.reshape(3, 8, 10)


@pytest.mark.parametrize("first", range(0, SCENES, CHUNK))
@pytest.mark.parametrize("how", ["shifts", "thesis"])
def test_recognition_on_random_scenes(first: int, how: Literal["shifts", "thesis"]) -> None:
    masks = [scene(seed) for seed in range(first, first + CHUNK)]
    masks = [mask for mask in masks if len(trace_edges(mask)) < 256]
    present = (0.05, 0.5, 1.0)[first // CHUNK % 3]
    references = random_references(first, present)
    matched = assert_recognised(drawn(masks), references, how, tolerance=(8, 20)[first % 2])
    assert present < 1 or set(matched) != {255}


def test_recognition_without_scanned_references() -> None:
    assert_recognised(drawn([scene(seed) for seed in range(12)]))


def test_the_triangle_of_the_photograph_and_nothing_else_is_recognised() -> None:
    photo = bundled_clips()["shapes_photo"]
    for threshold in (170, 180, 190, 200):
        assert assert_recognised(photo, threshold=threshold) == [0, 255, 255, 255]


def test_a_mirror_image_is_another_triangle() -> None:
    rng = np.random.default_rng(4)
    vertices = random_triangle(rng, "obtuse", (50, 60))
    mask = raster(vertices)
    (points,) = find_key_points(mask)
    references = np.zeros((3, 8, 10), np.uint8)
    references[:, 5, 7] = scaled(side_lengths(points))
    mirrored = mask[:, ::-1]
    turned = mask[::-1, ::-1]
    assert assert_recognised(drawn([mask, mirrored, turned]), references) == [57, 255, 57]


def test_the_cycle_budget_of_the_farthest_points_holds() -> None:
    chip = chip_with("keypoints_farthest")
    masks = [scene(seed) for seed in range(60)]
    assert chip.program.budget.cycles is not None
    most = int(chip.run(drawn(masks)).frame_cycles.max())
    assert 7_200 < most <= chip.program.budget.cycles


@pytest.mark.parametrize("name", ["keypoints", "recognise"])
def test_the_cycle_budget_of_the_tracer_is_reached(name: str) -> None:
    chip = chip_with(name)
    mask = np.ones((64, 80), bool)
    mask[1::2, 1::2] = False
    result = chip.run(drawn([mask]))
    assert int(result.frame_cycles[0]) == chip.program.budget.cycles
    if name == "keypoints":
        assert_exact(name, drawn([mask]))
