"""The chip: masks, links, memory, flow, traps, frames, cycles, outputs, going back."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import npchip
from npchip import Chip, InputError, assemble_text, load_machine
from npchip.engines import TrapError
from npchip.machine import Sensor
from npchip.program import Output, Program
from tests.chips import FILE, chip_of, clip_of, machine_of, places, raw_chip, word

if TYPE_CHECKING:
    from npchip.machine import Machine
    from npchip.result import FrameRecord, RunResult, Value

SMALL = machine_of()
ROW, COLUMN = places(SMALL)
HALT, NOP = word("HALT"), word("NOP")


def state_of(chip: Chip) -> dict[str, Any]:
    """Everything that can be seen of a chip, in a form that can be compared."""
    return {
        "pc": chip.pc,
        "registers": chip.registers.tolist(),
        "flags": {name: flag.tolist() for name, flag in chip.flags.items()},
        "active": chip.active.tolist(),
        "memory": chip.memory.tolist(),
        "stack": chip.stack,
        "cycles": chip.cycles,
        "instructions": chip.instructions,
        "executions": chip.executions.tolist(),
        "frames_taken": chip.frames_taken,
    }


def summary(result: RunResult) -> dict[str, Any]:
    """A result in a form that can be compared."""
    return {
        "status": result.status,
        "error": result.error,
        "setup": (result.setup.cycles, result.setup.instructions, result.setup.complete),
        "cycles": result.frame_cycles.tolist(),
        "instructions": result.frame_instructions.tolist(),
        "last_complete": result.last_complete,
        "outputs": {
            name: [np.array(result.value(name, k)).tolist() for k in range(result.frames)]
            for name in result.outputs
        },
    }


def plane(value: Value) -> list[list[int]]:
    """The numbers of a plane."""
    assert isinstance(value, np.ndarray)
    assert value.dtype == np.uint8
    numbers: list[list[int]] = value.tolist()
    return numbers


def failure(chip: Chip, **options: Any) -> tuple[str, int | None, int | None]:
    """Run into a failure: code, address and source line."""
    result = chip.run(**options)
    assert result.status == "failed"
    assert result.error is not None
    assert str(result.error).endswith(f"[{result.error.code}]")
    return result.error.code, result.error.address, result.error.line


# ---- masks


def test_inactive_processors_keep_everything() -> None:
    chip = chip_of(
        """
        .output sent, 0, plane
            ROW r0
            COL r1
            ST [7], r1
            CMP r1, #2          ; Z in column 2, C to the west of it
            WHERE HS
              MOV r2, #9
              ADD r1, #255      ; C everywhere here
              ST [7], r2
              ST [r0 + 64], r2
              LD r3, [7]
              NBR r4, r0, north
              SAMPLE signal, 128
              OUT 0, r2
            END
            HALT
        """
    )
    chip.memory[128:192] = 77
    result = chip.run()
    east = COLUMN >= 2
    assert np.array_equal(chip.registers[1], np.where(east, COLUMN - 1, COLUMN))
    assert np.array_equal(chip.registers[2], np.where(east, 9, 0))
    assert np.array_equal(chip.registers[3], np.where(east, 9, 0))
    assert np.array_equal(chip.registers[4], np.where(east & (ROW > 0), ROW - 1, 0))
    assert chip.flags["C"].tolist() == [[True] * 4] * 3  # of CMP in the west, of ADD in the east
    assert np.array_equal(chip.flags["Z"], np.zeros_like(east))
    assert np.array_equal(chip.memory[7], np.where(east, 9, COLUMN))
    for row in range(3):
        assert np.array_equal(chip.memory[64 + row], np.where(east & (row == ROW), 9, 0))
    assert np.array_equal(chip.memory[128:192], np.where(east, 0, 77)[None].repeat(64, axis=0))
    assert plane(result.setup.outputs["sent"]) == np.where(east, 9, 0).tolist()


def test_inactive_processors_can_be_read() -> None:
    chip = chip_of("COL r0\nCMP r0, #1\nWHERE EQ\nNBR r1, r0, east\nEND\nHALT")
    chip.run()
    assert np.array_equal(chip.registers[1], np.where(COLUMN == 1, 2, 0))


@pytest.mark.parametrize("depth", [1, 2, 7, 15])
@pytest.mark.parametrize("elses", [0, 1, 2, 3])
def test_nested_masks(depth: int, elses: int) -> None:
    """Level k keeps the NPs with column > k; ELSE at the deepest level takes the others."""
    machine = machine_of(1, 20)
    opened = "".join(f"CMP r0, #{k}\nWHERE HI\n" for k in range(depth))
    turned, closed = "ELSE\n" * elses, "END\n" * depth
    chip = chip_of(f"COL r0\n{opened}{turned}MOV r1, #1\n{closed}HALT", machine)
    chip.run()
    innermost = {depth - 1} if elses % 2 else set(range(depth, 20))
    assert {k for k in range(20) if chip.registers[1, 0, k]} == innermost
    assert chip.active.all()


@pytest.mark.parametrize("level", range(15))
def test_else_at_every_depth(level: int) -> None:
    """ELSE concerns the region that it stands in, not those around it."""
    machine = machine_of(1, 20)
    opened = "".join(f"CMP r0, #{k}\nWHERE HI\n" for k in range(15))
    inner, outer = "END\n" * (14 - level), "END\n" * (level + 1)
    chip = chip_of(f"COL r0\n{opened}{inner}ELSE\nMOV r1, #1\n{outer}HALT", machine)
    chip.run()
    assert np.flatnonzero(chip.registers[1]).tolist() == [level]


def test_flow_ignores_activity() -> None:
    chip = chip_of(
        """
            CMP r0, #0
            WHERE NE            ; nobody
              CALL routine
              JMP on
              NOP
        on:   EXPOSE
              HALT
            END
        routine: RET
        """
    )
    assert chip.run(clip_of(1, SMALL)).status == "halted"
    assert chip.frames_taken == 1


# ---- links, places, memory


@pytest.mark.parametrize(
    ("direction", "down", "right"),
    [("north", -1, 0), ("south", 1, 0), ("west", 0, -1), ("east", 0, 1)],
)
@pytest.mark.parametrize("shape", [(3, 4), (1, 1), (1, 5), (5, 1), (8, 10)])
def test_neighbours(direction: str, down: int, right: int, shape: tuple[int, int]) -> None:
    rows, columns = shape
    chip = chip_of(f"NBR r1, r0, {direction}\nNBR r0, r0, {direction}\nHALT", machine_of(*shape))
    held = np.random.default_rng(1).integers(1, 256, shape, np.uint8)
    chip.registers[0] = held
    chip.registers[1] = 99
    chip.run()
    expected = [
        [
            int(held[row + down, column + right])
            if 0 <= row + down < rows and 0 <= column + right < columns
            else 0
            for column in range(columns)
        ]
        for row in range(rows)
    ]
    assert chip.registers[1].tolist() == expected
    assert chip.registers[0].tolist() == expected  # all NPs read before any writes


def test_row_and_column() -> None:
    chip = chip_of("ROW r1\nCOL r2\nHALT", machine_of(256, 3))
    chip.run()
    assert chip.registers[1].tolist() == [[row] * 3 for row in range(256)]
    assert chip.registers[2].tolist() == [[0, 1, 2]] * 256


@pytest.mark.parametrize("size", [64, 128, 256])
def test_addresses_wrap_at_the_end_of_the_memory(size: int) -> None:
    machine = machine_of(16, 16, memory_bytes=size)
    banks = [bank for bank in (0, 64, 128, 192) if bank < size]
    for bank in banks:
        chip = chip_of(f"LD r1, [r0 + {bank}]\nST [r0 + {bank}], r2\nHALT", machine)
        assert chip.memory.shape == (size, 16, 16)
        own = np.arange(256, dtype=np.uint8).reshape(16, 16)
        before = np.random.default_rng(2).integers(0, 256, chip.memory.shape, np.uint8)
        chip.registers[0], chip.registers[2] = own, 255 - own
        chip.load_memory(0, before)
        chip.run()
        for row in range(16):
            for column in range(16):
                address = (int(own[row, column]) + bank) % size
                assert chip.registers[1, row, column] == before[address, row, column]
                expected = before[:, row, column].copy()
                expected[address] = 255 - own[row, column]
                assert np.array_equal(chip.memory[:, row, column], expected)


def test_addresses_in_the_instruction() -> None:
    chip = chip_of("MOV r1, #5\nST [0], r1\nST [255], r1\nLD r2, [255]\nLD r3, [254]\nHALT")
    chip.run()
    assert np.flatnonzero(chip.memory[:, 2, 3]).tolist() == [0, 255]
    assert chip.registers[:4, 2, 3].tolist() == [0, 5, 5, 0]


# ---- the global OR and flow


@pytest.mark.parametrize(
    ("jump", "who", "jumps"),
    [
        ("JANY EQ", "nobody", False),
        ("JNONE EQ", "nobody", True),
        ("JALL EQ", "nobody", False),
        ("JANY EQ", "all", True),
        ("JNONE EQ", "all", False),
        ("JALL EQ", "all", True),
        ("JANY EQ", "one", True),
        ("JNONE EQ", "one", False),
        ("JALL EQ", "one", False),
        ("JALL NE", "one", False),
        ("JNONE NE", "one", False),
    ],
)
@pytest.mark.parametrize("among", ["all", "some", "none"])
def test_global_or(jump: str, who: str, jumps: bool, among: str) -> None:
    """`who` of the active NPs meets EQ; the inactive ones, of which there may be all, do."""
    chip = chip_of(f"WHERE LO\n{jump}, taken\nMOV r1, #1\ntaken: END\nHALT")
    active = {"all": COLUMN >= 0, "some": COLUMN > 1, "none": COLUMN > 9}[among]
    meets = {"nobody": COLUMN > 9, "all": COLUMN >= 0, "one": (COLUMN == 2) & (ROW == 1)}[who]
    chip.flags["C"][:], chip.flags["Z"][:] = active, meets | ~active
    chip.run()
    if among == "none":
        jumps = not jump.startswith("JANY")
    assert chip.executions.tolist() == [1, 1, 0 if jumps else 1, 1, 1]
    assert np.array_equal(chip.registers[1], active & (not jumps))


def test_calls_nest_four_deep() -> None:
    calls = "CALL a\nMOV r0, #1\nHALT\na: CALL b\nRET\nb: CALL c\nRET\nc: CALL d\nRET\nd: "
    chip = chip_of(f"{calls}RET")
    for expected in ((1,), (1, 4), (1, 4, 6), (1, 4, 6, 8), (1, 4, 6), (1, 4), (1,), ()):
        assert chip.step() is None
        assert chip.stack == expected
    assert chip.pc == 1
    assert chip.run().status == "halted"
    deeper = chip_of(f"{calls}CALL e\nRET\ne: RET")
    assert failure(deeper) == ("NP301", 9, 10)
    assert deeper.stack == (1, 4, 6, 8)
    assert deeper.pc == 9


def test_stack_depth_of_the_machine() -> None:
    chip = chip_of("CALL a\nHALT\na: CALL b\nRET\nb: RET", machine_of(stack_depth=1))
    assert failure(chip) == ("NP301", 2, 3)


# ---- traps


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
    assert result.frame_cycles.tolist() == [10, 10]
    assert result.outputs["n"].tolist() == [0, 1]
    assert not result.last_complete


# ---- frames, cycles, instructions

LOOP = """
.output first, 0, scalar
.output n, 1, scalar
        MOV r0, #3
        NOP
