"""The compiled engine against the reference engine: random programs, states and frames."""

from __future__ import annotations

import _thread
import re
import signal
import threading
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from npchip import Chip, Program, assemble_text
from npchip.engines.wasm.host.session import Session
from npchip.engines.wasm.translate.regions import Regions
from npchip.run.result import FrameRecord
from tests.support.chips import clip_of, machine_of
from tests.support.lockstep import (
    assert_engines_agree,
    first_divergence,
    result_difference,
    state,
    state_difference,
)
from tests.support.profiles import THOROUGH, parts
from tests.support.random_programs import draw_case

SHARES = 30
"""Tests that share the random programs. See docs/engine.md for a million."""
SHRINKING = 2_000 if THOROUGH else 30
SEEDED = 100
LARGE = 12


@pytest.mark.parametrize("share", parts(1, SHARES))
def test_random_programs(share: int) -> None:
    for seed in range(share * SEEDED, (share + 1) * SEEDED):
        assert_engines_agree(draw_case(Random(seed)))


@pytest.mark.parametrize("share", parts(1, 20))
def test_random_programs_on_large_arrays(share: int) -> None:
    for seed in range(share * LARGE, (share + 1) * LARGE):
        assert_engines_agree(draw_case(Random(seed), large=True))


@pytest.mark.parametrize("_share", parts(2, 10))
@settings(max_examples=SHRINKING)
@given(random=st.randoms(use_true_random=False))
def test_random_programs_that_shrink(_share: int, random: Random) -> None:
    assert_engines_agree(draw_case(random))


def both(source: str, frames: int = 0, limit: int = 50_000_000) -> tuple[Chip, Chip]:
    """Run a source on both engines, with equal results."""
    machine = machine_of()
    program = assemble_text(source, "test.s", machine)
    slow, fast = Chip(program, machine, "reference"), Chip(program, machine, "wasm")
    clip = clip_of(frames, machine) if frames else None
    expected, found = slow.run(clip, max_cycles=limit), fast.run(clip, max_cycles=limit)
    assert found.engine == "wasm"
    assert not result_difference(expected, found)
    assert not state_difference(state(slow), state(fast))
    return slow, fast


@pytest.mark.parametrize("limit", [1, 2, 3, 5, 10, 99, 100, 101, 5000])
def test_the_cycle_limit_is_exact(limit: int) -> None:
    both("loop: ADD r0, #1\n SUB r1, r0\n COL r2\n JMP loop\n", limit=limit)


def test_the_cycle_limit_is_exact_where_a_run_begins_shortly_before_it() -> None:
    machine = machine_of()
    program = assemble_text("SAMPLE signal, 0\n" + "ADD r1, #1\n" * 9 + "HALT", "test.s", machine)
    results = []
    for engine in ("reference", "wasm"):
        chip = Chip(program, machine, engine)
        chip.step()
        results.append((chip.run(max_cycles=260).status, chip.cycles, chip.pc))
    assert results == [("cycle-limit", 260, 5)] * 2


def test_an_endless_loop_ends_soon() -> None:
    machine = machine_of()
    chip = Chip(assemble_text("loop: ADD r0, #1\n JMP loop\n", "test.s", machine), machine, "wasm")
    result = chip.run()
    assert result.status == "cycle-limit"
    assert result.cycles == 50_000_000
    assert chip.executions.tolist() == [25_000_000, 25_000_000]


def test_a_jump_into_a_loop() -> None:
    """The graph is irreducible: the loop has two entries."""
    both(
        "MOV r0, #5\n JANY EQ, inside\n CMP r1, #0\n JANY EQ, inside\n"
        "loop: ADD r1, #3\n COL r2\n JANY EQ, skip\n"
        "inside: ADD r1, #1\n SUB r0, #1\n skip: JANY NE, loop\n JMP end\n end: HALT\n"
    )


def test_recursion_ends_in_the_trap_of_the_reference_engine() -> None:
    slow, _ = both("again: ADD r0, #1\n CALL again\n")
    assert len(slow.stack) == 4


@pytest.mark.long
def test_more_sends_than_the_log_holds() -> None:
    both(
        ".output all, 0, list\n frame: EXPOSE\n MOV r1, #80\n"
        "outer: MOV r0, #0\n inner: OUT 0, r0\n OUT 1, r2\n ADD r0, #1\n JANY NE, inner\n"
        "COL r2\n SUB r1, #1\n JANY NE, outer\n JMP frame\n",
        frames=2,
    )


