"""docs/orientation.md: its text is the template's, its figures those of runs."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from examples import orientation_page
from examples.measure import ROOT

PAGE = orientation_page.PAGE.read_text(encoding="utf-8")


def test_the_page_is_made_of_its_template() -> None:
    parts = re.split(r"@\w+@", orientation_page.TEMPLATE.read_text(encoding="utf-8"))
    assert len(parts) > 8
    assert re.fullmatch(".*?".join(map(re.escape, parts)), PAGE, re.DOTALL)
    assert "@" not in PAGE


def test_the_figures_are_there() -> None:
    names = re.findall(r"\]\((figures/\S+)\)", PAGE)
    assert len(names) == 14
    assert all((ROOT / "docs" / name).is_file() for name in names)


def test_the_tutorial_runs_and_finds_the_drone() -> None:
    done = subprocess.run(
        [sys.executable, ROOT / "examples" / "orientation_tutorial.py"],
        capture_output=True,
        text=True,
        check=True,
    )
    wrong = re.search(r"so the drone is at .* - (\d+) mm wrong", done.stdout)
    assert wrong
    assert int(wrong[1]) < 100
    assert re.search(r"the chip says \d{4} mm, in \d+ cycles", done.stdout)


@pytest.mark.long
def test_the_table_of_the_chip_is_what_is_measured() -> None:
    assert orientation_page.chip_table() in PAGE
