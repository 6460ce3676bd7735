"""Decides whether each caller gets its own copy of a routine, or all callers share one."""

from __future__ import annotations

from contextlib import suppress
from typing import Any, Final, NamedTuple

from npchip.engines.wasm.translate.graph import build
from npchip.engines.wasm.translate.if_conversion import convert
from npchip.engines.wasm.translate.steps import Block, TooLargeError
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.graph import Place
from npchip.program.model import Program

MOST: Final = 14_000
"""Highest cost (`Block.cost`) of a program with copied routines and unrolled loops."""
LITTLE: Final = 0.9
"""Routines are shared if that costs less than this part of copies, as the program runs slower."""


class Flow(NamedTuple):
    """A program's control flow.

    Attributes:
        blocks: blocks in reverse postorder.
        shared: whether there is one copy of each routine; places have no stack then.
    """

    blocks: list[Block]
    shared: bool


def choose(
    program: Program, machine: Machine, isa: Isa, entry: Place, longest: int, *, stacks: bool
) -> Flow:
    """Return the flow of the fastest code, unless it takes too long to translate.

    Args:
        program: the program.
        machine: its limits and cycles.
        isa: the instruction set.
        entry: place where execution begins.
        longest: most steps of a block; with 1, branches are not converted.
        stacks: whether every place must have a stack.

    Raises:
        TooLargeError: see `build`.
    """

    def made(**options: Any) -> list[Block]:
        blocks = build(program, machine, isa, entry, longest, **options)
        return convert(blocks, longest) if longest > 1 else blocks

    if stacks:
        return Flow(made(), shared=False)
    copied: list[Block] = []
    with suppress(TooLargeError):
        copied = made(budget=2 * MOST)
        has_calls = len({block.first.place.stack for block in copied}) > 1
        if _cost(copied) <= MOST or not has_calls:
            return Flow(copied, shared=False)
    with suppress(TooLargeError):
        shared = made(shared=True)
        if not copied or _cost(shared) < LITTLE * _cost(copied):
            return Flow(shared, shared=True)
    return Flow(copied or made(), shared=False)


def _cost(blocks: list[Block]) -> int:
    return sum(block.cost for block in blocks)
