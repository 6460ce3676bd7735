"""Bounds of cycles, known without running, against runs."""

from __future__ import annotations

import math
from pathlib import Path
from random import Random

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from npchip import Chip, assemble_text, load_machine
from npchip.cli.main import cli
from npchip.formats.npo import from_text, to_text
from npchip.isa import load_isa
from npchip.profile import profile_of
from npchip.program.bounds import StaticView, static_view
from npchip.program.paths import CycleRange
from tests.engines.wasm.test_host import own
from tests.support.clips import bundled_clips
from tests.support.profiles import THOROUGH
from tests.support.programs import assembled
from tests.support.random_programs import draw_case

ASM = Path(__file__).parents[2] / "asm"
PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
QUICK = {"trajectory", "statistics", "fusion_lut"}
UNBOUNDED = {"keypoints", "polygons", "recognise"}
"""The length of an edge depends on the picture."""
FRAMES = None if THOROUGH else 8
MACHINES = ("default", "conservative")


def view_of(source: str) -> StaticView:
    return static_view(assemble_text(source), load_machine("default"))


def test_ranges_of_cycles_are_added_repeated_and_joined() -> None:
    """A part without cycles takes none if repeated without end; any part takes none 0 times."""
    one, none, endless = CycleRange(2, 3), CycleRange(0, 0), CycleRange(1, math.inf)
    assert one.then(endless) == CycleRange(3, math.inf)
    assert one.times(2, 5) == CycleRange(4, 15)
    assert one.times(0, math.inf) == CycleRange(0, math.inf)
    assert none.times(1, math.inf) == endless.times(0, 0) == none
    assert one.or_(endless) == CycleRange(1, math.inf)
    assert one.or_(None) == one


def within(span: CycleRange | None, cycles: int) -> bool:
    return span is not None and span.least <= cycles <= span.most


def test_a_branch_makes_a_span_and_a_known_one_does_not() -> None:
    open_ = "LD r0, [5]\nCMP r0, #1\nJANY EQ, a\nNOP\nNOP\na: HALT"
    assert view_of(open_).setup == (4, 6)
    assert view_of(open_.replace("LD r0, [5]", "MOV r0, #1")).setup == (4, 4)
    assert view_of(open_.replace("LD r0, [5]", "MOV r0, #2")).setup == (6, 6)


def test_a_routine_has_its_own_cycles() -> None:
    view = view_of(
        "CALL f\nCALL g\nHALT\nf: NOP\ng: LD r0, [1]\nCMP r0, #0\nJANY EQ, .e\nNOP\n.e: RET"
    )
    assert [(routine.address, routine.cycles) for routine in view.routines] == [
        (3, (5, 6)),
        (4, (4, 5)),
    ]
    assert view.setup == (2 + 5 + 4 + 1, 2 + 6 + 5 + 1)


def test_straight_runs_begin_where_ways_part_or_meet() -> None:
    view = view_of("NOP\nSAMPLE reset, 0\na: NOP\nJANY EQ, a\nNOP\nNOP\nHALT\nNOP")
    assert view.runs == (1, 257, 1, 2, 1, 2, 3, 0)


def test_what_a_program_reads_before_it_has_written_it() -> None:
    view = view_of(
        "SBC r3, r3\nf: EXPOSE\nADD r1, #1\nMOV r2, #1\nADD r2, r1\nJANY EQ, f\nMOV r4, #0\nJMP f"
    )
    assert view.assumes == {0: ("C",), 2: ("r1",)}


def test_stated_passes_survive_an_object_file() -> None:
    program = assemble_text(".loop 4, 20\nl: LD r0, [5]\nCMP r0, #1\nJANY NE, l\nHALT")
    assert program.loops == {0: (4, 20)}
    assert from_text(to_text(program, load_isa()), "x.npo", load_isa()).loops == {0: (4, 20)}


