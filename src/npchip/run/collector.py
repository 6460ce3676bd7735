"""Gathers the frames of a run into arrays, a few bytes for each scalar of each frame."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

from npchip.engines.batch import FrameBatch
from npchip.engines.state import RawFrame
from npchip.program.model import Program
from npchip.run.buffers import Growing
from npchip.run.columns import Column, first_unreadable, read_columns, read_scalars
from npchip.run.outputs import OutputError, nothing_sent, read_outputs
from npchip.run.result import FrameRecord, RunError, RunResult, Status, Value

_SCALARS = {"scalar", "scalar16"}


class Collector:
    """Turns the raw frames of one run into a `RunResult`.

    Args:
        program: whose outputs are read.
        on_frame: called with every completed frame; not with the setup.

    Attributes:
        taken: frames taken, the setup included.
    """

    def __init__(self, program: Program, on_frame: Callable[[FrameRecord], None] | None) -> None:
        self._program = program
        self._on_frame = on_frame
        self.taken = 0
        self._setup: FrameRecord | None = None
        self._cycles = Growing(np.int64)
        self._instructions = Growing(np.int64)
        self._last_complete = True
        self._kinds: dict[str, str] = {item.name: item.kind for item in program.outputs}
        self._declared = frozenset(self._kinds)
        self._columns: dict[str, list[Value] | Growing] = {
            name: Growing(np.int32) if kind in _SCALARS else []
            for name, kind in self._kinds.items()
        }
        self._missing: dict[str, list[int]] = {name: [] for name in self._kinds}

    def take(self, raw: RawFrame, *, complete: bool = True) -> None:
        """Take the next frame; the first one is the setup.

        Raises:
            OutputError: the outputs of a complete frame cannot be read; the frame is taken
                without them. One that was cut short may well have sent half a picture.
        """
        try:
            outputs = read_outputs(self._program, raw.sends)
        except OutputError:
            self._add(raw, nothing_sent(self._program), complete=False)
            if complete:
                raise
        else:
            self._add(raw, outputs, complete=complete)

    def take_batch(self, batch: FrameBatch) -> None:
        """Take the first frames of a batch, up to one whose outputs cannot be read."""
        if self._setup is None or (batch.prefix and len(batch.cycles)):
            first = batch.frame(0)  # the set-up, or a frame that was begun elsewhere
            try:
                outputs = read_outputs(self._program, first.sends)
            except OutputError:
                return
            self._add(first, outputs, complete=True)
            batch = batch.since(1)
        count = len(batch.cycles)
        if not count:
            return
        columns = read_scalars(self._program, batch.log, count)
        if columns is None:
            batch = batch.until(first_unreadable(self._program, batch.log, count))
            columns = read_columns(self._program, batch.log, len(batch.cycles))
        self._add_all(batch, columns)

    def _add_all(self, batch: FrameBatch, columns: Mapping[str, Column]) -> None:
        """Add complete frames and their outputs."""
        number, count = len(self._cycles), len(batch.cycles)
        self._cycles.add(batch.cycles)
        self._instructions.add(batch.instructions)
        self._last_complete = True
        self._name(columns, number)
        for name, column in self._columns.items():
            found = columns.get(name)
            present = np.zeros(count, np.bool_) if found is None else found.present
            if present is not None and not present.all():
                self._missing[name] += (np.flatnonzero(~present) + number).tolist()
            if isinstance(column, Growing):
                values = np.zeros(count, np.int32)
                if found is not None:
                    values[... if present is None else present] = found.values
                column.add(values)
            else:
                rest = iter(() if found is None else found.values)
                here = [True] * count if present is None else present
                column.extend(next(rest) if sent else None for sent in here)
        if self._on_frame is None:
            self.taken += count
            return
        cycles, instructions = self._cycles.numbers[number:], self._instructions.numbers[number:]
        values_of = {name: self._since(name, number) for name in self._columns}
        for index, counts in enumerate(zip(cycles.tolist(), instructions.tolist(), strict=True)):
            self.taken += 1
            outputs = {
                name: values[index]
                for name, values in values_of.items()
                if values[index] is not None or name in self._declared
            }
            self._on_frame(FrameRecord(*counts, outputs))

    def _since(self, name: str, number: int) -> list[Value]:
        """The values of an output in the frames from `number` on."""
        column = self._columns[name]
        if not isinstance(column, Growing):
            return column[number:]
        values: list[Value] = column.numbers[number:].tolist()
        for index in reversed(self._missing[name]):
            if index < number:
                break
            values[index - number] = None
        return values

    def _name(self, names: Iterable[str], number: int) -> None:
        """Begin a column for each port without a name that is first used in frame `number`."""
        for name in names:
            if name not in self._columns:
                self._kinds[name] = "plane"
                self._columns[name] = [None] * number
                self._missing[name] = list(range(number))

    def _add(self, raw: RawFrame, outputs: dict[str, Value], *, complete: bool) -> None:
        self.taken += 1
        record = FrameRecord(raw.cycles, raw.instructions, outputs, complete)
        if self._setup is None:
            self._setup = record
            return
        number = len(self._cycles)
        self._cycles.add(raw.cycles)
        self._instructions.add(raw.instructions)
        self._last_complete = complete
        self._name(outputs, number)
        for name, column in self._columns.items():
            value = outputs.get(name)
            if value is None:
                self._missing[name].append(number)
            if isinstance(column, Growing):
                column.add(0 if value is None else int(value))  # type: ignore[arg-type]
            else:
                column.append(value)
        if self._on_frame and complete:
            self._on_frame(record)

    def result(
        self,
        engine: str,
        machine: str,
        status: Status,
        error: RunError | None,
        first_frame: int,
    ) -> RunResult:
        """The result of the run."""
        setup = self._setup or FrameRecord(0, 0, nothing_sent(self._program))
        return RunResult(
            program=self._program.name,
            engine=engine,
            machine=machine,
            status=status,
            error=error,
            setup=setup,
            first_frame=first_frame,
            frame_cycles=self._cycles.numbers,
            frame_instructions=self._instructions.numbers,
            last_complete=self._last_complete,
            outputs={name: self._column(name) for name in self._columns},
        )

    def _column(self, name: str) -> Any:
        column, missing = self._columns[name], self._missing[name]
        if self._kinds[name] == "list":
            return column
        if isinstance(column, Growing):
            values = column.numbers
        else:
            shape = next((v.shape for v in column if isinstance(v, np.ndarray)), (0, 0))
            blank = np.zeros(shape, np.uint8)
            values = np.array([blank if v is None else v for v in column], np.uint8)
            values = values.reshape(len(column), *shape)
        if not missing:
            return values
        masked = np.ma.array(values, mask=False)
        masked[missing] = np.ma.masked
        return masked
