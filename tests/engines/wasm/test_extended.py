"""Instruction sets of one's own on both engines: semantics of every kind, in random programs."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import get_args

import pytest

from npchip import Chip, assemble, assemble_text
from npchip.isa import ir, parse_isa, read_isa
from tests.isa.test_extending import ABSD, ROOT
from tests.support.chips import clip_of, machine_of
from tests.support.clips import bundled_clips
from tests.support.lockstep import assert_engines_agree, result_difference, state, state_difference
from tests.support.profiles import THOROUGH
from tests.support.random_programs import draw_case

SHARES = 4
PROGRAMS = (20_000 if THOROUGH else 40) // SHARES

# Name, operands, encoding, semantics. What the built-in set has no use for stands here.
INSTRUCTIONS = (
    (
        "MIX",
        "{rd}, {rs}",
        "1111 dddd ssss 0000",
        """t = rd ^ rs
u = ~(t | 0x0F) - (rs & rd)
bit = rd <= rs and rs > t
rd = (u << 1) + (t >> 3) + byte(rd[2]) + row
Z = rd != rs or not C
C = bit""",
    ),
    (
        "PICK",
        "{rd}, {rs}",
        "1111 dddd ssss 0001",
        """C = borrow(rd, rs, C) if Z else carry(rs, column)
rd = rs if Z else (rd + 200 if C else 7)
Z = rd >= rs""",
    ),
    (
        "SWAP",
        "{rd}, {rs}",
        "1111 dddd ssss 0010",
        """t = mem[rs]
mem[rs] = rd
mem[rs + 1] = mem[rs] ^ rs
rd = t""",
    ),
    (
        "AROUND",
        "{rd}, {rs}, {direction}",
        "1111 dddd ssss 01nn",
        """t = neighbour(rd ^ rs, direction)
mem[9] = neighbour(mem[t] + rs, direction)
rd = byte(t[0]) if rd < rs else mem[9]""",
    ),
    (
        "TELL",
        "{port}, {rs}",
        "1111 ssss pppp 1000",
        """if any(Z):
    output(port, rs)""",
    ),
    (
        "NOTE",
        "{rd}, {rs}",
        "1111 dddd ssss 1001",
        """mem[3] = rd
