"""Whole runs of the page's chip against npchip."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from npchip import Chip, assemble_text, load_machine
from npchip.frames.memory import initial_memory
from tests.support.clips import bundled_clips
from tests.support.page_chip import (
    LIMIT,
    PageChip,
    document_of,
    memory_of,
    without_count,
    without_instructions,
)
from tests.support.programs import ASM, assembled
from tests.support.random_programs import draw_case

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip import Machine, Program

pytestmark = pytest.mark.long

NAMES = sorted(path.stem for path in ASM.glob("*.s"))


@pytest.mark.parametrize("clip", ["coin_slide", "shapes_photo"])
@pytest.mark.parametrize("machine", ["default", "conservative"])
@pytest.mark.parametrize("name", NAMES)
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
    *,
    limit: int = LIMIT,
    memory: tuple[tuple[int, NDArray[np.uint8]], ...] = (),
) -> dict[str, Any]:
    """Compare a whole run, and the frames that a run at full speed tells, with a run of npchip."""
    memory = tuple(initial_memory(program, machine, memory))
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
        assert all(
            value is None
            for name, value in theirs["outputs"].items()
            if name not in ours["outputs"]
        )
    seen = page.view
    assert (seen["status"], seen.get("error")) == (wanted["status"], wanted.get("error"))
    assert (seen["cycles"], seen["instructions"]) == (wanted["cycles"], wanted["instructions"])
    return wanted


@pytest.mark.parametrize("seed", range(40))
def test_random_programs_run_as_in_npchip(page: PageChip, seed: int) -> None:
    case = draw_case(Random(seed), plain=True)
    frames = case.clip() if case.frames else None
    memory = ((0, memory_of(case)),)
    whole_and_told(page, case.program(), case.machine, frames, limit=case.limit, memory=memory)


ENDS = {
    "halted": ("loop: EXPOSE\n MOV r0, #3\n OUT 0, r0\n HALT", "halted"),
    "halted at once": ("HALT", "halted"),
    "short frames": ("loop: EXPOSE\n JMP loop", "frames-exhausted"),
    "no end": ("EXPOSE\nloop: ADD r0, #1\n JMP loop", "cycle-limit"),
    "no end before a frame": ("loop: JMP loop", "cycle-limit"),
    "trap": ("EXPOSE\n OUT 2, r0\n RET", "failed"),
    "nobody sends": ("EXPOSE\n IN r0, 4", "failed"),
    "disagreement": (
        """
        .output a, 0, scalar
        .output b, 1, list
loop:   EXPOSE
        COL     r1
        OUT     1, r0
        OUT     0, r1
        OUT     1, r1
        JMP     loop
        """,
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
        """
        .output a, 0, scalar
loop:   EXPOSE
        ADD     r3, #1
        CMP     r3, #3
        MOV     r1, #7
        WHERE   EQ
        COL     r1
        END
        OUT     0, r1
        JMP     loop
        """,
        "failed",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", ENDS)
@pytest.mark.parametrize("limit", [1_000, 3, 2, 1])
def test_ends_of_runs(page: PageChip, case: str, limit: int) -> None:
    text, status = ENDS[case]
    frames = bundled_clips()["coin_slide"][:9]
    wanted = whole_and_told(page, assemble_text(text), load_machine("default"), frames, limit=limit)
    if limit == 1_000:
        assert wanted["status"] == status


WAYS = {
    "the same numbers": "OUT 0, r3\n OUT 1, r4",
    "one twice": "OUT 0, r3\n OUT 1, r4\n OUT 0, r4",
    "nothing": "",
    "another order now and then": """
        CMP     r4, #11
        JANY    LO, .usual
        OUT     1, r3
        OUT     0, r4
        JMP     loop
.usual: OUT     0, r3
        OUT     1, r4
    """,
    "fewer now and then": "OUT 0, r3\n CMP r4, #13\n JANY HS, loop\n OUT 1, r4",
    "none now and then": "CMP r4, #9\n JANY HS, loop\n OUT 0, r3",
    "from one NP now and then": """
        OUT     0, r3
        CMP     r4, #7
        JANY    LO, loop
        COL     r1
        CMP     r1, #3
        WHERE   EQ
          OUT   1, r3
        END
    """,
    "to a port without a name now and then": "OUT 0, r3\n CMP r4, #14\n JANY LO, loop\n OUT 5, r3",
    "a disagreement in the end": """
        OUT     0, r3
        CMP     r3, #150
        JANY    LO, loop
        COL     r1
        OUT     1, r1
    """,
}


@pytest.mark.parametrize("way", WAYS)
def test_frames_that_send_numbers_in_many_ways(page: PageChip, way: str) -> None:
    """Batches of frames that send alike are read at once, up to the first that does not."""
    text = f"""
        .output a, 0, scalar
        .output b, 1, scalar
        .output never, 2, scalar
loop:   EXPOSE
        ADD     r3, #1          ; counts frames
        MOV     r4, r3
        AND     r4, #15
{WAYS[way]}
        JMP     loop
    """
    frames = np.resize(bundled_clips()["coin_slide"], (200, 64, 80))
    wanted = whole_and_told(page, assemble_text(text), load_machine("default"), frames)
    assert len(wanted["frames"]) == (150 if way == "a disagreement in the end" else 200)
