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
ODD = """; expect: odd
.macro  twice, rx
        ADD     rx, rx
.endm
.EQU    A, 'x' + '\\'' + 0x1_F / 0b1010_0101 % ~3
start:  .local: mov R15, #-1    ; comment ; more
        twice   r3
        SAMPLE  signal, SIGNAL
        JALL    cs, .local
        NBR     r1, r2, north
        .output picture, 3, picture
        .output words, 4, scalar16;
        .word   (1 << 3) | 4
"""
"""Every kind of word that editors colour, oddly written."""


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
