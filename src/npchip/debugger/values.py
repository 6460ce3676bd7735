"""Quantities of a chip: values of every NP or of one, pixels, counters; and what writes them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

from npchip.isa import Decoded, Isa, ir
from npchip.program.model import Program

if TYPE_CHECKING:  # conditions are parsed where there is no NumPy
    from numpy.typing import NDArray

    from npchip import Chip
    from npchip.debugger.screen.look import Look
    from npchip.engines.state import Write

_PLANES: Final = {"register": "registers", "flag": "flags", "memory": "memory"}
_TEXTS: Final = {"register": "r{}", "flag": "{}", "memory": "mem[{}]", "active": "active"}


@dataclass(frozen=True)
class Cell:
    """A register, a flag, a byte of the memory, or the activity: a value in every NP.

    Attributes:
        kind: the kind of storage.
        index: number of the register, name of the flag, address of the byte.
    """

    kind: Literal["register", "flag", "memory", "active"]
    index: int | str = ""

    def plane(self, chip: Chip | Look) -> NDArray[Any]:
        """Return the values: uint8 or bool, shape (NP rows, NP columns).

        Those of a chip are live: writing to them is an edit.
        """
        if self.kind == "active":
            return chip.active
        plane: NDArray[Any] = getattr(chip, _PLANES[self.kind])[self.index]
        return plane

    def __str__(self) -> str:
        return _TEXTS[self.kind].format(self.index)


@dataclass(frozen=True)
class One:
    """A cell of one NP."""

    cell: Cell
    row: int
    column: int

    def value(self, chip: Chip) -> int:
        """Return the value; a flag is 0 or 1."""
        return int(self.cell.plane(chip)[self.row, self.column])

    def __str__(self) -> str:
        return f"np({self.row},{self.column}).{self.cell}"


@dataclass(frozen=True)
class Pixel:
    """A pixel of the exposed frame."""

    row: int
    column: int

    def value(self, chip: Chip) -> int:
        """Return the value; 0 before the first frame."""
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
"""Numbers of the chip as a whole. Frames count from 0; the frame is -1 before the first."""


@dataclass(frozen=True)
class Counter:
    """A number of the chip as a whole."""

    name: str

    def value(self, chip: Chip) -> int:
        """Return the value."""
        return COUNTERS[self.name](chip)

    def __str__(self) -> str:
        return self.name


Location = One | Pixel
"""A single value that instructions write."""

Quantity = Cell | Location | Counter
"""A value that conditions and commands can name."""


class Writers:
    """The instructions of a program that can write a quantity, found without running it.

    Args:
        program: the program. Undefined words write nothing.
        isa: its instruction set.

    Attributes:
        all: every address.
        exposes: addresses of the instructions that take a frame.
    """

    def __init__(self, program: Program, isa: Isa) -> None:
        self._decoded = {
            address: decoded
            for address, decoded in enumerate(program.decoded(isa))
            if decoded is not None
        }
        self.all = frozenset(range(len(program.words)))
        self.exposes = self._with_effect("expose")

    def of(self, quantity: Quantity) -> frozenset[int]:
        """Return the addresses of the instructions that may change a quantity; maybe too many."""
        match quantity:
            case Cell(kind="active"):
                return self._with_effect("mask_push", "mask_invert", "mask_pop")
            case Cell():
                return self._those(lambda decoded: _may_write(decoded, quantity))
            case One(cell=cell):
                return self.of(cell)
            case Pixel() | Counter(name="frame"):
                return self.exposes
            case Counter(name="calls"):
                return self._with_effect("call", "ret")
            case Counter():
                return self.all

    def sends_to(self, port: int) -> frozenset[int]:
        """Return the addresses of the instructions that send to a port."""
        return self._those(
            lambda decoded: any(
                ir.constant(effect.args[0], decoded.values) == port
                for name, effect in decoded.form.effects.items()
                if name == "output"
            )
        )

    def _with_effect(self, *names: str) -> frozenset[int]:
        return self._those(lambda decoded: any(name in decoded.form.effects for name in names))

    def _those(self, holds: Callable[[Decoded], bool]) -> frozenset[int]:
        return frozenset(address for address, item in self._decoded.items() if holds(item))


def _may_write(decoded: Decoded, cell: Cell) -> bool:
    values = decoded.values

    def writes(statement: ir.Statement) -> bool:
        match cell.kind, statement:
            case "register", ir.SetRegister(name=name):
                return values[name] == cell.index
            case "flag", ir.SetFlag(name=flag):
                return flag == cell.index
            case "memory", ir.Store(address=ir.Immediate(value=ir.Const() | ir.Field() as address)):
                return ir.constant(address, values) == cell.index
            case "memory", ir.Store():
                return True
            case "memory", ir.Effect(name="sample", args=(_, bank)):
                return 0 <= int(cell.index) - ir.constant(bank, values) < 64
        return False

    return any(map(writes, decoded.form.statements))


def wrote(write: Write, location: Location) -> bool:
    """Return whether a write of an instruction reached a location."""
    if isinstance(location, Pixel):
        return write.kind == "frame"
    at, cell = (location.row, location.column), location.cell
    if write.kind != cell.kind or (write.active is not None and not write.active[at]):
        return False
    index = write.index
    if isinstance(index, range):
        return cell.index in index
    return bool((index if isinstance(index, int | str) else index[at]) == cell.index)
