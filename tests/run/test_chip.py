"""The Python interface of the chip."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from npchip import Chip, InputError, assemble_text
from npchip.isa import parse_isa
from npchip.program.model import Output, Program
from tests.engines.wasm.test_extended import entry
from tests.support.chips import FILE, chip_of, machine_of, word

SMALL = machine_of()
HALT = word("HALT")


def test_shapes_and_types() -> None:
    chip = Chip(assemble_text("HALT"))
    assert chip.registers.shape == (16, 8, 10)
    assert chip.memory.shape == (256, 8, 10)
    assert chip.registers.dtype == chip.memory.dtype == np.uint8
    assert set(chip.flags) == {"Z", "C"}
    for bits in (*chip.flags.values(), chip.active):
        assert bits.shape == (8, 10)
        assert bits.dtype == np.bool_
    assert chip.active.all()
    assert not chip.registers.any()
    assert not chip.memory.any()
    assert not any(flag.any() for flag in chip.flags.values())
    assert (chip.pc, chip.stack) == (0, ())
    assert (chip.cycles, chip.instructions, chip.frames_taken) == (0, 0, 0)


def test_load_memory() -> None:
    chip = chip_of("HALT")
    planes = np.random.default_rng(4).integers(0, 256, (6, 3, 4), np.uint8)
    chip.load_memory(250, planes)
    assert np.array_equal(chip.memory[250:], planes)
    assert not chip.memory[:250].any()
    chip.load_memory(256, planes[:0])


@pytest.mark.parametrize(
    ("address", "planes"),
    [
        (0, np.zeros((1, 4, 3), np.uint8)),
        (0, np.zeros((3, 4), np.uint8)),
        (0, np.zeros((1, 3, 4), np.int64)),
        (0, np.zeros((1, 3, 4))),
        (-1, np.zeros((1, 3, 4), np.uint8)),
        (256, np.zeros((1, 3, 4), np.uint8)),
        (250, np.zeros((7, 3, 4), np.uint8)),
    ],
)
def test_load_memory_refuses(address: int, planes: Any) -> None:
    chip = chip_of("HALT")
    with pytest.raises(InputError) as caught:
        chip.load_memory(address, planes)
    assert caught.value.code == "NP105"
    assert not chip.memory.any()


def test_programs_that_do_not_fit_the_machine() -> None:
    program = assemble_text("HALT")
    with pytest.raises(InputError) as caught:
        Chip(program, SMALL)
    assert caught.value.code == "NP102"
    small = machine_of(memory_bytes=64)
    for line in ("LD r1, [64]", "ST [255], r1", "LD r1, [r2 + 64]", "SAMPLE reset, 192"):
        with pytest.raises(InputError, match=f"{FILE}:2") as caught:
            chip_of(f"NOP\n{line}\nHALT", small)
        assert caught.value.code == "NP103"
    own = parse_isa(
        "extends: npchip\nname: test\ninstructions:\n"
        + entry("LAST", "{level:level}", "1111 0000 0l11 1111", "sample(level, 192)"),
        "test.yaml",
    )
    with pytest.raises(InputError, match=f"{FILE}:1: error: memory address 192") as caught:
        Chip(assemble_text("LAST reset\nHALT", FILE, small, isa=own), small, isa=own)
    assert caught.value.code == "NP103"
    with pytest.raises(InputError) as caught:
        Chip(program, engine="fast")  # type: ignore[arg-type]
    assert caught.value.code == "NP104"
    with pytest.raises(InputError) as caught:
        Chip(program, "defualt")
    assert caught.value.code == "NP202"


def test_frames_of_another_size() -> None:
    chip = chip_of("EXPOSE\nHALT")
    for shape in ((1, 64, 80), (24, 31), (1, 1, 24, 32)):
        with pytest.raises(InputError):
            chip.run(np.zeros(shape, np.uint8))
    with pytest.raises(InputError):
        chip.run(np.zeros((1, 24, 32)))
    assert chip.frames_taken == 0
    assert chip.run(np.zeros((24, 32), np.uint8)).frames == 1


def test_a_bad_frame_in_the_middle_leaves_the_chip_usable() -> None:
    chip = chip_of("EXPOSE\nJMP 0")
    good = np.zeros((24, 32), np.uint8)
    with pytest.raises(InputError):
        chip.run([good, good[:-1]])
    assert (chip.frames_taken, chip.pc) == (1, 0)
    assert chip.run([good]).frames == 1


def test_names_in_a_result() -> None:
    program = Program("raw", (HALT,), outputs=(Output("x", 0, "scalar"),))
    result = Chip(program, engine="reference").run()
    assert (result.program, result.engine, result.machine) == ("raw", "reference", "default")
    assert result.outputs["x"].tolist() == []
