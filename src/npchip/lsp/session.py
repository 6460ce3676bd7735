"""The files that are open in an editor, and what is known of the programs that they belong to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from npchip.base.errors import InputError
from npchip.language.analysis import Analysis, Analyst
from npchip.language.includes import Includes
from npchip.language.settings import find


class Here(NamedTuple):
    """A file within its program: what most questions are about.

    Attributes:
        analysis: the program.
        path: the file.
        file: its name in messages.
        lines: its lines.
    """

    analysis: Analysis
    path: Path
    file: str
    lines: Sequence[str]


class _Known(NamedTuple):
    analysis: Analysis
    moment: int


class Session:
    """The open files; paths have their symbolic links resolved.

    Attributes:
        analyst: what reads them.
        folders: the folders that the editor works in.
    """

    def __init__(self) -> None:
        self.analyst = Analyst()
        self.folders: list[Path] = []
        self._includes = Includes()
        self._known: dict[Path, _Known] = {}
        self._programs: dict[Path, list[Path]] = {}
        self._moment = 0
        self._changed: dict[Path, int] = {}
        self._disk = 0  # the moment of the last change that may be anywhere

    # ---- what the editor does

    def open(self, path: Path, text: str) -> None:
        """A file has been opened."""
        self.analyst.texts[path] = text
        self.refresh()

    def change(self, path: Path, text: str) -> None:
        """A file that is open has changed."""
        before = self.analyst.texts.get(path, "")
        self.analyst.texts[path] = text
        self._moment += 1
        self._changed[path] = self._moment
        if _include_lines(before) != _include_lines(text):
            self._programs.clear()

    def close(self, path: Path) -> None:
        """A file has been closed: what is saved counts again."""
        self.analyst.texts.pop(path, None)
        self._changed.pop(path, None)
        self.refresh()

    def refresh(self) -> None:
        """Something on the disk may have changed."""
        self._moment += 1
        self._disk = self._moment
        self._programs.clear()

    # ---- answers

    def programs(self, path: Path) -> list[Path]:
        """Return the programs that a file belongs to; only itself if nothing includes it."""
        if path not in self._programs:
            self._programs[path] = self._includes.programs(
                path, self._folder(path), self.analyst.texts, self._include_folders(path)
            )
        return self._programs[path]

    def _folder(self, path: Path) -> Path:
        within = [folder for folder in self.folders if path.is_relative_to(folder)]
        if within:
            return max(within)
        project = find(path)
        return project.parent.resolve() if project else path.parent

    def _include_folders(self, path: Path) -> Sequence[Path]:
        try:
            return self.analyst.settings(path).include
        except InputError:
            return ()

    def program(self, path: Path) -> Path:
        """Return the program that a file is read as part of: one that is open, if there is one."""
        found = self.programs(path)
        return next((item for item in found if item in self.analyst.texts), found[0])

    def analysis(self, root: Path) -> Analysis:
        """Return what is known of a program."""
        known = self._known.get(root)
        if known is None or not self._holds(known):
            known = self._known[root] = _Known(self.analyst.analyse(root), self._moment)
        return known.analysis

    def _holds(self, known: _Known) -> bool:
        files = known.analysis.paths.values()
        return max(self._disk, *(self._changed.get(path, 0) for path in files)) <= known.moment

    def here(self, path: Path) -> Here | None:
        """Return a file within its program, if that can be read."""
        for root in dict.fromkeys((self.program(path), path)):
            analysis = self.analysis(root)
            file = analysis.file(path)
            if file is not None:
                return Here(analysis, path, file, self.analyst.lines(path))
        return None

    def analyses(self, path: Path) -> list[Analysis]:
        """Return all programs that a file belongs to."""
        return [self.analysis(root) for root in self.programs(path)]

    def roots(self, first: Path | None = None) -> list[Path]:
        """Return the programs of all open files, that of `first` first."""
        paths = sorted(self.analyst.texts, key=lambda path: (path != first, path))
        roots = list(dict.fromkeys(map(self.program, paths)))
        for root in self._known.keys() - set(roots):
            del self._known[root]
        return roots

    def faults(self, root: Path) -> Iterator[tuple[Path, Mapping[str, Any]]]:
        """Yield the mistakes in a program, each with the file that it is in."""
        analysis = self.analysis(root)
        for fault in analysis.faults:
            place = fault["place"]
            yield (path_of(place["file"], analysis) if place else root), fault


def path_of(file: str, analysis: Analysis) -> Path:
    """Return the path of a file by its name in messages."""
    return analysis.paths.get(file) or Path(file).resolve()


def _include_lines(text: str) -> list[str]:
    return [line for line in text.splitlines() if ".include" in line.lower()]
