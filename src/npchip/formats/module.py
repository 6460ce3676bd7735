"""Programs as WebAssembly modules that any host can run, as docs/module.md specifies them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final

from npchip.base.errors import InputError
from npchip.engines.base import TrapError
from npchip.engines.traps import trap_of_effect, trap_of_word
from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.encode import custom_section
from npchip.engines.wasm.emit.helpers import DRAIN, RECEIVE, REFILL, TICK
from npchip.engines.wasm.emit.layout import Layout
from npchip.engines.wasm.translate.steps import Block, TooLargeError
from npchip.engines.wasm.translate.summary import MASKS, SAME
from npchip.engines.wasm.translation import Stops, Translation, translate
from npchip.isa import Isa
from npchip.isa.ir import CARRY, ZERO
from npchip.machine import Machine
from npchip.program.graph import RESET
from npchip.program.model import Program

if TYPE_CHECKING:  # a module is made where there is no NumPy
    import numpy as np
    from numpy.typing import NDArray

VERSION: Final = 1
"""Version of the description; a change that breaks a host gets a new one."""
DESCRIPTION: Final = "npchip"
STEPPING: Final = "npchip.step"
_WORDS: Final = {
    "position": at.POSITION,
    "available": at.AVAILABLE,
    "log_end": at.LOG_END,
    "data_end": at.DATA_END,
    "conversions": at.CONVERSIONS,
    "frame": at.FRAME,
    "closed": at.CLOSED,
}
_LONGS: Final = {
    "cycles": at.CYCLES,
    "instructions": at.INSTRUCTIONS,
    "check": at.CHECK,
    "first_check": at.FIRST_CHECK,
    "taken": at.TAKEN,
}

Memory = Sequence[tuple[int, "Iterable[bytes] | NDArray[np.uint8]"]]
"""Addresses in the NPs' memory, each with planes from there on: bytes row by row, or uint8 of shape
(n, NP rows, NP columns)."""


def to_module(program: Program, machine: Machine, isa: Isa, memory: Memory = ()) -> bytes:
    """Return a program as a module, which holds a second one that can stop before every step.

    Args:
        program: the program.
        machine: the machine.
        isa: the program's instruction set.
        memory: what the NPs' memory holds at reset, where it is not 0, with what the program's
            ``.memory`` lines say: `npchip.frames.memory.initial_memory` returns both.

    Raises:
        InputError: NP116, the program cannot be compiled, or an instruction needs npchip itself.
    """
    return with_stepping(run_form(program, machine, isa, memory), program, machine, isa, memory)


def run_form(program: Program, machine: Machine, isa: Isa, memory: Memory = ()) -> bytes:
    """Return the module without the stepping form, which takes most of the time.

    Args:
        program: see `to_module`.
        machine: see `to_module`.
        isa: see `to_module`.
        memory: see `to_module`.

    Raises:
        InputError: NP116, as `to_module`.
    """
    return _form("never", program, machine, isa, memory)


def with_stepping(
    run: bytes, program: Program, machine: Machine, isa: Isa, memory: Memory = ()
) -> bytes:
    """Return the whole module.

    Args:
        run: what `run_form` returns for the same program, machine and memory.
        program: see `to_module`.
        machine: see `to_module`.
        isa: see `to_module`.
        memory: see `to_module`.

    Raises:
        InputError: NP116, as `to_module`.
    """
    return run + custom_section(STEPPING, _form("step", program, machine, isa, memory))


def _form(stops: Stops, program: Program, machine: Machine, isa: Isa, memory: Memory) -> bytes:
    begin = dict.fromkeys(range(MASKS), SAME)
    content = _content(Layout(machine), memory)
    try:
        made = translate(program, machine, isa, RESET, begin, stops=stops, content=content)
    except TooLargeError as error:
        raise InputError("NP116", f"{program.name} cannot be a module: {error}") from None
    exits = _Exits(program, machine, isa)
    return made.binary + custom_section(DESCRIPTION, _description(made, program, machine, exits))


def _content(where: Layout, memory: Memory) -> list[tuple[int, bytes]]:
    return [
        (where.memory + number * where.stride, memoryview(plane).tobytes())
        for address, planes in memory
        for number, plane in enumerate(planes, address)
    ]


def _description(made: Translation, program: Program, machine: Machine, exits: _Exits) -> bytes:
    where = made.layout
    described = {
        "version": VERSION,
        "program": program.name,
        "machine": machine.name,
        "form": "step" if made.stops == "step" else "run",
        "np_rows": machine.np_rows,
        "np_cols": machine.np_cols,
        "memory_bytes": machine.memory_bytes,
        "mask_depth": machine.mask_depth,
        "outputs": [{"name": o.name, "port": o.port, "kind": o.kind} for o in program.outputs],
        "requests": {"refill": REFILL, "tick": TICK, "drain": DRAIN, "receive": RECEIVE},
        "words": _WORDS,
        "longs": _LONGS,
        "state_end": where.facts,
        "stride": where.stride,
        "planes": {
            "registers": where.variable(0),
            "zero": where.variable(ZERO),
            "carry": where.variable(CARRY),
            "masks": where.variable(MASKS),
            "memory": where.memory,
            "received": where.received,
        },
        "frames": {
            "bytes": where.frame_bytes,
            "first": where.first_frame,
            "ring": where.frames,
            "capacity": where.ring,
        },
        "records": where.records,
        "log": where.log,
        "data": where.data,
        "pictures": where.pictures if where.assembles else None,
        "sites": [
            {"address": site.address, "port": site.port, "planes": planes}
            for site, planes in made.sites
        ],
        "blocks": [_block(block, exits) for block in made.blocks],
    }
    return json.dumps(described, separators=(",", ":")).encode()


def _block(block: Block, exits: _Exits) -> dict[str, Any]:
    place = block.first.place
    described: dict[str, Any] = {"address": place.address}
    if place.stack:
        described["stack"] = place.stack
    if place.depth:
        described["depth"] = place.depth
    if block.exposes:
        described["exposes"] = True
    if block.port is not None:
        described["port"] = block.port
    if block.leaves:
        described["exit"] = exits.describe(block)
    return described


class _Exits:
    """Describes the instructions that end a run."""

    def __init__(self, program: Program, machine: Machine, isa: Isa) -> None:
        self._machine = machine
        self._program = program
        self._words = program.decoded(isa)

    def describe(self, block: Block) -> dict[str, Any]:
        """Describe the instruction at which a block leaves.

        Raises:
            InputError: NP116, it does not end every run that reaches it.
        """
        place, words = block.first.place, self._words
        word = words[place.address] if place.address < len(words) else None
        if word is None:
            return _failed(trap_of_word(self._program.words, place.address))
        form = word.form
        conditional = form.guarded or (form.flow is not None and form.flow.guard is not None)
        if not (conditional or form.inputs or form.exposes or len(form.statements) > 1):
            for effect in form.effects:
                if effect == "halt":
                    return {"status": "halted", "cycles": self._machine.cycles(form.timing)}
                if trap := trap_of_effect(effect, place, self._machine):
                    return _failed(trap)
        raise InputError(
            "NP116",
            f"{self._program.name} cannot be a module: the instruction at address "
            f"{place.address} may end the run or go on, which only npchip can decide",
        )


def _failed(trap: TrapError) -> dict[str, Any]:
    return {"status": "failed", "code": trap.code, "message": str(trap)}
