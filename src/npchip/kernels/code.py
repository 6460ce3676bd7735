"""Straight code on numbered values, and the registers that it gets.

Values are written down as if there were any number of registers. `Code.lines` then gives each
value a register from its first to its last use. Where there are too few, the value that is needed
last goes to the NPs' memory until then (Belady 1966).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

Register = int
"""A value of 8 bits, which gets a register."""


class NoRoomError(Exception):
    """Registers and memory hold fewer values than are needed at once."""


class Step(NamedTuple):
    """Lines of source with ``{0}``, ``{1}`` ... for values.

    Attributes:
        lines: what to write; a line may hold several instructions by way of a macro.
        operands: the values, in the order of their numbers.
        made: those of them that have no value before.
        changed: those that have another value afterwards.
        note: comment of the first line.
    """

    lines: tuple[str, ...]
    operands: tuple[Register, ...]
    made: frozenset[Register]
    changed: frozenset[Register]
    note: str


class Code:
    """A list of steps that grows, with a pointer that walks through the NPs' memory.

    Args:
        pointer: name of the register that holds it.

    Attributes:
        at: what it holds, less what it holds at the start of a pass of the loop.
    """

    def __init__(self, pointer: str) -> None:
        self.pointer = pointer
        self.at = 0
        self.steps: list[Step] = []
        self._values = 0
        self._note = ""

    def note(self, text: str) -> None:
        """Put a comment at the next step."""
        self._note = text

    def new(self) -> Register:
        """Return a value that nothing has made yet."""
        self._values += 1
        return self._values

    def add(
        self,
        lines: str | Sequence[str],
        *operands: Register,
        made: Sequence[Register] = (),
        changed: Sequence[Register] = (),
    ) -> None:
        """Append a step; the values it makes are among those that it changes."""
        texts = (lines,) if isinstance(lines, str) else tuple(lines)
        sets = frozenset(made), frozenset((*made, *changed))
        self.steps.append(Step(texts, operands, *sets, self._note))
        self._note = ""

    def move(self, at: int) -> None:
        """Let the pointer hold another number."""
        delta = at - self.at
        if delta:
            self.add(f"{'ADD' if delta > 0 else 'SUB'} {self.pointer}, #{abs(delta)}")
        self.at = at

    def address(self, wanted: int, bank: int) -> str:
        """Return an operand for a byte of memory, and move the pointer there if need be.

        Args:
            wanted: the address, less what the pointer holds at the start of a pass.
            bank: the one to use where the pointer has to move.
        """
        near = (wanted - self.at) % 256
        if near % 64:
            self.move(wanted - bank)
            near = bank
        return f"[{self.pointer} + {near}]" if near else f"[{self.pointer}]"

    def lines(self, registers: Sequence[str], spare: Sequence[int]) -> list[str]:
        """Give every value a register.

        Args:
            registers: names of those that are free.
            spare: addresses of memory for values that have to wait.

        Raises:
            NoRoomError: there is not enough memory for those that wait.
        """
        return _Allocation(self.steps, registers, spare).run()


class _Allocation:
    def __init__(
        self, steps: Sequence[Step], registers: Sequence[str], spare: Sequence[int]
    ) -> None:
        self._steps = steps
        self._free = list(reversed(registers))
        self._spare = list(reversed(spare))
        self._in: dict[Register, str] = {}
        self._kept: dict[Register, int] = {}
        self._uses: dict[Register, list[int]] = {}
        self._out: list[str] = []
        for number, step in reversed(list(enumerate(steps))):
            for value in set(step.operands):
                self._uses.setdefault(value, []).append(number)

    def run(self) -> list[str]:
        for step in self._steps:
            for value in dict.fromkeys(step.operands):
                if value not in self._in:
                    self._in[value] = self._register(step.operands)
                    if value not in step.made:
                        self._out.append(line(f"LD {self._in[value]}, [{self._kept[value]}]"))
            names = [self._in[value] for value in step.operands]
            for number, text in enumerate(step.lines):
                note = step.note if not number else ""
                self._out.append(line(text.format(*names), note))
            for value in step.changed:
                self._forget(value)
            for value in set(step.operands):
                self._uses[value].pop()
                if not self._uses[value]:
                    self._free.append(self._in.pop(value))
                    self._forget(value)
        return self._out

    def _register(self, busy: Sequence[Register]) -> str:
        if self._free:
            return self._free.pop()
        late = max(
            (value for value in self._in if value not in busy),
            key=lambda value: self._uses[value][-1],
        )
        register = self._in.pop(late)
        if late not in self._kept:
            if not self._spare:
                raise NoRoomError
            self._kept[late] = self._spare.pop()
            self._out.append(line(f"ST [{self._kept[late]}], {register}"))
        return register

    def _forget(self, value: Register) -> None:
        if value in self._kept:
            self._spare.append(self._kept.pop(value))


def line(text: str, note: str = "") -> str:
    """Lay out an instruction, with its comment."""
    indent = len(text) - len(text.lstrip())
    mnemonic, _, operands = text.strip().partition(" ")
    code = f"        {' ' * indent}{mnemonic:<{8 - indent}}{operands}".rstrip()
    return f"{code:<31} ; {note}" if note else code
