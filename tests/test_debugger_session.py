"""The debugger without a screen against full traces of random programs."""

from __future__ import annotations

import os
import re
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from npchip import Chip, InputError, assemble, assemble_text
from npchip.assembler.disassembler import disassemble_word
from npchip.debugger import history, runner
from npchip.debugger.language import parse_condition
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, One, Pixel
from npchip.debugger.watch import Stop
from npchip.engines import TrapError
from tests.chips import clip_of, machine_of
from tests.clips import bundled_clips
from tests.lockstep import state, state_difference
from tests.random_cases import Case
from tests.random_programs import draw_case

if TYPE_CHECKING:
    from collections.abc import Iterator

    from npchip.debugger.values import Place
    from npchip.engines import ChipState

THOROUGH = os.environ.get("NPCHIP_PROFILE") == "thorough"
ASM = Path(__file__).parents[1] / "asm"
STEPS = 250
"""Instructions of a random program that are traced."""
QUERIES = 2_000 if THOROUGH else 200


@pytest.fixture
def small_spacing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Snapshots, chunks and looks so near each other that small programs meet them all."""
    make_small(monkeypatch)


def make_small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "SPACING", 50)
    monkeypatch.setattr(history, "SPACING", 50)
    monkeypatch.setattr(runner, "_FINE", 7)
    monkeypatch.setattr(runner, "_WORTH", 10)
    monkeypatch.setattr(runner, "_LOOK", 5)
    monkeypatch.setattr(runner, "_CHUNK", 100)


def memory_of(case: Case) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    shape = (case.machine.memory_bytes, *case.machine.geometry)
    return np.random.default_rng(case.seed).integers(0, 256, shape, np.uint8)


def debugger_of(case: Case) -> Debugger:
    return Debugger(
        case.program(),
        case.clip() if case.frames else None,
        case.machine,
        memory=[(0, memory_of(case))],
        max_cycles=case.limit,
    )


def trace(case: Case, most: int = STEPS) -> list[ChipState]:
    """All states of a run by stepping the reference engine; the last one is where it ends."""
    chip = Chip(case.program(), case.machine, "reference")
    chip.load_memory(0, memory_of(case))
    clip = case.clip() if case.frames else None
    chip.feed(clip)
    exposes = {
        address
        for address, word in enumerate(chip.program.words)
        if disassemble_word(word, chip.isa, {}) == "EXPOSE"
    }
    states = [state(chip).copy()]
    for _ in range(most):
        if chip.frame_cycles >= case.limit:
            break
        if chip.pc in exposes and chip.frames_taken >= case.frames:
            break
        try:
            ended = chip.step()
        except TrapError:
            break
        states.append(state(chip).copy())
        if ended:
            break
    return states


def assert_at(debugger: Debugger, states: list[ChipState]) -> None:
    assert not state_difference(states[debugger.time], state(debugger.chip))


@settings(max_examples=1_000 if THOROUGH else 12)
@given(random=st.randoms(use_true_random=False))
def test_any_moment_is_reached_again(random: Random) -> None:
    with pytest.MonkeyPatch.context() as patch:
        make_small(patch)
        case = draw_case(random, plain=True)
        states = trace(case)
        debugger = debugger_of(case)
        last = len(states) - 1
        debugger.step(random.randrange(last + 1))
        for _ in range(12):
            count = random.randrange(1, 60)
            way = random.randrange(4)
            before = debugger.time
            if way == 0:
                debugger.step_back(count)
                assert debugger.time == max(0, before - count)
            elif way == 1:
                count = min(count, last - before)
                if count:
                    debugger.step(count)
                    # Outputs that cannot be read stop a run once.
                    if debugger.stop.reason == "outputs":
                        debugger.step(count - (debugger.time - before))
            elif way == 2:
                time = random.randrange(last + 1)
                debugger.seek(time)
                assert debugger.time == time
            else:
                debugger.step_back(count)
                assert_at(debugger, states)
                debugger.seek(before)
                assert debugger.time == before
            assert_at(debugger, states)


class Traced(NamedTuple):
    """The last write of a place."""

    time: int
    address: int
    cycle: int
    frame: int
    old: int
    new: int


def writes_of(text: str, before: ChipState, row: int, column: int) -> Iterator[Place]:
    """What the text of an instruction says that it writes in an active NP."""
    mnemonic, _, rest = text.partition(" ")
    operands = [item.strip() for item in rest.split(",")]

    def one(kind: str, index: int | str) -> One:
        return One(Cell(kind, index), row, column)  # type: ignore[arg-type]

    destinations = [
        "MOV",
        "LD",
        "ADD",
        "ADC",
        "SUB",
        "SBC",
        "AND",
        "OR",
        "SHL",
        "SHR",
        "RCR",
        "NBR",
        "ROW",
        "COL",
    ]
    if mnemonic in destinations:
        yield one("register", int(operands[0][1:]))
    if mnemonic in ["ADD", "ADC", "SUB", "SBC", "CMP", "AND", "OR", "SHL", "SHR", "RCR"]:
        yield one("flag", "Z")
    if mnemonic in ["ADD", "ADC", "SUB", "SBC", "CMP", "SHL", "SHR", "RCR"]:
        yield one("flag", "C")
    if mnemonic == "SAMPLE":
        bank = int(operands[1], 0)
        for address in range(bank, bank + 64):
            yield one("memory", address)
    if mnemonic == "ST":
        match = re.fullmatch(r"\[(?:r(\d+))?(?:\s*\+\s*)?(\w+)?\]", operands[0])
        assert match
        address = int(match[2] or "0", 0)
        if match[1]:
            address += int(before.registers[int(match[1]), row, column])
        yield one("memory", address % len(before.memory))


def value_in(place: Place, found: ChipState) -> int:
    assert isinstance(place, One)
    cell, at = place.cell, (place.row, place.column)
    if cell.kind == "flag":
        return int((found.zero if cell.index == "Z" else found.carry)[at])
    planes = found.registers if cell.kind == "register" else found.memory
    return int(planes[int(cell.index)][at])


def last_writes(
    case: Case, states: list[ChipState], until: int, row: int, column: int
) -> dict[Place, Traced]:
    """Who wrote each place of an NP last, by reading the disassembly along a trace."""
    program, isa = case.program(), Chip(case.program(), case.machine).isa
    found: dict[Place, Traced] = {}
    for time in range(1, until + 1):
        before, after = states[time - 1], states[time]
        if before.activity[row, column]:
            continue
        text = disassemble_word(program.words[before.pc], isa, {})
        assert text
        for place in writes_of(text, before, row, column):
            found[place] = Traced(
                time,
                before.pc,
                before.cycles,
                after.frames_taken - 1,
                value_in(place, before),
                value_in(place, after),
            )
    return found


@pytest.mark.usefixtures("small_spacing")
def test_who_wrote_it_is_what_a_full_trace_says() -> None:
    asked = answered = 0
    seed = 0
    while asked < QUERIES:
        seed += 1
        random = Random(seed)
        case = draw_case(random, plain=True)
        states = trace(case, 200)
        if len(states) < 20:
            continue
        debugger = debugger_of(case)
        debugger.step(len(states) - 1)
        for _ in range(2):
            debugger.seek(random.randrange(len(states)))
            row, column = (random.randrange(size) for size in case.machine.geometry)
            known = last_writes(case, states, debugger.time, row, column)
            for _ in range(10):
                if known and random.randrange(4):
                    place = random.choice(sorted(known, key=str))
                else:
                    number = random.randrange(case.machine.memory_bytes)
                    place = One(Cell("memory", number), row, column)
                written = debugger.who(place)
                assert written
                expected = known.get(place)
                if expected is None:
                    assert written.by == "nobody"
                else:
                    answered += 1
                    assert written.by == "instruction"
                    assert expected == (
                        written.time,
                        written.address,
                        written.cycle,
                        written.frame,
                        written.old,
                        written.new,
                    ), (seed, place, case.text)
                asked += 1
        assert_at(debugger, states)
    assert answered > QUERIES // 2


def holds(text: str, before: ChipState, now: ChipState) -> bool:
    """What a condition of `conditions_for` means, on two states of a trace."""
    words = text.split()
    if text.startswith("at "):
        return now.pc == int(words[1])
    if words[0] == "any":
        number, limit = int(words[1][1:]), int(words[3])
        was, is_now = ((item.registers[number] > limit).any() for item in (before, now))
        return bool(is_now and not was)
    if text == "mask empty":
        return bool(now.activity.all() and not before.activity.all())
    if words[0] == "output":
        port = int(words[1])
        sent = len(now.sends) == len(before.sends) + 1 and now.pc == before.pc + 1
        return sent and now.sends[-1].port == port
    if words[0] == "frame":
        return now.frames_taken - 1 == int(words[2]) != before.frames_taken - 1
    match = re.fullmatch(r"np\((\d+),(\d+)\)\.mem\[(\d+)\] changes", text)
    assert match
    row, column, address = map(int, match.groups())
    return bool(before.memory[address, row, column] != now.memory[address, row, column])


def conditions_for(random: Random, case: Case, words: int) -> list[str]:
    rows, columns = case.machine.geometry
    place = f"np({random.randrange(rows)},{random.randrange(columns)})"
    return random.sample(
        [
            f"at {random.randrange(words)}",
            f"any r{random.randrange(13)} > {random.randrange(256)}",
            "mask empty",
            f"output {random.randrange(4)}",
            f"frame == {random.randrange(4)}",
            f"{place}.mem[{random.randrange(case.machine.memory_bytes)}] changes",
        ],
        random.randrange(1, 4),
    )


@settings(max_examples=1_000 if THOROUGH else 12)
@given(random=st.randoms(use_true_random=False))
def test_it_stops_where_a_trace_says_on_the_way_there_and_back(random: Random) -> None:
    with pytest.MonkeyPatch.context() as patch:
        make_small(patch)
        case = draw_case(random, plain=True)
        states = trace(case, 250)
        debugger = debugger_of(case)
        texts = conditions_for(random, case, len(debugger.program.words))
        for text in texts:
            debugger.add(text.removeprefix("at "))
        stops = [
            time
            for time in range(1, len(states))
            if any(holds(text, states[time - 1], states[time]) for text in texts)
        ]
        for expected in stops:
            debugger.run()
            while debugger.stop.reason == "outputs":
                debugger.run()
            assert debugger.time == expected, (texts, case.text)
            assert_at(debugger, states)
        debugger.seek(len(states) - 1)
        while debugger.stop.reason == "outputs":
            debugger.seek(len(states) - 1)
        for expected in reversed([time for time in stops if time < debugger.time]):
            debugger.run_back()
            assert debugger.stop.reason == "breakpoint"
            assert debugger.time == expected, (texts, case.text)
        debugger.run_back()
        assert debugger.stop.reason == "start"
        assert_at(debugger, states)


# ---- whole programs: the compiled engine does the long way


def trajectory(frames: int = 30, **extra: Any) -> Debugger:
    clip = np.concatenate([bundled_clips()["coin_slide"]] * 20)[:frames]
    return Debugger(assemble(ASM / "trajectory.s"), clip, **extra)


def test_whole_frames_at_once_lead_to_the_same() -> None:
    fast, slow = trajectory(), trajectory()
    slow.add("any r0 > 300")  # never, but every instruction on r0 has to be looked at
    for debugger in (fast, slow):
        assert debugger.run().reason == "frames-exhausted"
    assert not state_difference(state(slow.chip), state(fast.chip))
    assert fast.records.keys() == slow.records.keys() == {-1, *range(30)}
    for frame, record in slow.records.items():
        found = fast.records[frame]
        assert (found.cycles, found.outputs) == (record.cycles, record.outputs)
    random = Random(1)
    for _ in range(10):
        time = random.randrange(fast.time)
        fast.seek(time)
        slow.seek(time)
        assert fast.time == slow.time == time
        assert not state_difference(state(slow.chip), state(fast.chip))


def test_a_breakpoint_at_the_expose_itself() -> None:
    debugger = trajectory(5)
    debugger.add(str(min(debugger.names.writers.exposes)))
    frames = []
    while debugger.run().reason == "breakpoint":
        frames.append(debugger.chip.frames_taken)
    assert frames == [0, 1, 2, 3, 4, 5]


def test_outputs_are_those_of_a_run() -> None:
    debugger = trajectory()
    debugger.run()
    result = Chip(debugger.program).run(np.concatenate([bundled_clips()["coin_slide"]] * 20)[:30])
    for frame in range(30):
        record = debugger.records[frame]
        assert record.cycles == result.frame_cycles[frame]
        assert record.outputs == {name: result.value(name, frame) for name in result.outputs}


def test_frames_forward_and_back() -> None:
    debugger = trajectory()
    for frame in (1, 2, 3, 13, 14):
        assert debugger.next_frame(10 if frame == 13 else 1).reason == "frame"
        assert (debugger.chip.frames_taken, debugger.chip.frame_cycles) == (frame, 1)
    debugger.step(5)
    for expected in (14, 13, 11):
        assert debugger.previous_frame(2 if expected == 11 else 1).reason == "frame"
        assert (debugger.chip.frames_taken, debugger.chip.frame_cycles) == (expected, 1)
    assert debugger.previous_frame(50).reason == "start"
    assert debugger.time == 0


def test_over_and_out() -> None:
    debugger = trajectory()
    assert debugger.step_over().message == "stepped over the call"
    assert (len(debugger.chip.stack), debugger.chip.pc) == (0, 1)
    debugger.restart()
    debugger.step(4)
    assert len(debugger.chip.stack) == 1
    debugger.step_out()
    assert debugger.chip.pc == 1
    assert debugger.step_out().message == "no call is open"


# ---- edits


EDITED = """
frame:  EXPOSE
        SAMPLE  signal, 0
        ADD     r0, #1
        LD      r1, [5]
        ADD     r1, r0
        ST      [70], r1
        JMP     frame
