"""The floors of the page: what its files may import, and how long they may be."""

from __future__ import annotations

import os
import re
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from npchip.studio.places import HOME

PAGE = HOME / "page"
CONTRACT = {
    "conditions": set(),
    "protocol": {"conditions"},
    "store": {"protocol"},
    "say": {"store"},
    "actions": {"protocol", "store"},
}
"""The files at the bottom, and what each may import of the page."""
ROOMS = {"editor", "array", "results", "frames", "compiler", "machine", "offline"}
"""They import the contract, and none of each other, not even a type."""
SHARED = {"control": {"frames"}}
"""Rooms that shell and player share: control of a run, and the sources of its frames."""
TOPS = {
    "player": {"control", "frames", "machine", "results"},
    "shell": {"control", *ROOMS},
}
"""Rooms that join others: ``player`` those that run a program in a page of its own."""
WORKERS = {"worker", "service-worker"}
"""They have no status line, and answer for their faults themselves."""
WRITES = {"editor": {"breaks", "cursor"}, "array": {"message"}}
"""Signals of the store that rooms write; those that join rooms may write all of them."""
LONGEST = 400

_TYPES = re.compile(r"\bimport type\b[^;]*;")
_UNHEARD = re.compile(r"\bvoid [\w.]+\(.*")
_OF_STORE = re.compile(r'import \{([^}]*)\} from "[./]+store";')
_WRITTEN = re.compile(r"\b(\w+)\.value\s*(?:[-+*/|&?]{0,2}=(?![=>])|\+\+|--)")
_IMPORT = re.compile(r'(?:\bfrom|\bimport)\s*\(?\s*"(\.{1,2}/[^"]+)"')


def sources() -> list[Path]:
    found = sorted(PAGE.rglob("*.ts*"))
    assert len(found) > 100
    return found


@cache
def graph(*, types: bool = True) -> dict[str, set[str]]:
    """The files that each file imports, by their path in the page without its ending.

    Args:
        types: whether imports of types alone count.
    """
    files = {path.relative_to(PAGE).with_suffix("").as_posix(): path for path in sources()}
    found: dict[str, set[str]] = {}
    for name, path in files.items():
        text = path.read_text(encoding="utf-8")
        text = text if types else _TYPES.sub("", text)
        targets = {
            os.path.normpath(f"{Path(name).parent.as_posix()}/{target}")
            for target in _IMPORT.findall(text)
        }
        assert targets <= files.keys(), f"{name} imports what is not there"
        found[name] = targets
    return found


def source_of(name: str) -> str:
    """The text of a file by its path in the page without its ending."""
    (path,) = PAGE.glob(f"{name}.ts*")
    return path.read_text(encoding="utf-8")


def room(name: str) -> str:
    return name.split("/", maxsplit=1)[0]


def test_imports_are_found() -> None:
    """The other tests would hold if none were."""
    assert graph()["shell/main"] >= {"shell/app", "shell/boot"}
    assert sum(map(len, graph().values())) > 300


def test_every_file_stands_in_a_room() -> None:
    assert {room(name) for name in graph()} == {*CONTRACT, *ROOMS, *SHARED, *TOPS}


@pytest.mark.parametrize("name", CONTRACT)
def test_the_contract_imports_nothing_above(name: str) -> None:
    assert graph()[name] <= CONTRACT[name]


@pytest.mark.parametrize("name", sorted({*ROOMS, *SHARED, *TOPS}))
def test_rooms_import_only_what_is_below(name: str) -> None:
    below = {name, *CONTRACT, *(SHARED | TOPS).get(name, ())}
    wrong = [
        f"{file} imports {target}"
        for file, targets in graph().items()
        if room(file) == name
        for target in sorted(targets)
        if room(target) not in below
    ]
    assert wrong == []


def written_by(name: str) -> set[str]:
    """The signals of the store that a room writes."""
    found = set()
    for file in graph():
        if room(file) == name:
            text = source_of(file)
            imported = {*re.findall(r"\w+", " ".join(_OF_STORE.findall(text)))}
            found |= {signal for signal in _WRITTEN.findall(text) if signal in imported}
    return found


@pytest.mark.parametrize("name", sorted(ROOMS))
def test_rooms_write_what_is_theirs_in_the_store(name: str) -> None:
    assert written_by(name) == WRITES.get(name, set())
    assert {"running", "view"} <= written_by("player")  # or nothing would be found in rooms


def test_there_are_no_circles() -> None:
    """Types may refer to each other: nothing of them is left when the page runs."""
    TopologicalSorter(graph(types=False)).prepare()  # raises CycleError, which names the circle


def test_no_promise_goes_unheard() -> None:
    """`heard` of ``say.ts`` lets work go on by itself, and says what goes wrong."""
    found = [
        f"{path.relative_to(PAGE).as_posix()}: {match[0]}"
        for path in sources()
        if path.stem not in WORKERS
        for match in _UNHEARD.finditer(path.read_text(encoding="utf-8"))
    ]
    assert found == []


@pytest.mark.parametrize("suffix", [".ts", ".tsx", ".css"])
def test_files_can_be_read_at_a_sitting(suffix: str) -> None:
    lengths = {
        path.relative_to(PAGE).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for path in PAGE.rglob(f"*{suffix}")
    }
    assert lengths
    assert {name: lines for name, lines in lengths.items() if lines > LONGEST} == {}
