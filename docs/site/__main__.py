"""Build the web site of the documents: static files for any web server.

    python -m docs.site FOLDER

The extra ``site`` has what it needs. The gallery is live where the studio's page has been built
(``npchip studio --build``). Exit code 1: a warning of Sphinx or a dead link; the folder stays as it
was. Exit code 2: the site cannot be built or written here.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from docs.site import course, gallery, reference
from docs.site.check import faults
from docs.site.order import contents
from docs.site.sources import ROOT, DeadLinkError, Sources

HERE = Path(__file__).parent
NEEDED = ("sphinx", "myst_parser", "furo")
MARK = ".buildinfo"
"""A file that Sphinx writes: only a folder with it is replaced."""


def main(arguments: list[str]) -> int:
    """Build the site and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m docs.site", description="Build the site.")
    parser.add_argument("folder", type=Path, help="made, or replaced if it holds a site")
    folder: Path = parser.parse_args(arguments).folder.absolute()
    if missing := [name for name in NEEDED if find_spec(name) is None]:
        return refused(f"{', '.join(missing)} not installed: pip install --editable '.[site]'")
    if os.path.lexists(folder) and not replaceable(folder):
        return refused(f"{folder} holds something else than a site; name another folder")
    with tempfile.TemporaryDirectory(prefix="npchip-site-") as scratch:
        made = Path(scratch) / "site"
        try:
            wrong = build(Path(scratch), made)
        except DeadLinkError as error:
            wrong = [str(error)]
        if wrong:
            print(*wrong, sep="\n", file=sys.stderr)
            return 1
        try:
            put(made, folder)
        except OSError as error:
            return refused(f"cannot write {folder}: {error.strerror or error}")
    files = [path for path in folder.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in files) / 1e6
    print(f"{folder}: {len(files)} files, {size:.1f} MB")
    return 0


def refused(message: str) -> int:
    """Say why nothing is built."""
    print(f"error: {message}", file=sys.stderr)
    return 2


def replaceable(folder: Path) -> bool:
    """Return whether a folder is empty or holds a site."""
    return folder.is_dir() and ((folder / MARK).is_file() or not any(folder.iterdir()))


def put(made: Path, folder: Path) -> None:
    """Put a site in its place."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    if folder.is_dir():
        shutil.rmtree(folder)
    shutil.move(made, folder)


def build(scratch: Path, made: Path) -> list[str]:
    """Build the site and return what is wrong with it.

    Args:
        scratch: a folder for what the site is made from.
        made: the folder of the site, which is not there yet.

    Raises:
        DeadLinkError: a document links to a file that is not there.
    """
    from sphinx.cmd.build import main as sphinx  # noqa: PLC0415 - the command has looked for it

    live = scratch / gallery.LIVE
    live.mkdir()
    sources = Sources(scratch / "sources")
    write(sources, gallery.export(live))
    options = ["-b", "html", "-q", "-W", "--keep-going", "-c", HERE, "-d", scratch / "doctrees"]
    if sphinx([str(item) for item in (*options, sources.folder, made)]):
        return ["The site has warnings, so it was not written."]
    if any(live.iterdir()):
        shutil.move(live, made)
    return faults(made)


def write(sources: Sources, words: dict[str, str]) -> None:
    """Write all documents.

    Args:
        sources: the folder of sources.
        words: as for `gallery.write`.
    """
    docs = ROOT / "docs"
    for path in sorted(docs.glob("*.md")):
        text = path.read_text(encoding="utf-8")
        if path.stem == "index":
            text += contents(sources.linked(text, docs, path.name))
        sources.add(path.name, text, docs)
    changes, clips = ROOT / "CHANGELOG.md", ROOT / "examples" / "clips"
    sources.add("changelog.md", changes.read_text(encoding="utf-8"), ROOT)
    credits_ = "---\norphan: true\n---\n" + (clips / "README.md").read_text(encoding="utf-8")
    sources.add("clips.md", credits_, clips)
    course.write(sources)
    gallery.write(sources, words)
    reference.write(sources)
    sources.fetch()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
