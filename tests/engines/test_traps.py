"""Traps: what a program must not do."""

from __future__ import annotations

import pytest

from npchip.engines.base import TrapError
from tests.support.chips import (
    FILE,
    chip_of,
    clip_of,
    failure,
    machine_of,
    raw_chip,
    state_of,
    word,
)

SMALL = machine_of()
HALT, NOP = word("HALT"), word("NOP")


def test_return_without_a_call() -> None:
    assert failure(chip_of("; nothing\nNOP\nRET")) == ("NP302", 1, 3)


@pytest.mark.parametrize("undefined", [0x0000, 0xFFFF, 0xF123])
def test_undefined_word(undefined: int) -> None:
    chip = raw_chip(NOP, undefined)
    result = chip.run()
    assert result.error is not None
    assert (result.error.code, result.error.address) == ("NP303", 1)
    assert (result.error.file, result.error.line) == (None, None)
    assert f"0x{undefined:04X}" in result.error.message
    assert (chip.pc, chip.instructions, result.cycles) == (1, 1, 1)
    assert not result.setup.complete


def test_undefined_word_that_is_never_reached() -> None:
    assert raw_chip(NOP, HALT, 0x0000).run().status == "halted"


@pytest.mark.parametrize("name", ["ELSE", "END"])
def test_masks_that_are_not_open(name: str) -> None:
    assert failure(raw_chip(NOP, word(name))) == ("NP304", 1, None)


@pytest.mark.parametrize("limit", [1, 15])
def test_masks_nested_too_deep(limit: int) -> None:
    machine = machine_of(mask_depth=limit)
    where = word("WHERE", cc="EQ")
    chip = raw_chip(*[where] * limit, *[word("END")] * limit, HALT, machine=machine)
    assert chip.run().status == "halted"
    chip = raw_chip(*[where] * (limit + 1), HALT, machine=machine)
    assert failure(chip) == ("NP304", limit, None)


def test_falling_off_the_end() -> None:
    assert failure(chip_of("NOP")) == ("NP305", 1, None)
    assert failure(chip_of("JMP 511")) == ("NP305", 511, None)
    full = raw_chip(*[NOP] * 512)
    assert failure(full) == ("NP305", 512, None)
    assert full.instructions == 512


def test_input_without_a_partner() -> None:
    chip = chip_of("NOP\n\nIN r1, 4")
    result = chip.run()
    assert result.error is not None
    assert str(result.error).startswith(f"{FILE}:3: error: at address 1: ")
    assert "port 4" in result.error.message
    assert result.error.code == "NP306"
    assert not chip.registers[1].any()


def test_a_trap_leaves_the_state_before_the_instruction() -> None:
    chip = chip_of("MOV r1, #7\nRET")
    chip.step()
    before = state_of(chip)
    for _ in range(2):
        with pytest.raises(TrapError, match="no call is open") as caught:
            chip.step()
        assert (caught.value.code, caught.value.address) == ("NP302", 1)
        assert caught.value.processor is None
        assert state_of(chip) == before


def test_completed_frames_survive_a_trap() -> None:
    source = ".output n, 0, scalar\nEXPOSE\nOUT 0, r0\nADD r0, #1\nEXPOSE\nOUT 0, r0\nNOP\nRET"
    result = chip_of(source).run(clip_of(5, SMALL))
    assert result.status == "failed"
    assert result.frame_cycles.tolist() == [5, 5]
    assert result.outputs["n"].tolist() == [0, 1]
    assert not result.last_complete
