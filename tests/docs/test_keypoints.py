"""docs/keypoints.md: its figures are what its script measures."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from examples import keypoint_page

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "keypoints.md").read_text(encoding="utf-8")


@pytest.mark.long
@pytest.mark.parametrize("part", ["raised", "photo", "cycles", "verdict"])
def test_parts_that_are_soon_measured(part: str) -> None:
    assert f"\n{getattr(keypoint_page, part)()}\n" in PAGE, "python -m examples.keypoint_page"


@pytest.mark.long
def test_the_page_is_what_its_script_measures() -> None:
    assert keypoint_page.document() == PAGE


@pytest.mark.long
def test_its_figures_are_drawn(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "examples.keypoint_figures", str(tmp_path)]
    subprocess.run(command, check=True, cwd=ROOT)
    drawn = {file.name for file in tmp_path.iterdir()}
    assert {"figure-3.1.svg", "raised-pixel.svg", "same-sides.svg", "outlines.svg"} <= drawn
    assert drawn <= {file.name for file in (ROOT / "docs" / "figures").iterdir()}
