"""Movements, conditions and searches of the page's chip, as in `npchip debug`."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from npchip import assemble_text, load_machine
from npchip.debugger.language import parse_condition
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, One, Pixel
from tests.support.clips import bundled_clips
from tests.support.page_chip import (
    CALLS,
    LIMIT,
    PageChip,
    assert_sees,
    quantity,
    tree,
    view_of,
)
from tests.support.programs import assembled

pytestmark = pytest.mark.long

CONDITIONS = [
    "down", "once", "down + 2 if any r1 == 2", "12", "any r3 > 4", "all r3 >= 3", "r3 changes",
    "np(3,4).r3 changes", "np(1,0).mem[9] changes", "np(0,0).r2 == 0", "calls == 3", "calls > 1",
    "frame == 2", "frame_cycles > 90", "pc == 7", "cycles > 100", "instructions == 50",
    "mask empty", "active changes", "Z changes", "any Z == 1", "output 0", "output total > 0",
    "output 0 == 9", "mem[64] changes", "pixel(10,20) > 3", "pixel(0,0) changes",
]  # fmt: skip
MOVES = ("step", "over", "out", "frame", "end", "step back", "frame back", "end back")
REASONS = {
    "step": "step",
    "frame": "step",
    "breakpoint": "hit",
    "start": "beginning",
    "halted": "ended",
    "frames-exhausted": "ended",
    "cycle-limit": "ended",
    "trap": "ended",
}


def move(debugger: Debugger, page: PageChip, way: str) -> None:
    """Move both, and compare where they stop, and why."""
    methods = {
        "step": debugger.step,
        "over": debugger.step_over,
        "out": debugger.step_out,
        "frame": debugger.next_frame,
        "end": debugger.run,
        "step back": debugger.step_back,
        "frame back": debugger.previous_frame,
        "end back": debugger.run_back,
    }
    before = debugger.time
    wanted = methods[way]()
    to, *back = way.split()
    found = page.go(to, back=bool(back))
    reason = "hit" if found["reason"] in ("breakpoint", "condition") else found["reason"]
    told = (before, way, wanted, found)
    assert page.view["instructions"] == debugger.time, told
    assert reason == REASONS[wanted.reason], told
    if reason == "hit":
        assert found["text"] in {debugger.breakpoints[n].text for n in wanted.numbers}, told
    assert_sees(page, view_of(debugger.chip))


@pytest.mark.parametrize("seed", range(12))
def test_movements_are_those_of_the_debugger(
    page: PageChip, forgetful: PageChip, seed: int
) -> None:
    random = Random(seed)
    page = page if seed % 2 else forgetful
    program, machine = assemble_text(CALLS), load_machine("default")
    frames = bundled_clips()["coin_slide"][:4]
    debugger = Debugger(program, frames, machine, max_cycles=LIMIT)
    page.load(program, machine, frames, LIMIT)
    chosen = random.sample(CONDITIONS, random.randrange(4))
    added = [debugger.add(text).condition for text in chosen]
    trees = [{"addresses": [], "condition": tree(item)} for item in added if item is not None]
    page.ask("breakpoints", all=trees)
    for _ in range(40):
        move(debugger, page, random.choice(MOVES))


@pytest.mark.parametrize("text", CONDITIONS)
def test_each_condition_stops_where_the_debugger_does(page: PageChip, text: str) -> None:
    program, machine = assemble_text(CALLS), load_machine("default")
    frames = bundled_clips()["coin_slide"][:4]
    debugger = Debugger(program, frames, machine, max_cycles=LIMIT)
    page.load(program, machine, frames, LIMIT)
    condition = debugger.add(text).condition
    assert condition is not None
    page.ask("breakpoints", all=[{"addresses": [], "condition": tree(condition)}])
    for way in ("end", "end", "end", "end back", "end", "end", "end back", "end back"):
        move(debugger, page, way)


def test_a_line_with_a_condition_is_a_place_with_a_test(page: PageChip) -> None:
    program, machine = assemble_text(CALLS), load_machine("default")
    frames = bundled_clips()["coin_slide"][:4]
    debugger = Debugger(program, frames, machine, max_cycles=LIMIT)
    page.load(program, machine, frames, LIMIT)
    once = program.labels["once"]
    debugger.add("once if any r3 > 4")
    alone = parse_condition("any r3 > 4", debugger.names)
    page.ask("breakpoints", all=[{"addresses": [once], "condition": tree(alone)}])
    wanted, found = [], []
    while debugger.run().reason == "breakpoint":
        wanted.append(debugger.time)
    while page.go("end")["reason"] == "condition":
        found.append(page.view["instructions"])
    assert found == wanted
    assert len(found) > 2
    # An event on a line is one that the line causes.
    debugger.restart()
    debugger.breakpoints.clear()
    debugger.add("r3 changes")
    changes = parse_condition("r3 changes", debugger.names)
    page.ask("breakpoints", all=[{"addresses": [once], "condition": tree(changes)}])
    page.go("instruction", number=0)
    wanted, found = [], []
    while True:
        before = debugger.chip.pc
        if debugger.step().reason not in ("breakpoint", "step"):
            break
        if before == once and debugger.stop.reason == "breakpoint":
            wanted.append(debugger.time)
    while page.go("end")["reason"] == "condition":
        found.append(page.view["instructions"])
    assert found == wanted
    assert found


def test_plain_breakpoints_stop_at_each_use(page: PageChip) -> None:
    program, machine = assemble_text(CALLS), load_machine("default")
    frames = bundled_clips()["coin_slide"][:2]
    page.load(program, machine, frames, LIMIT)
    places = [program.labels["down"], program.labels["once"]]
    page.ask("breakpoints", all=[{"addresses": places, "condition": None}])
    page.go("instruction", number=0)
    found = []
    while True:
        told = page.ask("run", pace="max")["stop"]
        if told["reason"] != "breakpoint":
            break
        found.append(page.view["address"])
    # It calls itself three times; the other one is called, and then fallen into.
    assert found == ([places[0]] * 4 + [places[1]] * 2) * 2


CELLS = [
    *(Cell("register", number) for number in (0, 3, 7)),
    *(Cell("memory", address) for address in (9, 65)),
    Cell("flag", "Z"),
]


def test_the_last_write_is_that_of_the_debugger(page: PageChip) -> None:
    program, machine = assemble_text(CALLS), load_machine("default")
    frames = bundled_clips()["coin_slide"][:4]
    debugger = Debugger(program, frames, machine, max_cycles=LIMIT)
    page.load(program, machine, frames, LIMIT)
    for time in (3, 40, 90, 134):
        debugger.seek(time)
        page.go("instruction", number=time)
        for cell in CELLS:
            for place in (One(cell, 0, 0), One(cell, 3, 4)):
                assert_same_write(page, debugger, place)
        assert_same_write(page, debugger, Pixel(5, 6))


def assert_same_write(page: PageChip, debugger: Debugger, location: One | Pixel) -> None:
    wanted = debugger.who(location)
    assert wanted is not None
    writers = sorted(debugger.names.writers.of(location))
    found = page.ask("wrote", value=quantity(location), writers=writers)
    if wanted.by == "nobody":
        assert found is None, location
        return
    assert found == {
        "address": wanted.address,
        "frame": wanted.frame,
        "instruction": wanted.time,
        "before": wanted.old,
        "after": wanted.new,
    }, (location, debugger.time)


@pytest.mark.parametrize("name", ["keypoints", "edges"])
def test_cycles_of_a_frame_by_address(page: PageChip, name: str) -> None:
    program, machine = assembled(name), load_machine("default")
    frames = bundled_clips()["shapes_drawn"][:3]
    page.load(program, machine, frames, LIMIT)
    page.ask("run", pace="max")
    debugger = Debugger(program, frames, machine, max_cycles=LIMIT)
    spent = {frame: np.zeros(len(program.words)) for frame in range(-1, 3)}
    while True:
        address, frame, cycles = debugger.chip.pc, debugger.chip.frames_taken, debugger.chip.cycles
        if debugger.step().reason != "step":
            break
        frame = max(frame, debugger.chip.frames_taken)  # an exposure belongs to the new frame
        spent[frame - 1][address] += debugger.chip.cycles - cycles
    for frame, wanted in spent.items():
        assert page.ask("profile", frame=frame) == wanted.tolist(), frame
        assert wanted.any() or frame < 0
