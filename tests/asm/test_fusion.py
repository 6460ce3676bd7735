"""`asm/sighting.s` and `asm/fusion_lut.s` against plain integers, boxes and the host's library."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip import Chip, Machine, RunResult, assemble, load_machine
from npchip.base.errors import InputError
from npchip.engines.base import Request
from npchip.host.rig import ON_ARRAY, definitions, entries
from npchip.host.rig.array import ENTRIES
from npchip.host.vision.fusion import CHIP, Camera, Rig, Status, load_rig, locate
from tests.oracles.fusion_words import Sighting, position
from tests.support.clips import bundled_clips, synthetic_clip

ROOT = Path(__file__).parents[2]
ASM = ROOT / "asm"
RIG = load_rig(ROOT / "examples" / "rigs" / "chip.yaml")
POSITIONS = 1_200
Bytes = NDArray[np.uint8]
Ints = NDArray[np.int64]


@cache
def machine_of(rows: int = 8, cols: int = 10) -> Machine:
    default = load_machine("default")
    shape = (rows, cols)
    return default if shape == (8, 10) else replace(default, name="x", np_rows=rows, np_cols=cols)


def drawn(seen: Ints, machine: Machine) -> Bytes:
    """Frames with an object whose first + last row and column are given, shape (T, 2)."""
    clip = np.zeros((len(seen), machine.rows, machine.cols), np.uint8)
    for frame, (row, col) in zip(clip, seen, strict=True):
        frame[row // 2 : (row + 1) // 2 + 1, col // 2 : (col + 1) // 2 + 1] = 255
    return clip


def run(rig: Rig, seen: Ints, algorithm: str, engine: Any = "auto") -> RunResult:
    """Run `fusion_lut.s` on sightings (row, col, other), shape (T, 3)."""
    machine = machine_of(rig.camera1.rows // 8, rig.camera1.cols // 8)
    program = assemble(ASM / "fusion_lut.s", machine, definitions(rig, algorithm))
    chip = Chip(program, machine, engine)
    chip.load_memory(ENTRIES, entries(rig, machine))

    def partner(request: Request) -> Bytes:
        value = {0: 1, 2: seen[request.frame, 2]}[request.port]
        return np.full(machine.geometry, value, np.uint8)

    chip.connect(partner)
    result = chip.run(drawn(seen[:, :2], machine))
    assert result.status == "frames-exhausted"
    np.testing.assert_array_equal(result.outputs["seen"], 3)
    np.testing.assert_array_equal(result.outputs["twice_row"], seen[:, 0])
    np.testing.assert_array_equal(result.outputs["twice_col"], seen[:, 1])
    return result


def assert_positions(rig: Rig, seen: Ints, algorithm: str, result: RunResult) -> int:
    """Hold a result against fractions and the host's library; return how many are valid."""
    valid = result.outputs["valid"] == 1
    found = np.stack([result.outputs[name] for name in "xyz"], -1).astype(np.int16)
    for k, each in enumerate(seen):
        expected = position(rig, Sighting(*map(int, each)), ON_ARRAY[algorithm])
        assert (tuple(found[k]) if valid[k] else None) == expected, each
    assert not found[~valid].any()
    pixels = seen / 2
    two = np.stack([0 * pixels[:, 2], pixels[:, 2]], -1)
    host = locate(rig, pixels[:, :2], two, algorithm, CHIP)
    ahead = host.status != Status.BEHIND  # which the chip does not look at: the rig marks it
    np.testing.assert_array_equal(valid[ahead], host.valid[ahead])
    assert host.raw is not None
    np.testing.assert_array_equal(found[host.valid], host.raw[host.valid])
    return int(valid.sum())


def sightings(rig: Rig, count: int, seed: int) -> Ints:
    """Random sightings, those at the corners of the frame among them."""
    high = [2 * rig.camera1.rows - 1, 2 * rig.camera1.cols - 1, 2 * rig.camera2.cols - 1]
    seen = np.random.default_rng(seed).integers(0, high, (count, 3))
    seen[:8] = [[(k >> n & 1) * (high[n] - 1) for n in range(3)] for k in range(8)]
    return seen


