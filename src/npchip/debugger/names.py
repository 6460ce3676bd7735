"""The names and places of one program that conditions and commands may use."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING

from npchip.debugger.values import Writers

if TYPE_CHECKING:
    from npchip import Machine, Program
    from npchip.isa import Isa


@dataclass(frozen=True)
class Names:
    """The names that a line may use.

    Attributes:
        program: its labels, constants, register names, outputs and source lines.
        machine: geometry and memory.
        writers: which instructions write what.
    """

    program: Program
    machine: Machine
    writers: Writers

    @classmethod
    def of(cls, program: Program, machine: Machine, isa: Isa) -> Names:
        """The names of a program on a machine."""
        return cls(program, machine, Writers(program, isa))

    def line_starts(self, file: str, number: int) -> list[int]:
        """Addresses at which what a source line gave begins; macros and repetitions too."""
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
        """Return an address as a condition names it so that it survives changes of the program."""
        for name, at in self.program.labels.items():
            if at == address:
                return name
        line = self.program.place(address)
        if line is not None and self.line_starts(line.file, line.line) == [address]:
            file = PurePath(line.file).name
            plain = re.fullmatch(r"[A-Za-z_.][\w.]*", file, re.ASCII)
            return f"{file}:{line.line}" if plain else f'"{file}":{line.line}'
        return str(address)


def is_file(path: str, wanted: str) -> bool:
    """Return whether a path ends with a path that was written."""
    parts, end = PurePath(path).parts, PurePath(wanted).parts
    return parts[-len(end) :] == end
