"""The page offline: the list of its files, and the worker that keeps them."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Final

from npchip.studio.bundling import Bundler
from npchip.studio.places import VERSION_FILE, site_files

WORKER: Final = "service-worker.js"
_SOURCE: Final = "page/offline/service-worker.ts"


def write_worker(bundler: Bundler, site: Path) -> None:
    """Write the service worker, which knows every file of the site by its digest.

    A file that changes changes the worker, so browsers learn of a new page.
    """
    files = {
        path.relative_to(site).as_posix(): digest(path)
        for path in site_files(site)
        if path.name not in {VERSION_FILE, WORKER}
    }
    bundler.script(site / WORKER, _SOURCE, FILES=files)


def write_version(site: Path, version: str, sources: str, parts: dict[str, str]) -> None:
    """Write ``version.json``, which says that the site is complete.

    Args:
        site: the folder of the site.
        version: npchip's version.
        sources: digest of all that the site was made from.
        parts: the same of folders that take long to make.
    """
    content = hashlib.sha256()
    for path in site_files(site):
        content.update(f"{path.relative_to(site).as_posix()} {digest(path)}\n".encode())
    known = {
        "version": version,
        "content": content.hexdigest()[:16],
        "sources": sources,
        "parts": parts,
    }
    (site / VERSION_FILE).write_text(json.dumps(known) + "\n", encoding="utf-8")


def digest(path: Path) -> str:
    """Return a file's SHA-256, in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
