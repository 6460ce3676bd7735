"""Neovim's own client, set up as docs/editors.md says."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.editors.recipes import MISTAKEN, project, recipe, surroundings
from tests.support.page_code import MissingError, here

pytestmark = pytest.mark.long


def version() -> tuple[int, int]:
    """Return the version of Neovim.

    Raises:
        MissingError: it is not installed.
    """
    if shutil.which("nvim") is None:
        raise MissingError("Neovim is not installed")
    text = subprocess.run(["nvim", "--version"], capture_output=True, text=True, check=True).stdout
    found = re.search(r"v(\d+)\.(\d+)", text)
    assert found
    return int(found[1]), int(found[2])


def test_the_recipe_of_this_neovim(tmp_path: Path) -> None:
    title = "**Neovim 0.11" if here(version) >= (0, 11) else "**Neovim 0.7 to 0.10"
    settings, report = tmp_path / "init.lua", tmp_path / "report.json"
    settings.write_text(recipe(title, "lua"))
    (tmp_path / "work").mkdir()
    program = project(tmp_path / "work")
    questions = Path(__file__).with_name("neovim.lua")
    command = [
        "nvim",
        "--headless",
        "-u",
        str(settings),
        str(program),
        "-c",
        f"luafile {questions}",
    ]
    done = subprocess.run(
        command,
        env=surroundings(tmp_path) | {"REPORT": str(report)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert report.exists(), done.stderr
    found = json.loads(report.read_text())
    assert "fault" not in found, found["fault"]
    line, column, message, source = found["mistake"]
    assert (line, column, source) == (5, 8, "npchip")
    assert "unknown instruction 'ADDD'" in message
    assert "MOV" in found["hover"]
    assert found["definition"] == [1, 7]
    assert found["references"] == 4
    assert found["action"] == "Change ADDD to ADD"
    wanted = MISTAKEN.replace("sum", "total").replace("ADDD    ", "ADD     ")
    assert found["text"] == wanted.splitlines()
    assert "start" in found["completion"]
