"""The pixels and their ADCs: fixed offsets, temporal noise, correlated double sampling.

All of it is a decision: the thesis names double sampling but publishes no noise figures. All
numbers come from integer hashes, so they are the same on every engine and platform. With
unsigned arithmetic that wraps, of 64 bits but for h, which has 32::

    mix(z):  z ^= z >> 30;  z *= 0xBF58476D1CE4E5B9
             z ^= z >> 27;  z *= 0x94D049BB133111EB
             z ^= z >> 31                                    (the finaliser of SplitMix64)
    step(h, v) = mix(h + 0x9E3779B97F4A7C15 + v)
    pixel      = row * columns + column                      (of the frame)

    offset     = ((step(step(seed, 0), pixel) >> 48) * (fixed_pattern + 1)) >> 16
    key        = step(step(step(seed, 1), frame), conversion);  a, b = its low and high 32 bits
    h          = pixel + a
    h         ^= h >> 16;      h *= 0x7FEB352D              (multipliers: C. Wellons' lowbias32)
    h         ^= h >> 15 ^ b;  h *= 0x846CA68B
    h         ^= h >> 16
    noise      = ((b0 + b1 + b2 + b3 - 510) * scale + 16384) >> 15        (signed, rounds down)
    scale      = floor(noise_rms * 32768 / 147.8 + 0.5)

where b0..b3 are the bytes of h. Their sum is nearly normal (Irwin-Hall) with mean 510
and standard deviation sqrt(21845) = 147.8, and never more than 3.45 deviations from its mean.
Rounding to whole LSBs adds about 1/12 to the variance.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from npchip.machine import PIXELS
from npchip.machine.layout import to_planes
from npchip.machine.model import Sensor

_WRAP = (1 << 64) - 1
GOLDEN = 0x9E3779B97F4A7C15
MIX_1 = 0xBF58476D1CE4E5B9
MIX_2 = 0x94D049BB133111EB
NOISE_MIXES = 0x7FEB352D, 0x846CA68B
_OFFSETS, _NOISE = 0, 1
"""First value hashed after the seed, so that offsets and noise differ."""

IRWIN_HALL_MEAN = 510
_IRWIN_HALL_SIGMA = 147.8


class SensorModel:
    """The values that `SAMPLE` reads from the pixels of an array of NPs.

    Args:
        sensor: offsets, noise and seed.
        np_rows: rows of NPs.
        np_cols: columns of NPs.

    Attributes:
        ideal: True without offsets and noise: the reset frame is 0, the signal the frame itself.
        offsets: uint8, shape (64, NP rows, NP columns), read-only: the fixed pattern.
        noise_key: hash of the seed that the noise begins with, 64 bits.
    """

    def __init__(self, sensor: Sensor, np_rows: int, np_cols: int) -> None:
        rows, cols = PIXELS * np_rows, PIXELS * np_cols
        self._size = rows, cols
        self._scale = noise_scale(sensor)
        self.noise_key = _step(sensor.seed, _NOISE)
        self._dark = np.zeros((PIXELS * PIXELS, np_rows, np_cols), np.uint8)
        self._dark.setflags(write=False)
        self.ideal = sensor.fixed_pattern == 0 and self._scale == 0
        self.offsets = self._dark
        if sensor.fixed_pattern:
            steps = _step_array(_step(sensor.seed, _OFFSETS), self._pixels) >> np.uint64(48)
            offsets = (steps * np.uint64(sensor.fixed_pattern + 1)) >> np.uint64(16)
            self.offsets = offsets.astype(np.uint8)
            self.offsets.setflags(write=False)

    @cached_property
    def _pixels(self) -> NDArray[np.uint64]:
        """The numbers of the pixels, as planes."""
        rows, cols = self._size
        return to_planes(np.arange(rows * cols, dtype=np.uint64).reshape(rows, cols))

    @cached_property
    def _numbers(self) -> NDArray[np.uint32]:
        return self._pixels.astype(np.uint32)

    def noise(self, frame: int, conversion: int) -> NDArray[np.int32]:
        """Return the noise of one conversion in LSB: int32, shape (64, NP rows, NP columns).

        Args:
            frame: frames exposed since the chip was reset (0 before the first), from 0.
            conversion: conversions since that exposure, from 0.
        """
        key = _step(_step(self.noise_key, frame), conversion)
        low, high = np.uint32(key & 0xFFFF_FFFF), np.uint32(key >> 32)
        first, second = map(np.uint32, NOISE_MIXES)
        h = self._numbers + low
        h = (h ^ (h >> np.uint32(16))) * first
        h = (h ^ (h >> np.uint32(15)) ^ high) * second
        h ^= h >> np.uint32(16)
        pairs = (h & np.uint32(0xFF00FF)) + (h >> np.uint32(8) & np.uint32(0xFF00FF))
        total = ((pairs + (pairs >> np.uint32(16))) & np.uint32(0xFFFF)).astype(np.int32)
        noise: NDArray[np.int32] = (total - IRWIN_HALL_MEAN) * self._scale + (1 << 14) >> 15
        return noise

    def sample(
        self, signal: bool, pixels: NDArray[np.uint8] | None, frame: int, conversion: int
    ) -> NDArray[np.uint8]:
        """Convert every pixel once: offset + noise, plus the frame's value if `signal`.

        Args:
            signal: True for `SAMPLE signal`, False for `SAMPLE reset`.
            pixels: the exposed frame as planes, uint8, shape (64, NP rows, NP columns);
                None before the first exposure, which reads as a black frame.
            frame: frames exposed since the chip was reset, as for `noise`.
            conversion: conversions since that exposure, as for `noise`.

        Returns:
            uint8, shape (64, NP rows, NP columns), clipped to 0..255. Do not write to it: an ideal
            sensor returns `pixels` itself.
        """
        light = pixels if signal and pixels is not None else self._dark
        if self.ideal:
            return light
        level = self.offsets.astype(np.int32) + light
        if self._scale:
            level += self.noise(frame, conversion)
        return level.clip(0, 255).astype(np.uint8)


def noise_scale(sensor: Sensor) -> int:
    """Return the factor `scale` of a sensor's noise, at most 7,095."""
    return math.floor(sensor.noise_rms * 32768 / _IRWIN_HALL_SIGMA + 0.5)


def _step(value: int, extra: int) -> int:
    """Hash one more number into `value`; both are taken modulo 2**64."""
    z = (value + GOLDEN + extra) & _WRAP
    z = (z ^ (z >> 30)) * MIX_1 & _WRAP
    z = (z ^ (z >> 27)) * MIX_2 & _WRAP
    return z ^ (z >> 31)


def _step_array(value: int, extra: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """`_step` for an array of numbers; uint64 arrays wrap by themselves."""
    z = extra + np.uint64((value + GOLDEN) & _WRAP)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(MIX_1)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(MIX_2)
    return z ^ (z >> np.uint64(31))
