"""The built page as static files for any web server."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from npchip.base.errors import InputError
from npchip.base.files import make_directory, uninterrupted
from npchip.studio.places import need_site, site_files


def check_target(folder: Path) -> None:
    """Raise an error before a long build if the page could not be written.

    Raises:
        InputError: NP635, there is something in its place.
    """
    if folder.is_dir() and not any(folder.iterdir()):
        return
    if os.path.lexists(folder):
        what = "is not empty" if folder.is_dir() else "is a file"
        raise InputError(
            "NP635",
            f"--export {folder}: it {what}, nothing is written",
            hint="name a folder that is not there yet, or is empty",
        )


def export_site(folder: Path) -> tuple[int, int]:
    """Write the page, whole or not at all.

    Args:
        folder: an empty folder, or one that is made.

    Returns:
        numbers of files and of bytes.

    Raises:
        InputError: NP630 there is no page; NP635 as `check_target`; NP250 it cannot be written.
    """
    site = need_site()
    check_target(folder)
    folder = folder.absolute()
    make_directory(folder.parent)
    unfinished = folder.with_name(f".npchip-{os.getpid()}.tmp")
    size = 0
    files = site_files(site)
    try:
        for path in files:
            target = unfinished / path.relative_to(site)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, target)
            size += path.stat().st_size
        with uninterrupted():
            if folder.is_dir():
                folder.rmdir()
            unfinished.rename(folder)
    except OSError as error:
        raise InputError(
            "NP250",
            f"cannot write {folder}: {error.strerror or error}",
            hint="name another place",
        ) from None
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
    return len(files), size
