"""Finds facts about the variables at every block, and the live variables.

Both are fixed points over the control-flow graph. Uniformity goes forward: a variable is a known
number, uniform, or neither, and where paths meet the weakest fact holds. Liveness goes backward.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from npchip.engines.wasm.translate.block import Executor
from npchip.engines.wasm.translate.steps import Block
from npchip.engines.wasm.translate.summary import ANY, MASKS, SAME, Facts, Summary
from npchip.program.graph import Place


@dataclass(eq=False)
class Analysis:
    """Facts about a program's variables.

    Attributes:
        begins: facts about every variable at the beginning of each block.
        summaries: summary of each block; None where it leaves.
    """

    begins: list[dict[int, int]]
    summaries: list[Summary | None]


def uniformity(
    blocks: Sequence[Block],
    executor: Executor,
    begin: Facts,
    known: Mapping[Place, Facts] = MappingProxyType({}),
) -> Analysis:
    """Find the uniform variables.

    Args:
        blocks: blocks in reverse postorder; execution begins with the first.
        executor: executes blocks on values.
        begin: facts about every variable at the first block.
        known: facts known so far, by the place of a block. They save the loops of one block a
            second execution.
    """
    begins: list[dict[int, int]] = [{} for _ in blocks]
    for block in blocks[1:]:
        if block.number in block.after and block.first.place in known:
            begins[block.number].update(known[block.first.place])
    begins[0].update(begin)
    executed: list[Summary | None] = [None] * len(blocks)
    work = [0]  # a heap: in reverse postorder most blocks are done once or twice
    waiting: dict[int, set[int]] = {0: set()}  # variables whose facts have changed
    while work:
        number = heapq.heappop(work)
        changed = waiting.pop(number)
        block, now = blocks[number], begins[number]
        if block.leaves:
            continue
        done = executed[number]
        if done is None or not changed.isdisjoint(done.reads):
            done = executed[number] = executor.execute(block, now)
        end = now | done.ends()
        for after in block.after:
            weaker = _join(begins[after], end, blocks[after].first.place.depth)
            if weaker or (executed[after] is None and not blocks[after].leaves):
                if after not in waiting:
                    heapq.heappush(work, after)
                    waiting[after] = set()
                waiting[after] |= weaker
    return Analysis(begins, executed)


def _join(now: dict[int, int], end: Facts, depth: int) -> set[int]:
    """Weaken the facts at a block by those at the end of a predecessor.

    Args:
        now: the facts; empty at first.
        end: those at the end.
        depth: number of open masked regions.

    Returns:
        The variables whose facts are weaker now.
    """
    if not now:
        now.update({variable: end[variable] for variable in range(MASKS + depth)})
        return set()
    changed: set[int] = set()
    for variable, fact in now.items() - end.items():
        if fact != ANY:
            weaker = ANY if end[variable] == ANY else SAME
            if weaker != fact:
                changed.add(variable)
                now[variable] = weaker
    return changed


def use_zeros(blocks: Sequence[Block], analysis: Analysis, executor: Executor) -> None:
    """Find bytes that are known to be 0, and execute the blocks again that gain by it.

    Args:
        blocks: blocks in reverse postorder; execution begins with the first, in any memory.
        analysis: facts about their variables; the summaries are replaced.
        executor: executes blocks on values.
    """
    if not executor.blank:
        return
    begins = [-1] * len(blocks)  # all bytes are 0 until a path leads there
    begins[0] = 0
    changed = True
    while changed:
        changed = False
        for block, done in zip(blocks, analysis.summaries, strict=True):
            now = executor.zeros(block, begins[block.number])
            for item in () if done is None else done.items:
                now.change(item)
            for after in block.after:
                if begins[after] & ~now.bits:
                    begins[after] &= now.bits
                    changed = True
    for block, done in zip(blocks, analysis.summaries, strict=True):
        bits = begins[block.number]
        if (
            bits
            and done is not None
            and any(item.kind in {"load", "sample"} for item in done.items)
        ):
            again = executor.execute(block, analysis.begins[block.number], bits)
            # Less may be known of a value that was compared with a load that is gone.
            if all(_keeps(again, analysis.begins[after]) for after in block.after):
                analysis.summaries[block.number] = again


def _keeps(done: Summary, facts: Facts) -> bool:
    """Return whether the facts at a successor hold for the variables that a block writes."""
    ends = done.ends()
    return all(
        fact == ANY or ends[variable] == fact or (fact == SAME and ends[variable] < SAME)
        for variable, fact in facts.items()
        if variable in ends
    )


def liveness(blocks: Sequence[Block], analysis: Analysis, all_live: frozenset[int]) -> list[int]:
    """Return the bits of the variables that are live at the beginning of each block.

    Args:
        blocks: the blocks.
        analysis: facts about their variables.
        all_live: blocks that need every variable, as the module may leave there.
    """
    live = [0] * len(blocks)
    own: list[int] = []  # variables that the block's effects need
    deps: list[dict[int, int]] = []  # variables that each written variable needs
    for block, done in zip(blocks, analysis.summaries, strict=True):
        everything = block.first.alone or block.number in all_live
        needed = (1 << MASKS + block.first.place.depth) - 1 if everything else 0
        if done is not None:
            for value in done.needs():
                needed |= value.deps
        own.append(needed)
        outs = {} if done is None else done.outs
        deps.append({variable: value.deps for variable, value in outs.items()})
    changed = True
    while changed:
        changed = False
        for block in reversed(blocks):
            needed, after = own[block.number], 0
            for number in block.after:
                after |= live[number]
            for variable, needs in deps[block.number].items():
                bit = 1 << variable
                if after & bit:
                    after ^= bit
                    needed |= needs
            needed |= after
            if needed != live[block.number]:
                live[block.number] = needed
                changed = True
    return live
