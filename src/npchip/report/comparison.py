"""Programs and machines side by side, as a table or as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from npchip.base.json import in_rows

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from npchip.machine import Machine
    from npchip.report.table import Clock
    from npchip.run.result import RunResult

SCHEMA: Final = 1


@dataclass(frozen=True)
class Column:
    """One program on one machine.

    Attributes:
        program: name of the program in the table.
        file: file of the program.
        machine: the machine.
        words: size of the program.
        result: the run.
        tasks: cycles of the whole run by task (`npchip.profile.tasks`).
    """

    program: str
    file: str
    machine: Machine
    words: int
    result: RunResult
    tasks: Mapping[str, int]

    @property
    def cycles(self) -> float:
        """Mean cycles of a frame; those of the whole run if it took no frame."""
        return _mean(self.result.frame_cycles, self.result.cycles)

    @property
    def instructions(self) -> float:
        """Mean instructions of a frame; those of the whole run if it took no frame."""
        return _mean(self.result.frame_instructions, self.result.instructions)

    @property
    def worst(self) -> int:
        """Most cycles of a frame; those of the whole run if it took no frame."""
        return int(self.result.frame_cycles.max()) if self.result.frames else self.result.cycles

    @property
    def words_left(self) -> int:
        """Unused words of the program ROM."""
        return self.machine.rom_words - self.words

    def ratio(self, first: Column) -> float | None:
        """Return the cycles as a multiple of those of another column; None if it has none."""
        return self.cycles / first.cycles if first.cycles else None

    def share(self, task: str) -> float:
        """Return the part of the run's cycles that a task took, from 0 to 1."""
        return self.tasks[task] / max(1, self.result.cycles)


def labels(columns: Sequence[Column]) -> list[str]:
    """Return the label of each column: program, machine or, if both differ, both."""
    programs = [column.program for column in columns]
    machines = [column.machine.name for column in columns]
    if len(set(machines)) == 1:
        return programs
    if len(set(programs)) == 1:
        return machines
    return [f"{program}, {machine}" for program, machine in zip(programs, machines, strict=True)]


def used_tasks(columns: Sequence[Column]) -> list[str]:
    """Return the tasks that take cycles in some column."""
    return [task for task in columns[0].tasks if any(column.tasks[task] for column in columns)]


def to_text(columns: Sequence[Column], frames: str | None, clock: Clock) -> str:
    """Return a comparison as JSON, schema 1 of ``docs/compare.md``, with a line for each column.

    Args:
        columns: the columns, the first of which the others are compared with.
        frames: the clip as the user named it.
        clock: the clock for frame rates.
    """
    rows = [_column(column, columns[0], clock) for column in columns]
    head = {"schema": SCHEMA, "frames": frames, "clock_hz": clock.hz}
    return in_rows({**head, "columns": rows}, ("columns",))


def rows(columns: Sequence[Column], clock: Clock) -> list[list[str]]:
    """Return the cells of the table; each row begins with its title.

    It has frame rates if the user stated the clock.
    """
    tasks = used_tasks(columns)
    per_frame = " per frame" if any(column.result.frames for column in columns) else ""

    def rate(column: Column) -> str:
        return f"{clock.hz / column.cycles:,.0f}" if column.result.frames else "-"

    def cells(column: Column) -> dict[str, str]:
        ratio = column.ratio(columns[0])
        return {
            "program": column.program,
            "machine": column.machine.name,
            "status": column.result.status,
            "frames": str(column.result.frames),
            "words": str(column.words),
            "words left": str(column.words_left),
            f"cycles{per_frame}, mean": f"{column.cycles:,.1f}",
            f"cycles{per_frame}, worst": f"{column.worst:,}",
            "ratio to the first": "-" if ratio is None else f"{ratio:.3f}",
            f"instructions{per_frame}": f"{column.instructions:,.1f}",
            **({f"frames/s at {clock}, mean": rate(column)} if clock.stated else {}),
            **{f"  {task}": f"{100 * column.share(task):.1f} %" for task in tasks},
        }

    table = [cells(column) for column in columns]
    good = all(column["status"] == "frames-exhausted" for column in table)
    titles = [title for title in table[0] if title != "status" or not good]
    return [[title, *(column[title] for column in table)] for title in titles]


def _mean(of_frames: NDArray[np.int64], of_run: int) -> float:
    return float(of_frames.mean()) if len(of_frames) else float(of_run)


def _column(column: Column, first: Column, clock: Clock) -> dict[str, Any]:
    result = column.result
    error = result.error
    return {
        "program": column.program,
        "file": column.file,
        "machine": column.machine.name,
        "engine": result.engine,
        "status": result.status,
        **({"error": {"code": error.code, "message": error.message}} if error else {}),
        "words": column.words,
        "words_left": column.words_left,
        "frames": result.frames,
        "cycles": result.cycles,
        "setup_cycles": int(result.setup.cycles),
        "instructions": result.instructions,
        "cycles_per_frame": {"mean": column.cycles, "worst": column.worst}
        if result.frames
        else None,
        "frames_per_second": clock.hz / column.cycles if result.frames else None,
        "instructions_per_frame": column.instructions if result.frames else None,
        "cycles_by_task": dict(column.tasks),
        "ratio": column.ratio(first),
    }