@settings(max_examples=200 if THOROUGH else 20)
@given(st.randoms(use_true_random=False))
def test_spans_hold_on_random_programs(random: Random) -> None:
    case = draw_case(random, plain=True)
    program = case.program()
    view = static_view(program, case.machine)
    chip = Chip(program, case.machine)
    rng = np.random.default_rng(case.seed)
    chip.memory[...] = rng.integers(0, 256, chip.memory.shape, np.uint8)
    result = chip.run(case.clip() if case.frames else None)
    assert all(loop.why == "proven" for loop in view.loops), case.text
    check(
        view,
        result.setup.cycles if result.frames or result.status == "halted" else None,
        result.frame_cycles[: len(result.frame_cycles) - (not result.last_complete)].tolist(),
    )


def check(view: StaticView, setup: int | None, frames: list[int]) -> None:
    """Assert that the measured cycles lie inside the bounds."""
    if setup is not None:
        assert within(view.setup, setup)
    for cycles in frames:
        assert within(view.frame, cycles)


@given(
    st.lists(
        st.sampled_from(
            [
                "NOP",
                "ADD r0, r1",
                "SAMPLE reset, 0",
                "OUT 0, r0",
                "LD r1, [3]",
                "WHERE EQ",
                "ELSE",
                "END",
                "NBR r2, r0, north",
                "CALL f",
            ]
        ),
        max_size=40,
    ),
    st.sampled_from(MACHINES),
)
def test_straight_line_code_takes_what_is_said(lines: list[str], name: str) -> None:
    depth, kept = 0, []
    for line in lines:
        if (line in {"ELSE", "END"} and not depth) or (line == "CALL f" and depth):
            continue
        depth += (line == "WHERE EQ") - (line == "END")
        kept.append(line)
    source = "\n".join([*kept, *["END"] * depth, "HALT", "f: NOP", "ST [4], r0", "RET"])
    machine = load_machine(name)
    program = assemble_text(source, machine=machine)
    assert static_view(program, machine).setup == (Chip(program, machine).run().cycles,) * 2


def check_clip(chip: Chip, view: StaticView, clip: str) -> None:
    """Set-up, frames and routines of a run."""
    program = chip.program
    chip.reset()
    chip.connect(lambda request: np.full((8, 10), 40 + request.index, np.uint8))
    memory = ASM.parent / "examples" / "templates" / "disc.npy"
    if program.name == "correlate":
        chip.load_memory(128, np.load(memory)[:64])
    result = chip.run(bundled_clips()[clip][:FRAMES])
    assert result.status == "frames-exhausted"
    calls = {call.name: call for _, call in profile_of(chip, result).calls.walk()}
    for routine in view.routines:
        name = next(key for key, at in program.labels.items() if at == routine.address)
        call = calls.get(name)
        if call is not None and routine.cycles is not None:
            assert (call.calls - 1) * routine.cycles.least <= call.total
            assert call.total <= call.calls * routine.cycles.most
    frames = result.frame_cycles.tolist()
    check(view, result.setup.cycles, frames)
    assert view.frame is not None
    if view.frame.least == view.frame.most:
        assert set(frames) == {view.frame.least}


@pytest.mark.parametrize(
    "machine", ["default", pytest.param("conservative", marks=pytest.mark.long)]
)
@pytest.mark.parametrize(
    "name",
    [name if name in QUICK else pytest.param(name, marks=pytest.mark.long) for name in PROGRAMS],
)
def test_spans_hold_on_real_clips(name: str, machine: str) -> None:
    program = assembled(name, machine)
    view = static_view(program, load_machine(machine))
    assert view.frame is not None
    assert (view.frame.most == math.inf) == (name in UNBOUNDED)
    chip = Chip(program, machine, profile=True)
    quick = ("coin_slide",) if machine == "default" else ("shapes_drawn",)
    for clip in bundled_clips() if THOROUGH else quick:
        check_clip(chip, view, clip)


# ---- the command


