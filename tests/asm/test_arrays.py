"""The programs of asm/ on arrays of any size: the result of the oracle, or a refusal that says why.

A size that a program was not made for gave wrong results without a word.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip import AssemblyError, Chip, Machine, assemble, assemble_text, load_machine
from npchip.base.errors import InputError
from npchip.formats import load_program, write_program
from npchip.formats.npo import check_requirements
from npchip.host.rig import ON_ARRAY, definitions
from npchip.host.vision.follow import Follower, Sighting
from npchip.host.vision.follow_many import ManyFollower, Seen
from npchip.host.vision.foreground import Foreground
from npchip.host.vision.keypoints import farthest_points, find_key_points, object_mask
from npchip.host.vision.networks.files import bundled, load
from npchip.host.vision.orientation.corners import corner_pixels
from npchip.host.vision.orientation.eightbit import half_pixel_sides
from npchip.host.vision.outlines import find_outlines, is_regular
from npchip.host.vision.shapes import best_match, scaled, side_lengths
from npchip.program.model import Requirement
from tests.asm import test_filters, test_fusion
from tests.oracles import trajectory_prediction as prediction
from tests.oracles.tracking import tracking
from tests.oracles.trajectory import trajectory
from tests.support.clips import synthetic_clip
from tests.support.profiles import THOROUGH, parts

ASM = Path(__file__).parents[2] / "asm"
PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
SHARES = 15 if THOROUGH else 5
LIMITS = {
    "digits": [(8, 10), (8, 11), (9, 10), (8, 9)],
    "follow_many": [(28, 28), (29, 2), (2, 29), (1, 2), (2, 1)],
    "follow": [(28, 28), (29, 2), (2, 29), (1, 2), (2, 1)],
    "follow_large": [(2, 256), (256, 2), (1, 2), (2, 1)],
    "follow_many_large": [(2, 256), (256, 2), (1, 2), (2, 1)],
    "fusion_lut": [(10, 10), (11, 1), (1, 11)],
    "keypoints": [(31, 31), (32, 1), (1, 32)],
    "keypoints_farthest": [(32, 16), (16, 32), (33, 1), (1, 33), (23, 23)],
    "orientation": [(16, 16), (1, 31), (31, 1), (1, 32), (16, 17)],
    "polygons": [(22, 23), (23, 22), (24, 1), (1, 24), (23, 23)],
    "recognise": [(11, 11), (12, 1), (1, 12)],
    "sighting": [(16, 16), (17, 1), (1, 17)],
    "statistics": [(31, 33), (46, 22), (22, 46), (47, 1), (1, 47), (32, 32)],
    "tracking": [(31, 32), (32, 31), (32, 32), (33, 1), (1, 33)],
    "trajectory": [(32, 32), (33, 1), (1, 33)],
    "trajectory_mixed": [(32, 32), (33, 1), (1, 33)],
    "trajectory_nonlinear": [(32, 32), (33, 1), (1, 33)],
    "trajectory_robust": [(32, 32), (33, 1), (1, 33)],
    "trajectory_robust_large": [(2, 227), (227, 2), (2, 228), (228, 2)],
}
"""The largest arrays of each program, and the smallest beyond."""

LARGER = [
    *[(60, 80), (90, 160), (64, 65), (256, 17), (17, 256), (68, 120)],
    *[(128, 128), (33, 250), (250, 33), (180, 256)],
]

Frames = NDArray[np.uint8]


def machine_of(rows: int, cols: int) -> Machine:
    return replace(load_machine("default"), name=f"{rows} x {cols}", np_rows=rows, np_cols=cols)


def drawn_size(seed: int) -> tuple[int, int]:
    """At most 4,096 NPs: half of the arrays are small, the others of any shape."""
    rng = np.random.default_rng(seed)
    if seed % 2 == 0:
        return int(rng.integers(1, 34)), int(rng.integers(1, 34))
    rows = int(2 ** rng.uniform(0, 8))
    cols = int(2 ** rng.uniform(0, min(8, np.log2(4096 / rows))))
    return (rows, cols) if seed % 4 == 1 else (cols, rows)


def scenes(seed: int, rows: int, cols: int) -> Frames:
    """A clip, the whole frame, its opposite corners, and a triangle."""
    clip = synthetic_clip(seed, rows, cols, frames=4)
    rng = np.random.default_rng(seed)
    extreme = np.zeros((4, rows, cols), np.uint8)
    extreme[0] = 255
    extreme[1, 0, 0] = extreme[1, -1, -1] = 200
    y, x = np.ogrid[:rows, :cols]
    extreme[2] = 190 * (y * cols + x * rows < rows * cols * rng.uniform(0.3, 1.9))
    extreme[3, rows // 3 :, cols // 2 :] = 255
    return np.concatenate([clip, extreme])


def key_points(frames: Frames) -> dict[str, list[Any]]:
    found = [find_key_points(object_mask(frame, 128)) for frame in frames]
    return {
        "objects": [min(len(points), 255) for points in found],
        "count": [[len(points) for points in each] for each in found],
        "points": [[n for points in each for point in points for n in point] for each in found],
    }


def farthest(frames: Frames) -> dict[str, list[Any]]:
    found = [farthest_points(object_mask(frame, 128)) for frame in frames]
    return {
        "count": [len(points) for points in found],
        "points": [[n for point in points for n in point] for points in found],
    }


def recognised(frames: Frames) -> dict[str, list[Any]]:
    sent = key_points(frames)
    del sent["points"]
    sent |= {"sides": [], "match": [], "distance": []}
    for frame in frames:
        sides: list[int] = []
        matches, distances = [], []
        for points in find_key_points(object_mask(frame, 128)):
            best = None
            if len(points) == 3:
                lengths = side_lengths(points, "shifts")
                sides += scaled(lengths)
                best = best_match(lengths, [(128, 83, 96)], 255)
            distances.append(best.distance if best else 255)
            matches.append(0 if distances[-1] <= 8 else 255)
        sent["sides"].append(sides)
        sent["match"].append(matches)
        sent["distance"].append(distances)
    return sent


def read(frames: Frames) -> dict[str, Any]:
    network = load(bundled("digits"))
    scores = np.zeros((len(frames), 8, 10), np.int64)
    scores[:, -1] = network.scores(frames)
    sent = {"low": scores & 255, "high": scores >> 8 & 255}
    return {"digit": network.answers(frames), **sent}


def oriented(frames: Frames) -> dict[str, list[Any]]:
    """Without weights the distance is 0."""
    found = [corner_pixels(frame) for frame in frames]
    seen = [points is not None for points in found]
    return {
        "count": [3 * there for there in seen],
        "vertices": [[] if p is None else p.ravel().tolist() for p in found],
        "sides": [[] if p is None else half_pixel_sides(p[np.newaxis])[0].tolist() for p in found],
        "distance": [0] * len(frames),
    }


def outlined(frames: Frames) -> dict[str, Any]:
    found = [find_outlines(object_mask(frame)) for frame in frames]
    return {
        "objects": [min(len(each), 255) for each in found],
        "count": [[len(points) for points in each] for each in found],
        "regular": [[int(is_regular(points)) for points in each] for each in found],
        "points": [[v for points in each for point in points for v in point] for each in found],
    }


def sighted(frames: Frames) -> dict[str, list[int]]:
    found = np.array(test_fusion.boxes(frames, 128, dark=False))
    names = ("seen", "twice_row", "twice_col")
    return {name: found[:, k].tolist() for k, name in enumerate(names)}


def tracked(frames: Frames) -> dict[str, list[int]]:
    found = tracking(frames, 128)
    area = found.pop("area")
    return {**found, "area": [n % 65_536 for n in area], "area_high": [n >> 16 for n in area]}


def nonlinear(frames: Frames) -> dict[str, Any]:
    sent = prediction.trajectory_nonlinear(frames)
    return {**sent, "picture": prediction.nonlinear_picture(frames, sent)}


def followed(frames: Frames, *, large: bool = False) -> dict[str, list[int]]:
    model = Follower(large=large)
    found = [model.step(frame) for frame in frames]
    return {name: [getattr(one, name) for one in found] for name in Sighting._fields}


def followed_many(frames: Frames, *, large: bool = False) -> dict[str, list[Any]]:
    model = ManyFollower(large=large, foreground=Foreground(smooths=not large))
    found = [model.step(frame) for frame in frames]
    lists = {name: [[getattr(o, name) for o in each] for each in found] for name in Seen._fields}
    if large:
        for name in ("row", "col", "predicted_row", "predicted_col"):
            lists[f"{name}_high"] = [[value >> 8 for value in each] for each in lists[name]]
            lists[name] = [[value & 0xFF for value in each] for each in lists[name]]
    return {"count": [len(each) for each in found], **lists}


ORACLES: Mapping[str, Callable[[Frames], Mapping[str, Any]]] = {
    **{name: task.oracle for name, task in test_filters.TASKS.items() if "." not in name},
    "digits": read,
    "follow": followed,
    "follow_many": followed_many,
    "follow_large": partial(followed, large=True),
    "follow_many_large": partial(followed_many, large=True),
    "keypoints": key_points,
    "keypoints_farthest": farthest,
    "orientation": oriented,
    "polygons": outlined,
    "recognise": recognised,
    "sighting": sighted,
    "tracking_large": tracked,
    "trajectory": lambda frames: trajectory(frames, 32),
    "trajectory_large": lambda frames: trajectory(frames, 32),
    "trajectory_mixed": prediction.trajectory_mixed,
    "trajectory_nonlinear": nonlinear,
    "trajectory_robust": prediction.trajectory_robust,
    "trajectory_mixed_large": prediction.trajectory_mixed,
    "trajectory_nonlinear_large": nonlinear,
    "trajectory_robust_large": prediction.trajectory_robust,
}


def is_right(name: str, seed: int, rows: int, cols: int) -> bool:
    """Compare with the oracle; False if the program refuses the array and says why."""
    machine = machine_of(rows, cols)
    refused: AssemblyError | None = None
    try:
        program = assemble(ASM / f"{name}.s", machine)
    except AssemblyError as error:
        refused = error
    if refused is not None:
        assert {item.code for item in refused.diagnostics} == {"NP032"}
        assert "needs" in str(refused)
        assert "ROWS is" in str(refused) or "COLS is" in str(refused)
        return False
    if name == "fusion_lut":
        rig = test_fusion.rig_of(seed, 8 * rows, 8 * cols)
        algorithm = list(ON_ARRAY)[seed % 3]
        if definitions(rig, algorithm):
            seen = test_fusion.sightings(rig, 12, seed)
            result = test_fusion.run(rig, seen, algorithm)
            test_fusion.assert_positions(rig, seen, algorithm, result)
        return True
    chip = Chip(program, machine)
    if name == "correlate":
        chip.load_memory(test_filters.TEMPLATE, test_filters.template(rows, cols))
    frames = scenes(seed, 8 * rows, 8 * cols)
    result = chip.run(frames)
    assert result.status == "frames-exhausted", result.error
    for output, expected in ORACLES[name](frames).items():
        for index, value in enumerate(expected):
            found = result.value(output, index)
            same = (found if found is not None else np.zeros_like(value)) == np.asarray(value)
            assert np.all(same), (output, index)
    return True


@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("share", parts(1, SHARES))
def test_an_array_gives_the_right_result_or_a_refusal(name: str, share: int) -> None:
    is_right(name, share, *drawn_size(100 * PROGRAMS.index(name) + share))


@pytest.mark.long
@pytest.mark.parametrize("size", LARGER)
@pytest.mark.parametrize("name", PROGRAMS)
def test_arrays_of_more_than_4096_nps(name: str, size: tuple[int, int]) -> None:
    assert is_right(name, 1, *size) or name in LIMITS


@pytest.mark.long
@pytest.mark.parametrize("name", LIMITS)
def test_the_limits_are_neither_too_wide_nor_too_narrow(name: str) -> None:
    first, *others = LIMITS[name]
    assert is_right(name, 3, *first)
    for seed, size in enumerate(others):
        is_right(name, seed, *size)
    assert not is_right(name, 0, *others[-1])


def test_a_limit_is_named_and_what_follows_from_it_is_not_reported() -> None:
    """Only "expected a number from -128 to 255, found 479" was said."""
    with pytest.raises(AssemblyError) as caught:
        assemble(ASM / "trajectory.s", machine_of(60, 80))
    assert "NP_ROWS <= 32 (the number of a row of pixels has 8 bits), but NP_ROWS is 60" in str(
        caught.value
    )
    assert {item.code for item in caught.value.diagnostics} == {"NP032"}


def test_an_object_is_checked_for_the_machine_that_loads_it(tmp_path: Path) -> None:
    """A loaded object named the array that it was assembled for, and not its limit."""
    source = '.equ N, 3\n.require (NP_ROWS + N) <= 12, "a sum has 4 bits"\n.require N, "x"\n HALT'
    program = assemble_text(source)
    assert program.requirements == (Requirement("(NP_ROWS + 3) <= 12", "a sum has 4 bits"),)
    file = tmp_path / "p.npo"
    write_program(program, file)
    assert load_program(file) == program
    with pytest.raises(InputError) as caught:
        load_program(file, machine_of(10, 10))
    assert caught.value.code == "NP032"
    assert "needs (NP_ROWS + 3) <= 12 (a sum has 4 bits), but NP_ROWS is 10" in str(caught.value)


@pytest.mark.parametrize("condition", ["", "HUGO", "1 +", "1 2", "'", "NP_ROWS <", "1 / 0", "é"])
def test_a_damaged_condition_of_an_object_is_an_error(condition: str) -> None:
    program = replace(assemble_text(" HALT"), requirements=(Requirement(condition, "x"),))
    with pytest.raises(InputError) as caught:
        check_requirements(program, load_machine("default"), "p.npo")
    assert caught.value.code == "NP111"


@pytest.mark.parametrize(
    "line",
    [
        ".require",
        ".require 1",
        '.require "x"',
        '.require , "x"',
        '.require 1, "x", 2',
        '.require 1, "x" 2',
        ".require 1, x",
    ],
)
def test_a_malformed_requirement_is_an_error(line: str) -> None:
    with pytest.raises(AssemblyError) as caught:
        assemble_text(f"{line}\n HALT")
    assert {item.code for item in caught.value.diagnostics} == {"NP011"}