def test_a_callback_that_raises_leaves_the_same_state() -> None:
    machine = machine_of()
    source = ".output x, 0, scalar\n frame: EXPOSE\n ADD r0, #1\n OUT 0, r0\n JMP frame\n"
    program = assemble_text(source, "test.s", machine)
    clip = clip_of(300, machine)
    chips = [Chip(program, machine, "reference"), Chip(program, machine, "wasm")]
    for chip in chips:
        seen: list[FrameRecord] = []

        def stop(record: FrameRecord, seen: list[FrameRecord] = seen) -> None:
            seen.append(record)
            if len(seen) == 217:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            chip.run(clip, on_frame=stop)
        assert len(seen) == 217
    assert not state_difference(*map(state, chips))
    expected, found = (chip.run() for chip in chips)
    assert not result_difference(expected, found)


def test_an_interrupt_ends_a_run_and_leaves_a_state_to_go_on_from() -> None:
    machine = machine_of()
    program = assemble_text("loop: ADD r0, #1\n COL r1\n JMP loop\n", "test.s", machine)
    chip = Chip(program, machine, "wasm")
    chip.run(max_cycles=1000)
    handler = signal.getsignal(signal.SIGINT)
    for _ in range(3):
        timer = threading.Timer(0.2, _thread.interrupt_main)  # by then the module runs
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            chip.run(max_cycles=10**12)
        timer.join()
    assert signal.getsignal(signal.SIGINT) is handler
    cycles = chip.cycles
    assert chip.run(max_cycles=5000).status == "cycle-limit"
    assert chip.cycles == cycles + 5000


def test_a_long_frame_does_not_put_the_host_off_in_later_ones(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Python has its turn, and with it Ctrl-C, after as many cycles of each frame."""
    asked: list[int] = []
    original = Session._tick  # noqa: SLF001

    def tick(self: Session, about: int) -> int:
        asked.append(about)
        return original(self, about)

    monkeypatch.setattr(Session, "_tick", tick)
    machine = machine_of()
    source = """
                MOV r5, #8
        frame:  EXPOSE
        again:  MOV r4, #200
        outer:  MOV r3, #0
        inner:  COL r1
                ADD r3, #1
                JANY NE, inner
                SUB r4, #1
                JANY NE, outer
                SUB r5, #1
                JANY NE, again
                MOV r5, #2
                JMP frame
    """
    chip = Chip(assemble_text(source, machine=machine), machine, "wasm")
    result = chip.run(clip_of(5, machine))
    cycles = result.frame_cycles.tolist()
    assert cycles[0] > 8 * 153_600 > cycles[1] > 250_000
    assert len(asked) == sum(count // 250_000 for count in cycles)


def test_frames_of_an_iterator_are_streamed() -> None:
    machine = machine_of()
    program = assemble_text("frame: EXPOSE\n SAMPLE signal, 0\n JMP frame\n", "test.s", machine)
    clip = clip_of(200, machine)
    chip = Chip(program, machine, "wasm")
    result = chip.run(iter(clip))
    assert result.frames == 200
    chip.feed(iter(clip[:3]))
    assert chip.run().frames == 3
    np.testing.assert_array_equal(chip.memory[0], clip[2, ::8, ::8])


def test_a_divergence_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a fault in the compiled engine the report names instruction, NP and register."""
    original = Regions.write

    def faulty(self: Regions, variable: int, value: object) -> None:
        values = self._values
        wrong = values.constant(99) if variable == 7 else value
        original(self, variable, wrong)  # type: ignore[arg-type]

    monkeypatch.setattr(Regions, "write", faulty)
    case = next(
        case
        for case in (draw_case(Random(seed)) for seed in range(5000))
        if re.match(r"(\s*\.output.*)*\s*(frame: EXPOSE\s*)?MOV r7", case.text) and case.frames > 1
    )
    assert "registers[7] of NP (" in first_divergence(case)


def test_a_program_without_words_is_a_trap() -> None:
    program = Program("empty", ())
    results = [Chip(program, engine="reference").run(), Chip(program, engine="wasm").run()]
    assert not result_difference(*results)
    assert results[0].error is not None


def test_an_address_that_a_load_has_masked_is_not_taken_for_one_that_wraps() -> None:
    """The load behind 255 stores is the memory's version 255, which is its last byte too."""
    source = (
        "MOV r7, #254\nST [5], r7\nEXPOSE\nCOL r3\n"
        + "ST [0], r6\n" * 255
        + "LD r2, [5]\nMOV r4, r3\n"
        "AND r4, r2\nMOV r5, r3\nSUB r5, #1\nLD r8, [r4]\nST [r5], r7\nLD r9, [r4]\nHALT"
    )
    slow, fast = both(source, frames=1)
    assert fast.registers[9].tolist() == slow.registers[9].tolist()
