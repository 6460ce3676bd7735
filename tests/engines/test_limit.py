"""One rule for limits: a frame that takes more cycles than the limit is stopped."""

from __future__ import annotations

import numpy as np
import pytest

from npchip import Chip, assemble_text

CLIP = np.zeros((40, 64, 80), np.uint8)
PROGRAMS = {
    "loop": ("l: EXPOSE\n JMP l\n", 2),
    "halt": (" EXPOSE\n HALT\n", 2),
    "output": ("l: EXPOSE\n MOV r0, #1\n OUT 0, r0\n JMP l\n", None),
    "inner": ("l: EXPOSE\n MOV r0, #5\ni: SUB r0, #1\n JANY NE, i\n JMP l\n", None),
    "last": ("l: EXPOSE\n MOV r0, #1\n OUT 0, r0\n HALT\n", None),
}


@pytest.mark.parametrize("engine", ["wasm", "reference"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_frame_may_take_just_the_limit(name: str, engine: str) -> None:
    source, known = PROGRAMS[name]
    program = assemble_text(source)
    whole = Chip(program, engine=engine).run(CLIP)  # type: ignore[arg-type]
    worst = int(whole.frame_cycles.max())
    assert known in {None, worst}
    held = Chip(program, engine=engine).run(CLIP, max_cycles=worst)  # type: ignore[arg-type]
    assert (held.status, held.frames) == (whole.status, whole.frames)
    chip = Chip(program, engine=engine)  # type: ignore[arg-type]
    over = chip.run(CLIP, max_cycles=worst - 1)
    assert (over.status, over.frames) == ("cycle-limit", 1)
    chip.run(max_cycles=worst)  # goes on where it stopped
    assert chip.frames_taken == whole.frames
