"""The program being debugged: the adapter's own request ``npchip/program``."""

from __future__ import annotations

from typing import Any

from npchip.dap.arguments import Arguments
from npchip.dap.session import Session
from npchip.language.moves import moves

Body = dict[str, Any]


def program(session: Session, _arguments: Arguments) -> Body:
    """Return names, the machine, and what each word takes from neighbours, as the studio has them.

    A client that draws the array needs it once, and pictures at each stop.
    """
    program, chip = session.debugger.program, session.debugger.chip
    machine = chip.machine
    decoded = program.decoded(chip.isa)
    found = [moves(word) if word else () for word in decoded]
    return {
        "name": program.name,
        "words": [{"moves": [move._asdict() for move in word]} if word else {} for word in found],
        "labels": dict(program.labels),
        "symbols": dict(program.symbols),
        "registers": dict(program.registers),
        "machine": {
            "name": machine.name,
            "np_rows": machine.np_rows,
            "np_cols": machine.np_cols,
            "memory_bytes": machine.memory_bytes,
        },
    }