def test_every_position_is_that_of_the_host() -> None:
    seen = sightings(RIG, POSITIONS, 1)
    result = run(RIG, seen, "improved-2n")
    assert assert_positions(RIG, seen, "improved-2n", result) == POSITIONS
    assert len(np.unique(seen[:, 1:] // 16, axis=0)) == 100  # every entry of the table


@pytest.mark.parametrize("algorithm", ON_ARRAY)
def test_the_reference_engine_and_every_algorithm(algorithm: str) -> None:
    seen = sightings(RIG, 40, 2)
    result = run(RIG, seen, algorithm, "reference")
    assert assert_positions(RIG, seen, algorithm, result) == 40


def rig_of(seed: int, rows: int, cols: int) -> Rig:
    """A rig that may be hard to see anything with."""
    rng = np.random.default_rng(seed)
    places = rng.uniform(-7.99, 7.99, (2, 3)).round(3).tolist()
    ratio = 2.0 ** int(rng.integers(2, 11))
    size: dict[str, Any] = {"rows": rows, "cols": cols, "ratio": ratio}
    one, two = ((f"{'+-'[int(rng.integers(2))]}{axis}") for axis in "yx")
    return Rig(
        camera1=Camera(position=tuple(places[0]), looks=one, **size),  # type: ignore[arg-type]
        camera2=Camera(position=tuple(places[1]), looks=two, **size),  # type: ignore[arg-type]
    )


@pytest.mark.parametrize(
    ("seed", "rows", "cols"), [(1, 64, 80), (4, 64, 80), (3, 80, 80), (12, 24, 56), (5, 8, 8)]
)
def test_other_rigs_and_arrays(seed: int, rows: int, cols: int) -> None:
    """Marks of overflows and of rays that do not meet are those of the host, too."""
    rig = rig_of(seed, rows, cols)
    algorithm = list(ON_ARRAY)[seed % 3]
    seen = sightings(rig, 24, seed)
    found = assert_positions(rig, seen, algorithm, run(rig, seen, algorithm, "reference"))
    assert found < 24  # something does not fit, or does not meet


def test_the_oracle_and_the_host_agree_on_many_rigs() -> None:
    valid = 0
    for seed in range(60):
        rig = rig_of(seed, 64, 80)
        seen = sightings(rig, 30, seed)
        two = np.stack([0 * seen[:, 2], seen[:, 2]], -1) / 2
        for algorithm, rounds in ON_ARRAY.items():
            host = locate(rig, seen[:, :2] / 2, two, algorithm, CHIP)
            for k in np.flatnonzero(host.status != Status.BEHIND):
                expected = position(rig, Sighting(*map(int, seen[k])), rounds)
                assert host.raw is not None
                assert (tuple(host.raw[k]) if host.valid[k] else None) == expected
                valid += bool(host.valid[k])
    assert valid > 500


def test_what_one_camera_sees_alone_is_said() -> None:
    machine = machine_of()
    chip = Chip(assemble(ASM / "fusion_lut.s"), engine="reference")
    chip.load_memory(ENTRIES, entries(RIG, machine))
    others = (0, 1, 0, 1)

    def partner(request: Request) -> Bytes:
        return np.full(machine.geometry, others[request.frame] * (1 + request.port), np.uint8)

    chip.connect(partner)
    clip = drawn(np.array([[9, 30]] * 4), machine)
    clip[2:] = 0
    result = chip.run(clip)
    assert result.outputs["seen"].tolist() == [1, 3, 0, 2]
    assert result.outputs["valid"].tolist() == [0, 1, 0, 0]
    assert result.outputs["twice_col"].tolist() == [30, 30, 0, 0]
    for name in "xyz":
        assert result.outputs[name][[0, 2, 3]].tolist() == [0, 0, 0]


def test_the_template_is_the_table_of_the_example() -> None:
    template = np.load(ROOT / "examples" / "templates" / "fusion_chip.npy")
    np.testing.assert_array_equal(template, entries(RIG, machine_of()))
    defaults = assemble(ASM / "fusion_lut.s").symbols
    for name, value in definitions(RIG).items():
        assert defaults[name] == value, name


def test_arrays_beyond_24_bits_are_refused() -> None:
    with pytest.raises(Exception, match=r"NP_COLS <= 10 .* 24"):
        assemble(ASM / "fusion_lut.s", machine_of(8, 11))


# ---- sighting.s


def boxes(clip: Bytes, threshold: int, *, dark: bool) -> list[tuple[int, int, int]]:
    found = []
    for frame in clip:
        rows, cols = np.nonzero(frame < threshold if dark else frame >= threshold)
        here = (1, rows.min() + rows.max(), cols.min() + cols.max()) if rows.size else (0, 0, 0)
        found.append(tuple(map(int, here)))
    return found  # type: ignore[return-value]  # three each


@pytest.mark.parametrize(
    ("threshold", "dark"), [(1, 0), (128, 0), (255, 0), (1, 1), (40, 1), (255, 1)]
)
@pytest.mark.parametrize("fixed_pattern", [0, 60])
def test_sightings_on_random_and_real_clips(threshold: int, dark: int, fixed_pattern: int) -> None:
    machine = machine_of()
    sensor = replace(machine.sensor, fixed_pattern=fixed_pattern)
    machine = replace(machine, name="x", sensor=sensor)
    noise = np.random.default_rng(threshold).integers(0, 256, (4, 64, 80), np.uint8)
    sparse = np.where(np.random.default_rng(dark).random((90, 64, 80)) < 0.001, 255, 0)
    real = [clip[:20] for clip in bundled_clips().values()] if not fixed_pattern else []
    drawn = [synthetic_clip(threshold, frames=8), noise, sparse.astype(np.uint8)]
    clip = np.concatenate([*drawn, *real])
    clip = np.minimum(clip, 255 - fixed_pattern)  # beyond, the conversion clips
    defines = {"THRESHOLD": threshold, "DARK": dark}
    program = assemble(ASM / "sighting.s", machine, defines)
    result = Chip(program, machine).run(clip)
    found = zip(*(result.outputs[n] for n in ("seen", "twice_row", "twice_col")), strict=True)
    assert [tuple(map(int, each)) for each in found] == boxes(clip, threshold, dark=bool(dark))


# ---- what the array cannot do


def changed(**values: Any) -> Rig:
    return replace(RIG, camera1=replace(RIG.camera1, **values))


@pytest.mark.parametrize(
    ("rig", "algorithm", "code", "part"),
    [
        (RIG, "vector", "NP522", "vector is not among"),
        (changed(ratio=65), "improved-2n", "NP522", "ratios of 65 and 64 pixels"),
        (changed(ratio=32), "improved-2n", "NP522", "ratios of 32 and 64 pixels"),
        (changed(ratio=2.0**15), "improved-2n", "NP522", "up to 16384"),
        (changed(position=(8.0, 0, 0)), "improved-2n", "NP522", "camera1: x = 8 m does not fit"),
        (changed(position=(0, 0, -8.1)), "keep-y", "NP522", "camera1: z = -8.1 m does not fit"),
    ],
)
def test_what_the_array_cannot_compute(rig: Rig, algorithm: str, code: str, part: str) -> None:
    with pytest.raises(InputError) as caught:
        definitions(rig, algorithm)
    assert caught.value.code == code
    assert part in caught.value.message
    assert "--link host" in (caught.value.hint or "")


@pytest.mark.parametrize(
    ("rig", "part"),
    [
        (changed(cols=72), "camera1 of the rig has 64 x 72 pixels"),
        (replace(RIG, cell=16), "the rig's cell has 16 pixels, but an NP has 8"),
    ],
)
def test_cameras_that_are_no_such_arrays(rig: Rig, part: str) -> None:
    with pytest.raises(InputError) as caught:
        entries(rig, machine_of())
    assert caught.value.code == "NP523"
    assert part in caught.value.message
