"""The debugger without a screen: whole programs, edits, and how runs end."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from npchip import Chip, InputError, assemble_text
from npchip.debugger import history, runner
from npchip.debugger.conditions import Stop
from npchip.debugger.language import parse_condition
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, One, Pixel
from tests.support.chips import clip_of, machine_of
from tests.support.clips import bundled_clips
from tests.support.lockstep import state, state_difference
from tests.support.programs import assembled

if TYPE_CHECKING:
    from collections.abc import Iterator


ASM = Path(__file__).parents[2] / "asm"


def trajectory(frames: int = 30, **extra: Any) -> Debugger:
    clip = np.concatenate([bundled_clips()["coin_slide"]] * 20)[:frames]
    return Debugger(assembled("trajectory"), clip, **extra)


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
    debugger = Debugger(assembled("trajectory"), iter(clip))
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
    debugger = Debugger(assembled("trajectory"), frames)
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


@pytest.mark.long
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

    debugger = Debugger(assembled("trajectory"), frames())
    for _ in range(2):
        with pytest.raises(InputError, match="frame 5"):
            debugger.run()
        assert debugger.chip.frames_taken == 5
        assert debugger.chip.frame_cycles > 1_000
    assert debugger.step_back().reason == "step"
