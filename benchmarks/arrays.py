"""Larger arrays, on both engines."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import interleaved, pace, plan
from benchmarks.programs import made, sources
from npchip import Chip, Machine, assemble, load_machine

SHAPES: Final = ((8, 10), (60, 80), (128, 160))
"""Rows and columns of NPs: the chip's, VGA, and 1,280 x 1,024 pixels."""
PROGRAMS: Final = ("edges", "imaging")
SECONDS: Final = 0.2
"""About what one measurement takes."""

_MOST_BYTES: Final = 200_000_000
"""Most bytes of the frames of a measurement, which are held in memory, as their results are."""
_SLOW_FRAMES: Final = 3

Table = dict[str, dict[str, float]]


def arrays(clip: Any) -> Table:
    """Measure programs on larger arrays.

    Returns:
        For each program and array the frames per second on both engines and their ratio, the time
        from a program's words to the first frame, and the cost of an NP in a frame, as a multiple
        of that on the first array too.
    """
    table: Table = {}
    for name in PROGRAMS:
        least = 0.0
        for rows, cols in SHAPES:
            row = _measured(name, grown(rows, cols), clip)
            cost = row["ns per NP"]
            least = least or cost
            table[f"{name}, {rows} x {cols} NPs"] = {**row, "times of the chip's": cost / least}
    return table


def grown(rows: int, cols: int) -> Machine:
    """Return the default machine with another array."""
    return replace(load_machine("default"), name="grown", np_rows=rows, np_cols=cols)


def tiled(clip: NDArray[np.uint8], machine: Machine) -> NDArray[np.uint8]:
    """Return the clip's frames side by side, as many as fill the machine's array."""
    _, rows, cols = clip.shape
    times = (1, -(-machine.rows // rows), -(-machine.cols // cols))
    return np.ascontiguousarray(np.tile(clip, times)[:, : machine.rows, : machine.cols])


def _measured(name: str, machine: Machine, clip: Any) -> dict[str, float]:
    program = assemble(sources()[name], machine)
    frames = tiled(clip[: _MOST_BYTES // (machine.rows * machine.cols)], machine)
    most = len(frames)
    chips = {engine: made(program, machine=machine, engine=engine) for engine in _ENGINES}
    for chip in chips.values():
        chip.run(frames[:1])
    fast = chips["wasm"]
    count, passes = plan(pace(lambda n: _again(fast, frames[:n]), most), most, SECONDS)
    times = interleaved(
        {
            "wasm": partial(_again, fast, frames[:count], passes),
            "reference": partial(_again, chips["reference"], frames[:_SLOW_FRAMES]),
            "ready": lambda: made(program, machine=machine, engine="wasm").run(frames[:1]),
        }
    )
    compiled = count * passes / times["wasm"]
    reference = _SLOW_FRAMES / times["reference"]
    return {
        "wasm frames/s": compiled,
        "reference frames/s": reference,
        "ratio": compiled / reference,
        "ready ms": 1000 * times["ready"],
        "ns per NP": 1e9 / compiled / (machine.np_rows * machine.np_cols),
    }


_ENGINES: Final = ("wasm", "reference")


def _again(chip: Chip, frames: Any, passes: int = 1) -> None:
    for _ in range(passes):
        chip.reset()
        chip.run(frames)
