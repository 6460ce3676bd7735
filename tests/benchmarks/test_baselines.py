"""Baselines must compute the same as the chip, and measurements must be of what they name."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from benchmarks import arrays, baselines, noise, pictures
from benchmarks.arrays import grown, tiled
from benchmarks.measure import interleaved
from benchmarks.noise import CONVERSION, CONVERSIONS, noisy
from benchmarks.pictures import DRAWN
from benchmarks.programs import long_clip, made, sources
from npchip import assemble
from npchip.machine.layout import to_planes
from npchip.machine.sensor import SensorModel


def test_numpy_draws_the_pictures_of_the_program() -> None:
    clip = long_clip()[:40]
    (drawn,) = made(assemble(sources()["frame_difference"])).run(clip).outputs.values()
    np.testing.assert_array_equal(baselines.differences(clip), drawn)
    assert drawn.any()


@pytest.mark.long
@pytest.mark.parametrize("name", DRAWN["edges"])
def test_opencv_draws_the_pictures_of_the_program(name: str) -> None:
    pytest.importorskip("cv2")
    clip = np.random.default_rng(1).integers(0, 256, (20, 64, 80), np.uint8)
    (drawn,) = made(assemble(sources()["edges"])).run(clip).outputs.values()
    np.testing.assert_array_equal(DRAWN["edges"][name](clip), drawn)


def test_opencv_is_asked_for_in_a_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    monkeypatch.setattr(pictures, "DRAWN", {"edges": DRAWN["edges"]})
    with pytest.raises(SystemExit, match=r"pip install 'npchip\[benchmark\]'"):
        pictures.pictures(long_clip()[:2], 2)


def test_a_larger_array_sees_the_clip_side_by_side() -> None:
    clip = long_clip()[:2]
    frames = tiled(clip, grown(10, 15))
    assert frames.shape == (2, 80, 120)
    np.testing.assert_array_equal(frames[:, :64, :80], clip)
    np.testing.assert_array_equal(frames[:, 64:, 80:], clip[:, :16, :40])


@pytest.mark.parametrize("count", [1, CONVERSIONS])
def test_the_program_of_a_conversion_converts_as_often_as_it_says(count: int) -> None:
    """Else the compiled engine would seem faster than it is. Each conversion has other noise."""
    machine, clip = noisy(), long_clip()[:3]
    chip = made(noise.converting(count), machine=machine, engine="wasm")
    chip.run(clip)
    model = SensorModel(machine.sensor, machine.np_rows, machine.np_cols)
    last = model.sample(True, to_planes(clip[-1]), len(clip), count - 1)
    np.testing.assert_array_equal(chip.memory[:64], last)


def test_the_noisy_machine_is_the_one_of_the_documents() -> None:
    assert (noisy().sensor.noise_rms, noisy().sensor.fixed_pattern) == (5, 20)


@pytest.mark.long
def test_rows_of_noise_and_of_arrays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(noise, "SECONDS", 0.001)
    for module in (noise, arrays):
        monkeypatch.setattr(module, "interleaved", lambda works, *_: interleaved(works, 1))
    monkeypatch.setattr(noise, "sources", lambda: {"imaging": sources()["imaging"]})
    monkeypatch.setattr(arrays, "SECONDS", 0.001)
    monkeypatch.setattr(arrays, "SHAPES", ((8, 10), (16, 20)))
    clip = long_clip()[:60]
    found = noise.noise(clip)
    assert list(found) == [CONVERSION, "imaging"]
    assert 0 < found[CONVERSION]["part of NumPy"] < 1
    rows = arrays.arrays(clip)
    assert list(rows) == [
        f"{n}, {s} NPs" for n in ("edges", "imaging") for s in ("8 x 10", "16 x 20")
    ]
    assert rows["edges, 8 x 10 NPs"]["times of the chip's"] == 1
