"""Passes of loops, counted without running."""

from __future__ import annotations

import math

import pytest

from npchip import Chip, assemble_text, load_machine
from npchip.program.bounds import StaticView, static_view
from npchip.program.paths import CycleRange


def view_of(source: str) -> StaticView:
    return static_view(assemble_text(source), load_machine("default"))


def loop_of(source: str) -> tuple[float, float, str]:
    """The only loop of a source."""
    (loop,) = view_of(source).loops
    return loop.least, loop.most, loop.why


@pytest.mark.parametrize(
    ("source", "passes"),
    [
        ("MOV r0, #0\nl: ADD r0, #1\nCMP r0, #64\nJANY LO, l\nHALT", 64),
        ("MOV r0, #5\nl: SUB r0, #1\nJANY NE, l\nHALT", 5),
        ("MOV r0, #0\nl: ADD r0, #1\nJANY NE, l\nHALT", 256),
        ("MOV r0, #200\nl: ADD r0, #8\nJNONE CS, l\nHALT", 7),
        ("MOV r0, #250\nl: ADD r0, #1\nJALL NE, l\nHALT", 6),
        ("MOV r1, #2\nMOV r0, #88\nl: SUB r0, #1\nSBC r1, #0\nJANY NE, l\nHALT", 600),
        # A sentinel falls out after eight bits, whatever the others are.
        ("MOV r0, #1\nl: LD r1, [7]\nADD r1, #9\nADC r0, r0\nJNONE CS, l\nHALT", 8),
        ("MOV r0, #0x80\nl: LD r1, [7]\nADD r1, #9\nRCR r0\nJNONE CS, l\nHALT", 8),
        # Under a mask the counter is known where it counts.
        ("COL r1\nCMP r1, #3\nMOV r0, #4\nl: SUB r0, #1\nJANY NE, l\nWHERE LO\nNOP\nEND\nHALT", 4),
        ("JMP m\nl: SUB r0, #1\nJMP t\nm: MOV r0, #4\nt: CMP r0, #0\nJANY NE, l\nHALT", 5),
    ],
)
def test_passes_that_follow_from_constants(source: str, passes: int) -> None:
    assert loop_of(source) == (passes, passes, "proven")
    chip = Chip(assemble_text(source), engine="reference")
    cycles = chip.run().cycles
    view = view_of(source)
    assert view.setup == CycleRange(cycles, cycles)
    assert view.loops[0].most == chip.executions[view.loops[0].address]


@pytest.mark.parametrize(
    ("source", "loop"),
    [
        ("l: LD r0, [5]\nCMP r0, #1\nJANY NE, l\nHALT", (1, math.inf, "unbounded")),
        (".loop 20\nl: LD r0, [5]\nCMP r0, #1\nJANY NE, l\nHALT", (1, 20, "stated")),
        (".loop 4, 20\nl: LD r0, [5]\nCMP r0, #1\nJANY NE, l\nHALT", (4, 20, "stated")),
        # With nobody active JANY does not jump.
        (
            "COL r1\nCMP r1, #3\nWHERE LO\nMOV r0, #4\nl: SUB r0, #1\nJANY NE, l\nEND\nHALT",
            (1, 4, "proven"),
        ),
        # It may be left before the count is full.
        (
            "MOV r0, #9\nl: LD r1, [5]\nCMP r1, #1\nJANY EQ, e\nSUB r0, #1\nJANY NE, l\ne: HALT",
            (1, 9, "proven"),
        ),
        # What is stated may be less than what is proven, and what is proven less than stated.
        (
            "MOV r0,#9\n.loop 3\nl: LD r1, [5]\nCMP r1,#1\nJANY EQ, 6\nSUB r0,#1\nJANY NE,l\nHALT",
            (1, 3, "stated"),
        ),
        ("MOV r0, #5\n.loop 99\nl: SUB r0, #1\nJANY NE, l\nHALT", (5, 5, "proven")),
    ],
)
def test_loops_that_are_not_counted(source: str, loop: tuple[int, float, str]) -> None:
    assert loop_of(source) == loop


def test_a_loop_in_a_loop_is_counted_each_time() -> None:
    source = """
        MOV r0, #0
outer:  MOV r1, #0
inner:  ADD r1, #1
        ADD r0, #1
        CMP r1, #5
        JANY LO, inner
        CMP r0, #50
        JANY LO, outer
        HALT
    """
    view = view_of(source)
    assert [(loop.least, loop.most) for loop in view.loops] == [(10, 10), (5, 5)]
    assert view.setup == (Chip(assemble_text(source)).run().cycles,) * 2


def test_a_loop_with_two_entries_has_no_bound() -> None:
    source = (
        "LD r0, [5]\nCMP r0, #1\nJANY EQ, b\na: NOP\nb: LD r0, [6]\nCMP r0, #1\nJANY EQ, a\nHALT"
    )
    view = view_of(source)
    assert {loop.why for loop in view.loops} == {"several entries"}
    assert view.setup is not None
    assert view.setup.most == math.inf
    assert view.setup.least <= 7


@pytest.mark.long
def test_a_long_loop_leaves_the_others_their_bounds() -> None:
    long = "MOV r0, #0\nMOV r1, #0\nw: ADD r0, #1\nADC r1, #0\nJNONE CS, w\n"
    short = "MOV r2, #9\nl: SUB r2, #1\nJANY NE, l\nHALT"
    view = view_of("MOV r3, #4\nt: NOP\n" + long + "SUB r3, #1\nJANY NE, t\n" + short)
    assert [(loop.most, loop.why) for loop in view.loops] == [
        (4, "proven"),
        (math.inf, "unbounded"),
        (9, "proven"),
    ]
    assert view.setup is not None
    assert view.setup.most == math.inf


def test_passes_are_those_of_the_same_loop() -> None:
    # From an EXPOSE in the middle, a, too, is reached again and again without another one.
    source = """
h:      MOV r0, #8
        LD r1, [5]
        CMP r1, #1
        JANY EQ, a
        EXPOSE
a:      LD r1, [6]
        CMP r1, #1
        JANY EQ, e
        SUB r0, #1
        JANY NE, a
        JMP h
e:      EXPOSE
        JMP a
    """
    view = view_of(source)
    assert view.frame is not None
    assert view.frame.most == math.inf


def test_what_is_never_left_has_no_cycles() -> None:
    sources = ("a: JMP a", "NOP\nRET")
    assert [view_of(source).setup for source in sources] == [None, None]
    view = view_of("CALL f\nHALT\nf: JMP f")
    assert view.setup is None
    assert view.routines[0].cycles is None
