"""Texts of the small panes and of the picture's title."""

from __future__ import annotations

import numpy as np

from npchip.debugger.screen.look import Look, Shown, Sources
from npchip.debugger.values import Cell
from npchip.program.model import Program
from npchip.run.result import Value


def processor(look: Look, program: Program, row: int, column: int) -> str:
    """Return nine lines on one NP: activity, flags, and registers with their names."""
    names: dict[int, list[str]] = {}
    for name, number in program.registers.items():
        names.setdefault(number, []).append(name)
    values = look.registers[:, row, column].tolist()
    cells = [
        f"r{number:<2} {_fitting(names.get(number, []), 9):<9} {value:>3}"
        for number, value in enumerate(values)
    ]
    flags = "  ".join(f"{name} {int(plane[row, column])}" for name, plane in look.flags.items())
    activity = "active" if look.active[row, column] else "INACTIVE"
    lines = [f"{left}   {right}" for left, right in zip(cells[:8], cells[8:], strict=True)]
    return "\n".join([f"{activity}   {flags}", *lines])


def _fitting(names: list[str], width: int) -> str:
    text = " ".join(names)
    if len(text) <= width:
        return text
    text = text[:width]
    return (text.rsplit(" ", 1)[0] if " " in text else text[: width - 1]) + "…"


def counters(look: Look, since: int, sources: Sources) -> str:
    """Return four lines on cycles, instructions and calls."""
    frame = f"frame {look.frame_number}" if look.frame_number >= 0 else "set-up"
    calls = " < ".join(sources.name(back - 1) for back in reversed(look.stack)) or "none open"
    return (
        f"cycles {look.cycles:,}  {since:+,} since stop\n"
        f"{frame}: {look.frame_cycles:,} cycles\n"
        f"instructions {look.instructions:,}\n"
        f"calls from: {calls}"
    )


def caption(look: Look, shown: Shown, pixel: tuple[int, int], program: Program) -> str:
    """Return the subject of the picture and its value at the selected pixel or NP."""
    row, column = pixel[0] // 8, pixel[1] // 8
    if isinstance(shown, Cell):
        known = {"register": program.registers, "memory": program.symbols}.get(shown.kind, {})
        names = [name for name, number in known.items() if number == shown.index]
        if shown.kind == "memory":
            names = names[:3]
        called = f" {' '.join(names)}" if names else ""
        value = int(shown.plane(look)[row, column])
        return f"{shown}{called}   np({row},{column}) = {value}, 0x{value:02X}"
    what = "exposed frame" if shown is None else f"bank {shown}"
    value = int(look.pixels(shown)[pixel])
    return f"{what}   pixel({pixel[0]},{pixel[1]}) = {value}   np({row},{column})"


def outputs(look: Look, width: int, most: int) -> str:
    """Return a table of at most `most` lines: outputs of the last frames and the current one."""
    names = list(look.outputs)
    ended = look.frame_number in look.records
    rows = [("frame", "cycles", *names)]
    before = [number for number in sorted(look.records) if number >= 0][-(most - 1) :]
    if not ended:
        before = before[-(most - 2) :] if most > 2 else []
    for number in before:
        record = look.records[number]
        rows.append(
            (str(number), f"{record.cycles:,}", *(_short(record.outputs.get(n)) for n in names))
        )
    if not ended:
        label = f"{look.frame_number}…" if look.frame_number >= 0 else "set-up…"
        rows.append(
            (label, f"{look.frame_cycles:,}", *(_short(look.outputs[name]) for name in names))
        )
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = [
        "  ".join(f"{cell:>{wide}}" for cell, wide in zip(row, widths, strict=True)) for row in rows
    ]
    return "\n".join(line if len(line) <= width else line[: width - 1] + "…" for line in lines)


def _short(value: Value) -> str:
    if value is None:
        return "–"
    if isinstance(value, np.ndarray):
        return f"{value.shape[0]}x{value.shape[1]}"
    if isinstance(value, list) and len(value) > 6:
        return f"[{', '.join(map(str, value[:5]))}, … {len(value)}]"
    return str(value)
