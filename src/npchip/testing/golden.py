"""Golden files: recorded words, status, cycles and outputs of every run."""

from __future__ import annotations

import base64
import binascii
import errno
import hashlib
import json
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from npchip.base.errors import InputError
from npchip.base.files import read_bytes, write_text
from npchip.base.json import one_line
from npchip.run.result import Measured

SCHEMA = 1
_MAX_PLANE = 1 << 22
_MAX_FILE = 1 << 28
_KEYS = {"words", "status", "error", "instructions", "columns", "setup", "frames"}


@dataclass(frozen=True)
class Plane:
    """A plane or picture: uint8, row after row."""

    rows: int
    cols: int
    data: bytes

    @property
    def key(self) -> str:
        """Name of the plane in the table of frames."""
        head = f"{self.rows}x{self.cols}:".encode()
        return hashlib.sha256(head + self.data).hexdigest()[:16]


Cell = int | tuple[int, ...] | Plane | None


@dataclass(frozen=True)
class Row:
    """A frame or the setup: cycles, None if not recorded, and the value of every output."""

    cycles: int | None
    cells: tuple[Cell, ...]


@dataclass(frozen=True)
class Entry:
    """The record of a run, or of the parts that claims compare.

    Attributes:
        words: length of the program; None if only outputs are recorded.
        status: the status of the run.
        error: code of the error of a failed run.
        instructions: instructions executed in the whole run; None if only outputs are recorded.
        names: the outputs, in the order of the cells of each row; none if only cycles are
            recorded.
        setup: cycles and outputs before the first frame.
        frames: cycles and outputs of each frame.
    """

    words: int | None
    status: str
    error: str | None
    instructions: int | None
    names: tuple[str, ...]
    setup: Row
    frames: tuple[Row, ...]

    @property
    def cycles(self) -> int:
        """Cycles of the whole run."""
        return sum(row.cycles or 0 for row in (self.setup, *self.frames))


def golden_path(source: Path) -> Path:
    """Return the path of a source's golden file: ``coin.golden.json`` beside ``coin.s``."""
    return source.with_name(f"{source.stem}.golden.json")


def record(result: Measured, words: int, *, outputs: bool = True, cycles: bool = True) -> Entry:
    """Return the record of a run.

    Args:
        result: the run.
        words: length of the program.
        outputs: record the outputs.
        cycles: record words, instructions and cycles.
    """
    names = tuple(dict.fromkeys([*result.setup.outputs, *result.outputs])) if outputs else ()

    def row(taken: int, values: Iterable[Any]) -> Row:
        return Row(int(taken) if cycles else None, tuple(map(_cell, values)))

    def frame(k: int) -> Row:
        values = (result.value(name, k) if name in result.outputs else None for name in names)
        return row(result.frame_cycles[k], values)

    return Entry(
        words=words if cycles else None,
        status=result.status,
        error=result.error.code if result.error else None,
        instructions=int(result.instructions) if cycles else None,
        names=names,
        setup=row(result.setup.cycles, map(result.setup.outputs.get, names)),
        frames=tuple(map(frame, range(result.frames))),
    )


def _cell(value: Any) -> Cell:
    if value is None or isinstance(value, int):
        return value
    if not isinstance(value, list):
        rows, cols = value.shape
        return Plane(rows, cols, value.tobytes())
    if value and isinstance(value[0], list):
        return Plane(len(value), len(value[0]), bytes(chain.from_iterable(value)))
    return tuple(map(int, value))


# ---- the file


