"""docs/networks.md: its figures are what its script measures."""

from __future__ import annotations

from pathlib import Path

import pytest

from examples import networks_page
from tests.asm.test_digits import NEEDS_DIGITS

PAGE = (Path(__file__).parents[2] / "docs" / "networks.md").read_text(encoding="utf-8")


def test_costs_are_those_of_the_table() -> None:
    assert f"\n{networks_page.costs()}\n" in PAGE, "python -m examples.networks_page"


@NEEDS_DIGITS
@pytest.mark.long
def test_the_page_is_what_its_script_measures() -> None:
    assert networks_page.document() == PAGE
