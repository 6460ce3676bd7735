"""The parts of the page's site that are made of npchip's Python: `build.py` calls this."""

from __future__ import annotations

from pathlib import Path


def write_python_zip(path: Path) -> None:
    """Write ``npchip.zip``: the modules and tables that the compiler in the page needs.

    Args:
        path: the file to write, in the site ``python/npchip.zip``.
    """
    raise NotImplementedError


def make_snapshot(node: Path, site: Path) -> None:
    """Write ``python/snapshot.bin``: Pyodide's memory with the compiler loaded and warm.

    Args:
        node: Node's binary.
        site: the site, which holds Pyodide in ``pyodide/`` and ``python/npchip.zip`` already.
    """
    raise NotImplementedError


def precompile(folder: Path) -> None:
    """Write the bundled programs, compiled: ``index.json``, and a pair of files for each machine.

    ``index.json`` is a list in the order of names; each entry has ``name``, ``summary``,
    ``clip`` (name of the clip it is best seen with, or null) and ``project`` (as protocol.ts
    says: the source, what it includes, its golden file). ``NAME.MACHINE.json`` holds what
    ``Compiler.compile`` resolves to, but with the module null, and ``NAME.MACHINE.wasm`` the
    module.

    Args:
        folder: the folder to write to, in the site ``programs/``.
    """
    raise NotImplementedError
