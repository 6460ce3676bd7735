"""The page's chip at work: pauses, paces, live frames, its worker."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import Chip, assemble_text, load_machine
from npchip.formats.module import to_module
from npchip.isa import load_isa
from tests.support.clips import bundled_clips, synthetic_clip
from tests.support.page_chip import LIMIT, PageChip, document_of
from tests.support.page_code import PAGE, Bundles, run
from tests.support.programs import assembled

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.long


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


def test_back_in_a_long_run_takes_little(page: PageChip) -> None:
    frames = np.concatenate([bundled_clips()["shapes_drawn"]] * 400)
    page.load(assembled("trajectory"), load_machine("default"), frames, LIMIT)
    page.ask("run", pace="max")
    assert page.view["instructions"] > 2_000_000
    order = {"travel": {"to": "instruction", "number": 2_000_000}, "back": True}
    assert page.ask("go", **order)["took"] < 2_000  # 200 on a quiet computer
    assert page.view["instructions"] == 2_000_000


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


SEND = """
        ADD     r0, #1
        OUT     0, r0"""
LATE = f"""
.output all, 0, list
.output light, 1, plane
loop:   EXPOSE
{SEND * 80}
        SAMPLE  signal, 0
        LD      r2, [0]
        OUT     1, r2
        JMP     loop
"""
"""It sends all along a frame, and looks at the light at its end only."""


def test_a_frame_that_was_left_and_entered_again_has_its_outputs(forgetful: PageChip) -> None:
    frames = bundled_clips()["coin_slide"][:4]
    program, machine = assemble_text(LATE), load_machine("default")
    forgetful.load(program, machine, frames, LIMIT)
    for _ in range(3):
        forgetful.go("frame")
        start = forgetful.view["instructions"]
        for far, back in ((120, 70), (150, 110), (160, 130)):
            forgetful.go("instruction", number=start + far)
            forgetful.go("instruction", number=start + back, back=True)
    forgetful.go("end")
    told = forgetful.ask("outputs")["frames"]
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
    # 16 MiB of frames are kept: of this size, 64.
    text = "loop: EXPOSE\n SAMPLE signal, 0\n LD r0, [0]\n ADD r1, r0\n JMP loop"
    machine = replace(load_machine("default"), np_rows=64, np_cols=64, memory_bytes=64)
    program = assemble_text(text, machine=machine)
    clip = synthetic_clip(3, 512, 512, 4)
    np.save(tmp_path / "live.npy", clip)
    page.load(program, machine, None, LIMIT)
    page.ask("frames", clip="live")
    answers = page.ask("live", clip=str(tmp_path / "live.npy"), first=0, count=90, run=True)
    assert answers == ["done"] * 90
    now = page.view
    stop = page.go("instruction", number=3)
    assert stop["reason"] == "beginning"
    assert "no longer kept" in stop["text"]
    assert 3 < page.view["instructions"] < now["instructions"]
    page.go("instruction", number=now["instructions"])
    assert page.view["registers"] == now["registers"]


def test_the_client_speaks_to_its_worker_and_starts_another(
    tmp_path: Path, bundles: Bundles
) -> None:
    worker = bundles.for_node(PAGE / "machine/worker.ts")
    client = bundles.for_node("machine/client_driver.ts")
    clip = bundled_clips()["coin_slide"][:9]
    np.save(tmp_path / "clip.npy", clip)
    for name, program in (
        ("program", assembled("trajectory")),
        ("endless", assemble_text("EXPOSE\nloop: JMP loop")),
    ):
        module = to_module(program, load_machine("default"), load_isa(), ())
        (tmp_path / f"{name}.wasm").write_bytes(module)
    files = [str(tmp_path / name) for name in ("program.wasm", "endless.wasm", "clip.npy")]
    found = json.loads(run(client, worker, *files, seconds=60))
    result = Chip(assembled("trajectory")).run(clip)
    assert found["valid"] == [int(value) for value in result.outputs["valid"]]
    assert found["whole"] == result.cycles
    told = [first + i for first, count in found["firsts"] for i in range(count)]
    assert told == [*range(9)]
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
    # A run that an order cuts short is heard of no more, nor one that a newer run takes over.
    assert found["anew"] == [["view at 0"]] * 5
    assert found["stops"] == 0
