"""Collects the frames of a run into arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from npchip.engines.batch import FrameBatch
from npchip.program.model import Program
from npchip.run.dynamic_array import DynamicArray
from npchip.run.outputs import KINDS, Column, Kind, OutputError, nothing_sent, read_outputs
from npchip.run.result import FrameRecord, RunError, RunResult, Status, Value


class Collector:
    """Turns the batches of one run into a `RunResult`.

    Args:
        program: the program that runs.
        geometry: (NP rows, NP columns) of the machine.
        on_frame: function called with every completed frame, but not with the setup.
        expected: number of frames, as far as it is known; memory for them is reserved at once.

    Attributes:
        taken: number of frames taken, with the setup.
    """

    def __init__(
        self,
        program: Program,
        geometry: tuple[int, int],
        on_frame: Callable[[FrameRecord], None] | None,
        expected: int = 0,
    ) -> None:
        self._program = program
        self._geometry = geometry
        self._expected = expected
        self._on_frame = on_frame
        self.taken = 0
        self._setup: FrameRecord | None = None
        self._cycles = DynamicArray(np.int64, (), expected)
        self._instructions = DynamicArray(np.int64, (), expected)
        self._last_complete = True
        kinds = {output.name: KINDS[output.kind] for output in program.outputs}
        self._series = {name: _Series(kind, geometry, expected) for name, kind in kinds.items()}
        self._declared = frozenset(self._series)

    def take(self, batch: FrameBatch, *, complete: bool = True) -> None:
        """Add the next frames; the first frame of a run is its setup.

        Args:
            batch: the frames.
            complete: False for a single frame that was cut short.

        Raises:
            OutputError: the outputs of a complete frame cannot be read. That frame is the last one
                added, without outputs. A frame that was cut short loses unreadable outputs.
        """
        count = len(batch.cycles)
        if self._setup is None and count > 1:
            self.take(batch.part(0, 1))
            batch, count = batch.part(1, count), count - 1
        try:
            columns = read_outputs(self._program, batch.log)
        except OutputError:
            if count > 1:  # halve down to the frame that is to blame
                self.take(batch.part(0, count // 2))
                self.take(batch.part(count // 2, count))
                return
            self._add(batch, {}, complete=False)
            if complete:
                raise
        else:
            self._add(batch, columns, complete=complete)

    def _add(self, batch: FrameBatch, columns: dict[str, Column], *, complete: bool) -> None:
        if self._setup is None:
            self._begin(batch, columns, complete=complete)
            return
        number, count = len(self._cycles), len(batch.cycles)
        self._cycles.extend(batch.cycles)
        self._instructions.extend(batch.instructions)
        self._last_complete = complete
        new = [name for name in columns if name not in self._series]
        for name in new:  # an unnamed port that was not used before
            self._series[name] = _Series(KINDS["plane"], self._geometry, self._expected)
            self._series[name].extend(None, number)
        if new:  # by their ports, however many frames a batch has
            self._series = dict(sorted(self._series.items(), key=self._place))
        for name, series in self._series.items():
            series.extend(columns.get(name), count)
        if self._on_frame is None or not complete:
            self.taken += count
            return
        values_of = {name: series.since(number) for name, series in self._series.items()}
        pairs = zip(batch.cycles.tolist(), batch.instructions.tolist(), strict=True)
        for index, counts in enumerate(pairs):
            self.taken += 1
            outputs = {
                name: values[index]
                for name, values in values_of.items()
                if values[index] is not None or name in self._declared
            }
            self._on_frame(FrameRecord(*counts, outputs))

    def _place(self, series: tuple[str, _Series]) -> int:
        """Return where an output stands: the declared ones first, then ports without a name."""
        name, _ = series
        return 0 if name in self._declared else 1 + int(name.strip("port_"))

    def _begin(self, batch: FrameBatch, columns: dict[str, Column], *, complete: bool) -> None:
        outputs = nothing_sent(self._program)
        outputs |= {name: column.frame(0) for name, column in columns.items()}
        self._setup = FrameRecord(
            int(batch.cycles[0]), int(batch.instructions[0]), outputs, complete
        )
        self.taken += 1

    def result(
        self,
        engine: str,
        machine: str,
        status: Status,
        error: RunError | None,
        first_frame: int,
    ) -> RunResult:
        """Return the result of the run."""
        setup = self._setup or FrameRecord(0, 0, nothing_sent(self._program))
        return RunResult(
            program=self._program.name,
            engine=engine,
            machine=machine,
            status=status,
            error=error,
            setup=setup,
            first_frame=first_frame,
            frame_cycles=self._cycles.array,
            frame_instructions=self._instructions.array,
            last_complete=self._last_complete,
            outputs={name: series.result() for name, series in self._series.items()},
            geometry=self._geometry,
        )


class _Series:
    """The values of one output in all frames so far; 0 in an array where nothing was sent."""

    def __init__(self, kind: Kind, geometry: tuple[int, int], expected: int) -> None:
        self._values: list[Value] | DynamicArray
        if kind.form == "list":
            self._values = []
        elif kind.form == "array":
            shape = tuple(kind.side * count for count in geometry)
            self._values = DynamicArray(np.uint8, shape, expected)
        else:
            self._values = DynamicArray(np.int32, (), expected)
        self._missing: list[int] = []

    def extend(self, column: Column | None, count: int) -> None:
        """Add `count` frames; without a column they sent nothing."""
        present = None if column is None else column.present
        if column is not None and (present is None or present.all()):
            self._values.extend(column.values)
            return
        if present is None:
            present = np.zeros(count, np.bool_)
        self._missing += (np.flatnonzero(~present) + len(self._values)).tolist()
        if isinstance(self._values, list):
            rest = iter(() if column is None else column.values)
            self._values.extend(next(rest) if sent else None for sent in present)
            return
        values = np.zeros((count, *self._values.array.shape[1:]), self._values.array.dtype)
        if column is not None:
            values[present] = column.values
        self._values.extend(values)

    def since(self, number: int) -> list[Value]:
        """Return the values of the frames from `number` on."""
        if isinstance(self._values, list):
            return self._values[number:]
        found = self._values.array[number:]
        values: list[Value] = found.tolist() if found.ndim == 1 else [*found.copy()]
        for index in reversed(self._missing):
            if index < number:
                break
            values[index - number] = None
        return values

    def result(self) -> Any:
        """Return the values as in `RunResult.outputs`."""
        if isinstance(self._values, list):
            return self._values
        values = self._values.array
        if not self._missing:
            return values
        masked = np.ma.array(values, mask=False)
        masked[self._missing] = np.ma.masked
        return masked
