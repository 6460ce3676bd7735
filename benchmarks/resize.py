"""Fitting frames of 1080p to the array, beside Pillow's box filter."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np
from PIL import Image

from benchmarks.measure import interleaved
from npchip.frames.fit import fit_frame

SOURCE = (1080, 1920)
SIZES = ((64, 80), (480, 640))


def resize() -> dict[str, dict[str, float]]:
    """Milliseconds a frame by processor time and by the clock, for two sizes of the array.

    The box filter takes whole pixels, so its result is no average of areas.
    """
    frame = np.random.default_rng(1).integers(0, 256, SOURCE, np.uint8)
    picture = Image.fromarray(frame)
    table: dict[str, dict[str, float]] = {}
    for rows, cols in SIZES:
        name, other = f"npchip, {rows} x {cols}", f"Pillow's box filter, {rows} x {cols}"
        works: dict[str, Callable[[], object]] = {
            name: partial(fit_frame, frame, (rows, cols), "resize", name),
            other: partial(picture.resize, (cols, rows), Image.Resampling.BOX),
        }
        processor = interleaved(works)
        clock = interleaved(works, clock=time.perf_counter)
        for work in works:
            table[work] = {
                "processor ms": 1000 * processor[work],
                "clock ms": 1000 * clock[work],
                "times of Pillow": processor[work] / processor[other],
            }
    return table
