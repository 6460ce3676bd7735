"""The ALU, the masks and the links of the array in plain integers, from the words of the draft.

Nothing here comes from the instruction-set file. Masks are kept as a stack of sets of NPs, not
as the chip's activity counters.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

REGISTERS = 16
Position = tuple[int, int]


def alu(name: str, a: int, b: int, z: bool, c: bool) -> tuple[int, bool, bool]:
    """One ALU instruction in one NP.

    Args:
        name: mnemonic.
        a: the destination register.
        b: the other operand; for shifts the number of bits.
        z: flag Z before.
        c: flag C before.

    Returns:
        The destination register, Z and C afterwards.
    """
    match name:
        case "MOV":
            return b, z, c
        case "ADD":
            return (a + b) % 256, (a + b) % 256 == 0, a + b > 255
        case "ADC":
            total = a + b + c
            return total % 256, z and total % 256 == 0, total > 255
        case "SUB":
            return (a - b) % 256, a == b, a < b
        case "SBC":
            rest = a - b - c
            return rest % 256, z and rest % 256 == 0, rest < 0
        case "CMP":
            return a, a == b, a < b
        case "AND":
            both = sum(1 << n for n in range(8) if (a >> n) % 2 and (b >> n) % 2)
            return both, both == 0, c
        case "OR":
            either = sum(1 << n for n in range(8) if (a >> n) % 2 or (b >> n) % 2)
            return either, either == 0, c
        case "SHL":
            wide = a * 2**b
            return wide % 256, wide % 256 == 0, (wide // 256) % 2 == 1
        case "SHR":
            return a // 2**b, a // 2**b == 0, (a // 2 ** (b - 1)) % 2 == 1
        case "RCR":
            wide = a + 256 * c
            return wide // 2, wide // 2 == 0, wide % 2 == 1
    raise ValueError(name)


def condition(name: str, z: bool, c: bool) -> bool:
    """Return True if flags meet a condition (unsigned comparisons)."""
    return {"EQ": z, "NE": not z, "LO": c, "HS": not c, "HI": not (c or z), "LS": c or z}[name]


_STEP = {"north": (-1, 0), "south": (1, 0), "west": (0, -1), "east": (0, 1)}
_OPERAND = re.compile(r"[\w#]+")


@dataclass
class Processor:
    """Registers, flags and memory of one NP."""

    registers: list[int]
    z: bool = False
    c: bool = False
    memory: list[int] = field(default_factory=lambda: [0] * 256)


class Array:
    """An array of NPs that executes source lines of straight programs, one at a time.

    Args:
        processors: by (row, column).
    """

    def __init__(self, processors: dict[Position, Processor]) -> None:
        self.processors = processors
        self.active = set(processors)
        self._outer: list[set[Position]] = []  # who was active before each open WHERE

    def execute(self, line: str) -> None:
        """Execute one line, such as ``ADD r1, #5``, ``WHERE LO`` or ``LD r3, [r2 + 64]``."""
        name, *operands = _OPERAND.findall(line)
        match name:
            case "WHERE":
                self._outer.append(self.active)
                self.active = {at for at in self.active if self._meets(at, operands[0])}
            case "ELSE":
                self.active = self._outer[-1] - self.active
            case "END":
                self.active = self._outer.pop()
            case "NBR":
                self._link(*operands)
            case _:
                for at in self.active:
                    self._alone(name, operands, at)

    def _meets(self, at: Position, name: str) -> bool:
        processor = self.processors[at]
        return condition(name, processor.z, processor.c)

    def _link(self, to: str, source: str, direction: str) -> None:
        down, right = _STEP[direction]
        held = {at: np.registers[_number(source)] for at, np in self.processors.items()}
        for row, column in self.active:
            value = held.get((row + down, column + right), 0)
            self.processors[row, column].registers[_number(to)] = value

    def _alone(self, name: str, operands: list[str], at: Position) -> None:
        own = self.processors[at]
        registers = own.registers
        first = _number(operands[0])
        match name:
            case "ROW":
                registers[first] = at[0]
            case "COL":
                registers[first] = at[1]
            case "LD":
                registers[first] = own.memory[_address(operands[1:], registers)]
            case "ST":
                own.memory[_address(operands[:-1], registers)] = registers[_number(operands[-1])]
            case _:
                other = 0 if len(operands) == 1 else _value(operands[1], registers)
                registers[first], own.z, own.c = alu(name, registers[first], other, own.z, own.c)


def _number(operand: str) -> int:
    return int(operand.lstrip("r#"))


def _value(operand: str, registers: list[int]) -> int:
    return registers[_number(operand)] if operand[0] == "r" else _number(operand)


def _address(operands: list[str], registers: list[int]) -> int:
    return sum(_value(operand, registers) for operand in operands) % 256
