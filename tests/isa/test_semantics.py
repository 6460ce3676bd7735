"""The meaning of instructions of one's own, executed."""

from __future__ import annotations

from importlib import resources

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.base.errors import IsaError
from npchip.isa import Isa, load_isa, parse_isa
from tests.support.chips import machine_of, places

NAME = "mine.yaml"


def extended(syntax: str, encoding: str, semantics: str) -> Isa:
    """The built-in instruction set with one instruction more."""
    built_in = resources.files("npchip.isa").joinpath("npchip.yaml").read_text(encoding="utf-8")
    lines = "\n".join(f"      {line}" for line in semantics.splitlines())
    return parse_isa(
        f"{built_in}\n"
        f"  - group: mine\n"
        f"    name: {syntax.split(maxsplit=1)[0]}\n"
        f"    title: Mine\n"
        f"    timing: alu\n"
        f'    forms: [{{syntax: "{syntax}", encoding: "{encoding}"}}]\n'
        f"    semantics: |\n{lines}\n"
        f"    text: An instruction of my own.\n",
        NAME,
    )


@pytest.mark.parametrize(
    "semantics",
    [
        "C = borrow(rd, rs)\nrd = rs - rd if C else rd - rs\nZ = rd == 0",
        "x = rd - rs\ny = rs - rd\nC = rd < rs\nrd = y if C else x\nZ = not (rd != 0)",
        "C = rs > rd\nm = 255 if C else 0\nrd = ((rd - rs) ^ m) - m\nZ = rd == 0",
    ],
)
def test_absd(semantics: str) -> None:
    """The documented example: |rd - rs| in the free major opcode."""
    isa = extended("ABSD {rd}, {rs}", "1111 dddd ssss 0000", semantics)
    machine = machine_of(256, 256, memory_bytes=64)
    program = assemble_text("ABSD r3, r4\nABSD r5, r5\nHALT", machine=machine, isa=isa)
    assert program.words[:2] == (0xF340, 0xF550)
    chip = Chip(program, machine, isa=isa)
    a, b = places(machine)
    chip.registers[3], chip.registers[4], chip.registers[5] = a, b, a
    chip.step()
    pairs = [[(x, y) for y in range(256)] for x in range(256)]
    assert chip.registers[3].tolist() == [[abs(x - y) for x, y in row] for row in pairs]
    assert chip.registers[4].tolist() == b.tolist()
    assert chip.flags["C"].tolist() == [[x < y for x, y in row] for row in pairs]
    assert chip.flags["Z"].tolist() == [[x == y for x, y in row] for row in pairs]
    chip.step()
    assert not chip.registers[5].any()
    assert chip.flags["Z"].all()
    assert not chip.flags["C"].any()
    assert chip.cycles == 2


def test_absd_obeys_the_mask() -> None:
    isa = extended(
        "ABSD {rd}, {rs}", "1111 dddd ssss 0000", "x = rd - rs\nrd = rs - rd if rd < rs else x"
    )
    machine = machine_of(1, 4)
    source = "COL r1\nMOV r2, #2\nCMP r1, #1\nWHERE HI\nABSD r1, r2\nEND\nHALT"
    chip = Chip(assemble_text(source, machine=machine, isa=isa), machine, isa=isa)
    chip.run()
    assert chip.registers[1].tolist() == [[0, 1, 0, 1]]


@pytest.mark.parametrize(
    ("semantics", "expected"),
    [
        ("rd = imm + imm", 144),  # constants too are bytes modulo 256
        ("rd = imm - 201", 255),
        ("k = imm\nrd = k + k", 144),
        ("k = 5\nrd = k + imm", 205),
        ("b = imm > 199\nrd = 1 if b else 2", 1),
        ("mem[imm + imm] = imm + 100\nrd = mem[144]", 44),
        ("rd = ~byte(imm == 200)", 254),
        ("rd = (imm ^ 255) | 1 << 7", 183),
        ("rd = 1 << 9", 0),
        ("x = rd\nrd = 3\nrd = rd + x", 10),  # a name keeps what it was given
    ],
)
def test_constants_in_semantics(semantics: str, expected: int) -> None:
    isa = extended("MINE {rd}, #{imm}", "1111 dddd iiii iiii", semantics)
    machine = machine_of()
    source = "MOV r6, #7\nMINE r6, #200\nHALT"
    chip = Chip(assemble_text(source, machine=machine, isa=isa), machine, isa=isa)
    assert chip.run().status == "halted"
    assert chip.registers[6].tolist() == [[expected] * 4] * 3


