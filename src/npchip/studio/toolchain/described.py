"""A program as the page knows it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from npchip.assembler.definitions import Definition
from npchip.assembler.disassembler import disassemble_word, registers_of
from npchip.isa import Isa
from npchip.language.moves import moves
from npchip.language.places import place
from npchip.machine import Machine
from npchip.program.bounds import static_view
from npchip.program.graph import TooManyPlacesError
from npchip.program.model import Program


class Assembled(NamedTuple):
    """A program for a machine, and the names that its source defines."""

    program: Program
    machine: Machine
    definitions: Sequence[Definition]


def described(
    program: Program, machine: Machine, definitions: Sequence[Definition], isa: Isa
) -> dict[str, Any]:
    """Return a ``ProgramInfo``."""
    labels = program.label_names
    cycles = program.cycles(machine, isa)
    return {
        "name": program.name,
        "words": [
            {
                "origins": [{"file": origin.file, "line": origin.line} for origin in line.origins],
                "text": disassemble_word(word, isa, labels, registers_of(program, address))
                or f".word 0x{word:04X}",
                "cycles": cycles[address],
                **_moves(word, isa),
            }
            for address, (word, line) in enumerate(zip(program.words, program.source, strict=True))
        ],
        "labels": dict(program.labels),
        "symbols": dict(program.symbols),
        "registers": dict(program.registers),
        "outputs": [output._asdict() for output in program.outputs],
        "definitions": [
            {"name": item.name, "kind": item.kind, "place": place(item.span), "text": item.text}
            for item in definitions
        ],
        "machine": {
            "name": machine.name,
            "summary": machine.summary,
            "np_rows": machine.np_rows,
            "np_cols": machine.np_cols,
            "memory_bytes": machine.memory_bytes,
            "mask_depth": machine.mask_depth,
            "rom_words": machine.rom_words,
        },
        "exposes": any(word is not None and word.form.exposes for word in program.decoded(isa)),
        "budgets": program.budget._asdict(),
        "bounds": None,  # see `bounds`
    }


def _moves(word: int, isa: Isa) -> dict[str, Any]:
    """Return what a ``Word`` has for the arrows of the array: nothing for most words."""
    decoded = isa.decode(word)
    found = moves(decoded) if decoded else ()
    return {"moves": [move._asdict() for move in found]} if found else {}


def bounds(program: Program, machine: Machine, isa: Isa) -> dict[str, int | None] | None:
    """Return the bounds of a frame's cycles; None if there are none. It may take seconds."""
    try:
        frame = static_view(program, machine, isa).frame
    except TooManyPlacesError:
        return None
    if frame is None:
        return None
    return {"least": frame.least, "most": None if math.isinf(frame.most) else int(frame.most)}
