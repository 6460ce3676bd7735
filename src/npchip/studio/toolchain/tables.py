"""Memory files that bundled programs are tested with, as the page has no files."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import Any, NamedTuple

from npchip.machine import Machine


class Table(NamedTuple):
    """A file of ``memory=``: planes of a byte for each NP, row by row."""

    planes: int
    geometry: tuple[int, int]
    data: bytes

    def part(self, address: int) -> dict[str, Any]:
        """Return a ``MemoryPart``, but with its data in base64."""
        data = base64.b64encode(self.data).decode()
        return {"address": address, "planes": self.planes, "data": data}


Tables = Mapping[str, Table]
"""Tables by the name of their file, without folders."""


def table_for(tables: Tables, file: str, address: int, machine: Machine) -> Table | None:
    """Return the table that a test line names, if it is known and fits."""
    found = tables.get(PurePosixPath(file).name)
    if found is None or found.geometry != machine.geometry:
        return None
    return found if address + found.planes <= machine.memory_bytes else None


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
