"""docs/architecture.md and docs/engine.md name the floors and files that there are."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.test_architecture import FLOORS, PACKAGE

ROOT = Path(__file__).parents[2]
MAP = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
ENGINE = (ROOT / "docs" / "engine.md").read_text(encoding="utf-8")


def rows(page: str) -> Iterator[list[str]]:
    """Yield the cells of every row of every table."""
    for line in page.splitlines():
        if line.startswith("| "):
            yield line.strip("|").split(" | ")


def names(text: str) -> list[str]:
    return re.findall(r"`([^`]+)`", text)


def test_the_map_is_short() -> None:
    assert len(MAP.split()) <= 1800


def test_the_map_shows_the_floors_of_the_test() -> None:
    shown = {int(cells[0]): names(cells[1]) for cells in rows(MAP) if cells[0].strip().isdigit()}
    assert shown == {number: list(rooms) for number, rooms in enumerate(FLOORS)}


def test_every_room_and_file_of_the_map_is_there() -> None:
    looked_at: set[str] = set()
    files = 0
    for cells in rows(MAP):
        for room in names(cells[0]):
            home = PACKAGE if (PACKAGE / room).exists() else ROOT
            if not (home / room).exists():
                continue  # the table of floors
            looked_at.add(room.rstrip("/"))
            for name in names(" ".join(cells[1:])):
                if re.fullmatch(r"\w+\.(py|yaml)|\w+/", name):
                    files += 1
                    assert (home / room / name).exists(), f"{room}{name}"
    rooms = {path.name for path in PACKAGE.iterdir() if (path / "__init__.py").exists()}
    assert rooms <= looked_at
    assert files > 50


def test_every_path_of_the_questions_is_there() -> None:
    paths = {
        name
        for cells in rows(MAP.split("## Where to look")[1].split("\n## ")[0])
        for name in names(cells[1])
        if re.fullmatch(r"(\w+/)+(\w+\.\w+)?", name)
    }
    assert len(paths) > 15
    for path in paths:
        assert (PACKAGE / path).exists() or (ROOT / path).exists(), path


@pytest.mark.parametrize("folder", ["translate", "emit"])
def test_every_module_of_the_compiled_engine_is_in_the_table(folder: str) -> None:
    section = ENGINE.split(f": `{folder}/`\n")[1].split("\n##")[0]
    named = {name for cells in rows(section) for name in names(cells[1]) if name.endswith(".py")}
    there = {p.name for p in (PACKAGE / "engines/wasm" / folder).glob("*.py")} - {"__init__.py"}
    assert named == there
