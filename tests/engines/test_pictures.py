"""Pictures and planes that many frames send, on both engines.

The compiled engine reads what all frames of a batch send in the same way as arrays, and everything
else send by send. Here are programs on both sides of that, cut where batches, the log and runs end.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.machine.layout import to_frames, to_planes
from npchip.run.collector import Collector
from tests.support.chips import clip_of, machine_of
from tests.support.lockstep import (
    assert_engines_agree,
    cramped,
    result_difference,
    state,
    state_difference,
)
from tests.support.random_cases import Case

if TYPE_CHECKING:
    from npchip import Machine
    from npchip.engines.batch import FrameBatch
    from npchip.run.result import FrameRecord

SMALL = machine_of(2, 9)
FRAMES = 7
RINGS = [0, 2, *(pytest.param(ring, marks=pytest.mark.long) for ring in (1, 3, 5))]


def send(port: int, body: str = "", label: str = "p", *, backwards: bool = False) -> str:
    """Lines that send the pixels in bank 0 to a port; `body` stands behind each send."""
    first, step = (63, 255) if backwards else (0, 1)
    return f"""
        MOV r15, #64
        MOV r14, #{first}
    {label}:
        LD r1, [r14]
        OUT {port}, r1
        {body}
        ADD r14, #{step}
        SUB r15, #1
        JANY NE, {label}
    """


def program(body: str, *kinds: str, setup: str = "") -> str:
    """A program that samples each frame and sends something; `kinds` are those of its ports."""
    outputs = "".join(f".output out{port}, {port}, {kind}\n" for port, kind in enumerate(kinds))
    return f"{outputs}{setup}\nframe: EXPOSE\nSAMPLE signal, 0\n{body}\nJMP frame\n"


EVERY_SECOND = "ADD r9, #128\nJANY LO, skip\n"
AND_A_PLANE = "LD r2, [17]\nOUT 1, r2\n"
PROGRAMS = {
    "a picture": program(send(0), "picture"),
    "backwards": program(send(0, backwards=True), "picture"),
    "two": program(send(0) + send(1, label="q", backwards=True), "picture", "picture"),
    "two at once": program(send(0, "OUT 1, r1"), "picture", "picture"),
    "and a plane": program(send(0) + AND_A_PLANE, "picture", "plane"),
    "a plane before": program(AND_A_PLANE + send(0), "picture", "plane"),
    "a plane without a name": program(send(0, "OUT 5, r1"), "picture"),
    "and lists": program(send(0, "OUT 1, r14\nOUT 2, r15"), "picture", "list", "scalar"),
    "under a mask": program(
        "COL r3\nCMP r3, #3\nWHERE LO\n" + send(0) + "END\nOUT 1, r3", "picture", "plane"
    ),
    "under a mask of its own": program(
        send(0).replace("OUT 0, r1", "CMP r1, #99\nWHERE LO\nOUT 0, r1\nEND"), "picture"
    ),
    "partly uniform": program("MOV r4, #9\nST [5], r4\n" + send(0), "picture"),
    "uniform": program(send(0).replace("LD r1, [r14]", "MOV r1, #7"), "picture"),
    "every second frame": program(EVERY_SECOND + send(0) + "skip:", "picture"),
    "every second frame, and a plane": program(
        AND_A_PLANE + EVERY_SECOND + send(0) + "skip:", "picture", "plane"
    ),
    "in two orders in turn": program(
        EVERY_SECOND
        + send(0)
        + "JMP done\nskip:\n"
        + send(0, label="q", backwards=True)
        + "done: OUT 1, r15",
        "picture",
        "list",
    ),
    "at two ports in turn": program(
        EVERY_SECOND + send(0) + "JMP done\nskip:\n" + send(1, label="q") + "done:",
        "picture",
        "picture",
    ),
    "before and behind a plane in turn": program(
        EVERY_SECOND
        + AND_A_PLANE
        + "skip:"
        + send(0)
        + "CMP r9, #0\nJANY NE, done\n"
        + AND_A_PLANE
        + "done:",
        "picture",
        "plane",
    ),
    "with a plane in its middle": program(
        send(0).replace("#64", "#32")
        + "OUT 1, r1"
        + send(0, label="q", backwards=True).replace("#64", "#32").replace("#63", "#31"),
        "picture",
        "plane",
    ),
    "twice a frame": program(send(0) + send(0, label="q"), "picture"),
    "twice in the third frame": program(
        send(0) + "ADD r9, #1\nCMP r9, #3\nJANY NE, skip\n" + send(0, label="q") + "skip:",
        "picture",
    ),
    "one pixel too few": program(send(0).replace("#64", "#63"), "picture"),
    "in the setup": program(
        send(0), "picture", setup="SAMPLE reset, 0\nADD r8, #3\nST [9], r8" + send(0, label="s")
    ),
    "before the frame": program("", "picture").replace("SAMPLE", send(0) + "SAMPLE"),
    "planes only": program(AND_A_PLANE + AND_A_PLANE + "OUT 0, r2", "plane", "plane"),
    "a plane, then a byte for all": program(AND_A_PLANE + "MOV r2, #4\nOUT 1, r2", "list", "plane"),
    "a plane in every second frame": program(EVERY_SECOND + AND_A_PLANE + "skip:", "list", "plane"),
    "ports without a name in turn": program(
        EVERY_SECOND + send(6) + "JMP done\nskip: OUT 3, r1\ndone:", "list"
    ),
    "some frames without sends": program(
        "CMP r9, #3\nJANY HS, skip\n" + send(0) + "skip: ADD r9, #1", "picture"
    ),
    "and a halt": program(send(0) + "HALT", "picture"),
    "until a halt": program(send(0) + "ADD r9, #64\nJNONE LO, on\nHALT\non:", "picture"),
}


def case_of(text: str, machine: Machine = SMALL, **changes: object) -> Case:
    """A case that runs twice, from registers that are 0."""
    case = Case(text, machine, seed=4, frames=FRAMES, limit=100_000, again=True)
    return replace(case, **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("ring", RINGS)
def test_frames_that_send_pictures(name: str, ring: int) -> None:
    """In one batch, in many, and with room for the sends of few frames; with a listener too."""
    assert_engines_agree(case_of(PROGRAMS[name], ring=ring, hears=100 * (ring > 1)))


@pytest.mark.long
@pytest.mark.parametrize("name", ["two", "and lists", "under a mask", "every second frame"])
@pytest.mark.parametrize("ring", RINGS)
def test_a_listener_that_fails_within_a_batch(name: str, ring: int) -> None:
    for hears in (1, 3, 4, 7):
        assert_engines_agree(case_of(PROGRAMS[name], ring=ring, hears=hears, again=False))


@pytest.mark.long
@pytest.mark.parametrize("name", ["two at once", "and a plane", "twice in the third frame"])
@pytest.mark.parametrize("ring", RINGS)
def test_a_limit_within_a_picture(name: str, ring: int) -> None:
    """Every frame reaches it, and the next run goes on within the picture."""
    for limit in (1, 300, 401, 999):
        assert_engines_agree(case_of(PROGRAMS[name], ring=ring, limit=limit))


@pytest.mark.long
@pytest.mark.parametrize("name", ["and a plane", "and lists", "under a mask", "and a halt"])
@pytest.mark.parametrize("ring", RINGS)
def test_a_run_that_begins_within_a_picture(name: str, ring: int) -> None:
    """Bytes that were sent by stepping belong to the first frame of the run."""
    program = assemble_text(PROGRAMS[name], "test.s", SMALL)
    with cramped(ring):
        for steps in (5, 31, 32, 150):
            chips = [Chip(program, SMALL, engine) for engine in ("reference", "wasm")]
            for chip in chips:
                chip.feed(clip_of(FRAMES, SMALL))
                for _ in range(steps):
                    assert chip.step() is None
            # At first it ends within the picture, too.
            for limit in (chips[0].frame_cycles + 50, 100_000):
                expected, found = (chip.run(max_cycles=limit) for chip in chips)
                assert not result_difference(expected, found)
                assert not state_difference(*map(state, chips))


SHAPES = [(60, 80), (16, 16), (17, 16), (16, 17), (18, 15), (256, 3), (2, 255), (31, 33)]


@pytest.mark.long
@pytest.mark.parametrize("shape", SHAPES)
def test_more_pictures_than_the_log_holds(shape: tuple[int, int]) -> None:
    """On large arrays the log holds a few pictures: it is emptied within a frame, too."""
    machine = machine_of(*shape)
    for name in ("two", "and a plane", "every second frame"):
        assert_engines_agree(case_of(PROGRAMS[name], machine, frames=5, again=False))


def test_each_frame_sends_in_a_way_of_its_own() -> None:
    """In batches of one frame each of them has its form; the engine does not keep them all."""
    longer = "ADD r9, #1\nMOV r5, r9\nmore: OUT 0, r5\nSUB r5, #1\nJANY NE, more\n"
    text = program(longer + AND_A_PLANE, "list", "plane")
    assert_engines_agree(case_of(text, machine_of(1, 2), frames=70, ring=1, again=False))


def test_more_frames_than_a_batch() -> None:
    """A batch has 64 frames at first."""
    for name in ("and a plane", "every second frame"):
        assert_engines_agree(case_of(PROGRAMS[name], machine_of(1, 2), frames=150, again=False))


@pytest.mark.parametrize("shape", [(1, 1), (2, 9), (8, 10), *SHAPES])
def test_pictures_are_the_frames(shape: tuple[int, int]) -> None:
    """Each pixel is in its place: judged by the clip, not by the other engine."""
    machine = machine_of(*shape)
    chip = Chip(assemble_text(PROGRAMS["two"], "test.s", machine), machine, "wasm")
    clip = clip_of(4, machine)
    result = chip.run(clip)
    assert (result.outputs["out0"] == clip).all()
    reversed_pixels = [to_frames(to_planes(frame)[::-1]) for frame in clip]
    assert (result.outputs["out1"] == reversed_pixels).all()


def test_results_do_not_change_when_a_run_goes_on() -> None:
    """They are copies of what lies in the memory of the module."""
    chip = Chip(assemble_text(PROGRAMS["two"], "test.s", SMALL), SMALL, "wasm")
    clips = [clip_of(FRAMES, SMALL, seed=seed) for seed in range(3)]
    heard: list[FrameRecord] = []
    results = [chip.run(clip, on_frame=heard.append) for clip in clips]
    for clip, result in zip(clips, results, strict=True):
        assert (result.outputs["out0"] == clip).all()
    assert (np.array([record.outputs["out0"] for record in heard]) == np.concatenate(clips)).all()


@pytest.mark.parametrize("name", ["two", "and lists", "planes only"])
def test_arrays_reach_the_collector_whole(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The other tests would hold as well if nothing were read as an array."""
    ports: set[int] = set()
    take = Collector.take

    def watch(self: Collector, batch: FrameBatch, *, complete: bool = True) -> None:
        if len(batch.cycles) > 1:
            ports.update(batch.log.arrays)
        take(self, batch, complete=complete)

    monkeypatch.setattr(Collector, "take", watch)
    Chip(assemble_text(PROGRAMS[name], "test.s", SMALL), SMALL, "wasm").run(clip_of(5, SMALL))
    assert ports == {"two": {0, 1}, "and lists": {0}, "planes only": {0, 1}}[name]
