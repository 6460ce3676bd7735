"""Loops whose number of passes is known: passes become steps that follow one another.

A loop is looked at when it is one block that leads back to itself. Its nodes say how a pass
changes the variables, so that the wire of its branch can be followed from pass to pass, as far as
single bits are known: a counter is known as a whole, a sentinel that is shifted out only by the
bits that it pushes along. If the loop always ends after the same number of passes, all of them,
or a part that they are a multiple of, become one block, and a loop around such a loop may become
a single block itself. Neighbouring passes then share their values and need no branch.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

from npchip import bits
from npchip.bits import UNKNOWN, Bits
from npchip.engines.wasm.analysis import Claims
from npchip.engines.wasm.block import SAME, Executed
from npchip.engines.wasm.graph import Block
from npchip.engines.wasm.nodes import CONSTANT, UNIFORM, Node

_WHOLE: Final = 160
"""Steps up to which all passes become one block."""
_PART: Final = 64
"""Steps up to which some passes do."""
_MOST_PASSES: Final = 256


def unroll(blocks: Sequence[Block], claims: Claims) -> list[Block] | None:
    """Unroll what can be unrolled, and note `Block.most` of loops whose passes are known.

    Args:
        blocks: of a program, in reverse postorder. But for `most` they are not changed.
        claims: what is known of their variables.

    Returns:
        The blocks of the same program in reverse postorder; None where there is no such loop.
    """
    found: dict[int, Block] = {}
    for block in blocks[1:]:
        count = _passes(block, blocks, claims)
        if count is not None:
            more = _repeated(block, count)
            if more is not None:
                found[block.number] = more
    if not found:
        return None
    return _joined([found.get(block.number, block) for block in blocks])


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
    goes_on = replace(branch, following=(branch.following[again],), taken=again == 0)
    last, after = branch, list(block.after)
    if times == count:
        last = replace(branch, following=(branch.following[1 - again],), taken=again == 1)
        after = [block.after[1 - again]]
    steps = [*body, goes_on] * (times - 1) + [*body, last]
    return Block(block.number, steps, after)


def _joined(blocks: Sequence[Block]) -> list[Block]:
    """Blocks that only follow one another as one, numbered anew."""
    ways = [0] * len(blocks)
    for block in blocks:
        for number in block.after:
            ways[number] += 1
    ways[0] += 1
    inside: set[int] = set()
    found: list[Block] = []
    for block in blocks:
        if block.number in inside:
            continue
        steps, after = block.steps, block.after
        while not block.leaves and len(after) == 1 and ways[after[0]] == 1:
            following = blocks[after[0]]
            if following.leaves or following.exposes or following is block:
                break
            inside.add(following.number)
            steps = steps + following.steps  # the list of the block stays as it is
            after = following.after
        found.append(Block(block.number, steps, list(after), most=block.most))
    numbers = {block.number: index for index, block in enumerate(found)}
    for block in found:
        block.number = numbers[block.number]
        block.after = [numbers[number] for number in block.after]
    for block in found:
        for number in block.after:
            found[number].before.append(block.number)
    return found


# ---- how many passes


def _passes(block: Block, blocks: Sequence[Block], claims: Claims) -> int | None:
    """How often a loop of one block is passed, whatever happens; None where that is not known.

    Notes the greatest value of the variables that its addresses are made of.
    """
    if block.after.count(block.number) != 1 or len(block.after) != 2 or block.exposes:
        return None
    done = claims.executed[block.number]
    assert done is not None
    if done.wire is None:
        return None
    again = block.after.index(block.number) == 0  # whether a set wire leads to another pass
    needed, order = _needed(done, done.wire)
    now = _entry(block, blocks, claims, needed)
    most: dict[int, int] = {}
    for count in range(1, _MOST_PASSES + 1):
        table: dict[Node, Bits] = {}
        for node in order:
            table[node] = _bits(node, table, now)
        wire = bits.truth(table[done.wire])
        if wire is None:
            return None
        for variable, known in now.items():
            most[variable] = max(most.get(variable, 0), bits.most(known))
        if wire is not again:
            block.most = {variable: value for variable, value in most.items() if value < 255}
            return count
        now = {
            variable: table[done.outs[variable]] if variable in done.outs else known
            for variable, known in now.items()
        }
    return None


def _needed(done: Executed, wire: Node) -> tuple[set[int], list[Node]]:
    """Variables and nodes, in an order of evaluation, of all passes.

    Those that the wire depends on, and those that uniform addresses do.
    """
    variables: set[int] = set()
    order: dict[Node, None] = {}
    work = [wire, *_addresses(done)]
    while work:
        node = work[-1]
        if node in order:
            work.pop()
            continue
        missing = [arg for arg in _operands(node) if arg not in order]
        if missing:
            work += missing
            continue
        work.pop()
        order[node] = None
        if node.op == "leaf" and node.value not in variables:
            variables.add(node.value)
            if node.value in done.outs:
                work.append(done.outs[node.value])
    return variables, list(order)


def _addresses(done: Executed) -> list[Node]:
    """Uniform addresses of a block."""
    loads = [item.nodes[0].args[0] for item in done.items if item.kind == "load"]
    stores = [item.nodes[0] for item in done.items if item.kind == "store"]
    return [node for node in (*loads, *stores) if node.kind == UNIFORM]


def _operands(node: Node) -> Sequence[Node]:
    """What can tell something of a node."""
    return () if node.op in {"load", "neighbour"} else node.args


def _entry(
    block: Block, blocks: Sequence[Block], claims: Claims, needed: set[int]
) -> dict[int, Bits]:
    """What is known of variables where the loop is entered."""
    found: dict[int, Bits] = {}
    for number in block.before:
        if number == block.number:
            continue
        done = claims.executed[number]
        assert done is not None
        for variable in needed:
            node = done.outs.get(variable)
            claim = claims.begins[blocks[number].number].get(variable, SAME)
            if node is not None:
                claim = node.value if node.kind == CONSTANT else SAME
            known = bits.constant(claim) if claim < SAME else UNKNOWN
            found[variable] = bits.join(found.get(variable, known), known)
    return found


def _bits(node: Node, table: Mapping[Node, Bits], now: Mapping[int, Bits]) -> Bits:
    """What is known of the bits of a node, given what is of its operands and of variables."""
    args = [table[arg] for arg in _operands(node)]
    match node.op:
        case "const":
            return bits.constant(node.value)
        case "leaf":
            return now[node.value]
        case "add":
            return _sum(node, table)
        case "sub":
            if node.args[1].op == "mask":  # -1 where its bit is set
                return bits.add(args[0], _byte(table[node.args[1].args[0]]), bits.ZERO_BIT)[0]
            return bits.subtract(args[0], args[1], bits.ZERO_BIT)[0]
        case "and" | "both":
            return bits.both(*args)
        case "or" | "either":
            return bits.either(*args)
        case "xor":
            return bits.differ(*args)
        case "shl":
            return bits.shift_left(args[0], node.value)
        case "shr":
            return bits.shift_right(args[0], node.value)
        case "byte":
            return _byte(args[0])
        case "mask":
            return bits.constant(255 * args[0][1]) if args[0][0] & 1 else UNKNOWN
        case "not":
            return bits.complement(args[0], 1)
        case "bit":
            return args[0][0] >> node.value & 1, args[0][1] >> node.value & 1
        case "select":
            chosen = bits.truth(args[0])
            return bits.join(args[1], args[2]) if chosen is None else args[1 if chosen else 2]
        case "eq":
            return bits.equal(*args)
        case "ge":
            return bits.complement(bits.lower(*args), 1)
        case "any":  # of all NPs: where only some are asked, their mask is part of the bit
            return args[0]
    return UNKNOWN


def _byte(bit: Bits) -> Bits:
    """A bit as a byte."""
    return 254 | bit[0], bit[1] & 1


def _sum(node: Node, table: Mapping[Node, Bits]) -> Bits:
    """Of a sum: more is known where a mask stands for a carry than where it is -1."""
    left, right = node.args
    if left is right:
        return bits.shift_left(table[left], 1)
    if right.kind == CONSTANT and right.value == 1 and left.op == "add":  # x - b + 1: x + not b
        for mask, other in (left.args, left.args[::-1]):
            if mask.op == "mask":
                carry = _byte(bits.complement(table[mask.args[0]], 1))
                return bits.add(table[other], carry, bits.ZERO_BIT)[0]
    for mask, other in (node.args, node.args[::-1]):
        if mask.op == "mask":
            return bits.subtract(table[other], _byte(table[mask.args[0]]), bits.ZERO_BIT)[0]
    return bits.add(table[left], table[right], bits.ZERO_BIT)[0]
