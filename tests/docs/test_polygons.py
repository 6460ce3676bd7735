"""docs/polygons.md: its figures are what its script measures."""

from __future__ import annotations

from pathlib import Path

import pytest

from examples import polygon_page

PAGE = (Path(__file__).parents[2] / "docs" / "polygons.md").read_text(encoding="utf-8")


def test_discs_have_the_corners_of_the_table() -> None:
    assert f"\n{polygon_page.discs()}\n" in PAGE, "python -m examples.polygon_page"


@pytest.mark.thorough
def test_the_page_is_what_its_script_measures() -> None:
    assert polygon_page.document() == PAGE
