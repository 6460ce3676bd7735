"""Pictures that the chip draws, beside the same pictures drawn by NumPy and OpenCV."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from benchmarks import baselines
from benchmarks.measure import interleaved
from benchmarks.programs import made, sources
from npchip import Chip, assemble

FRAMES: Final = 40_000
_Draw = Callable[[Any], NDArray[np.uint8]]
DRAWN: Final[Mapping[str, Mapping[str, _Draw]]] = {
    "frame_difference": {"NumPy int16": baselines.differences},
    "edges": {
        "OpenCV's Sobel": baselines.sobel,
        "OpenCV's spatialGradient": baselines.gradient,
    },
}
"""Programs, and who else draws their pictures."""

Table = dict[str, dict[str, float]]


def pictures(clip: Any, frames: int = FRAMES) -> Table:
    """Measure all over a long clip: the chip in steady state, and from source to the last frame.

    Args:
        clip: frames to repeat.
        frames: how many.

    Raises:
        AssertionError: the pictures differ.
    """
    long = np.resize(clip, (frames, *clip.shape[1:]))
    table: Table = {}
    for name, others in DRAWN.items():
        chip = made(assemble(sources()[name]), engine="wasm")
        (drawn,) = chip.run(long).outputs.values()
        for other, draw in others.items():
            np.testing.assert_array_equal(drawn, _with_opencv(draw, long), f"{name}: {other}")
        del drawn
        works: dict[str, Callable[[], object]] = {
            "steady state": partial(_again, chip, long),
            "cold start": lambda n=name: made(assemble(sources()[n])).run(long),  # type: ignore[misc]
            **{other: partial(draw, long) for other, draw in others.items()},
        }
        times = interleaved(works)
        for key, seconds in times.items():
            figures = {"frames/s": frames / seconds, "times of npchip": seconds / times[_OURS]}
            table[f"{name}, {key}"] = figures
    return table


_OURS: Final = "steady state"


def _again(chip: Chip, frames: Any) -> None:
    chip.reset()
    chip.run(frames)


def _with_opencv(draw: _Draw, frames: Any) -> NDArray[np.uint8]:
    try:
        return draw(frames)
    except ModuleNotFoundError as error:
        sys.exit(f"error: {error}; install it: pip install 'npchip[benchmark]'")
