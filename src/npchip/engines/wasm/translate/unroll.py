"""Unrolls loops whose number of iterations is known.

All iterations of a loop of one block become one block, or as many as divide their number.
Neighbouring iterations then share values and need no branch. A loop around it may become a single
block too, and can be unrolled next.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from npchip.engines.wasm.translate.analysis import Analysis
from npchip.engines.wasm.translate.graph import joined
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.engines.wasm.translate.trip_count import bases, trip_count

_MOST: Final = 14_000
"""Highest cost (`Block.cost`) of a program with unrolled loops."""
_WHOLE: Final = 160
"""Most steps of a block of all iterations."""
_PART: Final = 64
"""Most steps of a block of some iterations."""


def unroll(blocks: Sequence[Block], analysis: Analysis, longest: int) -> list[Block] | None:
    """Unroll loops, and set `Block.bounds` of those whose iterations are known.

    Args:
        blocks: blocks of a program in reverse postorder. Only their `bounds` are changed.
        analysis: facts about the program's variables.
        longest: see `joined`.

    Returns:
        The blocks of the same program in reverse postorder; None if there is no such loop.
    """
    found: dict[int, Block] = {}
    room = _MOST - sum(block.cost for block in blocks)
    for block in blocks[1:]:
        done = analysis.summaries[block.number]
        if done is None or (block.cost > room and not bases(done)):
            continue  # no room for another iteration, and no address that bounds would help
        counted = trip_count(block, analysis)
        if counted is not None:
            block.bounds = counted.bounds
            more = _repeated(block, counted.times)
            if more is not None and more.cost - block.cost <= room:
                found[block.number] = more
                room -= more.cost - block.cost
    if not found:
        return None
    return joined([found.get(block.number, block) for block in blocks], longest)


def _repeated(block: Block, count: int) -> Block | None:
    """Return a block of several of `count` iterations; None if it would be too long."""
    size = len(block.steps)
    times = count
    if count * size > _WHOLE:
        times = max((n for n in range(2, _PART // size + 1) if count % n == 0), default=1)
        if times == 1:
            return None
    again = block.after.index(block.number)
    *body, branch = block.steps
    repeat = _decided(branch, again)
    last, after = branch, list(block.after)
    if times == count:
        last, after = _decided(branch, 1 - again), [block.after[1 - again]]
    steps = [*body, repeat] * (times - 1) + [*body, last]
    return Block(block.number, steps, after, bounds=block.bounds)


def _decided(branch: Step, side: int) -> Step:
    """Return the branch at the end of an iteration, with one successor."""
    return replace(branch, following=(branch.following[side],))
