"""asm/polygons.s: number for number as npchip.host.vision.outlines, on clips and random scenes.

Quick runs take dozens of random scenes; NPCHIP_PROFILE=thorough takes more than 1,000.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import AssemblyError, Chip, Machine, assemble, load_machine
from npchip.host.vision.keypoints import object_mask
from npchip.host.vision.outlines import corners, find_outlines, is_regular, objects
from npchip.host.vision.polygons import Mask, random_convex_polygon, random_regular_polygon, raster
from tests.support.clips import bundled_clips
from tests.support.masks import drawn, rectangles
from tests.support.masks import scene as tracer_scene
from tests.support.profiles import THOROUGH
from tests.support.programs import assembled, chip_with

if TYPE_CHECKING:
    from npchip import RunResult

ASM = Path(__file__).parents[2] / "asm"
CHUNK = 50 if THOROUGH else 10
SCENES = 1_500 if THOROUGH else 60
ROWS, COLS = np.indices((64, 80))


def assert_exact(result: RunResult, masks: list[Mask]) -> None:
    """Compare all outputs of all frames with the model."""
    assert result.status == "frames-exhausted", result.error
    for index, mask in enumerate(masks):
        found = find_outlines(mask)
        expected = {
            "count": [len(each) for each in found],
            "regular": [int(is_regular(each)) for each in found],
            "points": [place for each in found for point in each for place in point],
        }
        assert result.outputs["objects"][index] == min(len(found), 255)
        assert {name: result.outputs[name][index] or [] for name in expected} == expected


def scene(seed: int) -> Mask:
    """A scene of the tracers' tests, or a ring with a polygon in it."""
    if seed % 4:
        return tracer_scene(seed)
    rng = np.random.default_rng(seed)
    ring = random_regular_polygon(rng, int(rng.integers(3, 10)), (20, 30))
    middle = ring.mean(axis=0)
    inside = (ring - middle) * rng.uniform(0.2, 0.9) + middle
    core = (ring - middle)[::-1] * rng.uniform(0.1, 0.9) * [1, -1] + middle
    mask: Mask = raster(ring) & ~raster(inside) | raster(core)
    return mask


@pytest.mark.parametrize("first", range(0, SCENES, CHUNK))
def test_random_scenes(first: int) -> None:
    masks = [scene(seed) for seed in range(first, first + CHUNK)]
    assert_exact(chip_with("polygons").run(drawn(masks)), masks)


def test_scenes_are_varied() -> None:
    found = [each for seed in range(60) for each in find_outlines(scene(seed))]
    assert {3, 4, 5, 6, 7, 8} <= {len(each) for each in found}
    assert 5 < sum(map(is_regular, found)) < len(found) - 5


def test_both_engines_agree() -> None:
    masks = [scene(seed) for seed in range(3)]
    result = Chip(assembled("polygons"), engine="reference").run(drawn(masks))
    assert_exact(result, masks)
    other = chip_with("polygons").run(drawn(masks))
    assert result.frame_cycles.tolist() == other.frame_cycles.tolist()


@pytest.mark.parametrize(
    "defines",
    [
        {"TOLERANCE": 1, "MERGE": 0, "LAPS": 1},
        pytest.param({"TOLERANCE": 1, "MERGE": 2, "LAPS": 8}, marks=pytest.mark.long),
        {"TOLERANCE": 8, "MERGE": 127, "LAPS": 2},
        {"TOLERANCE": 3, "MERGE": 6, "LAPS": 3},
    ],
)
def test_other_constants(defines: dict[str, int]) -> None:
    masks = [scene(seed) for seed in (0, 1, 2, 3, 7, 8)]
    result = chip_with("polygons", defines=defines).run(drawn(masks))
    for index, mask in enumerate(masks):
        found = [corners(each, *defines.values()) for each in objects(mask)]
        counts = [len(each) for each in found if each]
        assert (result.outputs["count"][index] or []) == counts
        sent = result.outputs["points"][index] or []
        assert sent == [place for each in found for point in each for place in point]


