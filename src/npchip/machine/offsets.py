"""The fixed pattern as planes of bytes, with NumPy or, as in a browser, without."""

from __future__ import annotations

from npchip.machine.model import PIXELS, Sensor
from npchip.machine.noise import OFFSETS, step


def offset_planes(sensor: Sensor, np_rows: int, np_cols: int) -> list[bytes]:
    """Return the offsets of the pixels as planes: 64 times a byte for each NP, row by row."""
    try:
        from npchip.machine.sensor import SensorModel  # noqa: PLC0415 - it takes NumPy
    except ModuleNotFoundError:
        return plain_planes(sensor, np_rows, np_cols)
    return [plane.tobytes() for plane in SensorModel(sensor, np_rows, np_cols).offsets]


def plain_planes(sensor: Sensor, np_rows: int, np_cols: int) -> list[bytes]:
    """Return the same without NumPy, which is slow on a large array."""
    seed, most, cols = step(sensor.seed, OFFSETS), sensor.fixed_pattern + 1, PIXELS * np_cols
    return [
        bytes(
            (step(seed, (PIXELS * row + y) * cols + PIXELS * col + x) >> 48) * most >> 16
            for row in range(np_rows)
            for col in range(np_cols)
        )
        for y in range(PIXELS)
        for x in range(PIXELS)
    ]
