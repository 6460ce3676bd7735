"""Positions and cycles of two cameras as text, JSON and CSV."""

from __future__ import annotations

import csv
import io
from collections import Counter
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from npchip.base.columns import aligned
from npchip.host.vision.fusion import Status
from npchip.host.vision.fusion.rigfile import rig_as_data
from npchip.report.jsonform import to_text

if TYPE_CHECKING:
    from npchip.host.rig import Observation, Timing
    from npchip.host.vision.fusion import Rig
    from npchip.report.table import Clock

SCHEMA: Final = 1
HEADER: Final = ("frame", "row1", "col1", "row2", "col2", "x", "y", "z", "mark", "cycles")
AHEAD: Final = ("x_ahead", "y_ahead", "z_ahead")
"""Columns of a prediction, behind the others."""
LINK_HEADER: Final = ("link", "bytes", "link cycles", "latency", "period", "frames/s", "limit")


def frames(seen: Observation) -> int:
    """Return the number of frames."""
    return len(seen.seen1)


def mark(seen: Observation, k: int) -> str:
    """Return the quality of a frame's position, or the reason for which it has none."""
    status = Status(int(seen.positions.status[k]))
    if status != Status.UNSEEN:
        return status.name.lower()
    blind = [n for n, at in ((1, seen.seen1), (2, seen.seen2)) if np.isnan(at[k, 0])]
    return "unseen" if len(blind) == 2 else f"unseen by {blind[0]}"


def header(seen: Observation) -> tuple[str, ...]:
    """Return the columns of `rows`."""
    return HEADER if seen.predicted is None else (*HEADER, *AHEAD)


def rows(seen: Observation) -> list[tuple[str, ...]]:
    """Return a row of cells for each frame, as `header` says: pixels, metres, cycles."""
    latency = seen.timings[seen.link].latency
    return [
        (
            str(k),
            *(_cell(value, 1) for value in (*seen.seen1[k], *seen.seen2[k])),
            *(_cell(value, 3) for value in seen.positions.points[k]),
            mark(seen, k),
            str(latency[k]),
            *(_cell(value, 3) for value in _predicted(seen, k)),
        )
        for k in range(frames(seen))
    ]


def _predicted(seen: Observation, k: int) -> list[float]:
    return [] if seen.predicted is None else [float(value) for value in seen.predicted[k]]


def link_rows(seen: Observation, clock: Clock) -> list[tuple[str, ...]]:
    """Return a row of cells for each link, as `LINK_HEADER` says, with the worst frame's cycles."""
    return [
        (
            name,
            str(_worst(timing.sent)),
            f"{_worst(timing.parts['link']):,}",
            f"{_worst(timing.latency):,}",
            f"{_worst(timing.period):,}",
            f"{clock.hz / _worst(timing.period):,.0f}",
            timing.limit,
        )
        for name, timing in seen.timings.items()
    ]


def summary(seen: Observation, clock: Clock) -> list[str]:
    """Return three lines: the algorithm, the number of positions, and the columns of the links."""
    where = "a separate processor" if seen.link == "host" else "camera 1"
    counts = Counter(mark(seen, k) for k in range(frames(seen)))
    without = [f"{n} {why}" for why, n in counts.items() if why not in {"ok", "border", "apart"}]
    if seen.follows:
        where += ", follow.s in both cameras"
    if seen.ahead:
        where += f", predicted {seen.ahead} frames ahead"
    return [
        f"{seen.algorithm} on {where}, link {seen.link}, machine {seen.machine.name}",
        f"{int(seen.positions.valid.sum())} positions in {frames(seen)} frames"
        + (f"; {counts['border']} at the border of a frame" if counts["border"] else "")
        + (f"; {counts['apart']} with rays apart" if counts["apart"] else "")
        + (f"; none: {', '.join(without)}" if without else ""),
        f"links: cycles of the worst frame; frames per second pipelined, at {clock}, unexposed",
    ]


def doubt(seen: Observation) -> str | None:
    """Return a word on rays that miss each other, or None."""
    missed = int((seen.positions.status == Status.APART).sum())
    if not missed:
        return None
    return (
        f"note: in {missed} of {frames(seen)} frames the two cameras see the object at heights that"
        " no pixel explains\n"
        "  help: are the clips exchanged, not exposed together, or is the rig not the one they"
        " were taken with?"
    )


def plain_text(seen: Observation, clock: Clock) -> str:
    """Return the text for files and pipes: columns of blanks; other lines start with ``#``."""
    table = aligned([header(seen), *rows(seen)], left=0)
    links = aligned([LINK_HEADER, *link_rows(seen, clock)], left=0)
    return "\n".join([*table, *(f"# {x}" for x in (*summary(seen, clock), *links))]) + "\n"


def csv_text(seen: Observation) -> str:
    """Return CSV with a line for each frame, all digits, and empty fields for missing values."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    ahead = () if seen.predicted is None else AHEAD
    writer.writerow([*HEADER[:-1], *(f"cycles_{name}" for name in seen.timings), *ahead])
    for k in range(frames(seen)):
        pixels, place = (*seen.seen1[k], *seen.seen2[k]), seen.positions.points[k]
        writer.writerow(
            [
                k,
                *(_number(value) for value in (*pixels, *place)),
                mark(seen, k),
                *(int(timing.latency[k]) for timing in seen.timings.values()),
                *(_number(value) for value in _predicted(seen, k)),
            ]
        )
    return buffer.getvalue()


def json_text(seen: Observation, rig: Rig, clock_hz: int) -> str:
    """Return the document of ``docs/rig.md``."""
    document = {
        "schema": SCHEMA,
        "rig": rig_as_data(rig),
        "machine": seen.machine.name,
        "algorithm": seen.algorithm,
        "link": seen.link,
        "clock_hz": clock_hz,
        **({"follow": True} if seen.follows else {}),
        **({"predict": seen.ahead} if seen.ahead else {}),
        "links": {name: _link(timing) for name, timing in seen.timings.items()},
        "frames": [_frame(seen, k) for k in range(frames(seen))],
    }
    return to_text(document)


def _frame(seen: Observation, k: int) -> dict[str, Any]:
    def pair(pixels: Any) -> list[float] | None:
        return None if np.isnan(pixels[0]) else [float(value) for value in pixels]

    return {
        "index": k,
        "camera1": pair(seen.seen1[k]),
        "camera2": pair(seen.seen2[k]),
        "position": [float(v) for v in seen.positions.points[k]]
        if seen.positions.valid[k]
        else None,
        "mark": mark(seen, k),
        "cycles": {name: int(timing.latency[k]) for name, timing in seen.timings.items()},
        **({"predicted": _point(seen, k)} if seen.ahead else {}),
    }


def _point(seen: Observation, k: int) -> list[float] | None:
    point = _predicted(seen, k)
    return None if np.isnan(point).any() else point


def _link(timing: Timing) -> dict[str, Any]:
    return {
        "bytes": _worst(timing.sent),
        "parts": {name: _worst(cycles) for name, cycles in timing.parts.items()},
        "latency": _worst(timing.latency),
        "period": _worst(timing.period),
        "limit": timing.limit,
    }


def _worst(cycles: Any) -> int:
    return int(cycles.max())


def _cell(value: float, digits: int) -> str:
    return "-" if np.isnan(value) else f"{value:.{digits}f}"


def _number(value: float) -> float | str:
    return "" if np.isnan(value) else float(value)
