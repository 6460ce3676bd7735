"""A run as text: a row for each frame, then totals and the frame rate at a clock."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from npchip.base.columns import aligned
from npchip.report.jsonform import array_outputs

if TYPE_CHECKING:
    from npchip.run.result import RunResult, Value

ILLUSTRATIVE_CLOCK_HZ = 10_000_000
"""Clock if none is stated; the chip's own was never published."""

_LIST_ITEMS = 8


class Clock(NamedTuple):
    """A clock, which the user stated or not."""

    hz: int
    stated: bool

    def __str__(self) -> str:
        units = ((10**9, "GHz"), (10**6, "MHz"), (10**3, "kHz"), (1, "Hz"))
        factor, unit = next(each for each in units if self.hz >= each[0])
        text = f"{self.hz / factor:.6g} {unit}"
        return text if self.stated else f"{text} (illustrative)"


def plain_text(result: RunResult, clock: Clock) -> str:
    """Return the text for files and pipes: columns of blanks; other lines start with ``#``."""
    table = [header(result), *rows(result, range(result.frames), whole=True)]
    lines = aligned(table, left=0)
    lines += [f"# {line}" for line in summary(result, clock)]
    return "\n".join(lines) + "\n"


def summary(result: RunResult, clock: Clock) -> list[str]:
    """Return totals, mean and worst frame and frame rate, with a hint about planes and pictures."""
    where = f"{result.program} on machine {result.machine}, engine {result.engine}"
    before = f" ({result.setup.cycles:,} before the first frame)" if result.frames else ""
    lines = [
        f"{where}: {ending(result)}",
        f"{result.cycles:,} cycles{before}, {result.instructions:,} instructions",
    ]
    cycles = result.complete_cycles
    if len(cycles):
        mean, worst = float(cycles.mean()), int(cycles.max())
        at = result.first_frame + int(cycles.argmax())
        lines.append(f"cycles per frame: {mean:,.1f} on average, {worst:,} at worst (frame {at})")
        lines.append(
            f"frames per second at {clock}: {_rate(clock, mean)} on average, "
            f"{_rate(clock, worst)} at worst; exposure time is not counted"
        )
    if arrays := array_outputs(result):
        lines.append(f"{', '.join(arrays)}: --save DIR keeps every value, --json prints it")
    return lines


def worst_frame(result: RunResult) -> int | None:
    """Return the index, in this run, of the first frame with the most cycles; None if no frame."""
    return int(result.frame_cycles.argmax()) if result.frames else None


def ending(result: RunResult) -> str:
    """Return the number of frames of a run and its end, in words."""
    frames = f"{result.frames} frame{'' if result.frames == 1 else 's'}"
    how = {
        "halted": "halted",
        "frames-exhausted": "end of the clip",
        "cycle-limit": "CYCLE LIMIT REACHED",
        "failed": "FAILED",
    }[result.status]
    cut_short = "" if result.last_complete else ", the last one cut short"
    return f"{frames}{cut_short}, {how}"


def header(result: RunResult) -> list[str]:
    """Return the names of the columns."""
    return ["frame", *_names(result), "cycles"]


def _names(result: RunResult) -> list[str]:
    return list(dict.fromkeys([*result.outputs, *result.setup.outputs]))


def has_setup_row(result: RunResult) -> bool:
    """Return whether the table has a row for the part before the first frame."""
    return not result.frames or any(v is not None for v in result.setup.outputs.values())


def rows(result: RunResult, frames: list[int] | range, *, whole: bool) -> list[list[str]]:
    """Return the rows of the set-up, if it has one, and of `frames`; `whole` keeps long lists."""
    names = _names(result)
    table = []
    if has_setup_row(result):
        sent = [_cell(result.setup.outputs.get(name), whole=whole) for name in names]
        table.append(["setup", *sent, str(result.setup.cycles)])
    for k in frames:
        values = [result.value(name, k) if name in result.outputs else None for name in names]
        sent = [_cell(value, whole=whole) for value in values]
        table.append([str(result.first_frame + k), *sent, str(result.frame_cycles[k])])
    return table


def _cell(value: Value, *, whole: bool) -> str:
    if value is None:
        return "-"
    if isinstance(value, np.ndarray):
        return "x".join(map(str, value.shape))
    if not isinstance(value, list):
        return str(value)
    if whole:
        return ",".join(map(str, value)) or "none"
    more = f",... ({len(value)})" if len(value) > _LIST_ITEMS else ""
    return (",".join(map(str, value[:_LIST_ITEMS])) or "none") + more


def _rate(clock: Clock, cycles: float) -> str:
    if not cycles:  # a machine file may make instructions free
        return "-"
    per_second = clock.hz / cycles
    return f"{per_second:,.0f}" if per_second >= 100 else f"{per_second:.3g}"
