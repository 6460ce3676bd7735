"""An assembled program: all that the engines see of a source text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

if TYPE_CHECKING:
    from npchip.isa import Decoded, Isa
    from npchip.machine import Machine

OutputKind = Literal["scalar", "scalar16", "list", "plane", "picture"]
"""Names of the kinds of outputs; `npchip.run.outputs` says what they are."""
OUTPUT_KINDS: tuple[OutputKind, ...] = get_args(OutputKind)

PORTS = 16
"""Number of output ports (decision: a 4-bit port field)."""


class SourceLine(NamedTuple):
    """Where a word came from.

    Attributes:
        file: the source file.
        line: 1-based number in it.
        text: the line.
        expanded_from: for a line of a macro or repetition, the line that asked for it.
    """

    file: str
    line: int
    text: str
    expanded_from: SourceLine | None = None

    @property
    def written_at(self) -> SourceLine:
        """The line outside all macros and repetitions that led to this one."""
        line = self
        while line.expanded_from is not None:
            line = line.expanded_from
        return line

    @property
    def origins(self) -> tuple[SourceLine, ...]:
        """This line, and those that it was expanded from, the innermost first."""
        lines = [self]
        while lines[-1].expanded_from is not None:
            lines.append(lines[-1].expanded_from)
        return tuple(lines)


class Output(NamedTuple):
    """A named output: what is sent to `port` during a frame, read as `kind`."""

    name: str
    port: int
    kind: OutputKind


class Budget(NamedTuple):
    """Limits that the source sets itself; None where it sets none.

    Attributes:
        words: most words that the program may have (checked by the assembler).
        cycles: most cycles that the worst frame may take under the default machine.
    """

    words: int | None = None
    cycles: int | None = None


@dataclass(frozen=True)
class Program:
    """Words for the program ROM and what the tools need to speak of them.

    Attributes:
        name: by default the source file's stem.
        words: 16-bit words, address 0 first.
        source: for each word the line it came from; empty for a raw ROM image.
        labels: address of every label.
        symbols: value of every ``.equ``, after ``--define``.
        registers: number of each register that a ``.reg`` names.
        outputs: named outputs in the order of declaration.
        budget: limits set in the source.
        loops: least and most passes of loops that the source states, by the address of their
            first instruction.
        geometry: (NP rows, NP columns) that it was assembled for; None for a raw ROM image.
    """

    name: str
    words: tuple[int, ...]
    source: tuple[SourceLine, ...] = ()
    labels: Mapping[str, int] = field(default_factory=lambda: MappingProxyType({}))
    symbols: Mapping[str, int] = field(default_factory=lambda: MappingProxyType({}))
    registers: Mapping[str, int] = field(default_factory=lambda: MappingProxyType({}))
    outputs: tuple[Output, ...] = ()
    budget: Budget = field(default_factory=Budget)
    loops: Mapping[int, tuple[int, int]] = field(default_factory=lambda: MappingProxyType({}))
    geometry: tuple[int, int] | None = None

    def place(self, address: int) -> SourceLine | None:
        """Source line of the word at `address`, if the program carries its source."""
        return self.source[address] if 0 <= address < len(self.source) else None

    def decoded(self, isa: Isa) -> tuple[Decoded | None, ...]:
        """Return all words taken apart; None for an undefined one, which is a trap."""
        return tuple(map(isa.decode, self.words))

    def cycles(self, machine: Machine, isa: Isa) -> tuple[int, ...]:
        """Return the cycles of one execution of each word; 0 for an undefined one."""
        return tuple(machine.cycles(word.form.timing) if word else 0 for word in self.decoded(isa))
