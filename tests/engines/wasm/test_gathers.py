"""Loads and stores with an address for each NP, of which only some NPs need the result."""

from __future__ import annotations

from dataclasses import replace

import pytest

from npchip.engines.wasm.emit.effects import Effects
from npchip.engines.wasm.emit.helpers import HELPERS
from tests.support.chips import machine_of
from tests.support.compiled import compiled
from tests.support.lockstep import assert_engines_agree
from tests.support.random_cases import Case

BEGIN = "ROW r8\nCOL r9\nADD r2, r9\nADD r9, r0\n"
END = "CMP r8, r9\nHALT\n"  # the flags before are not needed
ALL, SOME = HELPERS.gather, HELPERS.gather_some
PROGRAMS = {
    "only bits that are set": ("LD r1, [r9]\nAND r1, r2\nMOV r3, r1", {SOME}),
    "one after the other": ("LD r1, [r9]\nAND r2, r1\nLD r1, [r8]\nAND r2, r1\nMOV r1, #0", {SOME}),
    "a value that needs the load itself": (
        "LD r1, [r9]\nMOV r2, r1\nSUB r2, #3\nAND r2, r1\nMOV r1, r8",
        {ALL},
    ),
    "a value made later": ("LD r1, [r9]\nMOV r2, r3\nADD r2, r8\nAND r1, r2", {ALL}),
    "a value loaded later": (
        "LD r1, [r9]\nST [r8], r4\nLD r3, [1]\nAND r1, r3\nMOV r3, r8",
        {ALL, HELPERS.scatter},
    ),
    "some bits, and the whole": ("LD r1, [r9]\nMOV r3, r1\nAND r3, r2", {ALL}),
    "a number": ("LD r1, [r9]\nAND r1, #12", {ALL}),
    "bits of the neighbour": ("LD r1, [r9]\nNBR r3, r1, east\nAND r3, r2\nMOV r1, r8", {ALL}),
    "bits of any NP": (
        "LD r1, [r9]\nCMP r1, #7\nJANY LO, a\nADD r2, #1\na: AND r1, r2\nMOV r1, r8",
        {ALL},
    ),
    "active NPs": (
        "CMP r2, #90\nWHERE LO\nLD r1, [r9]\nOR r1, r4\nST [r9], r1\nEND\nMOV r1, r8",
        {SOME, HELPERS.scatter_some},
    ),
    "active NPs, merged": ("CMP r2, #90\nWHERE HS\nLD r1, [r9]\nADD r1, r4\nEND", {SOME}),
    "active NPs, the complement of a bit": (
        "CMP r2, #90\nWHERE LO\nLD r1, [r9]\nADD r1, r4\nEND",
        {ALL},
    ),
    "active NPs, and all behind": (
        "CMP r2, #90\nWHERE LO\nLD r1, [r9]\nADD r1, r4\nEND\nLD r3, [r9]",
        {ALL},
    ),
    "NPs that become active later": (
        "LD r1, [r9]\nCMP r2, r1\nWHERE LO\nST [r8], r1\nEND\nMOV r1, r8",
        {ALL, HELPERS.scatter_some},
    ),
    "an address": ("LD r1, [r9]\nLD r3, [r1]\nAND r3, r2\nMOV r1, r8", {SOME}),
    "all NPs": ("LD r1, [r9]\nST [r1], r9", {ALL, HELPERS.scatter}),
    "sends": (
        ".output a, 0, plane\nCMP r2, #90\nWHERE LO\nLD r1, [r9]\nOUT 0, r1\nEND\nMOV r1, r8",
        {SOME},
    ),
}


@pytest.mark.parametrize("shape", [(1, 1), (3, 5), (8, 10), (16, 20)])
@pytest.mark.parametrize("text", [text for text, _ in PROGRAMS.values()], ids=PROGRAMS)
def test_only_some_nps_need_a_load(text: str, shape: tuple[int, int]) -> None:
    case = Case(
        f"{BEGIN}{text}\n{END}", machine_of(*shape), 7, 3, 900, again=False, partner="sends"
    )
    for seed in (5, 7):
        assert_engines_agree(replace(case, seed=seed))


@pytest.mark.parametrize("name", PROGRAMS)
def test_which_nps_are_served(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    text, expected = PROGRAMS[name]
    called: set[int] = set()
    call = Effects.call

    def note(self: Effects, function: int) -> None:
        called.add(function)
        call(self, function)

    monkeypatch.setattr(Effects, "call", note)
    compiled(f"{BEGIN}{text}\n{END}", machine_of(3, 5))
    accesses = {HELPERS.gather, HELPERS.gather_some, HELPERS.scatter, HELPERS.scatter_some}
    assert called & accesses == expected
