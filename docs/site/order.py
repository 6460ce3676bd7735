"""The order of the pages at the side: that of "All documents" in docs/index.md."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final

_ADDED: Final = {"Learn": "course", "Write programs": "gallery", "Background": "api"}
"""Pages that only the site has, each behind the documents of a heading."""


def contents(index: str) -> str:
    """Return the lists of pages for Sphinx, to stand behind the text of the index.

    Args:
        index: text of docs/index.md, with the links of the site.
    """
    return "\n".join(listed(title, names, hidden=True) for title, names in _groups(index))


def listed(title: str, names: Sequence[str], *, hidden: bool = False) -> str:
    """Return a list of pages, as Sphinx wants it.

    Args:
        title: its heading at the side; empty for none.
        names: the pages, relative to the one in which the list stands, without ``.md``.
        hidden: whether it is shown at the side only.
    """
    options = [f":caption: {title}"] if title else [":maxdepth: 1"]
    options += [":hidden:"] if hidden else []
    return "\n".join(["", "```{toctree}", *options, "", *names, "```", ""])


def _groups(index: str) -> Iterator[tuple[str, list[str]]]:
    _, _, text = index.partition("\n## All documents\n")
    for part in text.split("\n### ")[1:]:
        title, _, lines = part.partition("\n")
        names = re.findall(r"^- \[[^]]+\]\(([\w-]+)\.md\)", lines, re.MULTILINE)
        yield title, [*names, *([_ADDED[title]] if title in _ADDED else [])]