def test_the_command_shows_bounds() -> None:
    done = CliRunner().invoke(cli, ["asm", str(ASM / "trajectory.s"), "--cycles"])
    assert done.exit_code == 0
    assert "  frame    1,692 to 2,033\n" in done.stdout
    assert "  capture  1,648\n" in done.stdout
    assert "moving_box.s:17: 8\n" in done.stdout
    assert "trajectory.s:59: r15\n" in done.stdout
    slow = CliRunner().invoke(
        cli, ["asm", str(ASM / "keypoints.s"), "--cycles", "--machine", "conservative"]
    )
    assert "  frame   2,168 or more\n" in slow.stdout
    assert "or more" in slow.stdout
    assert ", as .loop states\n" in slow.stdout
    assert ": .loop MOST above it would bound them\n" in slow.stdout


def test_what_never_ends_is_called_so(tmp_path: Path) -> None:
    path = tmp_path / "loop.s"
    path.write_text("loop: ADD r0, #1\n JMP loop\n", encoding="utf-8")
    done = CliRunner().invoke(cli, ["asm", str(path), "--cycles"])
    assert done.exit_code == 0
    assert "  run  never ends\n" in done.stdout


def test_the_listing_has_runs_and_passes() -> None:
    done = CliRunner().invoke(cli, ["asm", str(ASM / "imaging.s"), "--listing", "--cycles"])
    assert done.exit_code == 0
    assert "        64     37  " in done.stdout
    assert "\n\nimaging on machine default, from reset\n" in done.stdout


def test_a_program_with_too_many_ways_is_refused(tmp_path: Path) -> None:
    source = tmp_path / "x.s"
    calls = [f"f{n}: " + f"CALL f{n + 1}\n" * 14 + "RET\n" for n in range(3)]
    source.write_text("CALL f0\nHALT\n" + "".join(calls) + "f3: RET\n")
    done = CliRunner().invoke(cli, ["asm", str(source), "--cycles"])
    assert done.exit_code == 2
    assert "[NP620]" in done.stderr


def test_a_line_from_which_a_macro_of_another_file_is_used_is_named_with_its_file(
    tmp_path: Path,
) -> None:
    """The number of the line stood alone, after the name of the other file."""
    (tmp_path / "lib.inc").write_text("; a library\n.macro again\n.x: ADD r0, #1\n JMP .x\n.endm\n")
    source = tmp_path / "p.s"
    source.write_text('.include "lib.inc"\nf: EXPOSE\n SAMPLE signal, 0\n again\n')
    done = CliRunner().invoke(cli, ["asm", str(source), "--cycles"])
    assert f"lib.inc:3 (from {source}:4)" in done.output


def test_a_routine_that_begins_with_a_loop_takes_all_its_passes() -> None:
    view = view_of("MOV r1, #5\nCALL f\nHALT\nf: SUB r1, #1\nJANY NE, f\nRET")
    (routine,) = view.routines
    assert routine.cycles == CycleRange(5 * 2 + 1, 5 * 2 + 1)
    assert view.setup == CycleRange(1 + 1 + 11 + 1, 1 + 1 + 11 + 1)


@pytest.mark.parametrize(
    ("meaning", "passes"),
    [
        ("mask_pop()\nrd = 5", (5, 5, "proven")),  # written where all NPs are active again
        ("rd = 5\nmask_pop()", (1, math.inf, "unbounded")),  # in some NPs only
    ],
)
def test_masks_and_writes_of_one_instruction_are_taken_in_their_order(
    meaning: str, passes: tuple[int, float, str]
) -> None:
    isa = own(("LEAVE", "{rd}", "1111 dddd 0000 0000", meaning))
    source = "ROW r1\nWHERE EQ\nLEAVE r1\nl: SUB r1, #1\nJANY NE, l\nHALT"
    program = assemble_text(source, isa=isa)
    (loop,) = static_view(program, load_machine("default"), isa).loops
    assert (loop.least, loop.most, loop.why) == passes
