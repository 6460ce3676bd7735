"""The pixels and their ADCs: fixed offsets, temporal noise, correlated double sampling.

All of it is a decision: the thesis names double sampling but publishes no noise figures. All
numbers come from integer hashes, so they are the same on every engine, platform and version.
With 64-bit unsigned arithmetic that wraps::

    mix(z):  z ^= z >> 30;  z *= 0xBF58476D1CE4E5B9
             z ^= z >> 27;  z *= 0x94D049BB133111EB
             z ^= z >> 31                                    (the finaliser of SplitMix64)
    step(h, v) = mix(h + 0x9E3779B97F4A7C15 + v)
    pixel      = row * columns + column                      (of the frame)

    offset     = ((step(step(seed, 0), pixel) >> 48) * (fixed_pattern + 1)) >> 16
    h          = step(step(step(step(seed, 1), frame), conversion), pixel)
    noise      = ((b0 + b1 + b2 + b3 - 510) * scale + 32768) >> 16        (signed, rounds down)
    scale      = floor(noise_rms * 65536 / 147.8 + 0.5)

where b0..b3 are the four low bytes of h. Their sum is nearly normal (Irwin-Hall) with mean 510
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
_GOLDEN = 0x9E3779B97F4A7C15
_MIX_1 = 0xBF58476D1CE4E5B9
_MIX_2 = 0x94D049BB133111EB
_OFFSETS, _NOISE = 0, 1
"""First value hashed after the seed, so that offsets and noise differ."""

_IRWIN_HALL_MEAN = 510
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
    """

    def __init__(self, sensor: Sensor, np_rows: int, np_cols: int) -> None:
        rows, cols = PIXELS * np_rows, PIXELS * np_cols
        self._size = rows, cols
        self._scale = math.floor(sensor.noise_rms * 65536 / _IRWIN_HALL_SIGMA + 0.5)
        self._noise_key = _step(sensor.seed, _NOISE)
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

    def noise(self, frame: int, conversion: int) -> NDArray[np.int32]:
        """Return the noise of one conversion in LSB: int32, shape (64, NP rows, NP columns).

        Args:
            frame: frames exposed since the chip was reset (0 before the first), from 0.
            conversion: conversions since that exposure, from 0.
        """
        key = _step(_step(self._noise_key, frame), conversion)
        hashes = _step_array(key, self._pixels).astype(np.uint32)  # the four low bytes
        total = np.zeros(hashes.shape, np.int32)
        for shift in (0, 8, 16, 24):
            total += ((hashes >> np.uint32(shift)) & np.uint32(0xFF)).astype(np.int32)
        # At most 510 * 14189, so int32 holds it. The shift of a negative number rounds down.
        return ((total - _IRWIN_HALL_MEAN) * np.int32(self._scale) + np.int32(1 << 15)) >> 16

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


def _step(value: int, extra: int) -> int:
    """Hash one more number into `value`; both are taken modulo 2**64."""
    z = (value + _GOLDEN + extra) & _WRAP
    z = (z ^ (z >> 30)) * _MIX_1 & _WRAP
    z = (z ^ (z >> 27)) * _MIX_2 & _WRAP
    return z ^ (z >> 31)


def _step_array(value: int, extra: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """`_step` for an array of numbers; uint64 arrays wrap by themselves."""
    z = extra + np.uint64((value + _GOLDEN) & _WRAP)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(_MIX_1)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(_MIX_2)
    return z ^ (z >> np.uint64(31))
