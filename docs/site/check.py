"""Faults of a built site: links that lead nowhere, and requests to another host."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from typing import Final
from urllib.parse import unquote, urlsplit

_LOADED: Final = {
    "audio": ("src",),
    "embed": ("src",),
    "iframe": ("src",),
    "img": ("src",),
    "link": ("href",),
    "object": ("data",),
    "script": ("src",),
    "source": ("src",),
    "video": ("src", "poster"),
}
"""Attributes whose addresses a browser asks for by itself."""
_IN_STYLE: Final = re.compile(r"""(?:url\(|@import)\s*["']?(?:https?:)?//""")


@dataclass
class _Page(HTMLParser):
    """The links of a page, and its requests.

    Attributes:
        ids: its anchors.
        links: the addresses of its links, and of what it loads.
        loaded: the latter only.
    """

    ids: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)
    loaded: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what an element refers to."""
        given = {name: value for name, value in attrs if value}
        self.ids |= {given[name] for name in ("id", "name") if name in given}
        loaded = [given[name] for name in _LOADED.get(tag, ()) if name in given]
        self.loaded += loaded
        self.links += loaded
        if tag in {"a", "area"} and "href" in given:
            self.links.append(given["href"])


def faults(site: Path) -> list[str]:
    """Return what is wrong with a site, a line for each fault.

    Args:
        site: the folder that a server serves.
    """
    site = site.resolve()
    pages = {path: _read(path) for path in sorted(site.rglob("*.html"))}
    found = [fault for path in pages for fault in _faults_of(path, site, pages)]
    found += [
        f"{path.relative_to(site)}: loads from another host"
        for path in sorted(site.rglob("*.css"))
        if _IN_STYLE.search(path.read_text(encoding="utf-8"))
    ]
    return found


def _read(path: Path) -> _Page:
    page = _Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page


def _faults_of(path: Path, site: Path, pages: dict[Path, _Page]) -> Iterator[str]:
    name = path.relative_to(site)
    for address in pages[path].loaded:
        if urlsplit(address).netloc:
            yield f"{name}: loads {address} from another host"
    for address in dict.fromkeys(pages[path].links):
        parts = urlsplit(address)
        if parts.scheme or parts.netloc:
            continue
        file = (path.parent / unquote(parts.path)).resolve() if parts.path else path
        anchor = unquote(parts.fragment)
        if not file.is_relative_to(site) or not file.is_file():
            yield f"{name}: {address} leads nowhere"
        elif anchor and file in pages and anchor not in pages[file].ids:
            yield f"{name}: {address} leads to no anchor of that page"
