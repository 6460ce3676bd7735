"""Events: one instruction each, and what it changed in the NPs that are looked at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from npchip.assembler import disassemble_word

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip.program.model import SourceLine
    from npchip.run.chip import Chip

NP = tuple[int, int]
"""Row and column of an NP."""


@dataclass(frozen=True)
class Change:
    """A register (``r3``), flag (``Z``, ``C``) or byte of memory (``mem[18]``) that was changed."""

    name: str
    before: int
    after: int


@dataclass(frozen=True)
class Seen:
    """The effect of an instruction on one NP.

    Attributes:
        np: row and column.
        active: whether it reached the NP.
        changes: what differs afterwards: registers, then flags, then memory.
    """

    np: NP
    active: bool
    changes: tuple[Change, ...]


@dataclass(frozen=True)
class Event:
    """An executed instruction.

    Attributes:
        cycle: cycles since reset when it began.
        cycles: how many it took.
        frame: of its expose, 0-based, since reset; None before the first.
        address: of its word.
        place: its source line, if the program carries its source.
        text: the instruction, from its word.
        seen: for each NP that is looked at.
    """

    cycle: int
    cycles: int
    frame: int | None
    address: int
    place: SourceLine | None
    text: str
    seen: tuple[Seen, ...]


def record(chip: Chip, nps: Sequence[NP]) -> Iterator[Event]:
    """Step a chip, which has its frames, and yield what happens until it stops.

    Args:
        chip: goes on from where it stands.
        nps: NPs to look at, each inside the array.

    Raises:
        TrapError: an instruction cannot be executed; the events before it were yielded.
    """
    program, isa = chip.program, chip.isa
    names = {address: name for name, address in program.labels.items()}
    texts = [disassemble_word(word, isa, names) or "undefined" for word in program.words]
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
                    Change(_name(place), int(before[place, number]), int(after[place, number]))
                    for place in np.flatnonzero(differs[:, number]).tolist()
                )
                if differs[:, number].any()
                else (),
            )
            for number, item in enumerate(nps)
        )
        frame = chip.frames_taken - 1 if chip.frames_taken else None
        yield Event(
            cycle,
            chip.cycles - cycle,
            frame,
            address,
            program.place(address),
            texts[address],
            seen,
        )
        if stop:
            return


def _view(chip: Chip, rows: NDArray[np.intp], cols: NDArray[np.intp]) -> NDArray[np.uint8]:
    """Registers, flags and memory of some NPs, a column for each: a copy."""
    flags = [chip.flags[name][rows, cols].view(np.uint8)[np.newaxis] for name in ("Z", "C")]
    return np.concatenate([chip.registers[:, rows, cols], *flags, chip.memory[:, rows, cols]])


def _name(place: int) -> str:
    if place < 16:
        return f"r{place}"
    return ("Z", "C")[place - 16] if place < 18 else f"mem[{place - 18}]"