@pytest.mark.parametrize(
    ("name", "values"), [("TOLERANCE", (0, 9)), ("LAPS", (0, 9)), ("MERGE", (-1, 128))]
)
def test_constants_that_the_head_excludes_are_refused(name: str, values: tuple[int, int]) -> None:
    for value in values:
        with pytest.raises(AssemblyError, match=f"{name} must be"):
            assemble(ASM / "polygons.s", defines={name: value})


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("threshold", [100, 128, 190])
@pytest.mark.parametrize("clip", ["shapes_photo", "shapes_drawn"])
def test_pictures_of_shapes(clip: str, threshold: int, dark: bool) -> None:
    frames = bundled_clips()[clip]
    result = chip_with("polygons", defines={"THRESHOLD": threshold, "DARK": int(dark)}).run(frames)
    assert_exact(result, [object_mask(frame, threshold, dark=dark) for frame in frames])


@pytest.mark.parametrize("clip", ["ball_fall_30000fps", "city_night", "coin_slide", "mouse_run"])
def test_clips(clip: str) -> None:
    frames = bundled_clips()[clip]
    frames = frames if THOROUGH else frames[::15]
    result = chip_with("polygons").run(frames)
    assert_exact(result, [object_mask(frame) for frame in frames])


def test_corners_and_borders() -> None:
    masks = [*rectangles(), np.eye(64, 80, dtype=bool), np.zeros((64, 80), bool)]
    assert_exact(chip_with("polygons").run(drawn(masks)), masks)


def test_a_disc_has_more_corners_than_have_a_place() -> None:
    """With a tolerance of a pixel, on 184 x 168 pixels, the list of corners is full."""
    machine = array(23, 21)
    rows, cols = np.indices((184, 168))
    disc = (rows - 90) ** 2 + (cols - 84) ** 2 <= 83**2
    defines = {"TOLERANCE": 1, "MERGE": 0, "LAPS": 1}
    result = chip_with("polygons", machine, defines).run(drawn([disc]))
    (found,) = (corners(each, 1, 0, 1) for each in objects(disc))
    assert [len(corners(each, 1, 0, 0)) for each in objects(disc)] == [32]
    assert result.outputs["count"][0] == [len(found)]
    assert result.outputs["points"][0] == [place for point in found for place in point]


def array(np_rows: int, np_cols: int) -> Machine:
    return replace(load_machine("default"), name="other", np_rows=np_rows, np_cols=np_cols)


def test_double_sampling_removes_the_fixed_pattern() -> None:
    machine = load_machine("default")
    sensor = replace(machine.sensor, fixed_pattern=60, seed=3)
    masks = [scene(seed) for seed in range(6)]
    frames = np.where(np.array(masks), 150, 60).astype(np.uint8)
    chip = chip_with("polygons", replace(machine, sensor=sensor), {"THRESHOLD": 100})
    assert_exact(chip.run(frames), masks)


def test_squares_pentagons_and_octagons_are_no_triangles() -> None:
    """One in 30 has a corner too many (docs/polygons.md), and none is taken for a triangle."""
    rng = np.random.default_rng(3)
    sides = [3, 4, 5, 6, 8] * 6
    regular = [raster(random_regular_polygon(rng, each, (18, 28))) for each in sides]
    convex = [raster(random_convex_polygon(rng, each)) for each in sides if each < 6]
    sent = chip_with("polygons").run(drawn(regular + convex)).outputs
    counts = np.array([count[0] for count in sent["count"]])
    wanted = np.array([*sides, *(each for each in sides if each < 6)])
    assert ((counts == 3) <= (wanted == 3)).all()
    assert (counts == wanted).mean() >= 0.9
    even = np.array([each[0] for each in sent["regular"]])
    right = counts == wanted
    assert even[: len(sides)][right[: len(sides)]].mean() >= 0.9
    assert even[len(sides) :].mean() <= 0.2


def test_the_cycle_budget_is_reached_by_a_chessboard_and_by_nothing_else() -> None:
    masks = [(ROWS + COLS) % 2 == 0]
    masks += [(ROWS // high + COLS // wide) % 2 == 0 for high in (1, 2, 3, 6) for wide in (1, 2, 5)]
    corridor = ROWS % 2 == 0
    corridor[1::4, -1] = corridor[3::4, 0] = True
    masks += [corridor, *(np.random.default_rng(k).random((64, 80)) < k / 10 for k in range(1, 9))]
    cycles = chip_with("polygons").run(drawn(masks)).frame_cycles
    budget = assembled("polygons").budget.cycles
    assert cycles.max() == cycles[0] == budget
    assert np.partition(np.unique(cycles), -2)[-2] < 0.9 * cycles[0]
