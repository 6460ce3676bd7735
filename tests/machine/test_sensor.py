"""The sensor against plain integers. `test_noise` beside it judges its statistics."""

from __future__ import annotations

import numpy as np
import pytest

from npchip.machine import Sensor
from npchip.machine.layout import to_planes
from npchip.machine.sensor import SensorModel
from tests.oracles.sensor import reading, step

ROWS, COLS = 64, 80


def model(fixed_pattern: int = 0, noise_rms: float = 0, seed: int = 1) -> SensorModel:
    return SensorModel(Sensor(fixed_pattern, noise_rms, seed), ROWS // 8, COLS // 8)


def test_splitmix_is_the_published_one() -> None:
    # First outputs for seed 1234567, as in the test vectors of Rosetta Code and of the authors.
    assert step(1234567, 0) == 6457827717110365317
    assert step(1234567, 0x9E3779B97F4A7C15) == 3203168211198807973


SENSORS = [
    Sensor(0, 0, 1),
    Sensor(20, 0, 1),
    Sensor(0, 3, 7),
    Sensor(255, 32, 2**32 - 1),
    Sensor(0, 0, 1, light=0.6),
    Sensor(90, 2, 1, light=2.5),
]


@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize(("frame", "conversion"), [(0, 0), (1, 0), (1, 1), (100_000, 3)])
def test_equals_plain_integers(sensor: Sensor, frame: int, conversion: int) -> None:
    scene = np.random.default_rng(4).integers(0, 256, (ROWS, COLS), np.uint8)
    wanted = np.array(reading(sensor, scene.tolist(), frame, conversion), np.uint8)
    chip = SensorModel(sensor, ROWS // 8, COLS // 8)
    assert (chip.sample(True, to_planes(scene), frame, conversion) == to_planes(wanted)).all()


def test_pinned_values() -> None:
    """The numbers of version 1: a change of these changes everybody's results."""
    chip = model(40, 4.0, 1)
    assert chip.offsets[0, 0, :8].tolist() == PINNED_OFFSETS
    assert chip.noise(0, 0)[0, 0, :8].tolist() == PINNED_NOISE
    assert chip.noise(5, 1)[63, 7, :8].tolist() == PINNED_LATER


PINNED_OFFSETS = [15, 7, 15, 18, 19, 9, 27, 40]
PINNED_NOISE = [0, 5, 4, 3, -3, 6, -1, 1]
PINNED_LATER = [-4, 3, -2, -2, -2, -5, 5, 1]


def test_ideal_sensor_passes_the_frame_through() -> None:
    chip = model()
    pixels = np.random.default_rng(5).integers(0, 256, (64, 8, 10), np.uint8)
    assert chip.ideal
    assert chip.sample(True, pixels, 0, 0) is pixels
    assert not chip.sample(False, pixels, 0, 1).any()
    assert not chip.sample(True, None, 0, 0).any()


def test_before_any_exposure_the_signal_is_dark() -> None:
    chip = model(30)
    assert (chip.sample(True, None, 0, 0) == chip.offsets).all()
    assert (chip.sample(False, None, 0, 0) == chip.offsets).all()


def test_reset_ignores_the_light() -> None:
    chip = model(30, 2)
    bright = np.full((64, 8, 10), 200, np.uint8)
    dark = np.zeros((64, 8, 10), np.uint8)
    assert (chip.sample(False, bright, 3, 0) == chip.sample(False, dark, 3, 0)).all()


def test_noise_is_repeatable() -> None:
    assert (model(noise_rms=5).noise(9, 2) == model(noise_rms=5).noise(9, 2)).all()


def test_double_sampling_removes_offsets_where_nothing_saturates() -> None:
    chip = model(60)
    pixels = to_planes(np.random.default_rng(6).integers(0, 256, (ROWS, COLS), np.uint8))
    reset = chip.sample(False, pixels, 1, 0)
    signal = chip.sample(True, pixels, 1, 1)
    whole = pixels.astype(int) + chip.offsets <= 255
    assert 0 < whole.sum() < whole.size
    assert (signal.astype(int) - reset == pixels)[whole].all()
    assert (signal[~whole] == 255).all()


def test_results_are_not_to_be_written_to() -> None:
    chip = model(9)
    with pytest.raises(ValueError, match="read-only"):
        chip.offsets[0] = 1
    with pytest.raises(ValueError, match="read-only"):
        model().sample(False, None, 0, 0)[0] = 1
