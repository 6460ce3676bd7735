"""If-conversion: a branch around a few instructions becomes a condition on them.

What a branch may skip is executed always, but changes nothing where it would have been skipped,
as if it stood in a masked region of its own (Allen, Kennedy, Porterfield and Warren 1983). The
blocks around it become one, which is shorter to compile, and nothing is left to be predicted
wrongly: whether any NP has a bit of a search is anybody's guess.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from npchip.engines.wasm.translate.graph import joined
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.isa import ir

_LONGEST: Final = 4
"""Steps that may be executed in vain: longer ones would cost more than a wrong prediction."""
_MOST: Final = 80
"""Branches of a program up to which they are converted: more would take too long to compile."""
_PLAIN: Final = (ir.SetRegister, ir.SetFlag, ir.SetLocal)


def convert(blocks: Sequence[Block], longest: int) -> list[Block]:
    """Convert the branches that skip a few steps which only change registers and flags.

    Args:
        blocks: of a program, in reverse postorder, as `graph.build` makes them.
        longest: see `joined`.

    Returns:
        The blocks of the same program in reverse postorder.
    """
    found: dict[int, Block] = {}
    gone: set[int] = set()
    for block in blocks:
        way = _skipped(blocks, block)
        if way is None:
            continue
        body = blocks[block.after[way]]
        *before, branch = block.steps
        branch = replace(branch, guards=len(body.steps), when=not way)
        steps = [*before, branch, *body.steps]
        found[block.number] = Block(block.number, steps, list(body.after))
        gone.add(body.number)
    if len(found) > _MOST:
        return joined(blocks, longest)
    return joined([found.get(block.number, block) for block in blocks], longest, gone)


def _skipped(blocks: Sequence[Block], block: Block) -> int | None:
    """The way of a branch that only leads to where the other leads too; None if there is none."""
    if len(block.after) == 2 and not block.returns:
        for way, number in enumerate(block.after):
            body = blocks[number]
            alone = body.before == [block.number] and body.after == [block.after[1 - way]]
            if number > 0 and alone and _is_plain(body):  # block 0 is entered from outside too
                return way
    return None


def _is_plain(block: Block) -> bool:
    return len(block.steps) <= _LONGEST and all(map(_is_plain_step, block.steps))


def _is_plain_step(step: Step) -> bool:
    if step.decoded is None:
        return False
    form = step.decoded.form
    plain = all(isinstance(statement, _PLAIN) for statement in form.statements)
    return plain and form.pure
