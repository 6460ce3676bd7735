"""Snapshots of a session for the screen, as the chip runs on in another thread."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from npchip.assembler.disassembler import disassemble_word
from npchip.debugger.values import Cell
from npchip.machine.layout import to_frames

if TYPE_CHECKING:
    from npchip.debugger.conditions import Stop
    from npchip.debugger.session import Debugger
    from npchip.program.model import SourceLine
    from npchip.run.result import FrameRecord, Value

Shown = Cell | int | None
"""Subject of the picture: a cell, a bank (its first address), or the exposed frame (None)."""


@dataclass(frozen=True)
class Look:
    """A snapshot of a session. Its arrays have the shapes of those of `Chip`."""

    pc: int
    stack: tuple[int, ...]
    registers: NDArray[np.uint8]
    memory: NDArray[np.uint8]
    flags: dict[str, NDArray[np.bool_]]
    active: NDArray[np.bool_]
    frame: NDArray[np.uint8] | None
    executions: NDArray[np.int64]
    frame_number: int
    cycles: int
    frame_cycles: int
    instructions: int
    outputs: dict[str, Value]
    records: dict[int, FrameRecord]
    stop: Stop
    breakpoints: dict[int, bool]

    @classmethod
    def at(cls, debugger: Debugger) -> Look:
        """Take a snapshot of a session."""
        chip = debugger.chip
        breakpoints: dict[int, bool] = {}
        for item in debugger.breakpoints.values():
            for address in item.condition.places if item.condition else ():
                breakpoints[address] = breakpoints.get(address, False) or item.enabled
        return cls(
            pc=chip.pc,
            stack=chip.stack,
            registers=chip.registers.copy(),
            memory=chip.memory.copy(),
            flags={name: plane.copy() for name, plane in chip.flags.items()},
            active=chip.active,
            frame=chip.frame,
            executions=chip.executions,
            frame_number=chip.frames_taken - 1,
            cycles=chip.cycles,
            frame_cycles=chip.frame_cycles,
            instructions=chip.instructions,
            outputs=debugger.outputs,
            records=debugger.records,
            stop=debugger.stop,
            breakpoints=breakpoints,
        )

    def plane(self, cell: Cell) -> NDArray[Any]:
        """Return a cell's value of every NP: shape (NP rows, NP columns)."""
        plane: NDArray[Any]
        match cell.kind:
            case "register":
                plane = self.registers[int(cell.index)]
            case "flag":
                plane = self.flags[str(cell.index)]
            case "memory":
                plane = self.memory[int(cell.index)]
            case "active":
                plane = self.active
        return plane

    def pixels(self, shown: int | None) -> NDArray[np.uint8]:
        """Return a bank or the exposed frame as a picture: uint8, shape (rows, columns)."""
        if shown is None:
            if self.frame is not None:
                return self.frame
            return np.zeros((8 * self.active.shape[0], 8 * self.active.shape[1]), np.uint8)
        return to_frames(self.memory[shown : shown + 64])


@dataclass(frozen=True)
class Row:
    """A line of the source pane: its number, its text and the addresses of its words."""

    number: int
    text: str
    addresses: tuple[int, ...]


class Sources:
    """The source text of a program, or its disassembly if it has none.

    Attributes:
        files: rows by file, in program order.
        costs: cycles of one execution, by address: int64.
    """

    def __init__(self, debugger: Debugger) -> None:
        program, chip = debugger.program, debugger.chip
        self.costs = np.array(program.cycles(chip.machine, chip.isa), np.int64)
        self._program = program
        self.files: dict[str, list[Row]] = {}
        if not program.source:
            labels = {address: name for name, address in program.labels.items()}
            self.files[""] = [
                Row(at, disassemble_word(word, chip.isa, labels) or f".word 0x{word:04X}", (at,))
                for at, word in enumerate(program.words)
            ]
            return
        addresses: dict[str, dict[int, list[int]]] = {}
        for address, line in enumerate(program.source):
            for origin in line.origins:
                addresses.setdefault(origin.file, {}).setdefault(origin.line, []).append(address)
        for file, of_line in addresses.items():
            texts = _text(file, program.source)
            self.files[file] = [
                Row(number, text, tuple(of_line.get(number, ()))) for number, text in texts
            ]

    def place(self, address: int) -> tuple[str, int]:
        """Return the file and the row index of an address."""
        line = self._program.place(address)
        if line is None:
            file = next(iter(self.files))
            return file, min(address, len(self.files[file]) - 1)
        rows = self.files[line.file]
        return line.file, next((i for i, row in enumerate(rows) if row.number == line.line), 0)

    def name(self, address: int) -> str:
        """Return the last label at or before an address, with the distance to it."""
        labels = [(at, name) for name, at in self._program.labels.items() if at <= address]
        if not labels:
            return str(address)
        at, name = max(labels)
        return name if at == address else f"{name}+{address - at}"


def _text(file: str, source: tuple[SourceLine, ...]) -> list[tuple[int, str]]:
    """Return the numbered lines of a file. If it has changed, return only those that gave words."""
    known = {line.line: line.text for item in source for line in item.origins if line.file == file}
    try:
        lines = Path(file).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError):
        lines = []
    if all(number <= len(lines) and lines[number - 1] == text for number, text in known.items()):
        return list(enumerate(lines, 1))
    return sorted(known.items())


def title(file: str) -> str:
    """Return the title of a file's pane."""
    return PurePath(file).name or "disassembly"
