"""What can be looked at in a chip: a value of every NP, of one NP, a pixel, a counter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from npchip.isa import ir

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from npchip import Chip, Program
    from npchip.engines.state import Write
    from npchip.isa import Decoded, Isa


@dataclass(frozen=True)
class Cell:
    """A register, a flag, a byte of the memory, or the activity: a value in every NP.

    Attributes:
        kind: which of them.
        index: number of the register, name of the flag, address of the byte.
    """

    kind: Literal["register", "flag", "memory", "active"]
    index: int | str = ""

    def plane(self, chip: Chip) -> NDArray[Any]:
        """The values: uint8 or bool, shape (NP rows, NP columns); writing to it is an edit."""
        plane: NDArray[Any]
        match self.kind:
            case "register":
                plane = chip.registers[int(self.index)]
            case "flag":
                plane = chip.flags[str(self.index)]
            case "memory":
                plane = chip.memory[int(self.index)]
            case "active":
                plane = chip.active
        return plane

    def __str__(self) -> str:
        match self.kind:
            case "register":
                return f"r{self.index}"
            case "flag":
                return str(self.index)
            case "memory":
                return f"mem[{self.index}]"
            case "active":
                return "active"


@dataclass(frozen=True)
class One:
    """A cell of one NP."""

    cell: Cell
    row: int
    column: int

    def value(self, chip: Chip) -> int:
        """The value; a flag is 0 or 1."""
        return int(self.cell.plane(chip)[self.row, self.column])

    def __str__(self) -> str:
        return f"np({self.row},{self.column}).{self.cell}"


@dataclass(frozen=True)
class Pixel:
    """A pixel of the exposed frame."""

    row: int
    column: int

    def value(self, chip: Chip) -> int:
        """The value; 0 before the first frame."""
        frame = chip.frame
        return 0 if frame is None else int(frame[self.row, self.column])

    def __str__(self) -> str:
        return f"pixel({self.row},{self.column})"


COUNTERS: Final[Mapping[str, Callable[[Chip], int]]] = {
    "pc": lambda chip: chip.pc,
    "frame": lambda chip: chip.frames_taken - 1,
    "cycles": lambda chip: chip.cycles,
    "frame_cycles": lambda chip: chip.frame_cycles,
    "instructions": lambda chip: chip.instructions,
    "calls": lambda chip: len(chip.stack),
}
"""Numbers of the chip as a whole; the frame is counted from 0, and -1 before the first."""


@dataclass(frozen=True)
class Counter:
    """A number of the chip as a whole."""

    name: str

    def value(self, chip: Chip) -> int:
        """The value."""
        return COUNTERS[self.name](chip)

    def __str__(self) -> str:
        return self.name


Place = One | Pixel
"""What somebody can have written: one value in one place."""

Value = Cell | One | Pixel | Counter


class Writers:
    """Which instructions of a program can write what, found without running it.

    Args:
        program: whose words are looked at; undefined ones write nothing.
        isa: its instruction set.
    """

    def __init__(self, program: Program, isa: Isa) -> None:
        self._decoded = {
            address: decoded
            for address, decoded in enumerate(program.decoded(isa))
            if decoded is not None
        }
        self.all = frozenset(range(len(program.words)))
        self.exposes = self._with_effect("expose")

    def of(self, value: Value) -> frozenset[int]:
        """Addresses of the instructions that may change a value; perhaps too many."""
        match value:
            case Cell(kind="active"):
                return self._with_effect("mask_push", "mask_invert", "mask_pop")
            case Cell():
                return self._where(lambda decoded: _may_write(decoded, value))
            case One(cell=cell):
                return self.of(cell)
            case Pixel() | Counter(name="frame"):
                return self.exposes
            case Counter(name="calls"):
                return self._with_effect("call", "ret")
            case Counter():
                return self.all

    def sends_to(self, port: int) -> frozenset[int]:
        """Addresses of the instructions that send to a port."""
        return self._where(
            lambda decoded: any(
                ir.constant(effect.args[0], decoded.values) == port
                for name, effect in decoded.form.effects.items()
                if name == "output"
            )
        )

    def _with_effect(self, *names: str) -> frozenset[int]:
        return self._where(lambda decoded: any(name in decoded.form.effects for name in names))

    def _where(self, holds: Callable[[Decoded], bool]) -> frozenset[int]:
        return frozenset(address for address, item in self._decoded.items() if holds(item))


def _may_write(decoded: Decoded, cell: Cell) -> bool:
    for statement in decoded.form.statements:
        match statement:
            case ir.SetRegister(name=name) if cell.kind == "register":
                if decoded.values[name] == cell.index:
                    return True
            case ir.SetFlag(name=flag) if cell.kind == "flag":
                if flag == cell.index:
                    return True
            case ir.Store(address=ir.Immediate(value=ir.Const() | ir.Field() as address)):
                if cell.kind == "memory" and ir.constant(address, decoded.values) == cell.index:
                    return True
            case ir.Store() if cell.kind == "memory":
                return True
            case ir.Effect(name="sample", args=(_, bank)) if cell.kind == "memory":
                first = ir.constant(bank, decoded.values)
                if first <= int(cell.index) < first + 64:
                    return True
            case _:
                pass
    return False


def wrote(write: Write, place: Place) -> bool:
    """Whether a write that an instruction has made reached a place."""
    if isinstance(place, Pixel):
        return write.kind == "frame"
    at = place.row, place.column
    if write.kind != place.cell.kind or (write.active is not None and not write.active[at]):
        return False
    index, wanted = write.index, place.cell.index
    if isinstance(index, np.ndarray):
        return bool(index[at] == wanted)
    return wanted in index if isinstance(index, range) else index == wanted
