"""Cycle bounds as text: a listing, and a summary of frames, routines and loops."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from npchip.assembler.listing import source_beside

if TYPE_CHECKING:
    from npchip.isa import Isa
    from npchip.machine import Machine
    from npchip.program.bounds import StaticView
    from npchip.program.model import Program
    from npchip.program.paths import CycleRange, Loop


def listing(
    program: Program,
    machine: Machine,
    view: StaticView,
    texts: Mapping[str, Sequence[str]],
    isa: Isa,
) -> str:
    """Return the source with cycles of words and straight runs, and passes of loops.

    Args:
        program: the program.
        machine: the machine, for the cycles.
        view: the static view of the program on the machine.
        texts: lines of its source files, from `npchip.assembler.listing.read_texts`.
        isa: the program's instruction set.
    """
    loops = {loop.address: loop for loop in view.loops}
    head = f"addr  word   {'cyc':>4}  {'run':>6}  {'passes':>8}"

    costs = program.cycles(machine, isa)

    def columns(address: int) -> str:
        word, cost, run = program.words[address], costs[address], view.runs[address]
        loop = loops.get(address)
        passes = _number(loop.least, loop.most, "-") if loop else ""
        return f"{address:03X}   {word:04X}   {cost or '-':>4}  {run or '-':>6}  {passes:>8}"

    beside = source_beside(program, texts, isa, columns, len(head))
    lines = [f"{head}   line  source", *beside]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def summary(program: Program, machine: Machine, view: StaticView) -> str:
    """Return cycles of set-up, frames and routines, loops, and reads before the first write."""
    names = program.label_names
    rows = [("set-up" if view.exposes else "run", cycles(view.setup))]
    rows += [("frame", cycles(view.frame))] if view.exposes else []
    rows += [
        (names.get(item.address, f"0x{item.address:03X}"), cycles(item.cycles))
        for item in view.routines
    ]
    wide = max(len(name) for name, _ in rows)
    lines = [f"{program.name} on machine {machine.name}, from reset"]
    lines += [f"  {name:<{wide}}  {shown}".rstrip() for name, shown in rows]
    if view.loops:
        lines += ["loops: passes each time they are entered", *_loops(program, view.loops)]
    if view.assumes:
        lines.append("read where some way from reset has not written them, so that they are 0:")
        for address, found in view.assumes.items():
            lines.append(f"  {where(program, address)}: {', '.join(found)}")
    return "\n".join(lines) + "\n"


def cycles(span: CycleRange | None) -> str:
    """Return a range of cycles as text."""
    if span is None:
        return "never ends"
    return _number(span.least, span.most, " to ")


def _number(least: int, most: float, to: str) -> str:
    if most == math.inf:
        return f"{least:,} or more" if to != "-" else f"{least}+"
    return f"{least:,}" if least == most else f"{least:,}{to}{int(most):,}"


def _loops(program: Program, loops: Sequence[Loop]) -> Iterator[str]:
    for loop in loops:
        passes = _number(loop.least, loop.most, " to ")
        remark = {
            "proven": "",
            "stated": ", as .loop states",
            "unbounded": ": .loop MOST above it would bound them",
            "several entries": ": entered at several places",
        }[loop.why]
        yield f"  {where(program, loop.address)}: {passes}{remark}"


def where(program: Program, address: int) -> str:
    """Return file and line of a word, with the line outside all macros; else its address."""
    place = program.place(address)
    if place is None:
        return f"0x{address:03X}"
    used = place.written_at
    via = ""
    if used is not place:
        called = f"line {used.line}" if used.file == place.file else f"{used.file}:{used.line}"
        via = f" (from {called})"
    return f"{place.file}:{place.line}{via}"
