"""Counts of both engines for a profile, against counting by hand while stepping."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from npchip import Chip, assemble_text
from npchip.engines.base import TrapError
from npchip.engines.rows import ACTIVE, ENTERED, EXECUTED, TAKEN
from npchip.isa import parse_isa
from tests.engines.wasm.test_extended import entry
from tests.support.chips import chip_of, machine_of
from tests.support.clips import bundled_clips
from tests.support.lockstep import assert_engines_agree, counts_difference
from tests.support.profiles import THOROUGH
from tests.support.programs import assembled
from tests.support.random_programs import draw_case

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip.engines.counts import Counts

ASM = Path(__file__).parents[2] / "asm"
PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
LIMIT = 1_300 if not THOROUGH else 200_000
FRAMES = 2 if not THOROUGH else 3

ENGINES: tuple[Literal["reference", "wasm"], ...] = ("reference", "wasm")

By_stack = dict[tuple[int, ...], "NDArray[np.int64]"]


def by_hand(chip: Chip, clip: NDArray[np.uint8], limit: int) -> By_stack:
    """Step through a run with only the public view of the chip."""
    found: By_stack = {}
    words = chip.program.words
    chip.feed(clip)
    frame, start = 0, 0
    while True:
        address, stack, before = chip.pc, chip.stack, int(chip.active.sum())
        if chip.cycles - start >= limit:
            return found
        decoded = chip.isa.decode(words[address])
        assert decoded is not None
        name = decoded.form.instruction
        condition = np.zeros_like(chip.active)
        if name in {"WHERE", "JANY", "JNONE"}:
            zero, carry = chip.flags["Z"], chip.flags["C"]
            condition = {
                "EQ": zero,
                "NE": ~zero,
                "LO": carry,
                "HS": ~carry,
                "HI": ~carry & ~zero,
                "LS": carry | zero,
            }[str(decoded.values["cc"])].copy()
        active = chip.active
        old = chip.cycles
        try:
            stop = chip.step()
        except TrapError:
            return found
        if stop == "frames-exhausted":
            return found
        table = found.setdefault(stack, np.zeros((4, len(words)), np.int64))
        table[EXECUTED, address] += 1
        table[ACTIVE, address] += before
        if name in {"JANY", "JNONE"}:
            table[TAKEN, address] += bool((condition & active).any()) == (name == "JANY")
        elif name in {"JMP", "CALL", "RET"}:
            table[TAKEN, address] += 1
        elif name == "WHERE":
            table[ENTERED, address] += int((condition & active).sum())
        if chip.frames_taken != frame:
            frame, start = chip.frames_taken, old
        if stop:
            return found


def plain(counts: Counts | None) -> dict[tuple[int, ...], Any]:
    """Tables that ``==`` compares."""
    assert counts is not None
    return {stack: table.tolist() for stack, table in counts.used()}


@pytest.mark.long
@pytest.mark.parametrize("name", PROGRAMS)
def test_both_engines_count_what_stepping_shows(name: str) -> None:
    program = assembled(name)
    clip = bundled_clips()["coin_slide"][5 : 5 + FRAMES]
    expected = by_hand(Chip(program, engine="reference"), clip, LIMIT)
    assert expected
    for engine in ENGINES:
        chip = Chip(program, engine=engine, profile=True)
        chip.run(clip, max_cycles=LIMIT)
        assert plain(chip.counts) == {stack: t.tolist() for stack, t in expected.items()}
        counts = chip.counts
        assert counts is not None
        assert counts.total()[EXECUTED].tolist() == chip.executions.tolist()


@settings(max_examples=300 if THOROUGH else 25)
@given(st.randoms(use_true_random=False))
def test_the_engines_count_the_same_on_random_programs(random: Random) -> None:
    assert_engines_agree(replace(draw_case(random), profile=True))


def test_each_call_has_its_own_table() -> None:
    chip = Chip(
        assemble_text("CALL one\nCALL one\nHALT\none: CALL two\nRET\ntwo: NOP\nRET\n"),
        engine="wasm",
        profile=True,
    )
    chip.run()
    counts = chip.counts
    assert counts is not None
    assert [stack for stack, _ in counts.used()] == [(), (1,), (2,), (1, 4), (2, 4)]
    assert counts.tables[2, 4][EXECUTED].tolist() == [0, 0, 0, 0, 0, 1, 1]


def test_masks_are_counted_in_nps() -> None:
    machine = machine_of(3, 4)
    source = "ROW r0\nCMP r0, #1\nWHERE LO\nNOP\nELSE\nNOP\nEND\nHALT\n"
    for engine in ENGINES:
        chip = Chip(
            assemble_text(source, machine=machine),
            machine,
            engine,
            profile=True,
        )
        chip.run()
        counts = chip.counts
        assert counts is not None
        assert counts.total()[ACTIVE].tolist() == [12, 12, 12, 4, 4, 8, 8, 12]
        assert counts.total()[ENTERED].tolist() == [0, 0, 4, 0, 0, 0, 0, 0]


def test_counts_follow_snapshots_and_resets() -> None:
    chip = Chip(chip_of("MOV r0, #3\nl: SUB r0, #1\nJANY NE, l\nHALT\n").program, machine_of())
    assert chip.counts is None
    chip = Chip(chip.program, machine_of(), profile=True)
    chip.step()
    start = chip.snapshot()
    chip.run()
    first = plain(chip.counts)
    chip.restore(start)
    chip.run()
    assert plain(chip.counts) == first
    counts = chip.counts
    assert counts is not None
    assert counts.total()[TAKEN].tolist() == [0, 0, 2, 0]
    chip.reset()
    assert plain(chip.counts) == {}


def test_each_caller_of_a_routine_counts_its_own_nps() -> None:
    """Both calls, and what they count, are one block."""
    source = (
        "COL r0\nCMP r0, #1\nCALL some\nCMP r0, #2\nCALL some\nHALT\n"
        "some: WHERE LO\nNOP\nEND\nRET\n"
    )
    machine = machine_of(3, 4)
    for engine in ENGINES:
        chip = Chip(assemble_text(source, machine=machine), machine, engine, profile=True)
        chip.run()
        counts = chip.counts
        assert counts is not None
        assert counts.tables[3,][ENTERED, 6] == counts.tables[3,][ACTIVE, 7] == 3
        assert counts.tables[5,][ENTERED, 6] == counts.tables[5,][ACTIVE, 7] == 6


def test_alike_nps_of_a_batch_of_long_frames_are_counted() -> None:
    """Short frames first, so that many long ones are taken at once; 8 * 10 ** 9 NPs in all."""
    source = """
        frame:  EXPOSE
                ADD r8, #1
                ADC r9, #0
                CMP r9, #2
                JANY LO, frame
                MOV r4, #243
        outer:  MOV r3, #0
        inner:  SUB r3, #1
                JANY EQ, on
                MOV r1, r2
        on:     JANY NE, inner
                SUB r4, #1
                JANY NE, outer
                JMP frame
    """
    machine = machine_of(8, 16)
    chip = Chip(assemble_text(source, machine=machine), machine, "wasm", profile=True)
    chip.run(np.zeros((1536, machine.rows, machine.cols), np.uint8))
    counts = chip.counts
    assert counts is not None
    executed, active = counts.total()[[EXECUTED, ACTIVE]]
    assert executed[7] == 1025 * 243 * 256
    assert (active == executed * machine.np_rows * machine.np_cols).all()


@pytest.mark.long
def test_nps_of_a_batch_of_long_frames_are_counted_in_a_partly_filled_vector() -> None:
    """132 NPs take nine vectors, of which the last has four; 64 and 512 frames are short."""
    source = """
                COL r0
                MOV r2, #1
        frame:  EXPOSE
                ADD r8, #1
                ADC r9, #0
                MOV r10, r8
                SHR r10, #6
                MOV r11, r9
                SHL r11, #2
                OR  r10, r11
                CMP r10, #9
                JANY LO, frame
                MOV r5, #2
        again:  MOV r4, #241
        outer:  CMP r0, #64
                WHERE LO
        inner:  ADD r1, r2
                JANY NE, inner
                END
                SUB r4, #1
                JANY NE, outer
                SUB r5, #1
                JANY NE, again
                JMP frame
    """
    machine = machine_of(11, 12)
    chip = Chip(assemble_text(source, machine=machine), machine, "wasm", profile=True)
    chip.run(np.zeros((576 + 992 + 3, machine.rows, machine.cols), np.uint8))
    counts = chip.counts
    assert counts is not None
    executed, active = counts.total()[[EXECUTED, ACTIVE]]
    assert executed[16] == 996 * 2 * 241 * 256
    assert (active == executed * 132).all()


@pytest.mark.parametrize("passes", [2, 3, 9])
@pytest.mark.parametrize("rest", ["", "MOV r7, r15\nAND r7, #1\nCMP r7, #0\n"])
def test_nps_of_a_region_that_is_open_from_one_pass_to_the_next(passes: int, rest: str) -> None:
    source = (
        f"COL r0\nMOV r15, #{passes}\nCMP r0, #2\nWHERE LO\nl: ADD r1, #1\nEND\nSUB r15, #1\n"
        f"MOV r6, r15\nCMP r3, r3\n{rest}WHERE EQ\nCMP r15, #0\nJANY NE, l\nADD r2, #1\nEND\n"
        "ADD r2, #1\nHALT"
    )
    machine = machine_of()
    program = assemble_text(source, machine=machine)
    chips = [Chip(program, machine, engine, profile=True) for engine in ENGINES]
    for chip in chips:
        chip.run()
    assert not counts_difference(chips[0].counts, chips[1].counts)


@pytest.mark.parametrize("passes", [2, 3, 9])
def test_nps_of_regions_that_are_exchanged_within_a_pass(passes: int) -> None:
    isa = parse_isa(
        "extends: npchip\nname: test\ninstructions:\n"
        + entry("SWAP", "{rd}, {rs}", "1111 dddd ssss 0000", "mask_pop()\nmask_push(rd < rs)"),
        "test.yaml",
    )
    source = (
        f"COL r0\nMOV r15, #{passes}\nMOV r6, #2\nCMP r3, r3\nWHERE EQ\nCMP r3, r3\nWHERE EQ\n"
        "l: SWAP r0, r6\nADD r1, #1\nELSE\nADD r2, #1\nEND\nSUB r15, #1\nCMP r3, r3\nWHERE EQ\n"
        "CMP r15, #0\nJANY NE, l\nEND\nEND\nHALT"
    )
    machine = replace(machine_of(), mask_depth=8)
    program = assemble_text(source, machine=machine, isa=isa)
    chips = [Chip(program, machine, engine, isa, profile=True) for engine in ENGINES]
    for chip in chips:
        assert chip.run().status == "halted"
    assert not counts_difference(chips[0].counts, chips[1].counts)
