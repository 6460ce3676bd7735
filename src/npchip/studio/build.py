"""Builds the page: ``npchip studio --build``, or ``python -m npchip.studio.build``.

A page is built in a folder beside its place and moved there when it is complete. What takes long
and has not changed is taken from the page that was there before.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Final

import npchip
from npchip import bundle
from npchip.base.errors import InputError, NpchipError
from npchip.base.files import locked, make_directory, uninterrupted
from npchip.studio import assets, python_files
from npchip.studio.bundling import Bundler, write_index
from npchip.studio.licences import write_licences
from npchip.studio.node import Node, fetch_packages, find_node
from npchip.studio.offline import digest, write_version, write_worker
from npchip.studio.places import HOME, PAGE, SITE, is_clone, known_version
from npchip.studio.player import write_player

Say = Callable[[str], None]
_PACKAGE: Final = HOME.parent
_PACKAGES: Final = ("package.json", "package-lock.json", "tsconfig.json")
_NO_SOURCE: Final = {"__pycache__", "site", "node_modules"}
_LIBRARIES: Final = ("numpy", "pillow", "PyYAML")
"""Packages that make the slow parts, or are in them."""


def build(say: Say, site: Path = SITE) -> bool:
    """Build the page unless it is up to date.

    Args:
        say: called with a line for each step.
        site: the folder of the page.

    Returns:
        whether it had to be built.

    Raises:
        InputError: NP630 there are no sources here; NP631 to NP633 a step failed.
    """
    if not is_clone():
        raise InputError(
            "NP630",
            "the page is built in a clone: an installed npchip has no sources of it",
            hint="install a release wheel, which has the page, or work in a clone:"
            " pip install --editable '.[studio]'",
        )
    with locked(HOME):
        wanted = sources()
        if known_version(site).get("sources") == wanted:
            return False
        node = find_node()
        begin = time.monotonic()
        with _Unfinished(site) as made:
            parts = _fill(made, node, site, say)
            write_version(made, npchip.__version__, wanted, parts)
            assets.compress(made)
        files = [path for path in site.rglob("*") if path.is_file()]
        size = sum(path.stat().st_size for path in files) / 1e6
        say(f"{len(files)} files, {size:.1f} MB, in {time.monotonic() - begin:.0f} s")
    return True


def sources() -> str:
    """Return a digest of all that the page is made from."""
    return _digest(_all_sources())


def slow_sources(node_version: str) -> str:
    """Return a digest of all that the slow parts may be made from: it leaves out the page's code.

    What each part needs would be less, but who adds to a part would have to think of it here.
    """
    own = _digest(path for path in _all_sources() if not path.is_relative_to(PAGE))
    return " ".join([own, node_version, *map(version, _LIBRARIES)])


def _all_sources() -> Iterator[Path]:
    yield from (HOME / name for name in _PACKAGES)
    for folder, below, files in os.walk(_PACKAGE):
        below[:] = [name for name in below if name not in _NO_SOURCE and name[0] != "."]
        yield from (Path(folder) / name for name in files)
    yield from bundle.all_files()


def _digest(paths: Iterable[Path]) -> str:
    found = hashlib.sha256()
    for path in sorted(set(paths)):
        found.update(f"{digest(path)} {os.path.relpath(path, _PACKAGE)}\n".encode())
    return found.hexdigest()


# ---- steps


def _fill(made: Path, node: Node, old: Path, say: Say) -> dict[str, str]:
    """Fill a folder; return what its slow parts were made from."""
    say(f"Node.js {node.version}")
    if fetch_packages(node):
        say("packages fetched")
    kept = Kept(old, made)
    made_from = slow_sources(node.version)

    bundler = Bundler(node, made)
    bundler.modules()
    packages = write_player(bundler, made)
    write_licences(made, packages | bundler.packages)
    say("scripts bundled")

    assets.copy_pictures(made)
    write_index(made)
    assets.copy_pyodide(made)
    if kept.make("python", made_from, lambda folder: _write_python(folder, node, made)):
        say("Python part packed, snapshot taken")
    if kept.make("clips", made_from, assets.write_clips):
        say("clips written")
    if kept.make("programs", made_from, _write_programs):
        say("programs compiled")
    write_worker(bundler, made)
    return kept.made_from


def _write_python(folder: Path, node: Node, site: Path) -> None:
    folder.mkdir()
    python_files.write_python_zip(folder / "npchip.zip")
    python_files.make_snapshot(Path(node.node[0]), site)


def _write_programs(folder: Path) -> None:
    folder.mkdir()
    python_files.precompile(folder)


class Kept:
    """Folders of the old page that are as good as new.

    Args:
        old: the page that is there, if any.
        new: the page that is being built.

    Attributes:
        made_from: what each folder of the new page was made from, as a digest.
    """

    def __init__(self, old: Path, new: Path) -> None:
        self._old, self._new = old, new
        self._known = known_version(old).get("parts", {})
        self.made_from: dict[str, str] = {}

    def make(self, name: str, made_from: str, write: Callable[[Path], None]) -> bool:
        """Take a folder from the old page, or write it; return whether it was written."""
        self.made_from[name] = made_from
        fits = self._known.get(name) == made_from and (self._old / name).is_dir()
        if fits:
            ignored = shutil.ignore_patterns("*.gz")
            shutil.copytree(self._old / name, self._new / name, ignore=ignored)
        else:
            write(self._new / name)
        return not fits


class _Unfinished:
    """A folder that takes the place of the site when the context ends well.

    Args:
        site: the folder of the page.
    """

    def __init__(self, site: Path) -> None:
        self._site = site
        self._new = site.with_name(f".{site.name}-new")
        self._old = site.with_name(f".{site.name}-old")

    def __enter__(self) -> Path:
        self._clean()
        make_directory(self._new)
        return self._new

    def __exit__(self, failed: type[BaseException] | None, *_: object) -> None:
        try:
            if failed is None:
                with uninterrupted():
                    if self._site.exists():
                        self._site.rename(self._old)
                    self._new.rename(self._site)
        finally:
            self._clean()

    def _clean(self) -> None:
        for folder in (self._new, self._old):
            shutil.rmtree(folder, ignore_errors=True)


def main() -> int:
    """Build the page; say what is done on standard output."""
    try:
        if not build(lambda line: print(line, flush=True)):  # noqa: T201 - a tool of the project
            print("the page is up to date")  # noqa: T201
    except NpchipError as error:
        print(error, file=sys.stderr)  # noqa: T201
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
