"""Links of the documents lead somewhere, and docs/index.md names every document."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [
    ROOT / "README.md",
    ROOT / "CHANGELOG.md",
    ROOT / "examples" / "clips" / "README.md",
    *sorted(DOCS.glob("*.md")),
]
_FENCE = re.compile(r"^( *)```.*?^\1```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\]\(([^()\s]+)\)")
_HEADING = re.compile(r"^#+ +(.+)$", re.MULTILINE)


def text_of(path: Path) -> str:
    """The text of a document without its fenced blocks."""
    return _FENCE.sub("", path.read_text(encoding="utf-8"))


def links(path: Path) -> Iterator[tuple[Path, str]]:
    """The file and the anchor of every link that stays in the repository."""
    for target in _LINK.findall(text_of(path)):
        if not re.match(r"[a-z]+:", target):
            file, _, anchor = target.partition("#")
            yield (path.parent / file).resolve() if file else path, anchor


def anchors(path: Path) -> set[str]:
    """Anchors of the headings, as forges and MyST make them."""
    plain = (
        re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", title) for title in _HEADING.findall(text_of(path))
    )
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in plain}


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_links_lead_somewhere(path: Path) -> None:
    for file, anchor in links(path):
        assert file.exists(), f"{path.name}: {file} is not there"
        assert file.is_relative_to(ROOT), f"{path.name}: {file} is outside"
        assert not anchor or anchor in anchors(file), f"{path.name}: {file.name}#{anchor}"


def test_every_document_is_in_the_index_once() -> None:
    """In the list of all; the reading orders above it name what they want."""
    listed = (DOCS / "index.md").read_text(encoding="utf-8").split("## All documents\n")[1]
    first = re.findall(r"^- \[[^]]+\]\(([\w-]+\.md)\)", listed, re.MULTILINE)
    assert sorted(first) == sorted({path.name for path in DOCS.glob("*.md")} - {"index.md"})