def load(path: Path) -> dict[str, Entry]:
    """Read a golden file: records by the run's name, none without a file.

    Raises:
        InputError: NP276, it cannot be read or is damaged.
    """
    try:
        if not path.exists():
            return {}
        document = json.loads(read_bytes(path, _MAX_FILE))
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            return {}  # no such file can exist
        raise InputError("NP276", f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise _damaged(path, str(error)) from None
    try:
        if document["schema"] != SCHEMA:
            raise _damaged(path, f"schema {document['schema']}, expected {SCHEMA}")
        planes = {key: _plane(key, text) for key, text in document["planes"].items()}
        return {name: _entry(data, planes) for name, data in document["runs"].items()}
    except (KeyError, TypeError, ValueError, AttributeError, zlib.error, binascii.Error) as error:
        reason = f"missing {error}" if isinstance(error, KeyError) else str(error)
        raise _damaged(path, reason) from None


def save(path: Path, program: str, entries: Mapping[str, Entry]) -> None:
    """Write a golden file, whole or not at all.

    Raises:
        InputError: NP250, it cannot be written.
    """
    write_text(path, to_text(program, entries), over=True)


def to_text(program: str, entries: Mapping[str, Entry]) -> str:
    """Return the golden as JSON with a line for every frame and every plane, to suit diffs."""
    planes: dict[str, Plane] = {}
    runs = ",\n".join(
        f"  {one_line(name)}: {{\n{_entry_text(entry, planes)}\n  }}"
        for name, entry in entries.items()
    )
    table = ",\n".join(
        f'  "{key}": "{plane.rows}x{plane.cols} '
        f'{base64.b64encode(zlib.compress(plane.data, 9)).decode()}"'
        for key, plane in sorted(planes.items())
    )
    return (
        f'{{\n "schema": {SCHEMA},\n "program": {one_line(program)},\n'
        f' "runs": {_braced(runs)},\n "planes": {_braced(table)}\n}}\n'
    )


def _braced(text: str) -> str:
    return f"{{\n{text}\n }}" if text else "{}"


def _entry_text(entry: Entry, planes: dict[str, Plane]) -> str:
    timed = entry.words is not None

    def row(row: Row) -> str:
        planes.update((cell.key, cell) for cell in row.cells if isinstance(cell, Plane))
        cells = [cell.key if isinstance(cell, Plane) else cell for cell in row.cells]
        return one_line([row.cycles, *cells] if timed else cells)

    rows = [row(frame) for frame in entry.frames]
    step = 1 if entry.names else 12
    lines = [", ".join(rows[at : at + step]) for at in range(0, len(rows), step)]
    frames = "".join(f"    {line},\n" for line in lines).rstrip(",\n")
    fields = {
        "words": entry.words,
        "status": entry.status,
        "error": entry.error,
        "instructions": entry.instructions,
        "columns": [*(["cycles"] if timed else []), *entry.names],
    }
    parts = [f'"{key}": {one_line(value)}' for key, value in fields.items() if value is not None]
    parts.append(f'"setup": {row(entry.setup)}')
    parts.append(f'"frames": [\n{frames}\n   ]' if rows else '"frames": []')
    return "   " + ",\n   ".join(parts)


def _entry(data: Mapping[str, Any], planes: Mapping[str, Plane]) -> Entry:
    unknown = data.keys() - _KEYS
    if unknown:
        raise ValueError(f"unknown key {min(unknown)!r}")
    timed = "words" in data
    names = data["columns"][timed:]
    if not all(isinstance(name, str) for name in names):
        raise ValueError("columns: expected cycles and the names of outputs")

    def row(values: Sequence[Any]) -> Row:
        cells = values[timed:]
        if len(values) != len(data["columns"]):
            raise ValueError(f"a row of {len(values)} under {len(data['columns'])} columns")
        return Row(_whole(values[0]) if timed else None, tuple(map(cell, cells)))

    def cell(value: Any) -> Cell:
        if value is None:
            return None
        if isinstance(value, str):
            return planes[value]
        return tuple(map(_whole, value)) if isinstance(value, list) else _whole(value)

    return Entry(
        words=_whole(data["words"]) if timed else None,
        status=str(data["status"]),
        error=None if data.get("error") is None else str(data["error"]),
        instructions=_whole(data["instructions"]) if timed else None,
        names=tuple(names),
        setup=row(data["setup"]),
        frames=tuple(map(row, data["frames"])),
    )


def _whole(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise TypeError(f"expected a whole number, found {value!r}")
    return value


def _plane(key: str, text: str) -> Plane:
    size, packed = text.split(" ")
    rows, cols = map(int, size.split("x"))
    unpacker = zlib.decompressobj()
    data = unpacker.decompress(base64.b64decode(packed, validate=True), _MAX_PLANE)
    plane = Plane(rows, cols, data)
    if len(data) != rows * cols or plane.key != key:
        raise ValueError(f"plane {key} is not what its name says")
    return plane


def _damaged(path: Path, reason: str) -> InputError:
    return InputError(
        "NP276",
        f"{path}: no golden file, or damaged: {reason}",
        hint="npchip test --update writes it anew",
    )
