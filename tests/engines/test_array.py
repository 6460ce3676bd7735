"""Masks, links, places, memory, the global OR and flow."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.chips import chip_of, clip_of, failure, machine_of, places, plane

SMALL = machine_of()
ROW, COLUMN = places(SMALL)


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
