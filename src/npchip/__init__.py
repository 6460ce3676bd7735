"""npchip: an instruction-level, cycle-counting emulator of a vision chip.

from npchip import Chip, assemble

chip = Chip(assemble("trajectory"))
result = chip.run(frames)            # uint8, shape (T, 64, 80)
result.outputs["center_row"]         # shape (T,)
"""

from __future__ import annotations

TYPE_CHECKING = False  # typing takes long to import, and signals are seen to after this file
if TYPE_CHECKING:
    from typing import Any

    from npchip.assembler import AssemblyError, assemble, assemble_text
    from npchip.base.errors import InputError, NpchipError
    from npchip.machine import Machine, load_machine
    from npchip.program.model import Program
    from npchip.run.chip import Chip, Snapshot
    from npchip.run.result import RunResult

__version__ = "0.1.0"

__all__ = [
    "AssemblyError",
    "Chip",
    "InputError",
    "Machine",
    "NpchipError",
    "Program",
    "RunResult",
    "Snapshot",
    "assemble",
    "assemble_text",
    "load_machine",
]

# Imported on first use, so that `npchip --help` does not wait for NumPy.
_HOMES = {
    "AssemblyError": "assembler",
    "Chip": "run.chip",
    "InputError": "base.errors",
    "Machine": "machine",
    "NpchipError": "base.errors",
    "Program": "program",
    "RunResult": "run.result",
    "Snapshot": "run.chip",
    "assemble": "assembler",
    "assemble_text": "assembler",
    "load_machine": "machine",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'npchip' has no attribute '{name}'")
    from importlib import import_module  # noqa: PLC0415 - as typing

    return getattr(import_module(f"npchip.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
