"""Compiles the bundled programs when the site is built: they run before Python has loaded."""

from __future__ import annotations

import base64
import json
import re
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from npchip import bundle
from npchip.assembler import assemble
from npchip.base.errors import InputError
from npchip.base.files import make_directory, write_bytes, write_text
from npchip.frames.memory import read_memory
from npchip.machine import BUILTIN, load_machine
from npchip.studio.lessons import lessons
from npchip.studio.toolchain.facade import Toolchain
from npchip.studio.toolchain.tables import BOUND, Table
from npchip.testing.golden import golden_path
from npchip.testing.suite import Run, read_suite

_MACHINE: Final = "default"
_INCLUDE: Final = re.compile(r'^[^;"\n]*\.include\s+"([^"\n]+)"', re.MULTILINE | re.IGNORECASE)


def precompile(folder: Path) -> None:
    """Write the bundled programs, compiled: ``index.json``, and a pair of files for each.

    ``index.json`` is a list in the order of names; each entry has

    - ``name`` and ``summary``;
    - ``project``, as protocol.ts says: the source, what it includes, its golden file;
    - ``clip``: name of the bundled clip of its first suitable run, or null;
    - ``memory``: what lies in the NPs' memories in that run, as ``MemoryPart`` but with ``data``
      in base64; the modules hold it;
    - ``note``: what the page lacks to run it, such as a second camera; or null;
    - ``lesson``: whether it is an exercise of the course, which the page compiles itself.

    ``NAME.json`` holds what ``Compiler.compile`` resolves to, with the bounds and without the
    module, and ``NAME.wasm`` the module. Both are for the machine with which the page opens: for
    another one it compiles, as Python is there before a reader has chosen.

    Args:
        folder: the folder to write to, in the site ``programs/``.

    Raises:
        InputError: a file cannot be written, or a bundled program is broken.
    """
    make_directory(folder)
    index = []
    with tempfile.TemporaryDirectory() as scratch:
        toolchain = Toolchain(Path(scratch), bundled_tables())
        for name, (path, summary) in bundle.bundled("program").items():
            entry = _entry(name, path, summary)
            index.append(entry)
            _compile(toolchain, entry, folder / f"{name}.json")
    index += lessons()
    write_text(folder / "index.json", json.dumps(index, ensure_ascii=False))


def bundled_tables() -> dict[str, Table]:
    """Return what bundled programs and their test lines put in the NPs' memory."""
    found: dict[str, Table] = {}
    for path, _ in bundle.bundled("program").values():
        if ".memory" in path.read_text(encoding="utf-8"):
            machine = load_machine(_MACHINE)
            for item in assemble(path, machine).memory:
                given = Path(item.file)
                planes = read_memory(item.address, given, machine)
                name = given.relative_to(path.parent.resolve()).as_posix()
                found[BOUND + name] = Table(len(planes), machine.geometry, planes.tobytes())
        for run in read_suite(path).runs:
            for address, file in run.memory:
                found[file] = _table(path.parent / file, address, run, path.parent)
    return found


def _table(path: Path, address: int, run: Run, folder: Path) -> Table:
    machine = run.machines[0]
    given = machine if machine in BUILTIN else folder / machine
    planes = read_memory(address, path, load_machine(given))
    rows, cols = planes.shape[1:]
    return Table(len(planes), (rows, cols), planes.tobytes())


def _entry(name: str, path: Path, summary: str) -> dict[str, Any]:
    runs = read_suite(path).runs
    best = _best(runs)
    partner = next((run.partner for run in runs if run.partner), None)
    return {
        "name": name,
        "summary": summary,
        "project": {"main": path.name, "files": dict(_files(path))},
        "clip": best and _clip(best),
        "memory": [*_memory(best, path)] if best else [],
        "note": None
        if best or not partner
        else f"needs a second camera that runs {partner}, which the studio cannot simulate",
        "lesson": False,
    }


def _best(runs: Sequence[Run]) -> Run | None:
    """Return the first run that the page can show as it is: on a bundled clip, without a partner.

    One without ``define`` comes first, as the program is compiled without.
    """
    fitting = [run for run in runs if not run.partner and _clip(run) and _MACHINE in run.machines]
    plain = [run for run in fitting if not run.defines]
    return next(iter([*plain, *fitting]), None)


def _clip(run: Run) -> str | None:
    clips = {item.path.name: name for name, item in bundle.bundled("clip").items()}
    return clips.get(Path(run.frames).name) if run.frames else None


def _memory(run: Run, path: Path) -> Iterator[dict[str, Any]]:
    machine = load_machine(_MACHINE)
    for address, file in run.memory:
        planes = read_memory(address, path.parent / file, machine)
        yield Table(len(planes), machine.geometry, planes.tobytes()).part(address)


def _files(path: Path) -> Iterator[tuple[str, str]]:
    """Yield the files of a program: its source, what that includes, its golden file."""
    top, work, seen = path.parent, [path], set()
    while work:
        file = work.pop(0)
        name = file.relative_to(top).as_posix()
        if name not in seen:
            seen.add(name)
            text = file.read_text(encoding="utf-8")
            yield name, text
            work += [file.parent / wanted for wanted in _INCLUDE.findall(text)]
    golden = golden_path(path)
    if golden.is_file():
        yield golden.name, golden.read_text(encoding="utf-8")


def _compile(toolchain: Toolchain, entry: dict[str, Any], path: Path) -> None:
    request = {
        "project": entry["project"],
        "machine": {"name": _MACHINE},
        "defines": {},
        "memory": [{**part, "data": k} for k, part in enumerate(entry["memory"])],
        "module": True,
    }
    blobs = [base64.b64decode(part["data"]) for part in entry["memory"]]
    text, module = toolchain.call("compile", json.dumps([request]), blobs)
    compiled = json.loads(text)["value"]
    if module is None:
        said = "; ".join(each["message"] for each in compiled["diagnostics"])
        raise InputError("NP637", f"the bundled program {entry['name']} has mistakes: {said}")
    compiled["program"]["bounds"] = json.loads(toolchain.call("bounds", "[]").text)["value"]
    compiled["milliseconds"] = {"assemble": 0, "translate": 0}  # the same sources, the same file
    write_text(path, json.dumps(compiled, separators=(",", ":")))
    write_bytes(path.with_suffix(".wasm"), module)