def test_a_sum_of_constants_is_sent_as_a_byte() -> None:
    isa = extended("MINE #{imm}", "1111 0000 iiii iiii", "output(3, imm + imm)")
    machine = machine_of()
    chip = Chip(assemble_text("MINE #200\nHALT", machine=machine, isa=isa), machine, isa=isa)
    sent = chip.run().setup.outputs["port3"]
    assert isinstance(sent, np.ndarray)
    assert np.array_equal(sent, np.full((3, 4), 144))


@pytest.mark.parametrize(
    ("semantics", "says"),
    [
        ("output(imm, row)", "output() takes a port, 0 to 15; this may be 16"),
        ("output((imm & 15) + 1, row)", "this may be 16"),
        (
            "jump(imm + imm + imm + imm + 4)",
            "jump() takes a program address, 0 to 1023; this may be",
        ),
        ("call(imm - 1)", "this may be -1"),
        ("mem[0] = input(imm | 16)", "input() takes a port, 0 to 15; this may be"),
    ],
)
def test_operands_may_not_go_beyond_what_a_device_has(semantics: str, says: str) -> None:
    with pytest.raises(IsaError) as caught:
        extended("MINE #{imm}", "1111 0000 iiii iiii", semantics)
    assert caught.value.code == "NP403"
    assert says in caught.value.message


@pytest.mark.parametrize(
    "semantics",
    ["output(imm & 15, row)", "jump(imm + imm + 1)", "mem[0] = input((imm ^ imm) & 15)"],
)
def test_operands_may_use_all_that_a_device_has(semantics: str) -> None:
    assert "MINE" in extended("MINE #{imm}", "1111 0000 iiii iiii", semantics).instructions


def test_an_instruction_may_stop_under_a_condition() -> None:
    isa = extended("STOP", "1111 0000 0000 0000", "if not none(C):\n  halt()")
    machine = machine_of(1, 4)
    source = "COL r1\n.more: ADD r1, #100\nSTOP\nJMP .more"
    chip = Chip(assemble_text(source, machine=machine, isa=isa), machine, isa=isa)
    assert chip.run(max_cycles=100).status == "halted"
    assert chip.registers[1].tolist() == [[44, 45, 46, 47]]


def test_the_built_in_set_stays_as_it_is() -> None:
    extended("ABSD {rd}, {rs}", "1111 dddd ssss 0000", "rd = rs")
    assert "ABSD" not in load_isa().instructions
    assert load_isa().decode(0xF340) is None


def test_words_that_yaml_takes_for_true_or_false_may_name_things() -> None:
    """NO as a condition is not False; the assembler and the listing know it by its name."""
    text = (
        "extends: npchip\nname: mine\nconditions:\n"
        "  NO: {code: 6, when: Z and C, text: none}\n"
        "  YES: {code: 7, when: not (Z and C), text: some}\n"
        "instructions: []\n"
    )
    isa = parse_isa(text, NAME)
    assert {"NO", "YES"} <= set(isa.condition_names)
    assert assemble_text("JANY NO, 0", isa=isa).words != assemble_text("JANY YES, 0", isa=isa).words


def test_what_is_wrong_with_a_file_is_one_kind_of_error_and_begins_with_its_place() -> None:
    for text, place in (("name: [", "mine.yaml:2: error: "), ("- 1", "error: mine.yaml: ")):
        with pytest.raises(IsaError) as caught:
            parse_isa(text, NAME)
        assert str(caught.value).startswith(place)
        assert str(caught.value).endswith(" [NP401]")
    with pytest.raises(IsaError) as caught:
        parse_isa("extends: npchip\nname: mine\ninstructions: 3\n", NAME)
    assert str(caught.value).startswith(
        "mine.yaml:3: error: instruction set: instructions: expected"
    )
