"""Events: executed instructions with their changes in chosen NPs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from npchip.assembler.disassembler import disassemble_word, registers_of
from npchip.base.frozen import FrozenMap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip.program.model import SourceLine
    from npchip.run.chip import Chip

NP = tuple[int, int]
"""Row and column of an NP."""


@dataclass(frozen=True)
class Change:
    """The change of a register (``r3``), flag (``Z``, ``C``) or byte of memory (``mem[18]``)."""

    name: str
    before: int
    after: int


@dataclass(frozen=True)
class Seen:
    """The effect of an instruction on one NP.

    Attributes:
        np: row and column.
        active: True if the NP was active.
        changes: changes of registers, then flags, then memory.
    """

    np: NP
    active: bool
    changes: tuple[Change, ...]


@dataclass(frozen=True)
class Event:
    """An executed instruction.

    Attributes:
        cycle: cycle since reset in which it began.
        cycles: number of cycles it took.
        frame: number of its frame since reset, 0-based; None before the first expose.
        address: address of its word.
        place: its source line, if the program carries its source.
        text: the instruction as disassembled text, with the source's names of registers.
        seen: the effect on each chosen NP.
        registers: these names, by number.
    """

    cycle: int
    cycles: int
    frame: int | None
    address: int
    place: SourceLine | None
    text: str
    seen: tuple[Seen, ...]
    registers: Mapping[int, str] = field(default_factory=FrozenMap)


def record(chip: Chip, nps: Sequence[NP]) -> Iterator[Event]:
    """Step a chip, from its present state until it stops, and yield each instruction.

    Args:
        chip: a chip that has its frames.
        nps: the chosen NPs, each inside the array.

    Raises:
        TrapError: an instruction cannot be executed; the events before it are yielded first.
    """
    program, isa = chip.program, chip.isa
    names = {address: name for name, address in program.labels.items()}
    registers = [registers_of(program, address) for address in range(len(program.words))]
    texts = [
        disassemble_word(word, isa, names, known) or "undefined"
        for word, known in zip(program.words, registers, strict=True)
    ]
    rows, cols = (np.array([item[axis] for item in nps], np.intp) for axis in (0, 1))
    while True:
        address, cycle, count = chip.pc, chip.cycles, chip.instructions
        before, active = _view(chip, rows, cols), chip.active
        stop = chip.step()
        if chip.instructions == count:
            return  # no frame left, or halted before
        after = _view(chip, rows, cols)
        differs = before != after
        seen = tuple(
            Seen(
                item,
                bool(active[item]),
                tuple(
                    Change(_name(row), int(before[row, number]), int(after[row, number]))
                    for row in np.flatnonzero(differs[:, number]).tolist()
                )
                if differs[:, number].any()
                else (),
            )
            for number, item in enumerate(nps)
        )
        frame = chip.frames_taken - 1 if chip.frames_taken else None
        place, text = program.place(address), texts[address]
        known = registers[address]
        yield Event(cycle, chip.cycles - cycle, frame, address, place, text, seen, known)
        if stop:
            return


def _view(chip: Chip, rows: NDArray[np.intp], cols: NDArray[np.intp]) -> NDArray[np.uint8]:
    """Return a copy of registers, flags and memory of some NPs, with a column for each NP."""
    flags = [chip.flags[name][rows, cols].view(np.uint8)[np.newaxis] for name in ("Z", "C")]
    return np.concatenate([chip.registers[:, rows, cols], *flags, chip.memory[:, rows, cols]])


def _name(row: int) -> str:
    if row < 16:
        return f"r{row}"
    return ("Z", "C")[row - 16] if row < 18 else f"mem[{row - 18}]"
