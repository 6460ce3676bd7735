"""The programs of ``asm/``, assembled and compiled once in a process."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from npchip import Chip, assemble

if TYPE_CHECKING:
    from collections.abc import Mapping

    from npchip import Machine, Program

ASM = Path(__file__).parents[2] / "asm"


def assembled(
    name: str, machine: Machine | str = "default", defines: Mapping[str, int] | None = None
) -> Program:
    """Return a program of ``asm/``."""
    return _program(name, machine, tuple((defines or {}).items()))


def chip_with(
    name: str, machine: Machine | str = "default", defines: Mapping[str, int] | None = None
) -> Chip:
    """Return a chip with a program of ``asm/``, as after reset.

    A later call with the same arguments returns the same chip.
    """
    chip = _chip(name, machine, tuple((defines or {}).items()))
    chip.reset()
    return chip


@cache
def _program(name: str, machine: Machine | str, defines: tuple[tuple[str, int], ...]) -> Program:
    return assemble(ASM / f"{name}.s", machine, dict(defines))


@cache
def _chip(name: str, machine: Machine | str, defines: tuple[tuple[str, int], ...]) -> Chip:
    return Chip(_program(name, machine, defines), machine)
