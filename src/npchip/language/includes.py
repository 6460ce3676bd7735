"""Programs that include a file, so that a file that is no program is read as part of one."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Final

from npchip.assembler.sources import MAX_BYTES

_INCLUDE: Final = re.compile(r'^[^;"\n]*?\.include[ \t]+"([^"\n]+)"', re.MULTILINE | re.IGNORECASE)
_MOST_FILES: Final = 1000
_MOST_FOLDERS: Final = 2000
_Stamp = tuple[int, int]


class Includes:
    """The ``.include`` lines of the sources below some folders."""

    def __init__(self) -> None:
        self._known: dict[Path, tuple[_Stamp, tuple[str, ...]]] = {}

    def programs(
        self, path: Path, folder: Path, texts: Mapping[Path, str], folders: Iterable[Path] = ()
    ) -> list[Path]:
        """Return the programs that include a file, directly or not: those nothing includes.

        Args:
            path: the file, with symbolic links resolved.
            folder: where to look for them.
            texts: texts that stand for files.
            folders: folders besides that of a source from which it includes files.

        Returns:
            Only `path` itself if nothing includes it.
        """
        includers: dict[Path, set[Path]] = {}
        for source in {*_sources(folder), *(p for p in texts if p.is_relative_to(folder))}:
            for wanted in self._wanted(source, texts):
                for base in (source.parent, *folders):
                    includers.setdefault(_real(base / wanted), set()).add(source)
        found: set[Path] = set()
        seen = {path}
        work = [path]
        while work:
            item = work.pop()
            above = includers.get(item, set()) - {item}
            if not above:
                found.add(item)
            work += above - seen
            seen |= above
        return sorted(found) or [path]

    def _wanted(self, source: Path, texts: Mapping[Path, str]) -> Iterable[str]:
        if source in texts:
            return _INCLUDE.findall(texts[source])
        try:
            status = source.stat()
            stamp = (status.st_mtime_ns, status.st_size)
            known = self._known.get(source)
            if known is None or known[0] != stamp:
                text = "" if status.st_size > MAX_BYTES else source.read_text("utf-8", "replace")
                known = self._known[source] = (stamp, tuple(_INCLUDE.findall(text)))
        except OSError:
            return ()
        return known[1]


def _real(path: Path) -> Path:
    return Path(os.path.realpath(path))


def _sources(folder: Path) -> Iterator[Path]:
    """Yield the sources below a folder, but not of a whole disk."""
    files = 0
    for number, (top, names, found) in enumerate(os.walk(folder)):
        names[:] = sorted(name for name in names if not name.startswith((".", "node_modules")))
        for name in found:
            if name.endswith(".s"):
                files += 1
                yield _real(Path(top, name))
        if number >= _MOST_FOLDERS or files >= _MOST_FILES:
            return