if none(rd == rs and C):
    output(1, rd + rs)
    output(2, 77)""",
    ),
    (
        "GRAB",
        "{level}, {bank}",
        "1111 0000 0lbb 1010",
        """if any(not C):
    sample(level, bank)""",
    ),
)
FLOW = (
    ("BACK", "", "1111 0000 0000 1111", "if any(C):\n    ret()"),
    ("STOP", "", "1111 0000 0001 1111", "if any(Z and C):\n    halt()"),
    ("NEXT", "", "1111 0000 0010 1111", "if any(not Z):\n    expose()"),
    ("VISIT", "{port}", "1111 0001 pppp 1110", "if any(Z):\n    call(port)"),
    ("STEP", "{port}", "1111 0000 pppp 1110", "if none(C or Z):\n    jump(port)"),
)


def entry(name: str, operands: str, encoding: str, semantics: str) -> str:
    """The text of an instruction."""
    syntax = f"{name} {operands}".strip()
    lines = "".join(f"      {line}\n" for line in semantics.splitlines())
    return (
        f"  - group: arithmetic\n    name: {name}\n    title: {name}\n    timing: alu\n"
        f'    forms:\n      - {{syntax: "{syntax}", encoding: "{encoding}"}}\n'
        f"    semantics: |\n{lines}    text: Of a test.\n"
    )


ISA = parse_isa(
    "extends: npchip\nname: test\ninstructions:\n"
    + "".join(entry(*item) for item in (*INSTRUCTIONS, *FLOW)),
    "test.yaml",
)


def draw_own(random: Random, register: Callable[[], str]) -> str:
    """One of `INSTRUCTIONS`."""
    name, operands, *_ = random.choice(INSTRUCTIONS)
    values = {
        "rd": register(),
        "rs": register(),
        "direction": random.choice(["north", "east", "south", "west"]),
        "port": random.randrange(4),
        "level": random.choice(["reset", "signal"]),
        "bank": 0,
    }
    return f"{name} {operands.format(**values)}"


def test_every_kind_of_node_is_used() -> None:
    nodes = [node for item in ISA.instructions.values() for f in item.forms for node in f.nodes]
    kinds = {type(node) for node in nodes}
    assert kinds == {*get_args(ir.Expr), *get_args(ir.Statement)}
    assert {node.op for node in nodes if isinstance(node, ir.Operation)} == set(ir.OPERATIONS)
    effects = {node.name for node in nodes if isinstance(node, ir.Effect)}
    assert effects == set(get_args(ir.EffectName))


@pytest.mark.long
@pytest.mark.parametrize("share", range(SHARES))
def test_random_programs_with_instructions_of_ones_own(share: int) -> None:
    for seed in range(share * PROGRAMS, (share + 1) * PROGRAMS):
        assert_engines_agree(draw_case(Random(1_000_000 + seed), ISA, draw_own))


@pytest.mark.parametrize(
    ("semantics", "ends"),
    [
        ("t = rd\nmask_pop()\nrs = t", ""),
        ("t = rd\nmask_invert()\nrs = t", "END"),
        ("z = Z\nmask_pop()\nrs = byte(z)", ""),
        ("t = rd == 5\nmask_pop()\nmask_push(t)\nrs = 9", "END"),
        ("mask_push(C)\nrd = 5\nt = rd\nmask_pop()\nrs = t", "END"),
    ],
)
def test_names_that_are_set_before_other_nps_become_active(semantics: str, ends: str) -> None:
    isa = parse_isa(
        "extends: npchip\nname: test\ninstructions:\n"
        + entry("WAKE", "{rd}, {rs}", "1111 dddd ssss 0000", semantics),
        "test.yaml",
    )
    machine = machine_of()
    source = f"COL r0\nROW r1\nCMP r0, #2\nWHERE LO\nMOV r0, #5\nWAKE r0, r1\n{ends}\nHALT"
    program = assemble_text(source, "test.s", machine, isa=isa)
    chips = [Chip(program, machine, engine, isa) for engine in ("reference", "wasm")]
    for chip in chips:
        chip.run()
    assert not state_difference(*map(state, chips))


@pytest.mark.parametrize("odd", ["BACK", "STOP", "NEXT", "VISIT 1", "STEP 1"])
@pytest.mark.parametrize("flags", ["CMP r2, #0", "CMP r2, #1", "CMP r2, #255", "ADD r2, #0"])
def test_flow_that_depends_on_the_global_or(odd: str, flags: str) -> None:
    machine = machine_of()
    source = (
        f".output x, 0, list\n JMP frame\nsub: {flags}\n OUT 0, r2\n"
        f" {odd if odd == 'BACK' else 'NOP'}\n ADD r3, #1\n RET\n"
        "frame: EXPOSE\n ADD r3, #1\n SAMPLE signal, 0\n LD r2, [0]\n CALL sub\n OUT 0, r3\n"
        f" {odd if odd != 'BACK' else 'NOP'}\n OUT 0, r2\n JMP frame\n"
    )
    program = assemble_text(source, "test.s", machine, isa=ISA)
    slow = Chip(program, machine, "reference", ISA)
    fast = Chip(program, machine, "wasm", ISA)
    clip = clip_of(4, machine) % 3
    expected, found = slow.run(clip), fast.run(clip)
    assert found.engine == "wasm"
    assert not result_difference(expected, found)
    assert not state_difference(state(slow), state(fast))


def test_the_example_of_an_instruction_of_ones_own() -> None:
    isa = read_isa(ABSD)
    program = assemble(ROOT / "examples" / "absd" / "frame_difference.s", isa=isa)
    chips = [Chip(program, "default", engine, isa) for engine in ("reference", "wasm")]
    expected, found = (chip.run(bundled_clips()["coin_slide"][:6]) for chip in chips)
    assert found.engine == "wasm"
    assert not result_difference(expected, found)
    assert not state_difference(*map(state, chips))
