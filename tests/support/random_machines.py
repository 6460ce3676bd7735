"""Random machines: sensors, and arrays on both sides of each size at which an engine changes."""

from __future__ import annotations

from dataclasses import replace
from random import Random
from typing import Literal

from npchip import Machine, load_machine

Size = Literal["small", "medium", "large"]
SMALL = ((1, 16), (2, 8), (2, 3), (1, 1), (3, 5), (4, 4), (2, 3), (3, 6), (17, 1), (4, 8))
MEDIUM = ((5, 7), (8, 10), (1, 33), (3, 16))
MOST = 5_000
"""Most NPs of a large array."""
_LIMIT = 256
"""NPs up to which planes are handled vector by vector; also most rows, and most columns."""


def draw_machine(random: Random, size: Size) -> Machine:
    """A machine with an array of a size; half of the sensors have a fixed pattern or noise."""
    machine = load_machine(random.choice(["default", "conservative"]))
    rows, cols = _large(random) if size == "large" else random.choice(_SIZES[size])
    pattern, noise = random.choice([(0, 0)] * 3 + [(0, 1), (1, 0), (1, 1)])
    sensor = replace(
        machine.sensor,
        fixed_pattern=pattern * random.choice([1, 30, 200, 255]),
        noise_rms=noise * random.choice([0.001, 0.5, 4.0, 32.0]),  # that of 0.001 is always 0
        seed=random.choice([0, 1, 2**32 - 1, random.randrange(2**32)]),
    )
    return replace(
        machine,
        name="random",
        np_rows=rows,
        np_cols=cols,
        memory_bytes=random.choice([256, 256, 128, 64]),
        sensor=sensor,
    )


_SIZES = {"small": SMALL, "medium": MEDIUM}


def _large(random: Random) -> tuple[int, int]:
    kind = random.randrange(6)
    if kind == 0:  # around the limit of NPs
        cols = random.choice([1, 7, 8, 15, 16, 17, 31, 32, 33, 64, 128])
        rows = (_LIMIT + random.choice([-17, -1, 0, 1, 17])) // cols
        return min(_LIMIT, max(2, rows)), cols
    if kind == 1:  # around a vector in a row
        cols = random.choice([14, 15, 16, 17, 18])
    elif kind == 2:  # wide
        cols = random.choice([_LIMIT, _LIMIT - 1, random.randrange(129, _LIMIT)])
    elif kind == 3:  # high
        rows = random.choice([_LIMIT, _LIMIT - 1, random.randrange(129, _LIMIT)])
        return rows, random.randrange(1, MOST // rows + 1)
    elif kind == 4:  # what people build
        return random.choice([(60, 80), (16, 20), (30, 40), (32, 32), (64, 64), (48, 100)])
    else:
        cols = random.randrange(1, 100)
    return random.randrange(1, min(_LIMIT, MOST // cols) + 1), cols
