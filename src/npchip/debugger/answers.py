"""Answers of the debugger as text."""

from __future__ import annotations

from pathlib import PurePath

import numpy as np

from npchip.assembler.expressions import COMPARISONS
from npchip.debugger.conditions import MaskEmpty, Test
from npchip.debugger.search import Written
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, One, Quantity
from npchip.program.model import SourceLine
from npchip.run.result import FrameRecord, Value


def where(debugger: Debugger) -> str:
    """Return frame, cycle, place and text of the next instruction."""
    chip = debugger.chip
    frame = f"frame {chip.frames_taken - 1}" if chip.frames_taken else "set-up"
    place = _place(debugger.line) or f"address {chip.pc}"
    return f"{frame}, cycle {chip.cycles:,}, {place}"


def _place(line: SourceLine | None) -> str:
    if line is None:
        return ""
    return f"{PurePath(line.file).name}:{line.line}: {line.code}"


def outputs(debugger: Debugger) -> str:
    """Return the outputs of this frame so far, one a line."""
    lines = [f"{name} = {output(value)}" for name, value in debugger.outputs.items()]
    return "\n".join(lines) or "the program names no outputs"


def output(value: Value) -> str:
    """Return the value of an output as text; of an array its size."""
    if value is None:
        return "nothing sent"
    if isinstance(value, np.ndarray):
        return f"{value.shape[0]} x {value.shape[1]} bytes"
    return str(value)


def frame(number: int, record: FrameRecord) -> str:
    """Return the outputs and cycles of a complete frame on one line."""
    what = "set-up" if number < 0 else f"frame {number}"
    sent = ", ".join(
        f"{name} {output(value)}" for name, value in record.outputs.items() if value is not None
    )
    return f"{what}: {sent or 'nothing sent'}; {record.cycles:,} cycles"


def processor(debugger: Debugger, row: int, column: int) -> str:
    """Return the activity, flags and registers of an NP on one line."""
    chip = debugger.chip
    values = chip.registers[:, row, column].tolist()
    registers = "  ".join(f"r{number} {value}" for number, value in enumerate(values))
    flags = "  ".join(f"{name} {int(plane[row, column])}" for name, plane in chip.flags.items())
    active = "active" if chip.active[row, column] else "inactive"
    return f"np({row},{column})  {active}  {flags}  {registers}"


def told(written: Written, place: str) -> str:
    """Return a sentence on the last write of a location, which the user called `place`."""
    frame = "in the set-up" if written.frame < 0 else f"in frame {written.frame}"
    change = f"{written.old} -> {written.new}"
    if written.by == "nobody":
        return f"{place} = {written.new}: nothing has written it since reset"
    if written.by == "edit":
        return f"{place}: {change} by an edit {frame}, cycle {written.cycle:,}, goto {written.time}"
    at = ", ".join(filter(None, (f"address {written.address}", _place(written.line))))
    return f"{place}: {change} {frame}, cycle {written.cycle:,}, goto {written.time}, {at}"


def shown(value: Quantity, debugger: Debugger) -> str:
    """Return a quantity as text: a number, or a row of numbers for each row of NPs."""
    chip = debugger.chip
    if not isinstance(value, Cell):
        return str(value.value(chip))
    plane = value.plane(chip)
    return "\n" + "\n".join(" ".join(f"{int(item):3d}" for item in row) for row in plane)


def found(test: Test, debugger: Debugger) -> str:
    """Return the values that made a test fail, as text."""
    if isinstance(test, MaskEmpty):
        return f"{int(debugger.chip.active.sum())} NPs are active"
    value = test.value
    if not isinstance(value, Cell):
        return str(value.value(debugger.chip))
    plane = value.plane(debugger.chip).astype(int)
    wrong = np.argwhere(~COMPARISONS[test.op](plane, test.number))
    row, column = (int(index) for index in wrong[0])
    place = One(value, row, column)
    return f"{int(plane.min())} to {int(plane.max())}, such as {place} = {plane[row, column]}"