frame:  EXPOSE
        SAMPLE signal, 0
        LD r1, [0]
        MOV r2, r0
.delay: SUB r2, #1
        JANY NE, .delay
        CMP r3, r3
        OUT 1, r0
        ADD r0, #1
        JMP frame
"""


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


@pytest.mark.parametrize("limit", range(2, 14))
def test_cycle_limit_is_tested_before_each_instruction(limit: int) -> None:
    """OUT takes 8 cycles from cycle 3 on: it starts below a limit of 4 and ends beyond."""
    chip = chip_of("EXPOSE\nNOP\nNOP\nOUT 0, r0\nNOP\nHALT")
    result = chip.run(clip_of(1, SMALL), max_cycles=limit)
    starts = [0, 1, 2, 3, 11, 12]
    ends = [1, 2, 3, 11, 12, 13]
    executed = sum(start < limit for start in starts)
    assert result.instructions == executed
    assert result.cycles == ends[executed - 1]
    assert result.status == ("halted" if executed == 6 else "cycle-limit")
    assert result.last_complete == (executed == 6)


def test_cycle_limit_is_per_frame() -> None:
    chip = chip_of("EXPOSE\nNOP\nNOP\nJMP 0")
    clip = clip_of(50, SMALL)
    result = chip.run(clip, max_cycles=4)
    assert (result.status, result.frames, result.cycles) == ("cycle-limit", 1, 4)
    chip.reset()
    result = chip.run(clip, max_cycles=5)
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
    """What was converted before, in whatever number, does not matter."""
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


# ---- going back

PICTURE = """
.output seen, 0, picture
.output sum, 1, scalar
frame:  EXPOSE
        SAMPLE signal, 0
        MOV r0, #0
