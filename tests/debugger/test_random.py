"""The debugger without a screen against full traces of random programs."""

from __future__ import annotations

import re
from random import Random
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from npchip import Chip
from npchip.assembler.disassembler import disassemble_word
from npchip.debugger import history, runner
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, One
from npchip.engines.base import TrapError
from tests.support.lockstep import state, state_difference
from tests.support.profiles import THOROUGH
from tests.support.random_cases import Case
from tests.support.random_programs import draw_case

if TYPE_CHECKING:
    from collections.abc import Iterator

    from npchip.debugger.values import Location
    from npchip.engines.state import ChipState

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


def writes_of(text: str, before: ChipState, row: int, column: int) -> Iterator[Location]:
    """Yield the places that an instruction writes in an active NP, by its text."""
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


def value_in(place: Location, found: ChipState) -> int:
    assert isinstance(place, One)
    cell, at = place.cell, (place.row, place.column)
    if cell.kind == "flag":
        return int((found.zero if cell.index == "Z" else found.carry)[at])
    planes = found.registers if cell.kind == "register" else found.memory
    return int(planes[int(cell.index)][at])


def last_writes(
    case: Case, states: list[ChipState], until: int, row: int, column: int
) -> dict[Location, Traced]:
    """Who wrote each place of an NP last, by reading the disassembly along a trace."""
    program, isa = case.program(), Chip(case.program(), case.machine).isa
    found: dict[Location, Traced] = {}
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
    """Judge a condition of `conditions_for` on two states of a trace."""
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
