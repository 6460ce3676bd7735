"""The tables of a sweep, Parquet and CSV, written a piece at a time so that they may be long."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Any, Final

import pyarrow as pa
import pyarrow.parquet as pq

from npchip.base.errors import InputError
from npchip.sweep.plan import FIXED, Run
from npchip.sweep.store import Store

_PIECE: Final = 4096
"""Rows that are in memory at the same time."""


def rows(runs: Sequence[Run], store: Store) -> Iterator[dict[str, Any]]:
    """Yield the rows of the runs that are done, in the order of the plan."""
    for run in runs:
        row = store.row(run.key)
        if row is not None:
            yield {"run": run.key, **dict(run.axes), **row}


def write_runs(runs: Sequence[Run], store: Store) -> None:
    """Write ``runs.parquet`` and ``runs.csv``.

    Raises:
        InputError: NP250 they cannot be written.
    """
    found = _Types([*(name for name, _ in runs[0].axes)] if runs else [])
    for row in rows(runs, store):
        found.add(row)
    schema = found.schema()
    names = schema.names
    with (
        _Whole(store.folder / "runs.parquet") as parquet,
        _Whole(store.folder / "runs.csv") as text,
        pq.ParquetWriter(parquet, schema, compression="zstd") as writer,
    ):
        lines = io.TextIOWrapper(text, encoding="utf-8", newline="", write_through=True)
        table = csv.writer(lines, lineterminator="\n")
        table.writerow(names)
        for piece in _pieces(rows(runs, store)):
            typed = [found.typed(row) for row in piece]
            writer.write_table(pa.Table.from_pylist(typed, schema=schema))
            table.writerows([row.get(name) for name in names] for row in typed)
        lines.detach()


def write_frames(runs: Sequence[Run], store: Store) -> None:
    """Write ``frames.parquet``, a row for each frame of each run.

    Raises:
        InputError: NP250 it cannot be written.
    """
    keys = list(dict.fromkeys(run.key for run in runs))
    names = dict.fromkeys(("cycles", *(name for key in keys for name in store.columns(key))))
    types = [("run", pa.string()), ("frame", pa.int64()), *((name, pa.int64()) for name in names)]
    schema = pa.schema(types)
    with (
        _Whole(store.folder / "frames.parquet") as file,
        pq.ParquetWriter(file, schema, compression="zstd") as writer,
    ):
        for key in keys:
            columns = store.columns(key)
            count = len(columns.get("cycles", ()))
            if not count:
                continue
            made: dict[str, Any] = {"run": [key] * count, "frame": [*range(count)]}
            made |= {name: columns.get(name, [None] * count) for name in names}
            writer.write_table(pa.table(made, schema=schema))


class _Types:
    """The columns of a table and the type of each, found by looking at all rows.

    Args:
        axes: names of the axes, which stand first.
    """

    def __init__(self, axes: Sequence[str]) -> None:
        first = ("run", *axes, *(name for name in FIXED if name in {"status", "error"}))
        self._types: dict[str, set[type]] = {name: set() for name in first}

    def add(self, row: dict[str, Any]) -> None:
        """Look at a row."""
        for name, value in row.items():
            found = self._types.setdefault(name, set())
            if value is not None:
                found.add(type(value))

    def schema(self) -> pa.Schema:
        """Return names and types; a column in which nothing stands is one of texts or numbers."""
        return pa.schema([(name, _type(name, found)) for name, found in self._types.items()])

    def typed(self, row: dict[str, Any]) -> dict[str, Any]:
        """Return a row whose values have the types of their columns."""
        return {
            name: str(value) if str in self._types[name] and value is not None else value
            for name, value in row.items()
        }


def _type(name: str, found: set[type]) -> pa.DataType:
    if str in found or (not found and name in {"run", "error", "status", "program", "clip"}):
        return pa.string()
    if found == {bool}:
        return pa.bool_()
    return pa.int64() if found == {int} else pa.float64()


def _pieces(rows: Iterator[dict[str, Any]]) -> Iterator[list[dict[str, Any]]]:
    while piece := list(islice(rows, _PIECE)):
        yield piece


class _Whole:
    """A file that is written whole or not at all."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._part = path.with_name(f".{path.name}.part")

    def __enter__(self) -> io.BufferedWriter:
        try:
            self._file = self._part.open("wb")
        except OSError as error:
            raise self._cannot(error) from None
        return self._file

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: object
    ) -> None:
        try:
            self._file.close()
            if kind is None:
                self._part.replace(self._path)
        except OSError as late:
            error = error or late
        if isinstance(error, OSError):
            with suppress(OSError):
                self._part.unlink()
            raise self._cannot(error) from None
        if kind is not None:
            self._part.unlink(missing_ok=True)

    def _cannot(self, error: OSError) -> InputError:
        return InputError(
            "NP250",
            f"cannot write {self._path}: {error.strerror or error}",
            hint="what is done is kept: make room, and run the same command again",
        )
