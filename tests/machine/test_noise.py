"""Statistics of the fixed pattern and of the noise.

All numbers come from fixed seeds, so each test holds always or never. A limit is five times the
error that so many independent numbers would have, which one of two million experiments exceeds;
a chi-square of n degrees of freedom has mean n and variance 2 n.
"""

from __future__ import annotations

import math
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.machine import Sensor
from npchip.machine.layout import to_frames
from npchip.machine.offsets import plain_planes
from npchip.machine.sensor import SensorModel
from tests.support.chips import machine_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

ROWS, COLS = 64, 80
LIMIT = 5
"""Largest deviation, in standard deviations."""


def model(fixed_pattern: int = 0, noise_rms: float = 0, seed: int = 1) -> SensorModel:
    return SensorModel(Sensor(fixed_pattern, noise_rms, seed), ROWS // 8, COLS // 8)


def picture(seed: int = 1, frame: int = 1, conversion: int = 0, rms: float = 32) -> NDArray[Any]:
    """The noise of a conversion: floats, shape (ROWS, COLS)."""
    return to_frames(model(noise_rms=rms, seed=seed).noise(frame, conversion)).astype(float)


def pattern(largest: int, seed: int = 1) -> NDArray[Any]:
    """The fixed pattern of a sensor: floats, shape (ROWS, COLS)."""
    return to_frames(model(largest, seed=seed).offsets).astype(float)


def chi_square(counts: NDArray[Any], expected: NDArray[Any]) -> float:
    """By how many standard deviations counts of classes miss what is expected."""
    freedom = counts.size - 1
    return (float(((counts - expected) ** 2 / expected).sum()) - freedom) / math.sqrt(2 * freedom)


def assert_independent(first: NDArray[Any], second: NDArray[Any]) -> None:
    """Neither the values nor their distances from the mean are correlated, nor do quarters meet."""
    first, second = first.ravel() - first.mean(), second.ravel() - second.mean()
    for a, b in [(first, second), (abs(first), abs(second)), (first, abs(second))]:
        assert abs(np.corrcoef(a, b)[0, 1]) < LIMIT / math.sqrt(a.size)
    classes = [np.searchsorted(np.quantile(a, [0.25, 0.5, 0.75]), a) for a in (first, second)]
    counts = np.bincount(4 * classes[0] + classes[1], minlength=16).reshape(4, 4)
    expected = np.outer(counts.sum(axis=1), counts.sum(axis=0)) / first.size
    freedom = 9
    excess = float(((counts - expected) ** 2 / expected).sum()) - freedom
    assert excess < LIMIT * math.sqrt(2 * freedom)


# ---- the distribution


def exact(rms: float) -> dict[int, float]:
    """The chance of each value: of four fair bytes, added, scaled and rounded."""
    byte = np.full(256, 1 / 256)
    chances = np.convolve(np.convolve(byte, byte), np.convolve(byte, byte))
    scale = math.floor(rms * 32768 / 147.8 + 0.5)
    found: dict[int, float] = {}
    for total, chance in enumerate(chances):
        value = (total - 510) * scale + 16384 >> 15
        found[value] = found.get(value, 0) + chance
    return found


@pytest.mark.parametrize("rms", [0.5, 1.0, 4.0, 32.0])
def test_each_value_is_as_frequent_as_four_fair_bytes_make_it(rms: float) -> None:
    samples = np.stack([picture(frame=frame, rms=rms) for frame in range(40)]).astype(int)
    chances = exact(rms)
    values, counts = np.unique(samples, return_counts=True)
    assert {*values.tolist()} <= {*chances}
    found = dict(zip(values.tolist(), counts.tolist(), strict=True))
    usual = [value for value, chance in chances.items() if chance * samples.size > 10]
    table = np.array([[found.get(value, 0), chances[value] * samples.size] for value in usual])
    rest = samples.size - table.sum(axis=0)  # the rare values together are a class of their own
    counts, expected = np.vstack([table, rest]).T if rest[1] > 10 else table.T
    assert abs(chi_square(counts, expected)) < LIMIT


@pytest.mark.parametrize("rms", [0.0, 0.5, 1.0, 3.0, 10.0, 32.0])
def test_mean_and_deviation_are_those_stated(rms: float) -> None:
    samples = np.stack([picture(frame=frame, rms=rms) for frame in range(40)])
    deviation = math.sqrt(rms**2 + 1 / 12) if rms else 0.0  # rounding adds a twelfth
    assert abs(samples.mean()) <= LIMIT * deviation / math.sqrt(samples.size)
    # The error of a deviation of n normal numbers is 1 / √(2 n), here 0.16 %; the scale is rounded,
    # and the rounding to whole LSB is no independent error where the noise is less than one.
    assert samples.std() == pytest.approx(deviation, rel=0.01)
    assert abs(samples).max() <= 3.45 * rms + 0.5


def test_the_shape_is_nearly_normal() -> None:
    """Four bytes have no skewness, and by theory a kurtosis of 3 - 1.2 / 4."""
    samples = np.stack([picture(frame=frame) for frame in range(40)]).ravel()
    scaled = (samples - samples.mean()) / samples.std()
    assert abs((scaled**3).mean()) < LIMIT * math.sqrt(6 / scaled.size)
    assert abs((scaled**4).mean() - 2.7) < LIMIT * math.sqrt(24 / scaled.size)
    # By theory no share of the values misses the normal one by more than 0.007.
    edges = np.arange(-100, 101, 8)
    found = (samples[:, None] <= edges).mean(axis=0)
    normal = [math.erf((edge + 0.5) / samples.std() / math.sqrt(2)) / 2 + 0.5 for edge in edges]
    assert abs(found - normal).max() < 0.007 + LIMIT * 0.5 / math.sqrt(scaled.size)


@pytest.mark.parametrize("largest", [1, 2, 20, 100, 255])
def test_offsets_are_uniform_from_0_to_the_largest(largest: int) -> None:
    offsets = np.stack([pattern(largest, seed) for seed in range(40)]).astype(int)
    counts = np.bincount(offsets.ravel())
    assert len(counts) == largest + 1
    assert abs(chi_square(counts, np.full(largest + 1, offsets.size / (largest + 1)))) < LIMIT


# ---- independence

SHIFTS = [(0, 1), (1, 0), (1, 1), (0, 2), (0, 8), (8, 0), (0, 10), (3, 40)]
"""To a pixel's neighbours, to those of the next NPs, and farther away."""


@pytest.mark.parametrize("shift", SHIFTS)
def test_pixels_are_independent_of_each_other(shift: tuple[int, int]) -> None:
    down, right = shift
    noise = np.stack([picture(frame=frame) for frame in range(8)])
    offsets = np.stack([pattern(255, seed) for seed in range(8)])
    for numbers in (noise, offsets):
        assert_independent(numbers[:, down:, right:], numbers[:, : ROWS - down, : COLS - right])


@pytest.mark.parametrize("seed", range(4))
def test_no_frequency_stands_out_in_a_picture(seed: int) -> None:
    """The power of each frequency is exponential if pixels are independent, at any distance."""
    for numbers in (picture(seed), pattern(255, seed)):
        power = np.abs(np.fft.rfft2(numbers - numbers.mean())) ** 2
        power = power[:, 1 : COLS // 2] / power[:, 1 : COLS // 2].mean()
        assert power.max() < math.log(power.size) + 13  # of which the chance is 1 / e¹³
        for axis in (0, 1):  # stripes
            stripes = power.mean(axis=axis)
            assert abs(stripes - 1).max() < LIMIT / math.sqrt(power.shape[axis])


FRAMES = [0, 1, 2, 3, 64, 1000, 2**20, 2**32, 2**32 + 1, 2**40]


def test_frames_are_independent_of_each_other() -> None:
    pictures = [picture(frame=frame) for frame in FRAMES]
    for first, second in combinations(pictures, 2):
        assert_independent(first, second)


def test_conversions_are_independent_of_each_other_and_of_frames() -> None:
    """Conversion 2 of frame 1 is another than conversion 1 of frame 2, and so on."""
    pictures = [
        picture(frame=frame, conversion=number) for frame in range(4) for number in range(4)
    ]
    for first, second in combinations(pictures, 2):
        assert_independent(first, second)


def test_seeds_are_independent_of_each_other_and_of_frames() -> None:
    pictures = [
        picture(seed=seed, frame=frame)
        for seed in (0, 1, 2, 3, 2**31, 2**32 - 1)
        for frame in (0, 1)
    ]
    for first, second in combinations(pictures, 2):
        assert_independent(first, second)
    for first, second in combinations([pattern(255, seed) for seed in (0, 1, 2, 2**32 - 1)], 2):
        assert_independent(first, second)


def test_noise_is_independent_of_the_fixed_pattern() -> None:
    for seed in range(8):
        offsets = pattern(255, seed)
        for frame, conversion in [(0, 0), (0, 1), (1, 0), (7, 3)]:
            assert_independent(offsets, picture(seed, frame, conversion))


@pytest.mark.long
def test_each_pixel_is_noise_of_its_own_in_time() -> None:
    """No pixel is brighter or noisier than others, nor does it follow itself."""
    count = 2000
    chip = model(noise_rms=32)
    series = np.stack([chip.noise(frame, 0).ravel() for frame in range(count)]) / 32.0
    # Of 5,120 pixels the largest deviation is 3.9 by expectation; 5.5 has a chance of 1 in 5,000.
    assert abs(series.mean(axis=0)).max() < 5.5 / math.sqrt(count)
    # The variance of a square is the kurtosis less 1.
    assert abs((series**2).mean(axis=0) - 1).max() < 5.5 * math.sqrt(1.7 / count)
    for lag in (1, 2, 3, 5, 64):
        products = (series[lag:] * series[:-lag]).mean(axis=0)
        assert abs(products).max() < 5.5 / math.sqrt(count - lag)
        assert abs(products.mean()) < LIMIT / math.sqrt(products.size * (count - lag))


@pytest.mark.long
def test_the_mean_of_a_picture_is_noise_too() -> None:
    """Pictures as a whole are neither brighter nor darker by turns."""
    chip = model(noise_rms=32)
    means = np.array([[chip.noise(f, c).mean() for c in range(4)] for f in range(1000)])
    scaled = means * math.sqrt(ROWS * COLS) / 32
    assert abs(scaled.mean()) < LIMIT / math.sqrt(scaled.size)
    assert abs(scaled.std() - 1) < LIMIT / math.sqrt(2 * scaled.size)
    for a, b in pairwise(scaled.T):
        assert abs(np.corrcoef(a, b)[0, 1]) < LIMIT / math.sqrt(a.size)
    power = np.abs(np.fft.rfft(scaled[:, 0]))[1:-1] ** 2
    assert power.max() / power.mean() < math.log(power.size) + 13


@pytest.mark.parametrize("engine", ["reference", "wasm"])
def test_double_sampling_removes_offsets_and_leaves_more_noise(engine: str) -> None:
    """As docs/machine.md says: √2 times the noise of one sample, whatever the pattern."""
    machine = machine_of(ROWS // 8, COLS // 8, sensor=Sensor(100, 4.0, 9))
    source = "EXPOSE\nSAMPLE reset, 0\nSAMPLE signal, 64\nHALT"
    chip = Chip(assemble_text(source, "test.s", machine), machine, engine)  # type: ignore[arg-type]
    chip.run(np.full((1, ROWS, COLS), 60, np.uint8))
    reset, signal = (to_frames(chip.memory[bank : bank + 64]).astype(int) for bank in (0, 64))
    whole = reset > 0  # where the noise of the reset level was not clipped
    difference = (signal - reset)[whole & (pattern(100, 9) > 14)]
    error = math.sqrt(2 * (4**2 + 1 / 12))
    assert abs(difference.mean() - 60) < LIMIT * error / math.sqrt(difference.size)
    assert difference.std() == pytest.approx(error, rel=LIMIT / math.sqrt(2 * difference.size))


@pytest.mark.parametrize(("fixed_pattern", "rows", "cols"), [(0, 1, 1), (37, 3, 5), (255, 8, 10)])
def test_offsets_without_numpy(fixed_pattern: int, rows: int, cols: int) -> None:
    """They are those of the array."""
    sensor = Sensor(fixed_pattern, 0.0, 12345)
    planes = SensorModel(sensor, rows, cols).offsets
    assert plain_planes(sensor, rows, cols) == [plane.tobytes() for plane in planes]
