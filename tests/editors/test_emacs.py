"""Eglot, the client of Emacs, set up as docs/editors.md says."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.editors.recipes import MISTAKEN, project, recipe, surroundings
from tests.support.page_code import MissingError, here

pytestmark = pytest.mark.long


def emacs() -> str:
    """Return Emacs.

    Raises:
        MissingError: it is not installed, or without eglot.
    """
    found = shutil.which("emacs")
    asked = ["emacs", "--batch", "--eval", "(require 'eglot)"]
    if found is None or subprocess.run(asked, capture_output=True, check=False).returncode:
        raise MissingError("Emacs with eglot is not installed")
    return found


def test_the_recipe_of_eglot(tmp_path: Path) -> None:
    command = here(emacs)
    settings, report = tmp_path / "init.el", tmp_path / "report.json"
    settings.write_text(recipe("The language server, with eglot", "elisp"))
    (tmp_path / "work").mkdir()
    program = project(tmp_path / "work")
    questions = Path(__file__).with_name("eglot.el")
    done = subprocess.run(
        [command, "--batch", "-l", settings, "-l", questions],
        env=surroundings(tmp_path) | {"REPORT": str(report), "PROGRAM": str(program)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert report.exists(), done.stderr
    found = json.loads(report.read_text())
    assert "fault" not in found, (found["fault"], done.stderr)
    assert found["mode"] == "npchip-mode"
    ((line, text),) = found["mistakes"]
    assert line == 6
    assert "unknown instruction 'ADDD'" in text
    assert found["references"] == 4
    wanted = MISTAKEN.replace("sum", "total").replace("ADDD    ", "ADD     ")
    assert found["text"] == wanted
