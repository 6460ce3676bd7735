"""Chips and machines for tests, out of a few lines of source."""

from __future__ import annotations

from dataclasses import replace
from textwrap import dedent
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from npchip import Chip, assemble_text, load_machine
from npchip.isa import load_isa
from npchip.program.model import Output, Program

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip.machine import Machine
    from npchip.run.result import RunResult, Value

    Bytes = NDArray[np.uint8]
    Bits = NDArray[np.bool_]

FILE = "test.s"
"""The name of the tests' sources in messages."""

LOOP = """
.output first, 0, scalar
.output n, 1, scalar
        MOV r0, #3
        NOP
frame:  EXPOSE
        SAMPLE signal, 0
        LD r1, [0]
        MOV r2, r0
.delay: SUB r2, #1
        JANY NE, .delay
        CMP r3, r3
        OUT 1, r0
        ADD r0, #1
        JMP frame
"""
"""Frame k of a run loops 3 + k times, and sends that number."""


def machine_of(np_rows: int = 3, np_cols: int = 4, **changes: Any) -> Machine:
    """The default machine with another array, by default a small one, and other changes."""
    return replace(load_machine("default"), np_rows=np_rows, np_cols=np_cols, **changes)


def chip_of(
    source: str,
    machine: Machine | None = None,
    engine: Literal["reference", "wasm"] = "reference",
) -> Chip:
    """A chip with an assembled source; line 1 of `FILE` is its first."""
    machine = machine or machine_of()
    text = dedent(source).removeprefix("\n")
    return Chip(assemble_text(text, FILE, machine), machine, engine)


def word(instruction: str, **values: int | str) -> int:
    """Encode the first form of an instruction, whatever the assembler thinks of its place."""
    isa = load_isa()
    return isa.encode(isa.instructions[instruction].forms[0], values)


def raw_chip(*words: int, machine: Machine | None = None, outputs: tuple[Output, ...] = ()) -> Chip:
    """A chip with a raw ROM image, which no assembler has checked."""
    program = Program("raw", words, outputs=outputs)
    return Chip(program, machine or machine_of(), engine="reference")


def places(machine: Machine) -> tuple[Bytes, Bytes]:
    """Row and column numbers of all NPs."""
    rows, columns = np.indices(machine.geometry).astype(np.uint8)
    return rows, columns


def clip_of(frames: int, machine: Machine, seed: int = 5) -> Bytes:
    """Random frames of the size that a machine takes."""
    shape = (frames, machine.rows, machine.cols)
    return np.random.default_rng(seed).integers(0, 256, shape, np.uint8)


def state_of(chip: Chip) -> dict[str, Any]:
    """Everything that can be seen of a chip, in a form that can be compared."""
    return {
        "pc": chip.pc,
        "registers": chip.registers.tolist(),
        "flags": {name: flag.tolist() for name, flag in chip.flags.items()},
        "active": chip.active.tolist(),
        "memory": chip.memory.tolist(),
        "stack": chip.stack,
        "cycles": chip.cycles,
        "instructions": chip.instructions,
        "executions": chip.executions.tolist(),
        "frames_taken": chip.frames_taken,
    }


def summary(result: RunResult) -> dict[str, Any]:
    """A result in a form that can be compared."""
    return {
        "status": result.status,
        "error": result.error,
        "setup": (result.setup.cycles, result.setup.instructions, result.setup.complete),
        "cycles": result.frame_cycles.tolist(),
        "instructions": result.frame_instructions.tolist(),
        "last_complete": result.last_complete,
        "outputs": {
            name: [np.array(result.value(name, k)).tolist() for k in range(result.frames)]
            for name in result.outputs
        },
    }


def plane(value: Value) -> list[list[int]]:
    """The numbers of a plane."""
    assert isinstance(value, np.ndarray)
    assert value.dtype == np.uint8
    numbers: list[list[int]] = value.tolist()
    return numbers


def failure(chip: Chip, **options: Any) -> tuple[str, int | None, int | None]:
    """Run into a failure: code, address and source line."""
    result = chip.run(**options)
    assert result.status == "failed"
    assert result.error is not None
    assert str(result.error).endswith(f"[{result.error.code}]")
    return result.error.code, result.error.address, result.error.line
