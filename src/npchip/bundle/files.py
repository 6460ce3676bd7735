"""The bundled files: a wheel has them in the package, a working copy beside it."""

from __future__ import annotations

import atexit
import json
import os
import tempfile
from collections.abc import Iterable
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Final, Literal, NamedTuple

from npchip.base.errors import InputError
from npchip.base.suggest import near_miss

What = Literal["program", "clip", "rig", "scene"]
FOLDERS: Final = ("asm", "examples")
EXAMPLES: Final = ("bundled.json", "clips", "orientation", "rigs", "scenes", "templates")
"""The bundled part of the folder ``examples``: pyproject.toml says it to the wheel."""


class Bundled(NamedTuple):
    """A bundled file, and what it is in a line."""

    path: Path
    summary: str


def find(what: What, given: str | Path, folder: Path | None = None) -> Path:
    """Return a path as given if something is there, else that of the bundled file of this name.

    Args:
        what: the kind of file that is asked for.
        given: a path, relative to `folder`, or a name.
        folder: the folder from which the path leads; None for the present one.
    """
    path = Path(given) if folder is None else folder / given
    name = str(given)
    if os.sep in name or os.path.lexists(path):
        return path
    found = bundled(what).get(name)
    return found.path if found else path


def need(what: What, given: str | Path, code: str) -> Path:
    """Return what `find` does.

    Raises:
        InputError: `code`, nothing is there, and a bundled name is near.
    """
    path = find(what, given)
    near = None if os.path.lexists(path) else hint(what, given)
    if near:
        raise InputError(code, f"cannot read {path}: no such file", hint=near)
    return path


def hint(what: What, given: str | Path) -> str | None:
    """Return a hint for a path at which nothing is: a source of this name, a bundled name."""
    known, path = bundled(what), Path(given)
    if what == "program" and not path.suffix and path.with_suffix(".s").is_file():
        return f"did you mean {path.with_suffix('.s')}?"
    if not known:
        return None
    if path.stem in known and str(given) not in known:
        return f"{path.stem}, without folder and ending, is the {what} that comes with npchip"
    near = near_miss(path.name[:80], known)
    if near:
        return f"did you mean {near}, a {what} that comes with npchip?"
    return None if path.suffix or len(path.parts) > 1 else "npchip examples lists the known names"


@cache
def bundled(what: What) -> dict[str, Bundled]:
    """Return the bundled files of a kind by name; none where npchip was installed without them."""
    if what == "program":
        return {
            path.stem: Bundled(path, _summary(path)) for path in sorted((top() / "asm").glob("*.s"))
        }
    folder = top() / "examples"
    try:
        catalogue = json.loads((folder / EXAMPLES[0]).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    return {name: Bundled(folder / file, text) for name, (file, text) in catalogue[what].items()}


def _summary(source: Path) -> str:
    with source.open(encoding="utf-8") as lines:
        return lines.readline().partition(" - ")[2].strip()


def all_files() -> list[Path]:
    """Return the bundled files, and what the tests of the programs read besides."""
    places = [top() / "asm", *(top() / "examples" / name for name in EXAMPLES)]
    found = [path for place in places for path in (place, *sorted(place.rglob("*")))]
    return [path for path in found if path.is_file()]


@cache
def top() -> Path:
    """Return the folder in which the folders `FOLDERS` are."""
    package = resources.files("npchip")
    if isinstance(package, Path):
        return package if (package / "asm").is_dir() else package.parents[1]
    return _unpacked(package, FOLDERS)


@cache
def course() -> Path:
    """Return the folder of the exercises of ``npchip learn``."""
    package = resources.files("npchip")
    within = "course/exercises"
    return package / within if isinstance(package, Path) else _unpacked(package, (within,)) / within


def _unpacked(package: Traversable, names: Iterable[str]) -> Path:
    """Copy parts of an archive into a folder, as programs include files by path."""
    unpacked = tempfile.TemporaryDirectory(prefix="npchip-")
    atexit.register(unpacked.cleanup)
    for name in names:
        target = Path(unpacked.name) / name
        target.parent.mkdir(exist_ok=True)
        _unpack(package / name, target)
    return Path(unpacked.name)


def _unpack(source: Traversable, target: Path) -> None:
    if source.is_file():
        target.write_bytes(source.read_bytes())
    elif source.is_dir():
        target.mkdir()
        for item in source.iterdir():
            _unpack(item, target / item.name)
