"""The places of a program, and what follows each."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from npchip import Chip, assemble_text, load_machine
from npchip.engines.base import TrapError
from npchip.isa import Isa, load_isa
from npchip.program.graph import HALTED, RESET, Graph, Place, TooManyPlacesError, Words, successors
from tests.engines.wasm.test_extended import ISA
from tests.support.random_programs import draw_case

MACHINE = load_machine("default")


def words(text: str, isa: Isa | None = None) -> Words:
    isa = isa or load_isa()
    return assemble_text(text, isa=isa).decoded(isa)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("ADD r0, #1", [Place(1, (7,), 1)]),
        ("WHERE EQ", [Place(1, (7,), 2)]),
        ("ELSE", [Place(1, (7,), 1)]),
        ("END", [Place(1, (7,))]),
        ("JMP 5", [Place(5, (7,), 1)]),
        ("JANY EQ, 5", [Place(5, (7,), 1), Place(1, (7,), 1)]),
        ("CALL 5", [Place(5, (7, 1), 1)]),
        ("RET", [Place(7, (), 1)]),
        ("HALT", [HALTED]),
        (".word 0xFFFF", [None]),
    ],
)
def test_what_follows_a_word(line: str, expected: list[Place | None]) -> None:
    code = [load_isa().decode(assemble_text(f"HALT\n{line}").words[1])]
    assert list(successors(code, MACHINE, Place(0, (7,), 1))) == expected


@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("RET", RESET),
        ("END", RESET),
        ("ELSE", RESET),
        ("WHERE EQ", Place(0, (), MACHINE.mask_depth)),
        ("CALL 0", Place(0, (3,) * MACHINE.stack_depth)),
        ("NOP", Place(1)),
    ],
)
def test_a_trap_has_no_successor(line: str, place: Place) -> None:
    code = [load_isa().decode(assemble_text(f"HALT\n{line}").words[1])]
    assert successors(code, MACHINE, place) == (None,)


def test_a_guarded_call_that_would_trap_may_be_passed() -> None:
    code = words("VISIT 0\nHALT", ISA)
    full = (5,) * MACHINE.stack_depth
    assert successors(code, MACHINE, Place(0, full)) == (None, Place(1, full))
    assert successors(code, MACHINE, RESET) == (Place(0, (1,)), Place(1))


def test_a_routine_is_looked_at_for_each_of_its_callers() -> None:
    graph = Graph(words("WHERE EQ\nCALL 5\nCALL 5\nEND\nHALT\nNOP\nRET"), MACHINE)
    assert graph.successors == {
        Place(0): (Place(1, (), 1),),
        Place(1, (), 1): (Place(5, (2,), 1),),
        Place(5, (2,), 1): (Place(6, (2,), 1),),
        Place(6, (2,), 1): (Place(2, (), 1),),
        Place(2, (), 1): (Place(5, (3,), 1),),
        Place(5, (3,), 1): (Place(6, (3,), 1),),
        Place(6, (3,), 1): (Place(3, (), 1),),
        Place(3, (), 1): (Place(4),),
        Place(4): (HALTED,),
    }
    assert graph.following(Place(4)) == []


def test_recursion_ends_where_the_return_stack_is_full() -> None:
    graph = Graph(words("NOP\nCALL 0"), MACHINE)
    assert len(graph.successors) == 2 * (MACHINE.stack_depth + 1)
    (trap,) = [place for place in graph.successors if not graph.following(place)]
    assert trap == Place(1, (2,) * MACHINE.stack_depth)


@settings(max_examples=20)
@given(st.randoms(use_true_random=False))
def test_a_run_stays_in_the_graph(random: Random) -> None:
    """Every instruction leads to one of the places that the graph has for it."""
    case = draw_case(random, plain=True)
    chip = Chip(case.program(), case.machine, "reference")
    graph = Graph(chip.program.decoded(chip.isa), case.machine)
    place = RESET
    for _ in range(2_000):
        try:
            stop = chip.step()
        except TrapError:
            assert None in graph.successors[place]
            return
        after = Place(chip.pc, tuple(chip.stack), chip.depth)
        if stop is not None:
            return
        assert after in graph.successors[place]
        place = after


def test_too_many_places() -> None:
    routines = [f"f{n}: " + f"CALL f{n + 1}\n" * 14 + "RET\n" for n in range(3)]
    with pytest.raises(TooManyPlacesError):
        Graph(words("CALL f0\nHALT\n" + "".join(routines) + "f3: RET"), MACHINE)
