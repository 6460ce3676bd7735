"""Strips as loops over the vectors of 16 NPs, and code that does not grow with the array."""

from __future__ import annotations

from dataclasses import replace

import pytest

from npchip import Chip, assemble_text, load_machine
from tests.support.chips import clip_of, machine_of
from tests.support.compiled import compiled
from tests.support.lockstep import assert_engines_agree, state, state_difference
from tests.support.random_cases import Case

PROGRAMS = {
    "carries": "COL r0\nROW r1\nADD r2, r0\nADC r3, r1\nSBC r4, r2\nRCR r5\nADC r6, r5\nHALT",
    "neighbours of neighbours": (
        "NBR r1, r0, north\nNBR r2, r1, east\nADD r2, r1\nNBR r3, r2, west\nNBR r4, r3, south\n"
        "ADC r0, r4\nNBR r0, r0, north\nHALT"
    ),
    "every way out": (
        ".output a, 0, plane\n.output b, 1, list\n.output c, 2, scalar\nframe: EXPOSE\n"
        "SAMPLE signal, 0\nLD r0, [9]\nOUT 0, r0\nCMP r0, r1\nWHERE LO\nOUT 1, r0\nMOV r1, r0\n"
        "ELSE\nOUT 0, r1\nEND\nMOV r3, #7\nOUT 2, r3\nJANY EQ, more\nOUT 1, r1\nmore: OUT 0, r0\n"
        "JMP frame"
    ),
    "the global OR": (
        "COL r0\nADD r0, r1\nJANY EQ, some\nADD r2, #1\nsome: CMP r0, #200\nJNONE HS, none\n"
        "ADD r2, #2\nnone: SHL r1, #1\nJANY CS, end\nADD r2, #4\nend: HALT"
    ),
    "a value for later strips": (
        "ADD r0, r1\nMOV r2, r0\nJANY CS, a\nADD r3, #1\na: NBR r4, r0, east\nSUB r4, r2\n"
        "ST [7], r4\nLD r5, [r0]\nST [r2], r5\nADD r5, r2\nADC r5, r0\nHALT"
    ),
    "addresses of all kinds": (
        "MOV r9, #3\nl: LD r1, [r9]\nADD r1, r0\nST [r9 + 64], r1\nLD r2, [r1]\nST [r2], r9\n"
        "SUB r9, #1\nJANY NE, l\nHALT"
    ),
    "inputs": (
        "frame: EXPOSE\nIN r1, 1\nIN r2, 0\nADD r1, r0\nADC r2, r1\nNBR r0, r2, west\nJMP frame"
    ),
}
MACHINE = machine_of(2, 16)
SHAPES = ((1, 1), (1, 16), (3, 5), (2, 9), (8, 10), (1, 33), (16, 20), (33, 32))


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("text", PROGRAMS.values(), ids=PROGRAMS)
@pytest.mark.parametrize("profile", [False, True])
def test_strips_as_loops(text: str, shape: tuple[int, int], *, profile: bool) -> None:
    case = Case(
        f"{text}\n", machine_of(*shape), 7, 3, 900, again=False, partner="sends", tight=True
    )
    for seed in (5, 7):
        assert_engines_agree(replace(case, seed=seed, profile=profile))


def test_the_code_of_a_strip_does_not_grow_with_the_array() -> None:
    source = "".join(f"ADC r{k * 7 % 16}, r{(k * 5 + 3) % 16}\n" for k in range(300)) + "HALT"
    machines = machine_of(8, 10), machine_of(64, 64)
    # Without the constants, of which there is one for each NP.
    small, large = (compiled(source, m).size - compiled("HALT", m).size for m in machines)
    assert large < 1.1 * small


@pytest.mark.parametrize("cols", [1, 7, 15])
def test_the_code_that_moves_pixels_does_not_grow_with_the_rows(cols: int) -> None:
    source = ".output it, 0, picture\nEXPOSE\nSAMPLE signal, 0\nLD r0, [r1]\nOUT 0, r0\nHALT"
    assert compiled(source, machine_of(256, cols)).size < 70_000  # most of it constants


@pytest.mark.parametrize("pattern", [0, 30])
@pytest.mark.parametrize("shape", [(60, 80), (17, 16), (31, 33), (256, 8), (3, 256)])
def test_arrays_of_any_size_are_compiled(shape: tuple[int, int], pattern: int) -> None:
    """Rows of 16 NPs and more are rearranged row by row, others 16 rows at a time."""
    default = load_machine("default")
    sensor = replace(default.sensor, fixed_pattern=pattern)
    machine = replace(default, name="large", np_rows=shape[0], np_cols=shape[1], sensor=sensor)
    source = """
            EXPOSE
            SAMPLE signal, 0
            LD r0, [r1]             ; all addresses are equal
            MOV r4, #31
            AND r0, r4
            CMP r0, #9
            WHERE LO
              SAMPLE signal, 64
            END
            LD r3, [r0 + 64]        ; and now they are not
            ST [r0], r3
            NBR r2, r0, north
            HALT
    """
    program = assemble_text(source, "test.s", machine)
    chips = [Chip(program, machine, engine) for engine in ("reference", "wasm")]
    for chip in chips:
        chip.run(clip_of(1, machine))
    assert not chips[1].notice
    assert not state_difference(*map(state, chips))


def test_a_profile_of_many_nps() -> None:
    text = "COL r0\nROW r1\nCMP r0, r1\nWHERE LO\nADD r2, #1\nELSE\nADD r3, #1\nEND\nHALT\n"
    assert_engines_agree(Case(text, machine_of(67, 63), 1, 0, 900, again=False, profile=True))


NEAR = {
    "asked twice": (
        "NBR r1, r0, north\nADD r0, r0\nCMP r2, #7\nWHERE LO\nCMP r1, #3\nJANY LO, s\nMOV r4, #1\n"
        "s: END\nMOV r1, #0\nJANY LO, t\nCMP r9, r9\nMOV r5, #1\nHALT\nt: CMP r9, r9\nMOV r5, #2\n"
        "HALT\n"
    ),
    "a mask of a conversion that is not done": (
        "NBR r1, r0, north\nAND r0, #0\nOR r0, r3\nCMP r1, #5\nSAMPLE reset, 0\nWHERE HS\n"
        "SAMPLE reset, 0\nEND\nMOV r1, #0\nJANY HS, t\nCMP r9, r9\nMOV r5, #1\nHALT\n"
        "t: CMP r9, r9\nMOV r5, #2\nHALT\n"
    ),
}


@pytest.mark.parametrize("text", NEAR.values(), ids=NEAR)
def test_neighbours_are_read_before_the_variable_changes(text: str) -> None:
    """The last strip stores it, and asks for the branch: whether any NP has seen a 2 or a 7."""
    sensor = replace(MACHINE.sensor, fixed_pattern=0, noise_rms=0.0)
    machine = replace(MACHINE, sensor=sensor)
    program = assemble_text(text, "test.s", machine)
    for value in (2, 7):
        chips = [Chip(program, machine, engine) for engine in ("reference", "wasm")]
        for chip in chips:
            chip.registers[0] = value
            chip.registers[0][1, 3] = 1
            chip.registers[2] = 5
            chip.registers[2][0] = 9
            chip.registers[3][1, 3] = 1
            chip.run()
        assert not state_difference(*map(state, chips))
