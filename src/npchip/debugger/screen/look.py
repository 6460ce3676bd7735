"""Snapshots of a session for the screen; the chip itself runs in another thread."""

from __future__ import annotations

from pathlib import Path, PurePath
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.assembler.disassembler import disassemble_word
from npchip.assembler.sources import MAX_BYTES, split_lines
from npchip.base.files import read_bytes
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell
from npchip.machine.layout import to_frames
from npchip.program.model import SourceLine

Shown = Cell | int | None
"""Subject of the picture: a cell, a bank (its first address), or the exposed frame (None)."""


class Look:
    """A snapshot of a session. Its arrays have the shapes of those of `Chip`.

    Attributes:
        breakpoints: by address, whether one of those there is enabled.
    """

    def __init__(self, debugger: Debugger) -> None:
        chip = debugger.chip
        self.pc = chip.pc
        self.stack = chip.stack
        self.registers = chip.registers.copy()
        self.memory = chip.memory.copy()
        self.flags = {name: plane.copy() for name, plane in chip.flags.items()}
        self.active = chip.active
        self.frame = chip.frame
        self.executions = chip.executions
        self.frame_number = chip.frames_taken - 1
        self.cycles = chip.cycles
        self.frame_cycles = chip.frame_cycles
        self.instructions = chip.instructions
        self.outputs = debugger.outputs
        self.records = debugger.records
        self.stop = debugger.stop
        self.breakpoints: dict[int, bool] = {}
        for item in debugger.breakpoints.values():
            for address in item.condition.places if item.condition else ():
                self.breakpoints[address] = self.breakpoints.get(address, False) or item.enabled

    def pixels(self, shown: int | None) -> NDArray[np.uint8]:
        """Return a bank or the exposed frame as a picture: uint8, shape (rows, columns)."""
        if shown is None:
            if self.frame is not None:
                return self.frame
            return np.zeros(np.multiply(self.active.shape, 8), np.uint8)
        return to_frames(self.memory[shown : shown + 64])


class Row(NamedTuple):
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
        self._program, self._names = program, debugger.names
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
        return self._names.near(address)


def _text(file: str, source: tuple[SourceLine, ...]) -> list[tuple[int, str]]:
    """Return a file's lines with their numbers; if it has changed, only those with words."""
    known = {line.line: line.text for item in source for line in item.origins if line.file == file}
    try:
        lines = split_lines(read_bytes(Path(file), MAX_BYTES).decode("utf-8-sig").rstrip("\r\n"))
    except (OSError, UnicodeDecodeError):
        lines = []
    if all(number <= len(lines) and lines[number - 1] == text for number, text in known.items()):
        return list(enumerate(lines, 1))
    return sorted(known.items())


def title(file: str) -> str:
    """Return the title of a file's pane."""
    return PurePath(file).name or "disassembly"
