"""An assembled program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

from npchip.base.frozen import FrozenMap

if TYPE_CHECKING:
    from npchip.isa import Decoded, Isa
    from npchip.machine import Machine

OutputKind = Literal["scalar", "scalar16", "list", "plane", "picture"]
"""Kinds of outputs; `npchip.run.outputs` describes them."""
OUTPUT_KINDS: tuple[OutputKind, ...] = get_args(OutputKind)

Form = Literal["integer", "list", "array"]
"""Type of the value of an output in one frame: an integer, which all NPs send byte by byte; a list
of such bytes; or an array, uint8 of shape (rows, columns), of which each NP sends a part."""
_FORMS: dict[OutputKind, Form] = {
    "scalar": "integer",
    "scalar16": "integer",
    "list": "list",
    "plane": "array",
    "picture": "array",
}
OUTPUT_FORMS: Mapping[OutputKind, Form] = FrozenMap(_FORMS)
"""The form of each kind of output."""

MAX_WORDS = 1024
"""Most words of a program: twice those of the chip (thesis), for studies of a larger ROM."""

MAX_AHEAD = 1000
"""Most frames ahead that a position may be for (decision)."""

PORTS = 16
"""Number of output ports (decision: a 4-bit port field)."""


class SourceLine(NamedTuple):
    """The source line of a word.

    Attributes:
        file: source file.
        line: number of the line, from 1.
        text: text of the line.
        expanded_from: for a line of a macro or repetition, the line that expanded it.
        copy: tells apart copies that are otherwise equal: those of a repetition, and of a file
            that is included again.
    """

    file: str
    line: int
    text: str
    expanded_from: SourceLine | None = None
    copy: int = 0

    @property
    def code(self) -> str:
        """The text without its comment, with single blanks."""
        return " ".join(self.text.partition(";")[0].split())

    @property
    def written_at(self) -> SourceLine:
        """The line outside all macros and repetitions that this one comes from."""
        return self.origins[-1]

    @property
    def origins(self) -> tuple[SourceLine, ...]:
        """This line and the lines that expanded it, the innermost first."""
        lines = [self]
        while lines[-1].expanded_from is not None:
            lines.append(lines[-1].expanded_from)
        return tuple(lines)


class Output(NamedTuple):
    """A named output: the sends to `port` in a frame, interpreted as `kind`."""

    name: str
    port: int
    kind: OutputKind


class Position(NamedTuple):
    """Two outputs that are a place in the frame, `ahead` frames after the one that sends them."""

    row: str
    col: str
    ahead: int = 0


class Budget(NamedTuple):
    """Limits that the source sets; None for no limit.

    Attributes:
        words: number of words of the program (checked by the assembler).
        cycles: cycles of the longest frame on the default machine.
    """

    words: int | None = None
    cycles: int | None = None


class Requirement(NamedTuple):
    """A condition on the machine, in the names of its geometry, and the reason for it."""

    condition: str
    reason: str


class Initial(NamedTuple):
    """Bytes that a ``.memory`` line puts into the NPs' memories before a run.

    Attributes:
        address: the first byte.
        file: the absolute path of a ``.npy`` file; empty where the bytes are known.
        place: file and line of the directive, for messages.
        planes: a byte of each NP, row by row, for each address; None: they are in the file.
    """

    address: int
    file: str
    place: str
    planes: tuple[bytes, ...] | None = None


@dataclass(frozen=True, repr=False)
class Program:
    """The words of the program ROM, with their names and source.

    Attributes:
        name: by default the source file's stem.
        words: 16-bit words, address 0 first.
        source: source line of each word; empty for a raw ROM image.
        labels: addresses of the labels.
        symbols: values of the ``.equ`` constants, after ``--define``.
        registers: numbers of the registers that ``.reg`` names.
        outputs: named outputs in the order of declaration.
        positions: the outputs that are a place, none for the same number of frames ahead.
        budget: limits set in the source.
        loops: least and most passes of the ``.loop`` lines, by the address of the loop's first
            instruction.
        requirements: what the ``.require`` lines ask of a machine.
        geometry: (NP rows, NP columns) that it was assembled for; None for a raw ROM image.
        memory: what the ``.memory`` lines put into the NPs' memories.
    """

    name: str
    words: tuple[int, ...]
    source: tuple[SourceLine, ...] = ()
    labels: Mapping[str, int] = field(default_factory=FrozenMap, hash=False)
    symbols: Mapping[str, int] = field(default_factory=FrozenMap, hash=False)
    registers: Mapping[str, int] = field(default_factory=FrozenMap, hash=False)
    outputs: tuple[Output, ...] = ()
    budget: Budget = field(default_factory=Budget)
    loops: Mapping[int, tuple[int, int]] = field(default_factory=FrozenMap, hash=False)
    requirements: tuple[Requirement, ...] = ()
    positions: tuple[Position, ...] = ()
    geometry: tuple[int, int] | None = None
    memory: tuple[Initial, ...] = ()

    def __repr__(self) -> str:
        return f"<Program {self.name!r}: {len(self.words)} words, {len(self.outputs)} outputs>"

    def place(self, address: int) -> SourceLine | None:
        """Return the source line of the word at `address`; None if the source is unknown."""
        return self.source[address] if 0 <= address < len(self.source) else None

    @cached_property
    def label_names(self) -> Mapping[int, str]:
        """The first label of each address that has one."""
        return {address: name for name, address in reversed([*self.labels.items()])}

    def decoded(self, isa: Isa) -> tuple[Decoded | None, ...]:
        """Return the decoded words; None for an undefined one, which is a trap."""
        return tuple(map(isa.decode, self.words))

    def cycles(self, machine: Machine, isa: Isa) -> tuple[int, ...]:
        """Return the cycles of each word; 0 for an undefined one."""
        return tuple(machine.cycles(word.form.timing) if word else 0 for word in self.decoded(isa))
