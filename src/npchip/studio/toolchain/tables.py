"""Memory files of bundled programs and their tests, as the page has no files."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

from npchip.base.errors import InputError
from npchip.formats.module import Memory
from npchip.machine import Machine
from npchip.program.model import Program


class Table(NamedTuple):
    """A file of ``memory=`` or ``.memory``: planes of a byte for each NP, row by row."""

    planes: int
    geometry: tuple[int, int]
    data: bytes

    def part(self, address: int) -> dict[str, Any]:
        """Return a ``MemoryPart``, but with its data in base64."""
        data = base64.b64encode(self.data).decode()
        return {"address": address, "planes": self.planes, "data": data}


Tables = Mapping[str, Table]
"""Tables by the path that test lines of npchip's programs name, such as ``../examples/…``; those of
``.memory`` lines by `BOUND` and the path.

A file beside a reader's own program is never one of the former, whatever its name. The latter a
reader's program may name too, as it may include what npchip's programs include.
"""
BOUND: Final = ".memory "


def table_for(tables: Tables, file: str, address: int, machine: Machine) -> Table | None:
    """Return the table that a test line names, if it is known and fits."""
    found = tables.get(file)
    if found is None or found.geometry != machine.geometry:
        return None
    return found if address + found.planes <= machine.memory_bytes else None


def bound(
    program: Program, machine: Machine, tables: Tables, folder: Path, given: Memory
) -> Memory:
    """Return what ``.memory`` lines put into the NPs' memories, and after it what is given.

    Args:
        program: the program; its files are not read.
        machine: where it runs.
        tables: the known files.
        folder: the folder from which their names lead, with symbolic links resolved.
        given: more of the kind; at the address of a ``.memory`` line, instead of it.

    Raises:
        InputError: NP243, a file is not known, or is for another array.
    """
    size = machine.np_rows * machine.np_cols
    replaced = {address for address, _ in given}
    found = []
    for item in program.memory:
        if item.address in replaced:
            continue
        path = Path(item.file)
        name = path.relative_to(folder).as_posix() if path.is_relative_to(folder) else path.name
        table = table_for(tables, BOUND + name, item.address, machine)
        if table is None:
            known = "is for another array" if BOUND + name in tables else "is not in this page"
            raise InputError(
                "NP243",
                f"{item.place}: {name} {known}",
                hint="run the program with npchip run, or make a page of it with npchip export",
            )
        planes = [table.data[size * k : size * (k + 1)] for k in range(table.planes)]
        found.append((item.address, planes))
    return [*found, *given]


def to_text(tables: Tables) -> str:
    """Return tables as JSON."""
    return json.dumps(
        {name: [*table.geometry, table.part(0)["data"]] for name, table in sorted(tables.items())}
    )


def from_text(text: str) -> dict[str, Table]:
    """Return the tables of a JSON: the inverse of `to_text`."""
    found = {}
    for name, (rows, cols, packed) in json.loads(text).items():
        data = base64.b64decode(packed)
        found[name] = Table(len(data) // (rows * cols), (rows, cols), data)
    return found
