"""A trace as lines of text, or as JSON Lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from npchip.base.json import one_line

if TYPE_CHECKING:
    from npchip.trace.record import NP, Event, Seen

_BYTES = 4
"""Greatest number of bytes of memory in a line of text; a conversion changes 64."""
_COLUMN = 28


def header(nps: Sequence[NP]) -> str:
    """Return the line above a trace."""
    columns = "  ".join(f"np {row},{col}".ljust(_COLUMN) for row, col in nps)
    return f"{'cycle':>9}  frame  addr  line  {'instruction':<26}  {columns}".rstrip()


def line(event: Event) -> str:
    """Return an event as a line of text."""
    frame = "-" if event.frame is None else str(event.frame)
    number = str(event.place.line) if event.place else "-"
    columns = "  ".join(_cell(seen, event.registers).ljust(_COLUMN) for seen in event.seen)
    return (
        f"{event.cycle:9d}  {frame:>5}  {event.address:03X}   {number:>4}  {event.text:<26}"
        f"  {columns}"
    ).rstrip()


def _cell(seen: Seen, registers: Mapping[int, str]) -> str:
    if not seen.active and not seen.changes:
        return "(masked)"
    names = {f"r{number}": name for number, name in registers.items()}
    shown = [
        f"{names.get(c.name, c.name)}={c.after}"
        for c in seen.changes
        if not c.name.startswith("mem")
    ]
    memory = [c for c in seen.changes if c.name.startswith("mem")]
    shown += [f"{c.name}={c.after}" for c in memory[:_BYTES]]
    if len(memory) > _BYTES:
        shown.append(f"... {len(memory)} bytes")
    return " ".join(shown) or "."


def json_line(event: Event) -> str:
    """Return an event as a line of JSON."""
    place = event.place
    return one_line(
        {
            "cycle": event.cycle,
            "cycles": event.cycles,
            "frame": event.frame,
            "address": event.address,
            "file": place.file if place else None,
            "line": place.line if place else None,
            "instruction": event.text,
            "nps": [
                {
                    "np": list(seen.np),
                    "active": seen.active,
                    "changes": {c.name: [c.before, c.after] for c in seen.changes},
                }
                for seen in event.seen
            ],
        }
    )
