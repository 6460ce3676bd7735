"""Every program of ``asm/`` on both engines, on the bundled clips, under both machine files.

Quick runs take the first two frames of each clip, one after the other; NPCHIP_PROFILE=thorough
takes each clip. Of a program that takes long, only as many frames as the reference engine can do
soon.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from npchip import Chip, assemble
from tests.support.clips import CLIPS, bundled_clips
from tests.support.lockstep import result_difference, state, state_difference
from tests.support.profiles import THOROUGH

PROGRAMS = sorted((Path(__file__).parents[3] / "asm").glob("*.s"))
BEGINNINGS = "beginnings"
CYCLES = 300_000 if THOROUGH else 15_000
"""Cycles after which no more frames are taken."""


@pytest.mark.long
@pytest.mark.parametrize(
    "clip", sorted(path.stem for path in CLIPS.glob("*.npy")) if THOROUGH else [BEGINNINGS]
)
@pytest.mark.parametrize(
    "machine", ["default", pytest.param("conservative", marks=pytest.mark.long)]
)
@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_program(path: Path, machine: str, clip: str) -> None:
    clips = bundled_clips()
    frames = clips.get(clip, np.concatenate([item[:2] for item in clips.values()]))
    program = assemble(path, machine)
    slow, fast = Chip(program, machine, "reference"), Chip(program, machine, "wasm")
    if "TEMPLATE" in path.read_text():
        template = np.random.default_rng(1).integers(0, 256, slow.memory[128:192].shape, np.uint8)
        slow.load_memory(128, template)
        fast.load_memory(128, template)
    for chip in (slow, fast):
        chip.connect(
            lambda request: np.full((8, 10), (37 * request.frame + request.index) % 256, np.uint8)
        )
    start = fast.snapshot()
    found = fast.run(frames)
    assert found.frames == len(frames)
    frames = frames[: max(2, int((found.frame_cycles.cumsum() < CYCLES).sum()))]
    fast.restore(start)
    expected, found = slow.run(frames), fast.run(frames)
    assert found.engine == "wasm"
    assert not result_difference(expected, found)
    assert not state_difference(state(slow), state(fast))
