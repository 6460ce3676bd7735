"""The names and source lines of a program that conditions and commands may use."""

from __future__ import annotations

import re
from functools import cached_property
from pathlib import PurePath

from npchip.debugger.values import Writers
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.model import Program, SourceLine


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

    @cached_property
    def files(self) -> tuple[str, ...]:
        """The source files with instructions, in the order of the program."""
        lines = (item for line in self.program.source for item in line.origins)
        return tuple(dict.fromkeys(item.file for item in lines))

    def lines(self, file: str) -> list[int]:
        """Return the numbers of the lines of a file that have instructions, in order."""
        source = self.program.source
        return sorted({item.line for line in source for item in line.origins if item.file == file})

    def near(self, address: int) -> str:
        """Return the last label at or before an address, with the distance to it."""
        labels = [(at, name) for name, at in self.program.labels.items() if at <= address]
        if not labels:
            return str(address)
        at, name = max(labels)
        return name if at == address else f"{name}+{address - at}"

    def line_starts(self, file: str, number: int) -> list[int]:
        """Return the first address of each copy of a source line."""
        first: dict[SourceLine, int] = {}
        for address, line in enumerate(self.program.source):
            for item in line.origins:
                if (item.file, item.line) == (file, number):
                    first.setdefault(item, address)
        return sorted(set(first.values()))

    @property
    def main_file(self) -> str:
        """The file of the program's name, or that of its first word."""
        files = [line.written_at.file for line in self.program.source]
        return next((file for file in files if PurePath(file).stem == self.program.name), files[0])

    def line_called(self, file: str, number: int) -> str:
        """Return a line with instructions as text for a condition that stops at all its copies.

        A label comes first, as it outlives changes of the program.
        """
        starts = self.line_starts(file, number)
        for name, at in self.program.labels.items():
            if [at] == starts:
                return name
        parts = PurePath(file).parts
        endings = (str(PurePath(*parts[-count:])) for count in range(1, len(parts)))
        short = next((end for end in endings if self.files_called(end) == [file]), file)
        if '"' in short or not short.isprintable():  # no text of the language
            return str(starts[0])
        plain = re.fullmatch(r"[A-Za-z_.][\w./]*", short, re.ASCII)
        return f"{short}:{number}" if plain else f'"{short}":{number}'

    def files_called(self, name: str) -> list[str]:
        """Return the source files with a name, which may lack their first folders."""
        found = [file for file in self.files if is_file(file, name)]
        return [name] if name in found else found


def is_file(path: str, ending: str) -> bool:
    """Return whether a path ends with the parts of another."""
    parts, end = PurePath(path).parts, PurePath(ending).parts
    return parts[-len(end) :] == end
