"""What is known of every variable at every block, and which variables are needed there.

Both are fixed points over the control-flow graph. Uniformity goes forward: a variable is known to
be a number, the same in all NPs, or neither, and where ways meet the weakest claim holds. Need
goes backward: a variable is live where some way leads to a use of it. What only a dead variable
depends on is never emitted.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from types import MappingProxyType

from npchip.engines.wasm.translate.block import Executor
from npchip.engines.wasm.translate.steps import Block
from npchip.engines.wasm.translate.summary import ANY, SAME, Item, Known, Summary, variables
from npchip.engines.wasm.translate.zero_bytes import ZeroBytes
from npchip.program.graph import Place


@dataclass(eq=False)
class Claims:
    """What is known of a program's variables.

    Attributes:
        begins: for each block what is known of every variable when it begins.
        summaries: for each block what it does; None where it leaves.
    """

    begins: list[dict[int, int]]
    summaries: list[Summary | None]


def uniformity(
    blocks: Sequence[Block],
    executor: Executor,
    begin: Known,
    known: Mapping[Place, Known] = MappingProxyType({}),
) -> Claims:
    """Find what is the same in all NPs.

    Args:
        blocks: in reverse postorder; execution begins with the first.
        executor: executes blocks on values.
        begin: what is known of every variable at the first.
        known: what is known already where blocks begin. It is used where a block leads back to
            itself, which would otherwise be executed once for its first pass and then again.
    """
    groups = _groups(blocks)
    begins: list[dict[int, int]] = [{} for _ in blocks]
    for block in blocks[1:]:
        if block.number in block.after and block.first.place in known:
            begins[block.number].update(known[block.first.place])
    begins[0].update(begin)
    for group in groups:
        for number in group[1:]:  # they begin alike: nothing is known of one alone
            begins[number] = begins[group[0]]
    executed: list[Summary | None] = [None] * len(blocks)
    work = [0]  # a heap: in reverse postorder most blocks are done once or twice
    waiting: dict[int, set[int]] = {0: set()}  # with the variables whose claims have changed
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
        for after in block.after[:1] if block.returns else block.after:
            weaker = _join(begins[after], end, blocks[after].first.place.depth)
            for other in groups[after]:
                if not weaker and (
                    executed[other] is not None or other in waiting or blocks[other].leaves
                ):
                    continue
                if other not in waiting:
                    heapq.heappush(work, other)
                    waiting[other] = set()
                waiting[other] |= weaker
    return Claims(begins, executed)


def _groups(blocks: Sequence[Block]) -> list[list[int]]:
    """For each block those of which the same must be known, in rising order.

    Blocks that one return leads to: what it does to variables on the way is the same for all.
    """
    groups = [[number] for number in range(len(blocks))]
    for block in blocks:
        if block.returns:
            found = {id(groups[number]): groups[number] for number in block.after}
            group = sorted(chain(*found.values())) if len(found) > 1 else []
            for number in group:
                groups[number] = group
    return groups


def _join(now: dict[int, int], end: Known, depth: int) -> set[int]:
    """Let what holds at the end of a block weaken the claims at a following one.

    Args:
        now: the claims; empty as long as there are none.
        end: what holds.
        depth: open masked regions.

    Returns:
        The variables whose claims are weaker now.
    """
    if not now:
        now.update({variable: end[variable] for variable in variables(depth)})
        return set()
    changed: set[int] = set()
    for variable, claim in now.items() - end.items():
        if claim != ANY:
            weaker = ANY if end[variable] == ANY else SAME
            if weaker != claim:
                changed.add(variable)
                now[variable] = weaker
    return changed


def use_zeros(blocks: Sequence[Block], claims: Claims, executor: Executor) -> None:
    """Find what is known to be 0, and execute the blocks again that gain by it.

    Args:
        blocks: in reverse postorder; execution begins with the first, in any memory.
        claims: of their variables; what blocks do is replaced.
        executor: executes blocks.
    """
    if not executor.blank:
        return
    begins = [-1] * len(blocks)  # all bytes are 0, until a way leads there
    begins[0] = 0
    changed = True
    while changed:
        changed = False
        for block, done in zip(blocks, claims.summaries, strict=True):
            now = executor.zeros(block, begins[block.number])
            for item in () if done is None else done.items:
                now.change(item)
            for after in block.after:
                if begins[after] & ~now.bits:
                    begins[after] &= now.bits
                    changed = True
    for block, done in zip(blocks, claims.summaries, strict=True):
        bits = begins[block.number]
        if done is not None and _gains(executor.zeros(block, bits), done.items):
            again = executor.execute(block, claims.begins[block.number], bits)
            # Without a load that others were compared with, a value may be less well known.
            if all(_keeps(again, claims.begins[after]) for after in block.after):
                claims.summaries[block.number] = again


def _keeps(done: Summary, claims: Known) -> bool:
    """Whether all that is claimed where a block leads holds of what it writes."""
    ends = done.ends()
    return all(
        claim == ANY or ends[variable] == claim or (claim == SAME and ends[variable] < SAME)
        for variable, claim in claims.items()
        if variable in ends
    )


def _gains(now: ZeroBytes, items: Sequence[Item]) -> bool:
    for item in items:
        if item.kind == "load" and now.known(item.nodes[0].args[0]):
            return True
        if item.kind == "sample" and not item.needless and now.is_needless(item):
            return True
        now.change(item)
    return False


def liveness(blocks: Sequence[Block], claims: Claims, all_live: frozenset[int]) -> list[int]:
    """Find what is needed: for each block a bit for each variable that is, when it begins.

    Args:
        blocks: as for `uniformity`.
        claims: its result.
        all_live: blocks that need every variable, whatever follows: there the module may hand
            its state back.
    """
    live = [0] * len(blocks)
    own: list[int] = []  # what a block's effects need
    deps: list[dict[int, int]] = []  # what each written variable needs
    for block, done in zip(blocks, claims.summaries, strict=True):
        everything = block.first.alone or block.number in all_live
        needed = (1 << len(variables(block.first.place.depth))) - 1 if everything else 0
        if done is not None:
            for item in done.items:
                if item.kind in {"store", "send", "sample", "count"}:
                    for node in item.operands():
                        needed |= node.deps
            for wire in (done.wire, *done.guards.values()):
                if wire is not None:
                    needed |= wire.deps
        own.append(needed)
        outs = done.outs if done is not None else {}
        deps.append({variable: node.deps for variable, node in outs.items()})
    changed = True
    while changed:
        changed = False
        for block in reversed(blocks):
            number = block.number
            needed = own[number]
            after = 0
            for following in block.after:
                after |= live[following]
            written = deps[number]
            for variable, needs in written.items():
                bit = 1 << variable
                if after & bit:
                    after ^= bit
                    needed |= needs
            needed |= after
            if needed != live[number]:
                live[number] = needed
                changed = True
    return live
