"""Sensors with a fixed pattern and noise: both engines against plain integers."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.machine import Sensor
from npchip.machine.layout import to_frames
from tests.oracles.sensor import reading
from tests.support.chips import clip_of, machine_of
from tests.support.lockstep import state

if TYPE_CHECKING:
    from numpy.typing import NDArray

SENSORS = [
    Sensor(fixed_pattern=0, noise_rms=4, seed=1),
    Sensor(fixed_pattern=40, noise_rms=0, seed=0),
    Sensor(fixed_pattern=255, noise_rms=32, seed=2**32 - 1),
    Sensor(fixed_pattern=7, noise_rms=0.001, seed=5),  # too little noise for any
    Sensor(fixed_pattern=1, noise_rms=0.5, seed=123_456_789),
    Sensor(fixed_pattern=0, noise_rms=0, seed=1, light=0.4),
    Sensor(fixed_pattern=60, noise_rms=0, seed=2, light=1.4),
    Sensor(fixed_pattern=3, noise_rms=6, seed=3, light=4),
]
SHAPES = [(1, 1), (2, 3), (2, 8), (1, 17)]
LARGE = [(16, 16), (17, 16), (2, 129), (18, 15), (1, 256), (256, 1), (60, 80)]
"""The first has the most NPs whose vectors are handled one by one; with and without whole vectors
in a row."""
SOURCE = """
        SAMPLE signal, 0        ; dark, before the first frame
        SAMPLE reset, 64
        EXPOSE
        SAMPLE reset, 128       ; conversion 0
        SAMPLE signal, 192
        EXPOSE
        COL r0                  ; in a masked region of half of the columns
        MOV r1, #1
        AND r0, r1
        WHERE EQ
          SAMPLE signal, 64     ; conversion 0
        ELSE
          SAMPLE signal, 64     ; conversion 1
        END
        CMP r0, #2
        WHERE EQ                ; in that of none, which counts
          SAMPLE reset, 0
        END
        SAMPLE reset, 192       ; conversion 3
        HALT
"""


def banks(
    engine: Literal["reference", "wasm"], shape: tuple[int, int], sensor: Sensor, before: int = 0
) -> list[NDArray[np.uint8]]:
    """The four banks as pictures after `SOURCE`, on a chip that has exposed some frames before."""
    machine = replace(machine_of(*shape), sensor=sensor)
    chip = Chip(assemble_text(SOURCE, "test.s", machine), machine, engine)
    state(chip).frames_taken = before
    clip = clip_of(2, machine)
    assert chip.run(iter(clip)).status == "halted"
    return [to_frames(chip.memory[bank : bank + 64]) for bank in range(0, 256, 64)]


def expected(shape: tuple[int, int], sensor: Sensor, before: int = 0) -> list[NDArray[np.uint8]]:
    """Return the frames that the memory should hold."""
    first, second = clip_of(2, machine_of(*shape)).tolist()
    dark = [[0] * len(first[0]) for _ in first]
    read = {
        "dark": reading(sensor, dark, before, 0),
        "reset": reading(sensor, dark, before + 1, 0),
        "even": reading(sensor, second, before + 2, 0),
        "odd": reading(sensor, second, before + 2, 1),
        "last": reading(sensor, dark, before + 2, 3),
    }
    pictures = {name: np.array(picture, np.uint8) for name, picture in read.items()}
    even = np.arange(len(first[0])) // 8 % 2 == 0
    masked = np.where(even, pictures["even"], pictures["odd"])
    return [pictures["dark"], masked, pictures["reset"], pictures["last"]]


CASES = [(shape, sensor) for shape in SHAPES for sensor in SENSORS]
MORE = [(shape, sensor) for shape in LARGE for sensor in (*SENSORS[1:3], *SENSORS[-2:])]


@pytest.mark.parametrize(
    ("shape", "sensor"), [*CASES, *(pytest.param(*case, marks=pytest.mark.long) for case in MORE)]
)
def test_sensors(shape: tuple[int, int], sensor: Sensor) -> None:
    wanted = expected(shape, sensor)
    for engine in ("reference", "wasm"):
        for bank, picture in enumerate(banks(engine, shape, sensor)):
            assert np.array_equal(picture, wanted[bank]), (engine, bank)


@pytest.mark.parametrize("light", [0, 0.0001, 0.4, 0.5, 0.99, 1, 1.0002, 1.4, 3.9999, 4])
def test_every_value_in_every_light(light: float) -> None:
    sensor = Sensor(0, 0, 1, light)
    machine = replace(machine_of(2, 2), sensor=sensor)
    values = np.arange(256, dtype=np.uint8).reshape(1, 16, 16)
    source = "EXPOSE\nSAMPLE signal, 0\nHALT"
    wanted = np.array(reading(sensor, values[0].tolist(), 1, 0))
    for engine in ("reference", "wasm"):
        chip = Chip(assemble_text(source, "test.s", machine), machine, engine)
        chip.run(values)
        assert np.array_equal(to_frames(chip.memory[:64]), wanted), engine
    exact = np.clip(np.rint(values[0].astype(np.float64) * light), 0, 255)
    assert np.abs(wanted - exact).max() <= 1  # 255 / 8192 off, then rounded


@pytest.mark.parametrize("before", [1, 1023, 2**32 - 2, 2**32 - 1, 2**40])
def test_frames_are_counted_in_64_bits(before: int) -> None:
    wanted = expected((1, 3), SENSORS[0], before)
    for engine in ("reference", "wasm"):
        for bank, picture in enumerate(banks(engine, (1, 3), SENSORS[0], before)):
            assert np.array_equal(picture, wanted[bank]), (engine, bank)


@pytest.mark.parametrize("shape", [(1, 2), (3, 90)])
def test_every_frame_of_many_batches(shape: tuple[int, int]) -> None:
    """One corner of each frame, also behind the ring buffer and in a second run."""
    sensor = SENSORS[2]
    machine = replace(machine_of(*shape), sensor=sensor)
    source = ".output a, 0, plane\nframe: EXPOSE\nSAMPLE reset, 0\nLD r0, [0]\nOUT 0, r0\nJMP frame"
    chip = Chip(assemble_text(source, "test.s", machine), machine, "wasm")
    clip = clip_of(130, machine)
    corners = [chip.run(clip).outputs["a"][:, 0, 0] for _ in range(2)]
    wanted = [reading(sensor, [[0]], frame, 0)[0][0] for frame in range(1, 261)]
    assert np.concatenate(corners).tolist() == wanted