"""


def edited() -> Debugger:
    machine = machine_of()
    return Debugger(assemble_text(EDITED, "e.s", machine), clip_of(5, machine), machine)


def test_an_edit_is_part_of_what_happened() -> None:
    debugger = edited()
    place = One(Cell("register", 0), 1, 2)
    debugger.step(3)
    debugger.edit(place, 100)
    debugger.edit(Cell("flag", "C"), 1)
    debugger.run()
    assert int(debugger.chip.registers[0, 1, 2]) == 104
    assert int(debugger.chip.registers[0, 0, 0]) == 5
    end = state(debugger.chip).copy()
    time = debugger.time
    debugger.step_back(time - 2)
    assert int(debugger.chip.registers[0, 1, 2]) == 0
    debugger.step()
    assert int(debugger.chip.registers[0, 1, 2]) == 100
    assert debugger.chip.flags["C"].all()
    debugger.run()
    assert not state_difference(end, state(debugger.chip))
    debugger.seek(2)
    assert debugger.edit(place, 50) == 2  # both later ones have not happened
    debugger.run()
    assert int(debugger.chip.registers[0, 1, 2]) == 55


def test_an_edit_of_a_pixel_lasts_for_its_frame() -> None:
    debugger = edited()
    debugger.step()
    clip = clip_of(5, machine_of())
    debugger.edit(Pixel(0, 5), 77)
    debugger.next_frame()
    assert int(debugger.chip.memory[5, 0, 0]) == 77
    debugger.step()
    assert int(debugger.chip.memory[5, 0, 0]) == clip[1, 0, 5]
    debugger.seek(2)
    assert int(debugger.chip.memory[5, 0, 0]) == 77
    np.testing.assert_array_equal(clip, clip_of(5, machine_of()))  # the clip is not written to


def test_who_knows_edits_and_exposes() -> None:
    debugger = edited()
    place = One(Cell("register", 0), 1, 2)
    debugger.edit(place, 9)
    written = debugger.who(place)
    assert written
    assert (written.by, written.time, written.old, written.new) == ("edit", 0, 0, 9)
    debugger.next_frame(3)
    debugger.edit(Cell("register", 0), 40)
    at = debugger.time
    debugger.step()
    written = debugger.who(place)
    assert written
    assert (written.by, written.time, written.old, written.new) == ("edit", at, 11, 40)
    written = debugger.who(Pixel(3, 4))
    assert written
    clip = clip_of(5, machine_of())
    assert (written.by, written.address, written.frame) == ("instruction", 0, 2)
    assert (written.old, written.new) == (clip[1, 3, 4], clip[2, 3, 4])
    debugger.edit(Pixel(3, 4), 1)
    written = debugger.who(Pixel(3, 4))
    assert written
    assert (written.by, written.new) == ("edit", 1)
    written = debugger.who(One(Cell("memory", 200), 0, 0))
    assert written
    assert written.by == "nobody"


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (One(Cell("register", 0), 0, 0), 256),
        (One(Cell("register", 0), 0, 0), -1),
        (One(Cell("flag", "Z"), 0, 0), 2),
        (Pixel(0, 0), 1),
        (Cell("active"), 1),
    ],
)
def test_what_cannot_be_set(place: Any, value: int) -> None:
    with pytest.raises(InputError, match="NP352"):
        edited().edit(place, value)


# ---- ends


def test_what_ends_a_run() -> None:
    machine = machine_of()

    def run(source: str, frames: int = 0, **extra: Any) -> tuple[Stop, Debugger]:
        clip = clip_of(frames, machine) if frames else None
        debugger = Debugger(assemble_text(source, "x.s", machine), clip, machine, **extra)
        return debugger.run(), debugger

    stop, debugger = run("MOV r0, #1\n HALT\n")
    assert (stop.reason, debugger.time) == ("halted", 2)
    assert debugger.run().reason == "halted"
    assert debugger.step_back().reason == "step"
    stop, debugger = run("loop: ADD r0, #1\n JMP loop\n", max_cycles=1000)
    assert (stop.reason, debugger.time) == ("cycle-limit", 1000)
    stop, debugger = run("RET\n")
    assert stop.reason == "trap"
    assert "NP302" in stop.message
    stop, debugger = run("EXPOSE\n", 0)
    assert (stop.reason, debugger.time) == ("frames-exhausted", 0)
    source = ".output x, 0, scalar\nframe: EXPOSE\n COL r0\n OUT 0, r0\n JMP frame\n"
    stop, debugger = run(source, 2)
    assert stop.reason == "outputs"
    assert "NP310" in stop.message
    again = [debugger.run().reason for _ in range(2)]
    assert again == ["outputs", "frames-exhausted"]  # of the second frame; the end


def test_seeking_goes_past_outputs_that_cannot_be_read() -> None:
    machine = machine_of()
    text = ".output a, 0, scalar\nframe: EXPOSE\n ROW r0\n OUT 0, r0\n JMP frame\n"
    debugger = Debugger(assemble_text(text, "a.s", machine), clip_of(5, machine), machine)
    assert [debugger.run().reason for _ in range(6)] == ["outputs"] * 5 + ["frames-exhausted"]
    end = debugger.time
    debugger.seek(1)
    debugger.seek(end)
    assert (debugger.time, debugger.stop.reason) == (end, "step")


def test_frames_of_an_iterator_can_be_gone_back_to() -> None:
    clip = np.concatenate([bundled_clips()["coin_slide"]] * 20)[:30]
    debugger = Debugger(assemble(ASM / "trajectory.s"), iter(clip))
    whole = trajectory()
    for item in (debugger, whole):
        item.run()
        item.seek(20_000)
    assert not state_difference(state(whole.chip), state(debugger.chip))


def test_an_endless_clip_is_kept_only_so_far(monkeypatch: pytest.MonkeyPatch) -> None:
    from itertools import repeat

    from npchip.debugger import clip

    monkeypatch.setattr(clip, "MOST_BYTES", 100 * 64 * 80)
    frames = repeat(np.zeros((64, 80), np.uint8))
    debugger = Debugger(assemble(ASM / "trajectory.s"), frames)
    with pytest.raises(InputError, match="100 frames are kept"):
        debugger.run()
    debugger.step_back()


def test_a_run_can_be_interrupted() -> None:
    import threading

    debugger = trajectory()
    debugger.add("any r0 > 300")
    timer = threading.Timer(0.05, debugger.interrupt)
    timer.start()
    stop = debugger.run()
    timer.join()
    assert stop.reason == "interrupted"
    time = debugger.time
    debugger.step()
    assert debugger.time == time + 1


def test_snapshots_are_thinned_to_the_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "BUDGET", 1 << 19)
    monkeypatch.setattr(runner, "_CHUNK", 2_000)
    debugger = trajectory(140)
    whole = trajectory(140)
    for item in (debugger, whole):
        item.run()
    count, size = debugger.snapshots
    assert size <= 1 << 19
    assert 5 < count < 20
    for time in (5, 60_000, 120_000, debugger.time - 1):
        for item in (debugger, whole):
            item.seek(time)
        assert not state_difference(state(whole.chip), state(debugger.chip))


def test_conditions_are_of_this_program() -> None:
    debugger = trajectory()
    condition = parse_condition("frame == 7", debugger.names)
    assert debugger.run_to(condition).reason == "place"
    assert debugger.chip.frames_taken == 8


def test_a_damaged_frame_is_met_where_it_comes() -> None:
    clip = bundled_clips()["coin_slide"]

    def frames() -> Iterator[Any]:
        yield from clip[:5]
        yield clip[5][:10]

    debugger = Debugger(assemble(ASM / "trajectory.s"), frames())
    for _ in range(2):
        with pytest.raises(InputError, match="frame 5"):
            debugger.run()
        assert debugger.chip.frames_taken == 5
        assert debugger.chip.frame_cycles > 1_000
    assert debugger.step_back().reason == "step"
