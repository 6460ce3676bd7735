"""The chip of the page against npchip: whole runs, and every moment of them."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from npchip import Chip, assemble_text, load_machine
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, One, Pixel
from npchip.formats.module import to_module
from npchip.isa import load_isa
from tests.support.clips import bundled_clips, synthetic_clip
from tests.support.page_chip import (
    DRIVER,
    NODE,
    STUDIO,
    PageChip,
    bundle,
    document_of,
    missing,
    quantity,
    tree,
    view_of,
    without_instructions,
)
from tests.support.programs import ASM, assembled
from tests.support.random_cases import Case
from tests.support.random_programs import draw_case

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from npchip import Machine, Program

LIMIT = 1_000_000
NAMES = sorted(path.stem for path in ASM.glob("*.s"))
QUICK = ("trajectory", "edges", "keypoints", "imaging")

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return bundle(DRIVER, tmp_path_factory.mktemp("driver"))


@pytest.fixture(scope="module")
def page(driver: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[PageChip]:
    chip = PageChip(driver, tmp_path_factory.mktemp("page"))
    yield chip
    chip.close()


@pytest.fixture(scope="module")
def forgetful(driver: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[PageChip]:
    """A chip whose snapshots are so near each other, and so few, that small programs meet all."""
    folder = tmp_path_factory.mktemp("forgetful")
    chip = PageChip(driver, folder, {"spacing": 40, "budget": 400_000})
    yield chip
    chip.close()


# ---- whole runs


@pytest.mark.parametrize("clip", ["coin_slide", "shapes_photo"])
@pytest.mark.parametrize("machine", ["default", "conservative"])
@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[] if name in QUICK else pytest.mark.long) for name in NAMES],
)
def test_programs_have_the_outputs_and_cycles_of_a_run(
    page: PageChip, name: str, machine: str, clip: str
) -> None:
    frames = bundled_clips()[clip][:6]
    whole_and_told(page, assembled(name, machine), load_machine(machine), frames)


def whole_and_told(
    page: PageChip,
    program: Program,
    machine: Machine,
    frames: NDArray[np.uint8] | None,
    limit: int = LIMIT,
    memory: tuple[tuple[int, NDArray[np.uint8]], ...] = (),
) -> dict[str, Any]:
    """Compare a whole run, and the frames that a run at full speed tells, with a run of npchip."""
    chip = Chip(program, machine)
    for address, planes in memory:
        chip.load_memory(address, planes)
    wanted = document_of(chip.run(frames, max_cycles=limit))
    module, clip = page.written(program, machine, frames, memory)
    found = page.ask("whole", module=module, clip=clip, limit=limit)
    assert without_instructions(found) == wanted

    page.load(program, machine, frames, limit, memory)
    page.ask("run", pace="max")
    complete = [frame for frame in wanted["frames"] if frame.get("complete", True)]
    outputs = page.ask("outputs")
    setup = wanted["setup"]
    told_setups = [setup] if setup.get("complete", True) else []
    assert [without_count(one) for one in outputs["setups"]] == told_setups
    told = outputs["frames"]
    assert [frame["cycles"] for frame in told] == [frame["cycles"] for frame in complete]
    for ours, theirs in zip(told, complete, strict=True):
        # A port without a name is told once something was sent to it.
        assert ours["outputs"].items() <= theirs["outputs"].items()
        assert all(value is None for name, value in theirs["outputs"].items()
                   if name not in ours["outputs"])
    seen = page.view
    assert (seen["status"], seen.get("error")) == (wanted["status"], wanted.get("error"))
    assert (seen["cycles"], seen["instructions"]) == (wanted["cycles"], wanted["instructions"])
    return wanted


def without_count(frame: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in frame.items() if key != "instructions"}


@pytest.mark.parametrize("seed", range(40))
def test_random_programs_run_as_in_npchip(page: PageChip, seed: int) -> None:
    case = draw_case(Random(seed), plain=True)
    frames = case.clip() if case.frames else None
    memory = ((0, memory_of(case)),)
    whole_and_told(page, case.program(), case.machine, frames, case.limit, memory)


def memory_of(case: Case) -> NDArray[np.uint8]:
    shape = (case.machine.memory_bytes, *case.machine.geometry)
    return np.random.default_rng(case.seed).integers(0, 256, shape, np.uint8)


ENDS = {
    "halted": ("loop: EXPOSE\n MOV r0, #3\n OUT 0, r0\n HALT", "halted"),
    "halted at once": ("HALT", "halted"),
    "no end": ("EXPOSE\nloop: ADD r0, #1\n JMP loop", "cycle-limit"),
    "no end before a frame": ("loop: JMP loop", "cycle-limit"),
    "trap": ("EXPOSE\n OUT 2, r0\n RET", "failed"),
    "nobody sends": ("EXPOSE\n IN r0, 4", "failed"),
    "disagreement": (
        ".output a, 0, scalar\n.output b, 1, list\nloop: EXPOSE\n COL r1\n OUT 1, r0\n"
        " OUT 0, r1\n OUT 1, r1\n JMP loop",
        "failed",
    ),
    "too few": (
        ".output wide, 1, scalar16\nloop: EXPOSE\n OUT 1, r0\n JMP loop",
        "failed",
    ),
    "a picture with a part": (".output p, 1, picture\nEXPOSE\n OUT 1, r0\n HALT", "failed"),
    "disagreement in the setup": (".output a, 0, scalar\nROW r1\n OUT 0, r1\nl: EXPOSE\n JMP l",
                                  "failed"),
    "disagreement at the third frame": (
        ".output a, 0, scalar\nloop: EXPOSE\n ADD r3, #1\n CMP r3, #3\n MOV r1, #7\n"
        " WHERE EQ\n COL r1\n END\n OUT 0, r1\n JMP loop",
        "failed",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", ENDS)
@pytest.mark.parametrize("limit", [1_000, 3, 1])
def test_ends_of_runs(page: PageChip, case: str, limit: int) -> None:
    text, status = ENDS[case]
    frames = bundled_clips()["coin_slide"][:9]
    wanted = whole_and_told(page, assemble_text(text), load_machine("default"), frames, limit)
    if limit == 1_000:
        assert wanted["status"] == status


# ---- every moment


class Trace:
    """States of a run by stepping the reference engine."""

    def __init__(
        self,
        program: Program,
        machine: Machine,
        frames: NDArray[np.uint8] | None,
        memory: tuple[tuple[int, NDArray[np.uint8]], ...] = (),
        most: int = 100_000,
        keep: Random | None = None,
        kept: float = 1,
    ) -> None:
        debugger = Debugger(program, frames, machine, memory=memory, max_cycles=LIMIT)
        self.views: dict[int, dict[str, Any]] = {0: view_of(debugger.chip)}
        for time in range(1, most):
            stop = debugger.step()
            if debugger.time != time:
                break
            if keep is None or keep.random() < kept:
                self.views[time] = view_of(debugger.chip)
            self.last = time
            if stop.reason != "step":
                break


def assert_sees(page: PageChip, wanted: dict[str, Any]) -> None:
    seen = page.view
    for key, value in wanted.items():
        assert seen[key] == value, (wanted["instructions"], key)


@pytest.mark.parametrize("name", ["trajectory", "keypoints"])
def test_any_moment_is_reached_forward_and_back(page: PageChip, name: str) -> None:
    random = Random(name)
    machine, frames = load_machine("default"), bundled_clips()["shapes_drawn"]
    program = assembled(name)
    trace = Trace(program, machine, frames, most=3_000, keep=random, kept=0.02)
    page.load(program, machine, frames, LIMIT)
    times = list(trace.views)
    random.shuffle(times)
    for time in times:
        page.go("instruction", number=time)
        assert_sees(page, trace.views[time])


@pytest.mark.parametrize("seed", range(25))
def test_random_programs_step_as_in_npchip(forgetful: PageChip, seed: int) -> None:
    random = Random(seed)
    case = draw_case(random, plain=True)
    text = "\n".join(line for line in case.text.splitlines() if ".output" not in line)
    program = assemble_text(text, machine=case.machine)
    frames = case.clip() if case.frames else None
    memory = ((0, memory_of(case)),)
    trace = Trace(program, case.machine, frames, memory, most=250)
    last = max(trace.views)
    forgetful.load(program, case.machine, frames, LIMIT, memory)
    now = 0
    for _ in range(25):
        way = random.randrange(4)
        if way == 0:
            time = random.randrange(last + 1)
            forgetful.go("instruction", number=time)
        elif way == 1 and now < last:
            time = now + 1
            forgetful.go("step")
        else:
            time = max(0, now - 1)
            forgetful.go("step", back=True)
        now = time
        assert_sees(forgetful, trace.views[now])


# ---- movements and conditions as in `npchip debug`

CALLS = """
.output total, 0, scalar
.macro bump, x
        ADD     x, #1
