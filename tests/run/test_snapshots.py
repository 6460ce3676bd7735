"""Going back: snapshot, restore and reset; frames that can be taken again."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from npchip import InputError
from npchip.frames import frames_from_iterable
from tests.support.chips import LOOP, chip_of, clip_of, machine_of, places, state_of, summary

SMALL = machine_of()
ROW, COLUMN = places(SMALL)


PICTURE = """
.output seen, 0, picture
.output sum, 1, scalar
frame:  EXPOSE
        SAMPLE signal, 0
        MOV r0, #0
.pixel: LD r1, [r0]
        OUT 0, r1
        ADD r0, #1
        CMP r0, #64
        JANY LO, .pixel
        ADD r2, #3
        OUT 1, r2
        JMP frame
"""


@pytest.mark.parametrize("steps", [0, 1, 2, 100, 329, 330, 500, 900])
def test_restore_resumes_identically(steps: int) -> None:
    """From anywhere, in the middle of a picture too."""
    clip = clip_of(3, SMALL)
    chip = chip_of(PICTURE)
    chip.feed(clip)
    for _ in range(steps):
        assert chip.step() is None
    at = chip.snapshot()
    before = state_of(chip)
    expected, after = summary(chip.run()), state_of(chip)
    for _ in range(2):
        chip.restore(at)
        assert state_of(chip) == before
        assert summary(chip.run()) == expected
        assert state_of(chip) == after
    taken = before["frames_taken"]
    pictures = np.array(expected["outputs"]["seen"])
    assert np.array_equal(pictures, clip[taken:]) or taken == 3


def test_restore_in_a_mask_and_a_routine() -> None:
    chip = chip_of("COL r0\nCMP r0, #2\nWHERE LO\nCALL a\nEND\nHALT\na: MOV r1, #1\nRET")
    for _ in range(4):
        chip.step()
    at = chip.snapshot()
    chip.run()
    chip.restore(at)
    assert chip.stack == (4,)
    assert np.array_equal(chip.active, COLUMN < 2)
    chip.run()
    assert np.array_equal(chip.registers[1], np.where(COLUMN < 2, 1, 0))


def test_snapshot_of_a_halted_chip() -> None:
    chip = chip_of("NOP\nHALT")
    start = chip.snapshot()
    chip.run()
    end = chip.snapshot()
    chip.restore(start)
    assert chip.run().instructions == 2
    chip.restore(end)
    assert chip.run().instructions == 0


def test_reset_clears_all_but_the_program() -> None:
    chip, fresh = chip_of(LOOP), chip_of(LOOP)
    chip.run(clip_of(2, SMALL), max_cycles=270)
    chip.reset()
    assert state_of(chip) == state_of(fresh)
    assert not chip.memory.any()
    assert summary(chip.run()) == summary(fresh.run())


def test_arrays_stay_live_after_going_back() -> None:
    chip = chip_of("ADD r1, #1\nHALT")
    registers, carry, at = chip.registers, chip.flags["C"], chip.snapshot()
    registers[1] = 255
    chip.run()
    assert carry.all()
    chip.restore(at)
    assert not carry.any()
    chip.step()
    assert (registers[1] == 1).all()


@pytest.mark.parametrize("source", [False, True])
@pytest.mark.parametrize("taken", [1, 2, 3])
def test_frames_of_a_generator_are_never_the_wrong_ones(taken: int, source: bool) -> None:
    """Going back beyond what is still held is refused, even where the generator has some left."""
    clip = clip_of(3, SMALL)
    chip = chip_of(PICTURE)
    frames = (frame for frame in clip)
    chip.feed(frames_from_iterable(frames, SMALL.rows, SMALL.cols) if source else frames)
    at = chip.snapshot()
    while chip.frames_taken < taken:
        chip.step()
    chip.restore(at)
    if taken < 3:  # frames that were taken last are held
        assert np.array_equal(chip.run().outputs["seen"], clip)
        return
    with pytest.raises(InputError, match="cannot be taken twice") as caught:
        chip.run()
    assert caught.value.code == "NP106"
    assert caught.value.hint is not None


@pytest.mark.parametrize("kind", ["array", "list", "generator"])
def test_any_kind_of_frames(kind: str) -> None:
    clip = clip_of(3, SMALL)
    given: Any = {"array": clip, "list": list(clip), "generator": (frame for frame in clip)}[kind]
    chip = chip_of(PICTURE)
    result = chip.run(given)
    assert np.array_equal(result.outputs["seen"], clip)
    assert chip.run().status == "frames-exhausted"  # those are all, however often one asks


@pytest.mark.parametrize("kind", ["array", "list"])
def test_going_back_in_frames_that_can_be_read_again(kind: str) -> None:
    clip = clip_of(3, SMALL)
    chip = chip_of(PICTURE)
    chip.feed(clip if kind == "array" else list(clip))
    at = chip.snapshot()
    expected = summary(chip.run())
    chip.restore(at)
    assert summary(chip.run()) == expected