.pixel: LD r1, [r0]
        OUT 0, r1
        ADD r0, #1
        CMP r0, #64
        JANY LO, .pixel
        ADD r2, #3
        OUT 1, r2
        JMP frame
"""


@pytest.mark.parametrize("steps", [0, 1, 2, 100, 329, 330, 500, 900])
def test_restore_resumes_identically(steps: int) -> None:
    """From anywhere, in the middle of a picture too."""
    clip = clip_of(3, SMALL)
    chip = chip_of(PICTURE)
    chip.feed(clip)
    for _ in range(steps):
        assert chip.step() is None
    at = chip.snapshot()
    before = state_of(chip)
    expected, after = summary(chip.run()), state_of(chip)
    for _ in range(2):
        chip.restore(at)
        assert state_of(chip) == before
        assert summary(chip.run()) == expected
        assert state_of(chip) == after
    taken = before["frames_taken"]
    pictures = np.array(expected["outputs"]["seen"])
    assert np.array_equal(pictures, clip[taken:]) or taken == 3


def test_restore_in_a_mask_and_a_routine() -> None:
    chip = chip_of("COL r0\nCMP r0, #2\nWHERE LO\nCALL a\nEND\nHALT\na: MOV r1, #1\nRET")
    for _ in range(4):
        chip.step()
    at = chip.snapshot()
    chip.run()
    chip.restore(at)
    assert chip.stack == (4,)
    assert np.array_equal(chip.active, COLUMN < 2)
    chip.run()
    assert np.array_equal(chip.registers[1], np.where(COLUMN < 2, 1, 0))


def test_snapshot_of_a_halted_chip() -> None:
    chip = chip_of("NOP\nHALT")
    start = chip.snapshot()
    chip.run()
    end = chip.snapshot()
    chip.restore(start)
    assert chip.run().instructions == 2
    chip.restore(end)
    assert chip.run().instructions == 0


def test_reset_clears_all_but_the_program() -> None:
    chip, fresh = chip_of(LOOP), chip_of(LOOP)
    chip.run(clip_of(2, SMALL), max_cycles=270)
    chip.reset()
    assert state_of(chip) == state_of(fresh)
    assert not chip.memory.any()
    assert summary(chip.run()) == summary(fresh.run())


def test_arrays_stay_live_after_going_back() -> None:
    chip = chip_of("ADD r1, #1\nHALT")
    registers, carry, at = chip.registers, chip.flags["C"], chip.snapshot()
    registers[1] = 255
    chip.run()
    assert carry.all()
    chip.restore(at)
    assert not carry.any()
    chip.step()
    assert (registers[1] == 1).all()


@pytest.mark.parametrize("taken", [1, 2, 3])
def test_frames_of_a_generator_are_never_the_wrong_ones(taken: int) -> None:
    """Going back beyond what is still held is refused, even where the generator has some left."""
    clip = clip_of(3, SMALL)
    chip = chip_of(PICTURE)
    chip.feed(frame for frame in clip)
    at = chip.snapshot()
    while chip.frames_taken < taken:
        chip.step()
    chip.restore(at)
    if taken == 1:  # the last frame may be held
        assert np.array_equal(chip.run().outputs["seen"], clip)
        return
    with pytest.raises(InputError, match="cannot be taken twice") as caught:
        chip.run()
    assert caught.value.code == "NP106"
    assert caught.value.hint is not None


@pytest.mark.parametrize("kind", ["array", "list", "generator"])
def test_any_kind_of_frames(kind: str) -> None:
    clip = clip_of(3, SMALL)
    given: Any = {"array": clip, "list": list(clip), "generator": (frame for frame in clip)}[kind]
    chip = chip_of(PICTURE)
    result = chip.run(given)
    assert np.array_equal(result.outputs["seen"], clip)
    assert chip.run().status == "frames-exhausted"  # those are all, however often one asks


@pytest.mark.parametrize("kind", ["array", "list"])
def test_going_back_in_frames_that_can_be_read_again(kind: str) -> None:
    clip = clip_of(3, SMALL)
    chip = chip_of(PICTURE)
    chip.feed(clip if kind == "array" else list(clip))
    at = chip.snapshot()
    expected = summary(chip.run())
    chip.restore(at)
    assert summary(chip.run()) == expected


# ---- outputs


def run_sends(kind: str, body: str, frames: int = 1) -> RunResult:
    """Run `body` once for each frame, with one output of a kind at port 2; r15 counts frames."""
    source = f".output it, 2, {kind}\nMOV r15, #255\nframe: EXPOSE\nADD r15, #1\n{body}\nJMP frame"
    return chip_of(source).run(clip_of(frames, SMALL))


def test_scalar_is_the_last_byte() -> None:
    result = run_sends("scalar", "OUT 2, r1\nADD r1, #7\nOUT 2, r1", 3)
    assert result.outputs["it"].tolist() == [7, 14, 21]
    assert result.outputs["it"].dtype == np.int32
    assert not np.ma.isMaskedArray(result.outputs["it"])
    assert result.value("it", 2) == 21


@pytest.mark.parametrize("kind", ["scalar", "scalar16", "list"])
def test_scalars_must_agree(kind: str) -> None:
    source = f"""
    .output it, 2, {kind}
        NOP
        EXPOSE
        ROW r0
        CMP r0, #0
        WHERE NE                ; the first row does not matter
          COL r1
          OUT 2, r1
          OUT 2, r1
        END
        NOP
        EXPOSE
    """
    chip = chip_of(source)
    result = chip.run(clip_of(2, SMALL))
    assert result.status == "failed"
    assert result.error is not None
    assert result.error.code == "NP310"
    assert (result.error.address, result.error.file) == (7 if kind == "scalar" else 6, FILE)
    assert result.error.line == (9 if kind == "scalar" else 8)
    assert result.error.processor == (1, 1)
    assert "NP(1,0) sent 0 and NP(1,1) sent 1" in result.error.message
    # The frame stays in the account, without its outputs.
    assert result.frame_cycles.tolist() == [7 + 2 * 8]
    assert (result.setup.cycles, result.cycles) == (1, chip.cycles)
    assert result.value("it", 0) is None
    assert not result.last_complete


@pytest.mark.parametrize(
    ("kind", "sends", "expected"), [("scalar", 1, 5), ("list", 2, [5, 5]), ("scalar16", 2, 0x0505)]
)
def test_only_active_processors_must_agree(kind: str, sends: int, expected: Any) -> None:
    """The 0 of those that did not send is no byte of theirs."""
    sending = "OUT 2, r1\n" * sends
    result = run_sends(kind, f"MOV r1, #5\nCOL r2\nCMP r2, #1\nWHERE HI\n{sending}END")
    assert result.status == "frames-exhausted"
    assert result.value("it", 0) == expected


@pytest.mark.parametrize("end", ["HALT", "RET", "JMP end", "EXPOSE"])
def test_outputs_that_cannot_be_read(end: str) -> None:
    """Judged where a frame is complete; one that was cut short may have sent half of them."""
    source = f".output it, 2, scalar16\nNOP\nEXPOSE\nOUT 2, r1\nend: {end}\nHALT"
    chip = chip_of(source)
    result = chip.run(clip_of(1, SMALL), max_cycles=20)
    assert result.error is None or result.error.code == {"RET": "NP302"}.get(end, "NP311")
    assert (result.status == "cycle-limit") == (end == "JMP end")
    assert result.frames == 1
    assert result.cycles == chip.cycles
    assert result.value("it", 0) is None
    assert not result.last_complete


def test_setup_that_cannot_be_read() -> None:
    chip = chip_of(".output it, 2, scalar16\nOUT 2, r1\nNOP\nEXPOSE\nHALT")
    result = chip.run(clip_of(1, SMALL))
    assert result.error is not None
    assert (result.error.code, result.error.address) == ("NP311", 0)
    assert (result.setup.cycles, result.setup.complete, result.frames) == (9, False, 0)
    assert result.setup.outputs == {"it": None}


def test_scalar_of_sixteen_bits() -> None:
    result = run_sends("scalar16", "MOV r1, #52\nOUT 2, r1\nMOV r1, #254\nOUT 2, r1", 2)
    assert result.outputs["it"].tolist() == [254 * 256 + 52] * 2
    for sends in (1, 3):
        result = run_sends("scalar16", "OUT 2, r1\n" * sends)
        assert result.error is not None
        assert result.error.code == "NP311"
        assert f"found {sends}" in result.error.message


def test_list_is_every_send() -> None:
    body = "CMP r15, #1\nJANY EQ, frame\nOUT 2, r15\nMOV r1, #9\nOUT 2, r1\nOUT 2, r1"
    result = run_sends("list", body, 3)
    assert result.outputs["it"] == [[0, 9, 9], None, [2, 9, 9]]
    assert result.value("it", 1) is None


def test_plane_is_the_last_send() -> None:
    body = "CMP r15, #1\nJANY EQ, frame\nOUT 2, r1\nROW r1\nADD r1, r15\nOUT 2, r1"
    result = run_sends("plane", body, 3)
    planes = result.outputs["it"]
    assert planes.shape == (3, 3, 4)
    assert plane(result.value("it", 0)) == ROW.tolist()
    assert plane(result.value("it", 2)) == (ROW + 2).tolist()
    assert result.value("it", 1) is None
    assert planes.mask[1].all()
    assert not planes.mask[0].any()


@pytest.mark.parametrize("sends", [63, 64, 65])
def test_picture_is_64_sends(sends: int) -> None:
    body = f"MOV r0, #0\n.more: OUT 2, r0\nADD r0, #1\nCMP r0, #{sends}\nJANY LO, .more"
    result = run_sends("picture", body)
    if sends == 64:
        assert result.status == "frames-exhausted"
        picture = result.outputs["it"][0]
        expected = [[8 * (y % 8) + x % 8 for x in range(32)] for y in range(24)]
        assert picture.tolist() == expected
    else:
        assert result.error is not None
        assert result.error.code == "NP311"
        assert f"found {sends}" in result.error.message


@pytest.mark.parametrize("kind", ["scalar", "scalar16", "list", "plane", "picture"])
def test_nothing_sent(kind: str) -> None:
    result = run_sends(kind, "NOP", 2)
    assert [result.value("it", k) for k in range(2)] == [None, None]
    assert result.setup.outputs == {"it": None}
    column = result.outputs["it"]
    assert len(column) == 2
    assert kind == "list" or column.mask.all()


@pytest.mark.parametrize("kind", ["scalar", "scalar16", "list", "plane", "picture"])
def test_sends_without_an_active_processor(kind: str) -> None:
    """None for scalars; zeros for planes and pictures."""
    sends = {"scalar16": 2, "picture": 64}.get(kind, 1)
    sending = "OUT 2, r1\n" * sends
    result = run_sends(kind, f"MOV r1, #5\nCMP r1, #5\nWHERE NE\n{sending}END")
    assert result.status == "frames-exhausted"
    value = result.value("it", 0)
    if kind in {"plane", "picture"}:
        assert not any(number for row in plane(value) for number in row)
    else:
        assert value is None


def test_ports_without_a_name() -> None:
    chip = chip_of(
        """
        .output named, 0, scalar
                OUT 9, r0
        frame:  EXPOSE
                ADD r0, #1
                OUT 0, r0
                COL r1
                CMP r1, r0
                WHERE LO
                  OUT 15, r1
                END
                CMP r0, #2
                JANY NE, frame
                OUT 3, r0
                JMP frame
        """
    )
    result = chip.run(clip_of(3, SMALL))
    assert set(result.outputs) == {"named", "port3", "port15"}
    assert result.setup.outputs["named"] is None
    assert plane(result.setup.outputs["port9"]) == [[0] * 4] * 3
    assert result.value("port3", 0) is None
    assert plane(result.value("port3", 1)) == [[2] * 4] * 3
    assert plane(result.value("port15", 2)) == [[0, 1, 2, 0]] * 3


def test_a_run_that_halts_completes_its_frame() -> None:
    result = chip_of(".output n, 0, scalar\nEXPOSE\nMOV r1, #8\nOUT 0, r1\nHALT").run(
        clip_of(3, SMALL)
    )
    assert (result.status, result.last_complete) == ("halted", True)
    assert result.outputs["n"].tolist() == [8]
    assert result.frame_cycles.tolist() == [11]


# ---- the Python interface


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


# ---- what engines never do


def test_engines_know_nothing_of_the_world_outside() -> None:
    """They neither print, open files nor read clocks, and import nothing that shows results."""
    folder = Path(npchip.__file__).parent / "engines"
    files = sorted(folder.rglob("*.py"))
    assert len(files) >= 5
    assert {"lowering.py", "reference.py"} <= {file.name for file in files}
    calls = {"print", "open", "input", "exec", "eval", "breakpoint", "__import__"}
    modules = {"time", "datetime", "os", "sys", "io", "pathlib", "random", "logging", "subprocess"}
    layers = {"npchip.cli", "npchip.report", "npchip.assembler", "npchip.chip", "npchip.frames"}
    for file in files:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            imported: list[str] = []
            if isinstance(node, ast.Import):
                imported = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 0, file
                imported = [f"{node.module}.{alias.name}" for alias in node.names]
            elif isinstance(node, ast.Name):
                assert node.id not in calls, f"{file}:{node.lineno}"
            for name in imported:
                place = f"{file}: {name}"
                assert name.partition(".")[0] not in modules, place
                assert not any(name == item or name.startswith(f"{item}.") for item in layers), (
                    place
                )
