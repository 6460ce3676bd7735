"""The sensor against plain integers, and against what its statistics should be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip.machine import Sensor
from npchip.machine.layout import to_planes
from npchip.machine.sensor import SensorModel

ROWS, COLS = 64, 80


def model(fixed_pattern: int = 0, noise_rms: float = 0, seed: int = 1) -> SensorModel:
    return SensorModel(Sensor(fixed_pattern, noise_rms, seed), ROWS // 8, COLS // 8)


def splitmix(state: int) -> int:
    """SplitMix64's output for a state, written out independently of the package."""
    state = (state + 0x9E3779B97F4A7C15) % 2**64
    state = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) % 2**64
    state = ((state ^ (state >> 27)) * 0x94D049BB133111EB) % 2**64
    return state ^ (state >> 31)


def plain_offset(sensor: Sensor, pixel: int) -> int:
    top = splitmix(splitmix(sensor.seed) + pixel) // 2**48
    return top * (sensor.fixed_pattern + 1) // 2**16


def plain_noise(sensor: Sensor, frame: int, conversion: int, pixel: int) -> int:
    key = sensor.seed
    for value in (1, frame, conversion):
        key = splitmix(key + value)
    h = (pixel + key) % 2**32
    h = (h ^ h >> 16) * 0x7FEB352D % 2**32
    h = (h ^ h >> 15 ^ key >> 32) * 0x846CA68B % 2**32
    h ^= h >> 16
    scale = math.floor(sensor.noise_rms * 32768 / 147.8 + 0.5)
    return ((sum(h.to_bytes(4, "little")) - 510) * scale + 16384) // 32768


def test_splitmix_is_the_published_one() -> None:
    # First outputs for seed 1234567, as in the test vectors of Rosetta Code and of the authors.
    assert splitmix(1234567) == 6457827717110365317
    assert splitmix(1234567 + 0x9E3779B97F4A7C15) == 3203168211198807973


SENSORS = [Sensor(0, 0, 1), Sensor(20, 0, 1), Sensor(0, 3, 7), Sensor(255, 32, 2**32 - 1)]


@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize(("frame", "conversion"), [(0, 0), (1, 0), (1, 1), (100_000, 3)])
def test_equals_plain_integers(sensor: Sensor, frame: int, conversion: int) -> None:
    scene = np.random.default_rng(4).integers(0, 256, (ROWS, COLS), np.uint8)
    wanted = np.empty((ROWS, COLS), np.uint8)
    for row in range(ROWS):
        for col in range(COLS):
            pixel = row * COLS + col
            level = plain_offset(sensor, pixel) + plain_noise(sensor, frame, conversion, pixel)
            wanted[row, col] = min(max(level + int(scene[row, col]), 0), 255)
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


@pytest.mark.parametrize("largest", [1, 20, 255])
def test_offsets_are_uniform(largest: int) -> None:
    counts = np.zeros(largest + 1)
    for seed in range(20):
        counts += np.bincount(model(largest, seed=seed).offsets.ravel(), minlength=largest + 1)
    expected = 20 * ROWS * COLS / (largest + 1)
    chi_square = float(((counts - expected) ** 2 / expected).sum())
    assert abs(chi_square - largest) < 5 * math.sqrt(2 * largest)


@pytest.mark.parametrize("rms", [0.0, 0.5, 1.0, 3.0, 10.0, 32.0])
def test_noise_has_the_stated_mean_and_rms(rms: float) -> None:
    samples = noises(model(noise_rms=rms), frames=40)
    rounded = math.sqrt(rms**2 + 1 / 12) if rms else 0.0
    assert abs(samples.mean()) < 5 * rounded / math.sqrt(samples.size) + 1e-9
    assert samples.std() == pytest.approx(rounded, rel=0.01)
    assert abs(samples).max() <= 3.46 * rms + 0.5


def noises(chip: SensorModel, frames: int) -> NDArray[np.int32]:
    return np.array([chip.noise(frame, 0) for frame in range(frames)])


def test_noise_of_frames_conversions_pixels_and_seeds_is_independent() -> None:
    one, other = model(noise_rms=10), model(noise_rms=10, seed=2)
    pairs = [
        (one.noise(0, 0), one.noise(1, 0)),
        (one.noise(0, 0), one.noise(0, 1)),
        (one.noise(0, 1), one.noise(1, 0)),
        (one.noise(0, 0), other.noise(0, 0)),
        (one.noise(0, 0), one.noise(2**31, 0)),
        (one.noise(0, 0)[1:], one.noise(0, 0)[:-1]),
        (one.noise(0, 0)[:, 1:], one.noise(0, 0)[:, :-1]),
    ]
    for first, second in pairs:
        correlation = np.corrcoef(first.ravel(), second.ravel())[0, 1]
        assert abs(correlation) < 5 / math.sqrt(first.size)


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
