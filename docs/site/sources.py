"""The folder of sources for Sphinx: documents with links that lead to pages and downloads of it."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import Final

ROOT: Final = Path(__file__).parents[2]
_PLACES: Final = {
    "CHANGELOG.md": "changelog.md",
    "README.md": "index.md",
    "asm": "gallery.md",
    "examples/clips/README.md": "clips.md",
}
"""Places on the site of files and folders of the repository that are not in ``docs/``."""
_LINK: Final = re.compile(r"\]\(([^()\s]+)\)")
_ELSEWHERE: Final = re.compile(r"#|[a-z][a-z+.-]*:")


class DeadLinkError(Exception):
    """A link of a document that leads nowhere."""


class Sources:
    """The folder of sources.

    Documents come first, by `add`. Then `fetch` copies the files that they link to, and adds a page
    for each folder that they link to.

    Args:
        folder: an empty folder.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._wanted: dict[Path, str] = {}

    def add(self, place: str, text: str, home: Path) -> None:
        """Write a document.

        Args:
            place: its path on the site.
            text: its Markdown.
            home: the folder of the repository from which its links lead.

        Raises:
            DeadLinkError: a link leads to a file that is not there.
        """
        target = self.folder / place
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(self.linked(text, home, place), encoding="utf-8")

    def linked(self, text: str, home: Path, place: str) -> str:
        """Return a document with links that lead from its place on the site."""

        def replaced(match: re.Match[str]) -> str:
            if _ELSEWHERE.match(match[1]):
                return match[0]
            file, mark, anchor = match[1].partition("#")
            to = os.path.relpath(self._place(home / file, place), PurePosixPath(place).parent)
            return f"]({to}{mark}{anchor})"

        return "\n".join(
            line if fenced else _LINK.sub(replaced, line) for line, fenced in _lines(text)
        )

    def fetch(self) -> None:
        """Copy what the documents link to, and what the pages of folders link to in turn."""
        done: set[Path] = set()
        while todo := [path for path in self._wanted if path not in done]:
            for path in todo:
                done.add(path)
                if path.is_dir():
                    self.add(self._wanted[path], _listing(path), path)
                else:
                    target = self.folder / self._wanted[path]
                    target.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(path, target)

    def _place(self, path: Path, document: str) -> str:
        """Return where a file or folder stands on the site, and see that it will."""
        path = Path(os.path.normpath(path))
        if not path.exists() or not path.is_relative_to(ROOT):
            raise DeadLinkError(f"{document}: a link leads to {path}, which is not there")
        name = path.relative_to(ROOT)
        if name.as_posix() in _PLACES:
            return _PLACES[name.as_posix()]
        if name.parent == Path("docs") and name.suffix == ".md":
            return name.name
        if name.parent == Path("asm") and name.suffix == ".s":
            return f"gallery/{name.stem}.md"
        kind, suffix = ("folders", ".md") if path.is_dir() else ("files", "")
        return self._wanted.setdefault(path, f"{kind}/{name.as_posix()}{suffix}")


def _lines(text: str) -> Iterator[tuple[str, bool]]:
    """Yield the lines of a document, and whether each stands in a fence."""
    fence = ""
    for line in text.split("\n"):
        mark = re.match(r" *(```+)", line)
        if mark and not fence:
            fence = mark[1]
        elif mark and line.strip() == fence:
            fence = ""
        yield line, bool(fence)


def _listing(folder: Path) -> str:
    """Return the page of a folder: its files to be downloaded, and links to its folders."""
    lines = []
    for path in sorted(folder.iterdir()):
        name = path.relative_to(ROOT).as_posix()
        hidden = path.name.startswith((".", "__"))
        part = path.suffix == ".md" and name not in _PLACES  # of a page that a script writes
        if not hidden and not part:
            lines.append(f"- [`{path.name}{'/' if path.is_dir() else ''}`]({path.name})")
    title = folder.relative_to(ROOT).as_posix()
    return "\n".join(["---", "orphan: true", "---", f"# `{title}/`", "", *lines, ""])
