"""If-conversion: turns a branch around a few steps into a condition on them.

The steps are always executed, as in a masked region of their own, but change nothing where the
branch skipped them (Allen, Kennedy, Porterfield and Warren 1983). The blocks around the branch
become one, which compiles faster, and no branch can be predicted wrongly.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from npchip.engines.wasm.translate.graph import joined
from npchip.engines.wasm.translate.steps import Block
from npchip.isa import ir

_LONGEST: Final = 4
"""Most steps to convert: more would cost more than a wrong prediction."""
_PLAIN: Final = (ir.SetRegister, ir.SetFlag, ir.SetLocal)


def convert(blocks: Sequence[Block], longest: int) -> list[Block]:
    """Convert the branches that skip a few steps which only change registers and flags.

    Args:
        blocks: blocks of a program in reverse postorder, as `graph.build` makes them.
        longest: see `joined`.

    Returns:
        The blocks of the same program in reverse postorder.
    """
    found: dict[int, Block] = {}
    gone: set[int] = set()
    for block in blocks:
        side = _skipped(blocks, block)
        if side is None:
            continue
        body = blocks[block.after[side]]
        *before, branch = block.steps
        branch = replace(branch, guards=len(body.steps), when=not side)
        steps = [*before, branch, *body.steps]
        found[block.number] = Block(block.number, steps, list(body.after))
        gone.add(body.number)
    return joined([found.get(block.number, block) for block in blocks], longest, gone)


def _skipped(blocks: Sequence[Block], block: Block) -> int | None:
    """Return the side of a branch that only leads to its other side; None if there is none."""
    if len(block.after) == 2:
        for side, number in enumerate(block.after):
            body = blocks[number]
            alone = body.before == [block.number] and body.after == [block.after[1 - side]]
            if number > 0 and alone and _is_plain(body):  # block 0 is entered from outside too
                return side
    return None


def _is_plain(block: Block) -> bool:
    return len(block.steps) <= _LONGEST and all(
        step.decoded is not None
        and step.decoded.form.pure
        and all(isinstance(statement, _PLAIN) for statement in step.decoded.form.statements)
        for step in block.steps
    )
