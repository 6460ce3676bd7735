"""The pixels and their ADCs; `machine.noise` says which numbers they give."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from npchip.machine import PIXELS
from npchip.machine import noise as number
from npchip.machine.layout import to_planes
from npchip.machine.model import Sensor


class SensorModel:
    """The values that `SAMPLE` reads from the pixels of an array of NPs.

    Args:
        sensor: offsets, noise, seed and light.
        np_rows: rows of NPs.
        np_cols: columns of NPs.

    Attributes:
        ideal: True without offsets and noise, and with all the light: the reset frame is 0, the
            signal the frame itself.
        offsets: uint8, shape (64, NP rows, NP columns), read-only: the fixed pattern.
        noise_key: hash of the seed that the noise begins with, 64 bits.
    """

    def __init__(self, sensor: Sensor, np_rows: int, np_cols: int) -> None:
        rows, cols = PIXELS * np_rows, PIXELS * np_cols
        self._size = rows, cols
        self._scale = number.noise_scale(sensor)
        self._gain = number.light_gain(sensor)
        self.noise_key = number.step(sensor.seed, number.NOISE)
        self._dark = np.zeros((PIXELS * PIXELS, np_rows, np_cols), np.uint8)
        self._dark.setflags(write=False)
        self.ideal = sensor.fixed_pattern == 0 == self._scale and self._gain is None
        self.offsets = self._dark
        if sensor.fixed_pattern:
            steps = _step_array(
                number.step(sensor.seed, number.OFFSETS), self._pixels
            ) >> np.uint64(48)
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
        key = number.step(number.step(self.noise_key, frame), conversion)
        low, high = np.uint32(key & 0xFFFF_FFFF), np.uint32(key >> 32)
        first, second = map(np.uint32, number.NOISE_MIXES)
        h = self._numbers + low
        h = (h ^ (h >> np.uint32(16))) * first
        h = (h ^ (h >> np.uint32(15)) ^ high) * second
        h ^= h >> np.uint32(16)
        pairs = (h & np.uint32(0xFF00FF)) + (h >> np.uint32(8) & np.uint32(0xFF00FF))
        total = ((pairs + (pairs >> np.uint32(16))) & np.uint32(0xFFFF)).astype(np.int32)
        noise: NDArray[np.int32] = (total - number.MEAN) * self._scale + (1 << 14) >> 15
        return noise

    def sample(
        self, signal: bool, pixels: NDArray[np.uint8] | None, frame: int, conversion: int
    ) -> NDArray[np.uint8]:
        """Convert every pixel once: offset + noise, plus the light of the frame if `signal`.

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
        level = self.offsets + self._lit(light)
        if self._scale:
            level += self.noise(frame, conversion)
        return level.clip(0, 255).astype(np.uint8)

    def _lit(self, light: NDArray[np.uint8]) -> NDArray[np.int32]:
        """Return how much light of a frame reaches the pixels, which hold 255 at most."""
        values = light.astype(np.int32)
        if self._gain is None:
            return values
        half = 1 << number.GAIN_BITS - 1
        return (values * self._gain + half >> number.GAIN_BITS).clip(max=255)


def _step_array(value: int, extra: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """`noise.step` for an array of numbers; uint64 arrays wrap by themselves."""
    first, second = map(np.uint64, number.MIXES)
    z = extra + np.uint64((value + number.GOLDEN) & (1 << 64) - 1)
    z = (z ^ (z >> np.uint64(30))) * first
    z = (z ^ (z >> np.uint64(27))) * second
    return z ^ (z >> np.uint64(31))
