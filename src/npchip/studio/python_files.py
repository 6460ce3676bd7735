"""The parts of the page's site that are made of npchip's Python: `build.py` calls this."""

from __future__ import annotations

import gzip
import subprocess
import zipfile
from pathlib import Path
from typing import Final

from npchip.base.errors import InputError
from npchip.base.files import write_bytes
from npchip.studio.precompiled import bundled_tables, precompile
from npchip.studio.toolchain.modules import needed
from npchip.studio.toolchain.tables import to_text

__all__ = ["make_snapshot", "precompile", "write_python_zip"]

ZIP: Final = "python/npchip.zip"
SNAPSHOT: Final = "python/snapshot.bin"
_TABLES: Final = ("npchip.isa", "npchip.machine")
"""Packages whose YAML files are read when the compiler starts."""
_MEMORY: Final = "npchip/studio/toolchain/tables.json"
_DATE: Final = (1980, 1, 1, 0, 0, 0)
"""The date of all files, so that the same sources give the same archive."""
_PATIENCE: Final = 600
_MOST_SAID: Final = 2_000


def write_python_zip(path: Path) -> None:
    """Write ``npchip.zip``: the modules and tables that the compiler in the page needs.

    Args:
        path: the file to write, in the site ``python/npchip.zip``.

    Raises:
        InputError: NP250, it cannot be written.
    """
    files: dict[str, Path] = {}
    modules = needed()
    for name, file in modules.items():
        folder = name.replace(".", "/")
        files[f"{folder}/__init__.py" if file.name == "__init__.py" else f"{folder}.py"] = file
    for package in _TABLES:
        folder = package.replace(".", "/")
        files |= {f"{folder}/{f.name}": f for f in modules[package].parent.glob("*.yaml")}
    contents = {name: file.read_bytes() for name, file in files.items()}
    contents[_MEMORY] = to_text(bundled_tables()).encode()
    try:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
            for name, data in sorted(contents.items()):
                info = zipfile.ZipInfo(name, _DATE)
                info.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(info, data)
    except OSError as error:
        raise InputError("NP250", f"cannot write {path}: {error.strerror or error}") from None


def make_snapshot(node: Path, site: Path) -> None:
    """Write ``python/snapshot.bin``: Pyodide's memory with the compiler loaded and warm.

    It is compressed with gzip, as not every web server would do it.

    Args:
        node: Node's binary.
        site: the site, which holds Pyodide in ``pyodide/`` and ``python/npchip.zip`` already.

    Raises:
        InputError: NP637, Pyodide or the compiler in it does not start.
    """
    script = Path(__file__).with_name("snapshot.mjs")
    raw = site / f"{SNAPSHOT}.raw"
    command = [str(node), str(script), str(site / "pyodide"), str(site / ZIP), str(raw)]
    try:
        subprocess.run(  # noqa: S603 - our own script
            command, check=True, capture_output=True, text=True, timeout=_PATIENCE
        )
        write_bytes(site / SNAPSHOT, gzip.compress(raw.read_bytes(), 9, mtime=0))
    except (OSError, subprocess.SubprocessError) as error:
        said = str(getattr(error, "stderr", None) or error)[-_MOST_SAID:].strip().splitlines()
        message = "\n".join(["no snapshot of Pyodide could be made:", *said])
        raise InputError(
            "NP637", message, hint="the pinned version of pyodide and this Node.js must fit"
        ) from None
    finally:
        raw.unlink(missing_ok=True)
