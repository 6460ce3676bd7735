"""Modules of the compiled engine, as far as tests may know them: their size and shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from npchip import assemble_text
from npchip.engines.wasm.translate.summary import MASKS, SAME
from npchip.engines.wasm.translation import translate
from npchip.isa import load_isa
from npchip.program.graph import Place

if TYPE_CHECKING:
    from npchip.isa import Isa
    from npchip.machine import Machine


@dataclass(frozen=True)
class Compiled:
    """The module of a program that begins after reset.

    Attributes:
        size: bytes of the module.
        blocks: for each block of code the number of its instructions, copies included.
        branches: how many blocks lead to two others.
        loops: how many blocks lead to themselves.
    """

    size: int
    blocks: tuple[int, ...]
    branches: int
    loops: int

    @property
    def instructions(self) -> int:
        """Instructions of all blocks, each copy counted."""
        return sum(self.blocks)


def compiled(source: str, machine: Machine, isa: Isa | None = None) -> Compiled:
    """Assemble and translate a source."""
    program = assemble_text(source, "test.s", machine, isa=isa)
    begin = dict.fromkeys(range(MASKS), SAME)
    made = translate(program, machine, isa or load_isa(), Place(0), begin)
    return Compiled(
        len(made.binary),
        tuple(len(block.steps) for block in made.blocks),
        sum(len(block.after) == 2 for block in made.blocks),
        sum(block.number in block.after for block in made.blocks),
    )
