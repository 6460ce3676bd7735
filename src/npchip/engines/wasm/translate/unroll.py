"""Loops whose number of passes is known: passes become steps that follow one another.

If a loop of one block always ends after the same number of passes, all of them, or a part that
they are a multiple of, become one block. Neighbouring passes then share their values and need no
branch. A loop around such a loop may become a single block itself, and is looked at next.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from npchip.engines.wasm.translate.analysis import Claims
from npchip.engines.wasm.translate.flow import MOST
from npchip.engines.wasm.translate.graph import joined
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.engines.wasm.translate.trip_count import bases, trip_count

_WHOLE: Final = 160
"""Steps up to which all passes become one block."""
_PART: Final = 64
"""Steps up to which some passes do."""


def unroll(blocks: Sequence[Block], claims: Claims, longest: int) -> list[Block] | None:
    """Unroll what can be unrolled, and note `Block.most` of loops whose passes are known.

    Args:
        blocks: of a program, in reverse postorder. But for `most` they are not changed.
        claims: what is known of their variables.
        longest: see `joined`.

    Returns:
        The blocks of the same program in reverse postorder; None where there is no such loop.
    """
    found: dict[int, Block] = {}
    room = MOST - sum(block.cost for block in blocks)
    for block in blocks[1:]:
        done = claims.summaries[block.number]
        if done is None or (block.cost > room and not bases(done)):
            continue  # there is no room for another pass, and no address to know more of
        counted = trip_count(block, claims)
        if counted is not None:
            block.most = counted.most
            more = _repeated(block, counted.times)
            if more is not None and more.cost - block.cost <= room:
                found[block.number] = more
                room -= more.cost - block.cost
    if not found:
        return None
    return joined([found.get(block.number, block) for block in blocks], longest)


def _repeated(block: Block, count: int) -> Block | None:
    """A block of several passes, or None."""
    size = len(block.steps)
    times = count
    if count * size > _WHOLE:
        times = max((n for n in range(2, _PART // size + 1) if count % n == 0), default=1)
        if times == 1:
            return None
    again = block.after.index(block.number)
    *body, branch = block.steps
    goes_on = _known(branch, again)
    last, after = branch, list(block.after)
    if times == count:
        last, after = _known(branch, 1 - again), [block.after[1 - again]]
    steps = [*body, goes_on] * (times - 1) + [*body, last]
    steps[0] = replace(steps[0], begins_loop=True)
    return Block(block.number, steps, after, most=block.most)


def _known(branch: Step, way: int) -> Step:
    """A branch that always goes the same way: a pass ends, and the next follows, or none."""
    following = (branch.following[way],)
    return replace(branch, following=following, taken=way == 0, ends_pass=True)
