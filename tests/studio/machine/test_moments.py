"""Every moment of the page's chip against npchip, forward and back."""

from __future__ import annotations

from random import Random
from typing import Any

import pytest

from npchip import assemble_text, load_machine
from npchip.debugger.session import Debugger
from tests.support.clips import bundled_clips
from tests.support.page_chip import LIMIT, PageChip, assert_sees, memory_of, view_of
from tests.support.programs import assembled
from tests.support.random_programs import draw_case

pytestmark = pytest.mark.long


class Trace:
    """States of a run by stepping the reference engine."""

    def __init__(
        self, debugger: Debugger, most: int, random: Random | None = None, share: float = 1
    ) -> None:
        self.views: dict[int, dict[str, Any]] = {0: view_of(debugger.chip)}
        for time in range(1, most):
            stop = debugger.step()
            if debugger.time != time:
                break
            if random is None or random.random() < share:
                self.views[time] = view_of(debugger.chip)
            if stop.reason != "step":
                break


@pytest.mark.parametrize("name", ["trajectory", "keypoints"])
def test_any_moment_is_reached_forward_and_back(page: PageChip, name: str) -> None:
    random = Random(name)
    machine, frames = load_machine("default"), bundled_clips()["shapes_drawn"]
    program = assembled(name)
    debugger = Debugger(program, frames, machine, max_cycles=LIMIT)
    trace = Trace(debugger, 3_000, random, 0.02)
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
    debugger = Debugger(program, frames, case.machine, memory=memory, max_cycles=LIMIT)
    trace = Trace(debugger, 250)
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
