"""The names and source lines of a program that conditions and commands may use."""

from __future__ import annotations

import re
from pathlib import PurePath

from npchip import Machine, Program
from npchip.debugger.values import Writers
from npchip.isa import Isa


class Names:
    """The names that a line may use.

    Attributes:
        program: the program: labels, constants, register names, outputs and source lines.
        machine: geometry and memory.
        writers: the instructions that can write each quantity.
    """

    def __init__(self, program: Program, machine: Machine, isa: Isa) -> None:
        self.program = program
        self.machine = machine
        self.writers = Writers(program, isa)

    def line_starts(self, file: str, number: int) -> list[int]:
        """Return the first address of each run of words that a source line gave."""
        addresses = [
            address
            for address, line in enumerate(self.program.source)
            if any(item.line == number and is_file(item.file, file) for item in line.origins)
        ]
        return [each for each in addresses if each - 1 not in addresses]

    @property
    def main_file(self) -> str:
        """The file of the program's name, or that of its first word."""
        files = [line.written_at.file for line in self.program.source]
        return next((file for file in files if PurePath(file).stem == self.program.name), files[0])

    def called(self, address: int) -> str:
        """Return an address as text for a condition that outlives changes of the program.

        A label comes first, then file and line, then the number.
        """
        for name, at in self.program.labels.items():
            if at == address:
                return name
        line = self.program.place(address)
        if line is not None and self.line_starts(line.file, line.line) == [address]:
            file = PurePath(line.file).name
            plain = re.fullmatch(r"[A-Za-z_.][\w.]*", file, re.ASCII)
            return f"{file}:{line.line}" if plain else f'"{file}":{line.line}'
        return str(address)


def is_file(path: str, ending: str) -> bool:
    """Return whether a path ends with the parts of another."""
    parts, end = PurePath(path).parts, PurePath(ending).parts
    return parts[-len(end) :] == end
