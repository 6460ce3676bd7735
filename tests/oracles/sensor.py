"""Readings of a sensor, one pixel at a time in plain integers, as docs/machine.md says."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from npchip.machine import Sensor


def mix(z: int) -> int:
    """Stir 64 bits: the end of SplitMix64."""
    z ^= z >> 30
    z = z * 0xBF58476D1CE4E5B9 % 2**64
    z ^= z >> 27
    z = z * 0x94D049BB133111EB % 2**64
    return z ^ z >> 31


def step(h: int, v: int) -> int:
    """Hash another number into 64 bits."""
    return mix((h + 0x9E3779B97F4A7C15 + v) % 2**64)


def offset(sensor: Sensor, pixel: int) -> int:
    """The fixed pattern at a pixel."""
    return (step(step(sensor.seed, 0), pixel) >> 48) * (sensor.fixed_pattern + 1) >> 16


def noise_key(sensor: Sensor, frame: int, conversion: int) -> int:
    """The number that the noise of a conversion begins with."""
    return step(step(step(sensor.seed, 1), frame), conversion)


def noise_scale(sensor: Sensor) -> int:
    """The factor of the noise."""
    return math.floor(sensor.noise_rms * 32768 / 147.8 + 0.5)


def noise(key: int, scale: int, pixel: int) -> int:
    """The noise of a pixel in a conversion."""
    h = (pixel + key % 2**32) % 2**32
    h ^= h >> 16
    h = h * 0x7FEB352D % 2**32
    h ^= h >> 15 ^ key >> 32
    h = h * 0x846CA68B % 2**32
    h ^= h >> 16
    return (sum(h.to_bytes(4, "little")) - 510) * scale + 16384 >> 15


def lit(sensor: Sensor, value: int) -> int:
    """Return a value of a frame in the light that the sensor gets."""
    gain = math.floor(sensor.light * 4096 + 0.5)
    return min(255, value * gain + 2048 >> 12)


def reading(
    sensor: Sensor, light: Sequence[Sequence[int]], frame: int, conversion: int
) -> list[list[int]]:
    """Return the readings of a conversion.

    Args:
        sensor: the sensor.
        light: value of each pixel, row by row; 0 for the reset level.
        frame: exposures since reset.
        conversion: conversions since the last of them.
    """
    columns = len(light[0])
    key, scale = noise_key(sensor, frame, conversion), noise_scale(sensor)
    levels = [
        offset(sensor, pixel) + lit(sensor, value) + noise(key, scale, pixel)
        for pixel, value in enumerate(value for line in light for value in line)
    ]
    clipped = [min(max(level, 0), 255) for level in levels]
    return [clipped[first : first + columns] for first in range(0, len(clipped), columns)]