.endm
start:  MOV     r0, #0
loop:   EXPOSE
        MOV     r1, #3
        CALL    down
        ROW     r2
        WHERE   EQ
        bump    r0
        CALL    twice
        ELSE
        bump    r0
        END
        OUT     0, r1
        JMP     loop
down:   CMP     r1, #0
        JANY    EQ, back
        SUB     r1, #1
        ST      [r1 + 64], r1
        CALL    down
        bump    r3
back:   RET
twice:  CALL    once
once:   bump    r3
        ST      [9], r3
        RET
"""
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
    try:
        for _ in range(40):
            move(debugger, page, random.choice(MOVES))
    finally:
        page.ask("breakpoints", all=[])


@pytest.mark.parametrize("text", CONDITIONS)
def test_each_condition_stops_where_the_debugger_does(page: PageChip, text: str) -> None:
    program, machine = assemble_text(CALLS), load_machine("default")
    frames = bundled_clips()["coin_slide"][:4]
    debugger = Debugger(program, frames, machine, max_cycles=LIMIT)
    page.load(program, machine, frames, LIMIT)
    condition = debugger.add(text).condition
    assert condition is not None
    page.ask("breakpoints", all=[{"addresses": [], "condition": tree(condition)}])
    try:
        for way in ("end", "end", "end", "end back", "end", "end", "end back", "end back"):
            move(debugger, page, way)
    finally:
        page.ask("breakpoints", all=[])


# ---- at work


def test_an_endless_program_is_paused_stepped_and_goes_on(page: PageChip) -> None:
    program = assemble_text("EXPOSE\nloop: ADD r0, #1\n MOV r1, r0\n JMP loop")
    frames = bundled_clips()["coin_slide"][:2]
    page.load(program, load_machine("default"), frames, 10**12)
    times = []
    for _ in range(3):
        told = page.ask("run", pace="max", pause=150)
        assert told["stop"]["reason"] == "paused"
        assert told["latency"] < 500  # 50 on a quiet computer
        times.append(page.view["instructions"])
    assert times == sorted(set(times))
    time = times[-1]
    assert page.go("step")["reason"] == "step"
    assert page.view["instructions"] == time + 1
    page.go("step", back=True)
    # Three instructions a round, after the exposure: r0 has counted them.
    seen = page.view
    assert (seen["instructions"], seen["registers"][0]) == (time, (time - 1 + 2) // 3 % 256)
    page.go("instruction", number=1_000_000)
    assert page.view["registers"][0] == (1_000_000 - 1 + 2) // 3 % 256


def test_a_slow_pace_steps_so_many_a_second(page: PageChip) -> None:
    frames = bundled_clips()["coin_slide"][:9]
    page.load(assembled("trajectory"), load_machine("default"), frames, LIMIT)
    page.ask("run", pace={"unit": "steps", "rate": 20}, pause=480)
    assert 2 <= page.view["instructions"] <= 11
    before = page.view["instructions"]
    page.ask("run", pace={"unit": "frames", "rate": 10}, pause=480)
    assert 1 <= page.view["frame"] <= 6
    assert page.view["instructions"] > before


def test_frames_are_told_once_and_in_order_whatever_the_way(page: PageChip) -> None:
    frames = bundled_clips()["coin_slide"]
    frames = np.concatenate([frames] * 4)
    program, machine = assembled("edges"), load_machine("default")
    page.load(program, machine, frames, LIMIT)
    for _ in range(3):
        page.go("frame")
    page.go("frame", back=True)
    page.ask("run", pace={"unit": "frames", "rate": 200}, pause=100)
    page.go("instruction", number=500, back=True)
    page.ask("run", pace="max")
    told = page.ask("outputs")["frames"]
    wanted = document_of(Chip(program, machine).run(frames))["frames"]
    assert [{"cycles": f["cycles"], "outputs": f["outputs"]} for f in told] == wanted


def test_live_frames(page: PageChip, tmp_path: Path) -> None:
    clip = bundled_clips()["coin_slide"]
    np.save(tmp_path / "live.npy", clip)
    program, machine = assembled("trajectory"), load_machine("default")
    page.load(program, machine, None, LIMIT)
    page.ask("frames", clip="live")
    path = str(tmp_path / "live.npy")
    assert page.ask("live", clip=path, first=0, count=3) == ["dropped"] * 3  # the chip rests
    answers = page.ask("live", clip=path, first=0, count=10, run=True)
    assert answers == ["done"] * 10
    told = page.ask("outputs")["frames"]
    wanted = document_of(Chip(program, machine).run(clip[:10]))["frames"]
    assert [{"cycles": f["cycles"], "outputs": f["outputs"]} for f in told] == wanted
    page.go("instruction", number=1_000)
    assert page.view["frame"] == 0
    assert page.view["exposed"] == clip[0].ravel().tolist()


def test_live_frames_long_ago_are_not_kept(page: PageChip, tmp_path: Path) -> None:
    # 16 MiB of frames are kept: of this size, 16.
    text = "loop: EXPOSE\n SAMPLE signal, 0\n LD r0, [0]\n ADD r1, r0\n JMP loop"
    machine = replace(load_machine("default"), np_rows=128, np_cols=128)
    program = assemble_text(text, machine=machine)
    clip = synthetic_clip(3, 1024, 1024, 4)
    np.save(tmp_path / "live.npy", clip)
    page.load(program, machine, None, LIMIT)
    page.ask("frames", clip="live")
    answers = page.ask("live", clip=str(tmp_path / "live.npy"), first=0, count=40, run=True)
    assert answers == ["done"] * 40
    now = page.view
    stop = page.go("instruction", number=3)
    assert stop["reason"] == "beginning"
    assert "no longer kept" in stop["text"]
    assert 3 < page.view["instructions"] < now["instructions"]
    page.go("instruction", number=now["instructions"])
    assert page.view["registers"] == now["registers"]


def test_the_last_write_is_that_of_the_debugger(page: PageChip) -> None:
    program, machine = assemble_text(CALLS), load_machine("default")
    frames = bundled_clips()["coin_slide"][:4]
    debugger = Debugger(program, frames, machine, max_cycles=LIMIT)
    page.load(program, machine, frames, LIMIT)
    for time in (3, 40, 90, 134):
        debugger.seek(time)
        page.go("instruction", number=time)
        for cell in (Cell("register", 0), Cell("register", 3), Cell("memory", 65), Cell("flag", "Z"),
                     Cell("memory", 9), Cell("register", 7)):  # fmt: skip
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


def test_the_client_speaks_to_its_worker_and_starts_another(tmp_path: Path) -> None:
    worker = bundle(STUDIO / "page/machine/worker.ts", tmp_path)
    client = bundle(DRIVER.with_name("client_driver.ts"), tmp_path)
    clip = bundled_clips()["coin_slide"][:9]
    np.save(tmp_path / "clip.npy", clip)
    for name, program in (
        ("program", assembled("trajectory")),
        ("endless", assemble_text("EXPOSE\nloop: JMP loop")),
    ):
        module = to_module(program, load_machine("default"), load_isa(), ())
        (tmp_path / f"{name}.wasm").write_bytes(module)
    files = [str(tmp_path / name) for name in ("program.wasm", "endless.wasm", "clip.npy")]
    command = [str(NODE), str(client), str(worker), *files]
    found = json.loads(subprocess.run(command, check=True, capture_output=True, timeout=60).stdout)
    result = Chip(assembled("trajectory")).run(clip)
    assert found["valid"] == [int(value) for value in result.outputs["valid"]]
    assert found["whole"] == result.cycles
    assert found["firsts"] == [[0, 9]]
    over = {"reason": "ended", "text": "no frame is left"}
    assert (found["first"], found["again"]) == (over, over)
    assert found["paused"]["reason"] == "paused"
    assert found["small"].startswith("the clip small has frames of 32 \u00d7 80 pixels")
    assert found["rest"] == "dropped"
    assert found["ended"] == "the chip was stopped: load the program again"
    assert found["empty"] == "no program is in the chip: assemble one"
    assert found["same"]
    assert found["back"]["reason"] == "beginning"
    assert found["seen"] == 0
    assert found["faults"] == []
