"""Files of the site that are no scripts: Pyodide, clips, and compressed copies."""

from __future__ import annotations

import gzip
import json
import re
import shutil
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from npchip.bundle import bundled
from npchip.frames import open_frames
from npchip.host.scenes import read_scene, render
from npchip.machine import load_machine
from npchip.studio.places import COMPRESSED, HOME, PAGE, site_files

PYODIDE: Final = HOME / "node_modules" / "pyodide"
PYODIDE_FILES: Final = (
    "pyodide.mjs",
    "pyodide.asm.mjs",
    "pyodide.asm.wasm",
    "python_stdlib.zip",
    "pyodide-lock.json",
)
_LIBRARY: Final = "python_stdlib.zip"
_UNUSED: Final = re.compile(
    r"(_pyio|_pyrepl|argparse|bdb|cmd|code|compileall|configparser|cProfile|ctypes|doctest|email)\b"
    r"|(filecmp|ftplib|gettext|http|imaplib|ipaddress|mailbox|mimetypes|modulefinder)\b"
    r"|(multiprocessing|netrc|optparse|pdb|pickletools|plistlib|poplib|profile|pstats|pyclbr)\b"
    r"|(pydoc|sched|shelve|smtplib|socketserver|sqlite3|ssl|statistics|symtable|tabnanny)\b"
    r"|logging/(config|handlers)\b"
    r"|(timeit|trace|unittest|urllib|uuid|wave|webbrowser|wsgiref|xml|xmlrpc|zipapp)\b"
    r"|encodings/(cp(?!437)|iso|koi|mac|ptcp|euc|shift|big5|gb|hz|johab)"
)
"""Modules for networks, terminals, processes, other tools and old character sets, half of the
library: npchip calls none of them, and Pyodide none before it is asked to."""
_PICTURES: Final = {".png", ".svg", ".webmanifest"}
_SMALL: Final = 1_000
_GAIN: Final = 0.9
_FOR_RIGS: Final = "for --rig"
"""Scenes of space, which two cameras see."""
_COMPRESSED_ALREADY: Final = {".zip"}


def copy_pyodide(site: Path) -> None:
    """Copy the files of Pyodide that a page loads, its library without what nobody calls."""
    (site / "pyodide").mkdir()
    for name in PYODIDE_FILES:
        copy = shutil.copyfile if name != _LIBRARY else _cut
        copy(PYODIDE / name, site / "pyodide" / name)


def _cut(library: Path, target: Path) -> None:
    """Write the modules of Python's library that a page may need; the same bytes each time."""
    with zipfile.ZipFile(library) as whole, zipfile.ZipFile(target, "w") as part:
        for entry in whole.infolist():
            if not _UNUSED.match(entry.filename):
                data = whole.read(entry)
                part.writestr(entry, data, zipfile.ZIP_DEFLATED, compresslevel=9)


def copy_pictures(site: Path) -> None:
    """Copy the pictures and the manifest of the page."""
    for path in sorted((PAGE / "shell").iterdir()):
        if path.suffix in _PICTURES:
            shutil.copyfile(path, site / path.name)


def write_clips(folder: Path) -> None:
    """Write bundled clips and scenes at the sensor's size, and ``index.json``.

    ``NAME.npy`` has the first frame of a clip, and of each later one what it adds to the frame
    before, modulo 256: compressed, that is two thirds of the frames themselves.
    """
    folder.mkdir()
    listed = []
    for name, title, fps, clip in _clips():
        changes = np.diff(clip, axis=0, prepend=np.uint8(0))
        np.save(folder / f"{name}.npy", changes, allow_pickle=False)
        count, rows, cols = clip.shape
        entry = {"name": name, "title": title, "count": count, "rows": rows, "cols": cols}
        listed.append({**entry, "fps": fps})
    (folder / "index.json").write_text(json.dumps(listed), encoding="utf-8")


def _clips() -> Iterator[tuple[str, str, float | None, NDArray[np.uint8]]]:
    """Yield name, title, frames a second and frames of each clip; scenes come last."""
    machine = load_machine("default")
    for name, item in bundled("clip").items():
        frames = open_frames(item.path, machine.rows, machine.cols)
        clip = np.stack([np.asarray(frame) for frame in frames]).astype(np.uint8)
        yield name, item.summary, _rate(item.path), clip
    for name, item in bundled("scene").items():
        if not item.summary.startswith(_FOR_RIGS):
            yield name, f"a drawn scene: {item.summary}", None, render(read_scene(item.path))[0]


def _rate(path: Path) -> float | None:
    """Return the frames a second at which a file wants to be shown; None if it does not say."""
    if path.suffix != ".gif":
        return None
    with Image.open(path) as image:
        milliseconds = image.info.get("duration")
    return 1000 / milliseconds if milliseconds else None


def compress(site: Path) -> None:
    """Write a compressed copy beside each file that becomes smaller by one."""
    for path in site_files(site):
        if path.stat().st_size < _SMALL or path.suffix in _COMPRESSED_ALREADY:
            continue
        data = path.read_bytes()
        packed = gzip.compress(data, 9, mtime=0)
        if len(packed) < _GAIN * len(data):
            path.with_name(path.name + COMPRESSED).write_bytes(packed)
