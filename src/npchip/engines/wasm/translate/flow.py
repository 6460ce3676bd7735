"""Which control flow a program is translated from: with copies of its routines, or without."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final

from npchip.engines.wasm.translate.graph import build
from npchip.engines.wasm.translate.if_conversion import convert
from npchip.engines.wasm.translate.steps import Block, TooLargeError
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.graph import Place
from npchip.program.model import Program

MOST: Final = 14_000
"""What blocks may cost (`Block.cost`) before something is done about it: some 70 ms."""
LITTLE: Final = 0.9
"""Part of the cost of copies: if sharing saves less, it is not worth a slower program."""


@dataclass(eq=False)
class Flow:
    """A program's control flow.

    Attributes:
        blocks: in reverse postorder.
        shared: whether there is one copy of each routine; places have no stack then.
    """

    blocks: list[Block]
    shared: bool


def choose(
    program: Program, machine: Machine, isa: Isa, entry: Place, longest: int, *, stacks: bool
) -> Flow:
    """Find the flow that is fast, unless it takes too long to translate.

    Args:
        program: the program.
        machine: its limits and cycles.
        isa: the instruction set.
        entry: where execution begins.
        longest: steps of a block; with 1 branches stay as they are.
        stacks: whether every place must have a stack.

    Raises:
        TooLargeError: see `build`.
    """

    def made(**how: Any) -> list[Block]:
        blocks = build(program, machine, isa, entry, longest, **how)
        return convert(blocks, longest) if longest > 1 else blocks

    if stacks:
        return Flow(made(), shared=False)
    copied: list[Block] = []
    with suppress(TooLargeError):
        copied = made(most=2 * MOST)
        if _cost(copied) <= MOST or _has_no_calls(copied):
            return Flow(copied, shared=False)
    with suppress(TooLargeError):
        shared = made(shared=True)
        if not copied or _cost(shared) < LITTLE * _cost(copied):
            return Flow(shared, shared=True)
    return Flow(copied or made(), shared=False)


def _cost(blocks: list[Block]) -> int:
    return sum(block.cost for block in blocks)


def _has_no_calls(blocks: list[Block]) -> bool:
    return len({block.first.place.stack for block in blocks}) == 1
