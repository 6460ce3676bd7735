"""Structured control flow from a control-flow graph (Ramsey, "Beyond Relooper", 2022).

WebAssembly has no goto. Each block is written inside its immediate dominator. A loop header opens
a ``loop``. A merge point follows the end of a ``block``, so that a ``br`` leads to it. This needs a
reducible graph, in which no edge enters a loop past its header. Other graphs become one ``loop``
around a ``br_table``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from npchip.engines.wasm.emit.emitter import Emitter
from npchip.engines.wasm.emit.encode import I32, Function
from npchip.engines.wasm.translate.steps import Block


@dataclass(eq=False)
class Shape:
    """Loops and dominators of a graph whose blocks are numbered in reverse postorder.

    Attributes:
        dominated: children of each block in the dominator tree, in rising order.
        headers: loop headers, the targets of back edges.
        merges: merge points, blocks with several forward edges in.
        reducible: whether each loop is entered through its header only.
    """

    dominated: list[list[int]]
    headers: frozenset[int]
    merges: frozenset[int]
    reducible: bool


def shape(blocks: Sequence[Block]) -> Shape:
    """Find loops and dominators (Cooper, Harvey and Kennedy, 2001)."""
    dominator = [0] * len(blocks)
    known = [True] + [False] * (len(blocks) - 1)
    changed = True
    while changed:
        changed = False
        for block in blocks[1:]:
            new = -1
            for before in block.before:
                if known[before]:
                    new = before if new < 0 else _common(dominator, new, before)
            if not known[block.number] or dominator[block.number] != new:
                dominator[block.number], known[block.number] = new, True
                changed = True
    dominated: list[list[int]] = [[] for _ in blocks]
    for number in range(1, len(blocks)):
        dominated[dominator[number]].append(number)
    headers: set[int] = set()
    merges: set[int] = set()
    reducible = True
    for block in blocks:
        forward = 0
        for before in block.before:
            if before < block.number:
                forward += 1
            else:
                headers.add(block.number)
                reducible = reducible and _dominates(dominator, block.number, before)
        if forward > 1:
            merges.add(block.number)
    return Shape(dominated, frozenset(headers), frozenset(merges), reducible)


def _common(dominator: list[int], a: int, b: int) -> int:
    while a != b:
        if a > b:
            a = dominator[a]
        else:
            b = dominator[b]
    return a


def _dominates(dominator: list[int], above: int, number: int) -> bool:
    while number > above:
        number = dominator[number]
    return number == above


def write_structured(blocks: Sequence[Block], form: Shape, out: Function, emit: Emitter) -> None:
    """Write all blocks of a reducible graph.

    Pending work is kept in a list, as deep dominator trees would overflow Python's stack.
    """
    labels: list[int | None] = []  # of the open constructs, innermost last
    work: list[Callable[[], None]] = []
    edges: dict[tuple[int, int], bytearray] = {}

    def later(*actions: Callable[[], None]) -> None:
        work.extend(reversed(actions))

    def close() -> None:
        labels.pop()
        out.op("end")

    def tree(number: int) -> None:
        merges = [item for item in form.dominated[number] if item in form.merges]
        if number in form.headers:
            out.op("loop")
            labels.append(number)
            later(lambda: within(number, merges), close)
        else:
            within(number, merges)

    def within(number: int, merges: list[int]) -> None:
        actions: list[Callable[[], None]] = []
        for merge in reversed(merges):  # the last one is the outermost
            out.op("block")
            labels.append(merge)
        actions.append(lambda: node(number))
        for merge in merges:
            actions += [close, lambda merge=merge: tree(merge)]  # type: ignore[misc]
        later(*actions)

    def node(number: int) -> None:
        block = blocks[number]
        emit.body(block)
        # Now, as the writer still holds the state of this block.
        for index, after in enumerate(block.after):
            edges[number, index] = _written(out, emit, block, after)
        if not block.after:
            return
        if len(block.after) == 1:
            follow(block, 0)
            return
        for index, after in enumerate(block.after):
            if is_branch(block, after) and not edges[number, index]:  # needs no "if"
                if index == 1:
                    out.op("i32.eqz")
                out.br_if(outwards(after))
                follow(block, 1 - index)
                return
        out.op("if")
        labels.append(None)

        def otherwise() -> None:
            out.op("else")

        later(lambda: follow(block, 0), otherwise, lambda: follow(block, 1), close)

    def is_branch(block: Block, after: int) -> bool:
        return after <= block.number or after in form.merges

    def outwards(number: int) -> int:
        """Return the branch depth of the construct that leads to a block."""
        return next(k for k, label in enumerate(reversed(labels)) if label == number)

    def follow(block: Block, index: int) -> None:
        after = block.after[index]
        out.code += edges.pop((block.number, index))
        if is_branch(block, after):
            out.br(outwards(after))
        else:
            tree(after)

    tree(0)
    while work:
        work.pop()()


def _written(out: Function, emit: Emitter, block: Block, after: int) -> bytearray:
    """Return the code of an edge without adding it to the function."""
    before, out.code = out.code, bytearray()
    emit.edge(block, after)
    written, out.code = out.code, before
    return written


def write_dispatch(blocks: Sequence[Block], out: Function, emit: Emitter) -> None:
    """Write all blocks of any graph as a loop around a branch table of block numbers."""
    following = out.local(I32)
    out.op("loop")
    for _ in blocks:
        out.op("block")
    out.get(following)
    out.br_table(range(len(blocks)), 0)
    for block in blocks:
        out.op("end")
        emit.body(block)
        again = len(blocks) - 1 - block.number  # branch depth of the loop
        successors = block.after[:1] if block.returns else block.after
        if len(successors) == 2:
            out.op("if")
        for index, after in enumerate(successors):
            if index == 1:
                out.op("else")
            emit.edge(block, after)
            inside = len(successors) - 1
            if after > block.number and not block.returns:
                out.br(after - block.number - 1 + inside)
                continue
            if block.returns:
                emit.target(block)
            else:
                out.i32(after)
            out.set(following)
            out.br(again + inside)
        if len(successors) == 2:
            out.op("end", "unreachable")
    out.op("end")
