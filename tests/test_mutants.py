"""`python -m tests.mutants` draws the same small mistakes again, all of which can be read."""

from __future__ import annotations

import ast
from pathlib import Path

import yaml

from tests.mutants.draw import draw

PACKAGE = Path(__file__).parents[1] / "src" / "npchip"


def test_mutants_can_be_read_and_are_drawn_again() -> None:
    drawn = draw(PACKAGE, ("isa",), 25, seed=3)
    assert drawn == draw(PACKAGE, ("isa",), 25, seed=3)
    assert {Path(mutant.path).suffix for mutant in drawn} == {".py", ".yaml"}
    for mutant in drawn:
        before = (PACKAGE / mutant.path).read_bytes()
        after = mutant.applied(before)
        assert after != before, mutant
        if mutant.path.endswith(".py"):
            assert ast.dump(ast.parse(after)) != ast.dump(ast.parse(before)), mutant
        else:
            assert yaml.safe_load(after) != yaml.safe_load(before), mutant
