"""Frames, cycles, instructions, the cycle limit, the sensor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import InputError, load_machine
from npchip.machine import Sensor
from tests.support.chips import LOOP, chip_of, clip_of, machine_of, raw_chip, state_of, word

if TYPE_CHECKING:
    from npchip.machine import Machine
    from npchip.run.result import FrameRecord

SMALL = machine_of()
HALT, NOP = word("HALT"), word("NOP")


# ---- frames, cycles, instructions


def loop_cycles(start: int, frames: int, machine: Machine) -> list[int]:
    """Cycles of the frames of `LOOP`, counted by hand, with r0 as at the start of the first."""
    time = machine.cycles
    fixed = (
        time("control") + time("sample") + time("memory") + time("move")
        + 2 * time("alu") + time("output") + time("branch")
    )  # fmt: skip
    return [fixed + (start + k) * (time("alu") + time("global_or")) for k in range(frames)]


@pytest.mark.parametrize("name", ["default", "conservative"])
def test_cycles_from_expose_to_expose(name: str) -> None:
    machine = load_machine(name)
    chip = chip_of(LOOP, machine)
    seen: list[FrameRecord] = []
    result = chip.run(clip_of(4, machine), on_frame=seen.append)
    expected = loop_cycles(3, 4, machine)
    assert expected[0] == {"default": 276, "conservative": 551}[name]
    assert result.status == "frames-exhausted"
    assert result.frame_cycles.tolist() == expected
    assert result.frame_instructions.tolist() == [8 + 2 * (3 + k) for k in range(4)]
    assert (result.setup.cycles, result.setup.instructions) == (2, 2)
    assert result.cycles == chip.cycles == 2 + sum(expected)
    assert result.instructions == chip.instructions == int(chip.executions.sum())
    assert [record.cycles for record in seen] == expected
    assert [record.outputs["n"] for record in seen] == [3, 4, 5, 6]
    assert result.outputs["n"].tolist() == [3, 4, 5, 6]
    assert result.outputs["first"].mask.all()
    assert [result.value("first", k) for k in range(4)] == [None] * 4
    assert (result.machine, result.frames, result.first_frame) == (name, 4, 0)


def test_expose_at_the_end_of_input_counts_nothing() -> None:
    chip = chip_of("NOP\nEXPOSE\nNOP\nEXPOSE\nHALT")
    result = chip.run()
    assert (result.status, result.cycles, result.frames) == ("frames-exhausted", 1, 0)
    assert (chip.pc, chip.cycles, chip.instructions, chip.frames_taken) == (1, 1, 1, 0)
    assert chip.executions.tolist() == [1, 0, 0, 0, 0]
    result = chip.run(clip_of(1, SMALL))
    assert (result.status, result.setup.cycles) == ("frames-exhausted", 0)
    assert result.frame_cycles.tolist() == [2]
    assert (chip.pc, chip.cycles, chip.instructions) == (3, 3, 3)
    result = chip.run(clip_of(1, SMALL))
    assert (result.status, result.setup.cycles, result.first_frame) == ("halted", 0, 1)
    assert result.frame_cycles.tolist() == [2]


def test_second_run_goes_on() -> None:
    clip = clip_of(7, SMALL)
    whole, parts = chip_of(LOOP), chip_of(LOOP)
    expected = whole.run(clip)
    first, second = parts.run(clip[:3]), parts.run(clip[3:])
    assert (second.first_frame, second.setup.cycles) == (3, 0)
    assert [*first.frame_cycles, *second.frame_cycles] == expected.frame_cycles.tolist()
    assert [*first.outputs["n"], *second.outputs["n"]] == expected.outputs["n"].tolist()
    assert state_of(parts) == state_of(whole)


def test_frames_without_new_ones_go_on() -> None:
    chip = chip_of(LOOP)
    chip.feed(clip_of(2, SMALL))
    assert chip.run().frames == 2
    assert chip.run().frames == 0


@pytest.mark.parametrize("machine", ["default", "conservative"])
def test_step_equals_run(machine: str) -> None:
    clip = clip_of(3, load_machine(machine))
    ran, stepped = chip_of(LOOP, load_machine(machine)), chip_of(LOOP, load_machine(machine))
    ran.run(clip)
    stepped.feed(clip)
    steps = 0
    while stepped.step() is None:
        steps += 1
    assert steps == ran.instructions
    assert state_of(stepped) == state_of(ran)


@pytest.mark.parametrize("limit", range(2, 10))
def test_cycle_limit_is_tested_before_each_instruction(limit: int) -> None:
    """OUT takes a cycle a row, from cycle 3 on: it starts below a limit of 4 and ends beyond."""
    chip = chip_of("EXPOSE\nNOP\nNOP\nOUT 0, r0\nNOP\nHALT")
    result = chip.run(clip_of(1, SMALL), max_cycles=limit)
    starts = [0, 1, 2, 3, 6, 7]
    ends = [1, 2, 3, 6, 7, 8]
    executed = sum(start < limit for start in starts)
    assert result.instructions == executed
    assert result.cycles == ends[executed - 1]
    assert result.status == ("halted" if executed == 6 else "cycle-limit")
    assert result.last_complete == (executed == 6)


def test_cycle_limit_is_per_frame() -> None:
    chip = chip_of("EXPOSE\nNOP\nNOP\nJMP 0")
    clip = clip_of(50, SMALL)
    result = chip.run(clip, max_cycles=3)
    assert (result.status, result.frames, result.cycles) == ("cycle-limit", 1, 3)
    chip.reset()
    result = chip.run(clip, max_cycles=4)
    assert (result.status, result.frames, result.cycles) == ("frames-exhausted", 50, 200)


@pytest.mark.parametrize("limit", [0, 1, 999])
def test_endless_loop_ends_by_the_limit(limit: int) -> None:
    chip = chip_of(".here: JMP .here")
    result = chip.run(max_cycles=limit)
    assert (result.status, result.cycles, chip.pc) == ("cycle-limit", limit, 0)
    assert not result.setup.complete
    assert chip.run(max_cycles=limit).cycles == limit  # and goes on from there


def test_program_of_one_word() -> None:
    result = chip_of("HALT").run()
    assert (result.status, result.cycles, result.instructions) == ("halted", 1, 1)
    assert result.setup.complete


def test_program_that_fills_the_rom() -> None:
    chip = raw_chip(*[NOP] * 511, HALT)
    assert chip.run().cycles == 512
    with pytest.raises(InputError, match="513 words: 1 more than the 512") as caught:
        raw_chip(*[NOP] * 513)
    assert caught.value.code == "NP101"


def test_halted_chip_stays_halted() -> None:
    chip = chip_of("NOP\nHALT\nNOP")
    chip.run()
    before = state_of(chip)
    assert chip.step() == "halted"
    result = chip.run(clip_of(1, SMALL), max_cycles=0)
    assert (result.status, result.cycles, result.frames) == ("halted", 0, 0)
    assert state_of(chip) == before
    chip.reset()
    assert chip.run().instructions == 2


# ---- sensor


def test_sample_fills_its_bank() -> None:
    chip = chip_of("SAMPLE signal, 64\nEXPOSE\nSAMPLE signal, 128\nSAMPLE reset, 192\nHALT")
    clip = clip_of(1, SMALL)
    chip.memory[:] = 1
    chip.run(clip)
    for y in range(8):
        for x in range(8):
            pixel = 8 * y + x
            assert (chip.memory[pixel] == 1).all()
            assert (chip.memory[64 + pixel] == 0).all()  # before any EXPOSE the frame is black
            assert np.array_equal(chip.memory[128 + pixel], clip[0, y::8, x::8])
            assert (chip.memory[192 + pixel] == 0).all()


def test_noise_follows_frame_and_conversion_on_every_replay() -> None:
    machine = machine_of(sensor=Sensor(fixed_pattern=20, noise_rms=4.0, seed=9))
    source = "EXPOSE\nSAMPLE reset, 0\nSAMPLE reset, 64\nSAMPLE signal, 128\nJMP 0"
    clip = np.full((2, machine.rows, machine.cols), 100, np.uint8)
    chip = chip_of(source, machine)
    chip.run(clip[:1])
    first, at_first = chip.memory.copy(), chip.snapshot()
    chip.run(clip[1:])
    second = chip.memory.copy()
    for one, other in ((first[:64], first[64:128]), (first[:64], second[:64])):
        assert not np.array_equal(one, other)
    assert abs(float(first[128:192].mean()) - 110) < 3
    chip.restore(at_first)
    chip.run(clip[1:])
    assert np.array_equal(chip.memory, second)
    chip.reset()
    chip.run(clip)
    assert np.array_equal(chip.memory, second)


def test_noise_counts_conversions_from_the_expose() -> None:
    """The number of earlier conversions does not matter."""
    machine = machine_of(sensor=Sensor(fixed_pattern=0, noise_rms=4.0, seed=9))
    clip = np.full((1, machine.rows, machine.cols), 100, np.uint8)
    read = []
    for earlier in (0, 1, 3):
        before = "SAMPLE reset, 0\n" * earlier
        chip = chip_of(f"{before}EXPOSE\nSAMPLE signal, 64\nSAMPLE signal, 128\nHALT", machine)
        chip.run(clip)
        read.append(chip.memory[64:192].tolist())
    assert read[0] == read[1] == read[2]
    assert read[0][:64] != read[0][64:]
