"""The studies in docs/networks.md are what examples/studies measures."""

from __future__ import annotations

import pytest

from examples import networks_costs
from examples.measure import ROOT
from examples.studies import measures
from examples.studies.rewritten import DIFFERENCE, MULTIPLIED

PAGE = (ROOT / "docs" / "networks.md").read_text(encoding="utf-8")


def line(cells: list[str]) -> str:
    """A row of a table."""
    return f"\n| {' | '.join(cells)} |\n"


def test_the_row_of_the_pyramid_and_of_a_kernel() -> None:
    rows = networks_costs.row(f"{networks_costs.STUDIES}/pyramid.s", "half the resolution")
    assert line(rows.cells()) in PAGE
    assert line(networks_costs.compiled_row("binomial").cells()) in PAGE


@pytest.mark.long
def test_what_a_multiplication_and_an_absolute_difference_save() -> None:
    saved = networks_costs.studied("correlate", MULTIPLIED["correlate"])
    assert line(saved.cells()) in PAGE
    assert line(networks_costs.studied("block_matching", DIFFERENCE).cells()) in PAGE


def test_memory_that_is_needed() -> None:
    """A pyramid's step needs both samples and 16 means, block matching all there is."""
    folder = ROOT / networks_costs.STUDIES
    assert measures.memory_used(folder / "pyramid.s") == 64 + 64 + 16
    assert measures.memory_used(folder / "block_matching.s") == 256
