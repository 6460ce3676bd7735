"""Texts of the small panes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from npchip.debugger.values import Cell

if TYPE_CHECKING:
    from npchip.debugger.screen.look import Look, Shown, Sources
    from npchip.program.model import Program


def processor(look: Look, program: Program, row: int, column: int) -> str:
    """Registers with their names, and flags, of one NP: nine lines."""
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
    """As many of the names as fit; a mark at the end stands for what does not."""
    text = " ".join(names)
    if len(text) <= width:
        return text
    text = text[:width]
    return (text.rsplit(" ", 1)[0] if " " in text else text[: width - 1]) + "…"


def counters(look: Look, since: int, sources: Sources) -> str:
    """Cycles and calls: four lines."""
    frame = f"frame {look.frame_number}" if look.frame_number >= 0 else "set-up"
    calls = " < ".join(sources.name(back - 1) for back in reversed(look.stack)) or "none open"
    return (
        f"cycles {look.cycles:,}  {since:+,} since stop\n"
        f"{frame}: {look.frame_cycles:,} cycles\n"
        f"instructions {look.instructions:,}\n"
        f"calls from: {calls}"
    )


def caption(look: Look, shown: Shown, pixel: tuple[int, int], program: Program) -> str:
    """What the picture is of, and the value at the selected place."""
    row, column = pixel[0] // 8, pixel[1] // 8
    if isinstance(shown, Cell):
        names = [
            name
            for name, number in program.registers.items()
            if shown.kind == "register" and number == shown.index
        ]
        if shown.kind == "memory":
            names = [name for name, value in program.symbols.items() if value == shown.index][:3]
        called = f" {' '.join(names)}" if names else ""
        value = int(look.plane(shown)[row, column])
        return f"{shown}{called}   np({row},{column}) = {value}, 0x{value:02X}"
    what = "exposed frame" if shown is None else f"bank {shown}"
    value = int(look.pixels(shown)[pixel])
    return f"{what}   pixel({pixel[0]},{pixel[1]}) = {value}   np({row},{column})"
