"""Control flow from a graph of blocks: one loop around a branch table of block numbers.

WebAssembly has no goto. The blocks follow one another in reverse postorder, each at the end of a
``block``, so that a branch forward is a ``br``. A branch backward sets the number of the next block
and repeats the loop, unless a block branches to itself: then it is a ``loop`` of its own.
"""

from __future__ import annotations

from collections.abc import Sequence

from npchip.engines.wasm.emit.emitter import Emitter
from npchip.engines.wasm.emit.encode import Function
from npchip.engines.wasm.translate.steps import Block


def headers(blocks: Sequence[Block]) -> frozenset[int]:
    """Return the numbers of the blocks that an edge leads back to."""
    return frozenset(after for block in blocks for after in block.after if after <= block.number)


def write(blocks: Sequence[Block], out: Function, emit: Emitter) -> None:
    """Write all blocks of a program. Execution begins with the block whose number is local 0."""
    following = 0
    out.op("loop")
    for _ in blocks:
        out.op("block")
    out.get(following)
    out.br_table(range(len(blocks)), 0)
    for block in blocks:
        out.op("end")
        again = len(blocks) - 1 - block.number  # branch depth of the outer loop
        repeats = block.number in block.after
        if repeats:
            out.op("loop")
        emit.body(block)
        if len(block.after) == 2:
            out.op("if")
        for index, after in enumerate(block.after):
            if index == 1:
                out.op("else")
            emit.edge(block, after)
            inside = len(block.after) - 1
            if after == block.number:
                out.br(inside)
            elif after > block.number:
                out.br(after - block.number - 1 + inside + repeats)
            else:
                out.i32(after)
                out.set(following)
                out.br(again + inside + repeats)
        if len(block.after) == 2:
            out.op("end", "unreachable")
        if repeats:
            out.op("end")
    out.op("end")
