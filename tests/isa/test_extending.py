"""Instruction sets of one's own, which extend the built-in one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from npchip import Chip, assemble
from npchip.base.errors import IsaError
from npchip.isa import load_isa, parse_isa, read_isa
from tests.oracles.frame_difference import frame_difference
from tests.support.clips import bundled_clips, synthetic_clip

ROOT = Path(__file__).parents[2]
ABSD = ROOT / "examples" / "absd" / "absd.yaml"

ENTRY = ABSD.read_text()[ABSD.read_text().index("  - group") :]


def extension(entry: str = ENTRY, head: str = "extends: npchip\nname: mine\n") -> str:
    return f"{head}instructions:\n{entry}"


def test_an_extension_has_all_of_the_built_in_instructions() -> None:
    isa, base = read_isa(ABSD), load_isa()
    assert set(isa.instructions) == {*base.instructions, "ABSD"}
    assert isa.name == "npchip-absd"
    for word in range(0, 0x10000, 7):
        expected = base.decode(word)
        if expected is not None:
            assert isa.decode(word) == expected


def test_the_built_in_set_is_as_it_was_after_an_extension() -> None:
    read_isa(ABSD)
    assert "ABSD" not in load_isa().instructions
    assert "ABSD" not in load_isa().forms


@pytest.mark.parametrize("seed", range(3))
def test_the_example_computes_what_the_original_does(seed: int) -> None:
    isa = read_isa(ABSD)
    program = assemble(ROOT / "examples" / "absd" / "frame_difference.s", isa=isa)
    frames = synthetic_clip(seed) if seed else bundled_clips()["coin_slide"][:8]
    result = Chip(program, isa=isa).run(frames)
    np.testing.assert_array_equal(result.outputs["difference"], frame_difference(frames))
    original = Chip(assemble(ROOT / "asm" / "frame_difference.s")).run(frames)
    assert result.cycles < original.cycles


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (extension(ENTRY.replace("1111", "1011")), "overlaps"),
        (extension(ENTRY.replace("ABSD", "ADD")), "defined twice (it is built in)"),
        (extension(head="extends: npchp\nname: mine\n"), "only 'npchip' can be extended"),
        (extension(head="extends: npchip\nname: npchip\n"), "a name of its own"),
        (extension(head="extends: npchip\n"), "needs name"),
        (extension(head="extends: npchip\nname: mine\nword_bits: 16\n"), "has no word_bits"),
        (
            extension(
                head="extends: npchip\nname: mine\n"
                "operands:\n  rd: {letter: d, kind: register, text: mine}\n"
            ),
            "built in and cannot be changed",
        ),
        (
            extension(
                head="extends: npchip\nname: mine\n"
                'conditions:\n  ZZ: {code: 1, when: "Z", text: mine}\n'
            ),
            "code 1 is that of NE",
        ),
        (
            extension(
                head="extends: npchip\nname: mine\n"
                'conditions:\n  CS: {code: 6, when: "Z", text: mine}\n'
            ),
            "the name CS is already taken",
        ),
    ],
)
def test_a_contradiction_is_named(text: str, message: str) -> None:
    with pytest.raises(IsaError, match=r"mine\.yaml:") as caught:
        parse_isa(text, "mine.yaml")
    assert message in str(caught.value)


def test_an_extension_may_bring_operands_and_conditions() -> None:
    isa = parse_isa(
        extension(
            head="extends: npchip\nname: mine\n"
            'conditions:\n  TT: {code: 6, when: "Z or not Z", text: always}\n'
            '  FF: {code: 7, when: "Z and not Z", text: never}\n'
        ),
        "mine.yaml",
    )
    assert isa.conditions["TT"].code == 6
    assert "JANY" in isa.instructions
