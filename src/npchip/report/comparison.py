"""Programs and machines side by side: as a table, as JSON. `npchip.report.chart` draws them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from npchip.base.json import in_rows

if TYPE_CHECKING:
    from npchip.machine import Machine
    from npchip.run.result import RunResult

SCHEMA: Final = 1


@dataclass(frozen=True)
class Column:
    """One program on one machine.

    Attributes:
        program: how it is called here.
        file: where it came from.
        machine: what it ran on.
        words: its size.
        result: its run.
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
        """Mean cycles of a frame; of the whole run where it took no frame."""
        result = self.result
        return float(result.frame_cycles.mean()) if result.frames else float(result.cycles)

    @property
    def instructions(self) -> float:
        """Mean instructions of a frame, or of the whole run."""
        result = self.result
        return (
            float(result.frame_instructions.mean()) if result.frames else float(result.instructions)
        )

    @property
    def worst(self) -> int:
        """Most cycles of a frame, or those of the whole run."""
        return int(self.result.frame_cycles.max()) if self.result.frames else self.result.cycles

    def share(self, task: str) -> float:
        """Part of the run's cycles that a task took, from 0 to 1."""
        return self.tasks[task] / max(1, self.result.cycles)


def labels(columns: Sequence[Column]) -> list[str]:
    """Call each column by what tells it from the others: program, machine or both."""
    programs = {column.program for column in columns}
    machines = {column.machine.name for column in columns}
    if len(machines) == 1:
        return [column.program for column in columns]
    if len(programs) == 1:
        return [column.machine.name for column in columns]
    return [f"{column.program}, {column.machine.name}" for column in columns]


def used_tasks(columns: Sequence[Column]) -> list[str]:
    """Tasks that take cycles in some column."""
    return [task for task in columns[0].tasks if any(column.tasks[task] for column in columns)]


def to_text(columns: Sequence[Column], frames: str | None) -> str:
    """As JSON, schema 1 of ``docs/compare.md``: one line for each column.

    Args:
        columns: what is compared.
        frames: the clip as the user named it.
    """
    rows = [_column(column, columns[0]) for column in columns]
    return in_rows({"schema": SCHEMA, "frames": frames, "columns": rows}, ("columns",))


def rows(columns: Sequence[Column]) -> list[list[str]]:
    """Cells of the table, each row headed by its title."""
    first = columns[0]

    statuses = [column.result.status for column in columns]
    per_frame = " per frame" if any(column.result.frames for column in columns) else ""

    def row(title: str, cells: Sequence[str]) -> list[str]:
        return [title, *cells]

    return [
        row("program", [column.program for column in columns]),
        row("machine", [column.machine.name for column in columns]),
        *([row("status", statuses)] if {*statuses} != {"frames-exhausted"} else []),
        row("frames", [str(column.result.frames) for column in columns]),
        row("words", [str(column.words) for column in columns]),
        row("words left", [str(column.machine.rom_words - column.words) for column in columns]),
        row(f"cycles{per_frame}, mean", [f"{column.cycles:,.1f}" for column in columns]),
        row(f"cycles{per_frame}, worst", [f"{column.worst:,}" for column in columns]),
        row("ratio to the first", [_ratio(column, first) for column in columns]),
        row(f"instructions{per_frame}", [f"{column.instructions:,.1f}" for column in columns]),
        *(
            row(f"  {task}", [f"{100 * column.share(task):.1f} %" for column in columns])
            for task in used_tasks(columns)
        ),
    ]


def _ratio(column: Column, first: Column) -> str:
    return f"{column.cycles / first.cycles:.3f}" if first.cycles else "-"


def _column(column: Column, first: Column) -> dict[str, Any]:
    result = column.result
    form: dict[str, Any] = {
        "program": column.program,
        "file": column.file,
        "machine": column.machine.name,
        "engine": result.engine,
        "status": result.status,
    }
    if result.error:
        form["error"] = {"code": result.error.code, "message": result.error.message}
    return form | {
        "words": column.words,
        "words_left": column.machine.rom_words - column.words,
        "frames": result.frames,
        "cycles": result.cycles,
        "setup_cycles": int(result.setup.cycles),
        "instructions": result.instructions,
        "cycles_per_frame": {"mean": column.cycles, "worst": column.worst}
        if result.frames
        else None,
        "instructions_per_frame": column.instructions if result.frames else None,
        "cycles_by_task": dict(column.tasks),
        "ratio": column.cycles / first.cycles if first.cycles else None,
    }
