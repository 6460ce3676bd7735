"""Recipes of docs/editors.md, and a project to try them on."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "editors.md").read_text(encoding="utf-8")

MISTAKEN = """\
.include "lib/add.s"
.equ LIMIT, 5
.reg sum, r3
start:  MOV     sum, #LIMIT
        add_up  sum, 2
        ADDD    sum, #1
        JMP     start
"""
LIBRARY = """\
.macro add_up register, number
        ADD     register, #number
.endm
"""


def recipe(after: str, language: str) -> str:
    """Return the first block of a language after a text of the page."""
    _, found, rest = PAGE.partition(after)
    assert found, f"docs/editors.md has no '{after}'"
    block = re.search(rf"^```{language}\n(.*?)^```$", rest, re.MULTILINE | re.DOTALL)
    assert block
    return block[1]


def project(folder: Path) -> Path:
    """Write a program with a mistake, and the file that it includes; return the program."""
    (folder / "lib").mkdir()
    (folder / "lib" / "add.s").write_text(LIBRARY)
    (folder / "npchip.toml").write_text('machine = "conservative"\n')
    program = folder / "main.s"
    program.write_text(MISTAKEN)
    return program


def surroundings(folder: Path) -> dict[str, str]:
    """Return an environment in which ``npchip`` is this one, and nobody's settings count."""
    tools, home = folder / "tools", folder / "home"
    tools.mkdir()
    home.mkdir()
    command = tools / "npchip"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m npchip "$@"\n')
    command.chmod(0o755)
    path = f"{tools}{os.pathsep}{os.environ['PATH']}"
    kinds = ("HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME")
    return os.environ | {"PATH": path} | dict.fromkeys(kinds, str(home))
