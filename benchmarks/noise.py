"""The cost of noise and a fixed pattern of the sensor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from benchmarks.measure import interleaved, pace, plan
from benchmarks.programs import made, sources
from npchip import Machine, Program, assemble, assemble_text, load_machine
from npchip.machine import PIXELS
from npchip.machine.sensor import SensorModel

SECONDS: Final = 0.1
"""About what one measurement takes."""
CONVERSIONS: Final = 33
"""Conversions of a frame by a program that is compared with one of a single conversion."""
CONVERSION: Final = "a conversion of 5,120 pixels"
"""The row that has no program, but the conversion alone."""

_SLOW_FRAMES: Final = 5

Table = dict[str, dict[str, float]]


def noisy() -> Machine:
    """Return the default machine with a noise of 5 LSB and a fixed pattern of up to 20."""
    machine = load_machine("default")
    sensor = replace(machine.sensor, noise_rms=5.0, fixed_pattern=20)
    return replace(machine, name="noisy", sensor=sensor)


def converting(count: int) -> Program:
    """Return a program of the noisy machine that converts all pixels so many times a frame."""
    samples = "SAMPLE signal, 0\n" * count
    return assemble_text(f"l: EXPOSE\n{samples}JMP l\n", "noise.s", noisy())


def noise(clip: Any) -> Table:
    """Measure a conversion in the compiled engine and in NumPy, and all programs with noise.

    Returns:
        Microseconds: of a conversion, then of a frame of each program.
    """
    return {CONVERSION: _conversion(clip), **{name: _program(name, clip) for name in sources()}}


def _conversion(clip: Any) -> dict[str, float]:
    machine = noisy()
    model = SensorModel(machine.sensor, machine.np_rows, machine.np_cols)
    planes = np.zeros((PIXELS * PIXELS, machine.np_rows, machine.np_cols), np.uint8)
    planes[:] = np.arange(len(planes))[:, None, None]
    works: dict[str, Callable[[], object]] = {
        "NumPy": lambda: [model.sample(True, planes, 1, k) for k in range(CONVERSIONS)]
    }
    frames = clip[:1_000]
    for count in (1, CONVERSIONS):
        chip = made(converting(count), machine=machine)
        works[str(count)] = partial(_again, chip, frames)
        chip.run(frames[:2])
    times = interleaved(works)
    compiled = (times[str(CONVERSIONS)] - times["1"]) / (CONVERSIONS - 1) / len(frames)
    numpy = times["NumPy"] / CONVERSIONS
    return {"compiled": 1e6 * compiled, "NumPy": 1e6 * numpy, "part of NumPy": compiled / numpy}


def _program(name: str, clip: Any) -> dict[str, float]:
    """Measure a program without noise, with it, and with it on the reference engine."""
    ideal, machine = load_machine("default"), noisy()
    works, per_call = {}, {}
    for column, where, engine in (
        ("ideal", ideal, "wasm"),
        ("noisy", machine, "wasm"),
        ("reference", machine, "reference"),
    ):
        chip = made(assemble(sources()[name], where), machine=where, engine=engine)
        chip.run(clip[:2])
        frames, passes = _SLOW_FRAMES, 1
        if engine == "wasm":
            speed = pace(lambda count, c=chip: _again(c, clip[:count]), len(clip))  # type: ignore[misc]
            frames, passes = plan(speed, len(clip), SECONDS)
        works[column] = partial(_again, chip, clip[:frames], passes)
        per_call[column] = frames * passes
    times = interleaved(works, 3)
    table = {column: 1e6 * seconds / per_call[column] for column, seconds in times.items()}
    return {**table, "times of ideal": table["noisy"] / table["ideal"]}


def _again(chip: Any, frames: Any, passes: int = 1) -> None:
    for _ in range(passes):
        chip.reset()
        chip.run(frames)
