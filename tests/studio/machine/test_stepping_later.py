"""The page's chip with a program whose stepping form comes later, as after an edit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from npchip import assemble_text, load_machine
from npchip.formats.module import run_form
from npchip.isa import load_isa
from tests.support.clips import bundled_clips
from tests.support.page_chip import LIMIT, PageChip, about
from tests.support.programs import assembled

if TYPE_CHECKING:
    from npchip import Program

MACHINE = load_machine("default")
ENDLESS = "EXPOSE\nloop: ADD r0, #1\n JMP loop"
"""A program whose frame takes too long for the run form."""
SOON = 150
"""Milliseconds after which the stepping form comes."""

pytestmark = pytest.mark.long


def load(page: PageChip, program: Program, limit: int = LIMIT) -> str:
    """Put in the run form and a clip; return the file of the whole module."""
    whole, frames = page.written(program, MACHINE, bundled_clips()["coin_slide"])
    run = page.folder / "run.wasm"
    run.write_bytes(run_form(program, MACHINE, load_isa()))
    page.ask("breakpoints", all=[])
    page.ask("load", module=str(run), program=about(program), limit=limit)
    page.ask("frames", clip=frames)
    return whole


def test_a_run_tells_its_frames_at_once(page: PageChip) -> None:
    """Only the end of a run waits."""
    program = assembled("trajectory")
    page.load(program, MACHINE, bundled_clips()["coin_slide"], LIMIT)
    page.ask("run", pace="max")
    wanted, seen = page.ask("outputs")["frames"], page.view
    assert len(wanted) > 1
    whole = load(page, program)
    assert page.ask("run", pace="max", pause=SOON)["stop"]["reason"] == "paused"
    assert page.ask("outputs")["frames"] == wanted
    page.ask("stepping", module=whole)
    assert page.ask("run", pace="max")["stop"]["reason"] == "ended"
    assert page.view == seen
    assert page.ask("outputs")["frames"] == wanted


@pytest.mark.parametrize("to", ["step", "frame", "end"])
def test_a_travel_waits(page: PageChip, to: str) -> None:
    program = assembled("trajectory")
    page.load(program, MACHINE, bundled_clips()["coin_slide"], LIMIT)
    stop = page.go(to)
    seen = page.view
    whole = load(page, program)
    page.ask("stepping", module=whole, after=SOON)
    assert page.go(to) == stop
    assert page.view == seen


def test_another_program_does_not_wait(page: PageChip) -> None:
    """A run that waits for its stepping form gives way, and is where it should be."""
    program = assemble_text(ENDLESS)
    whole = load(page, program, 10**12)
    assert page.ask("run", pace="max", pause=SOON)["stop"]["reason"] == "paused"
    page.ask("stepping", module=whole)
    page.go("instruction", number=1001)
    assert page.view["registers"][0] == 500 % 256
    load(page, program, 10**12)
    page.ask("run", pace="max", pause=SOON)
    page.load(assembled("trajectory"), MACHINE, bundled_clips()["coin_slide"], LIMIT)
    assert page.ask("run", pace="max")["stop"]["reason"] == "ended"


def test_what_is_asked_meanwhile_waits(page: PageChip) -> None:
    program = assembled("trajectory")
    page.load(program, MACHINE, bundled_clips()["coin_slide"], LIMIT)
    page.ask("run", pace="max")
    cycles = page.ask("profile", frame=1)
    whole = load(page, program)
    page.ask("run", pace="max", pause=SOON)
    page.ask("stepping", module=whole, after=SOON)
    assert page.ask("profile", frame=1) == cycles


def test_a_form_that_is_not_to_be_had(page: PageChip) -> None:
    load(page, assembled("trajectory"))
    page.ask("stepping", module=None, why="the compiler broke down")
    with pytest.raises(ValueError, match="the compiler broke down"):
        page.go("step")
