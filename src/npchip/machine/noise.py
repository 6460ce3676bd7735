"""The numbers that a sensor's offsets and noise are made of.

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
from typing import Final

from npchip.machine.model import Sensor

_WRAP = (1 << 64) - 1
GOLDEN: Final = 0x9E3779B97F4A7C15
MIXES: Final = 0xBF58476D1CE4E5B9, 0x94D049BB133111EB
NOISE_MIXES: Final = 0x7FEB352D, 0x846CA68B
OFFSETS, NOISE = 0, 1
"""First value hashed after the seed, so that offsets and noise differ."""

MEAN: Final = 510
"""Mean of the sum of four bytes."""
_DEVIATION = 147.8


def noise_scale(sensor: Sensor) -> int:
    """Return the factor `scale` of a sensor's noise, at most 7,095."""
    return math.floor(sensor.noise_rms * 32768 / _DEVIATION + 0.5)


def step(value: int, extra: int) -> int:
    """Hash one more number into `value`; both are taken modulo 2**64."""
    z = (value + GOLDEN + extra) & _WRAP
    z = (z ^ (z >> 30)) * MIXES[0] & _WRAP
    z = (z ^ (z >> 27)) * MIXES[1] & _WRAP
    return z ^ (z >> 31)
