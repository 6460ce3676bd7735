"""How often a loop is passed, where that is always the same.

A loop is looked at when it is one block that leads back to itself. Its nodes say how a pass
changes the variables, so that the wire of its branch can be followed from pass to pass, as far as
single bits are known: a counter is known as a whole, of a sentinel that is shifted out only the
bits that have come in behind it are not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

from npchip.engines.wasm.translate.analysis import Claims
from npchip.engines.wasm.translate.steps import Block
from npchip.engines.wasm.translate.summary import SAME, Summary
from npchip.engines.wasm.translate.values import CONSTANT, UNIFORM, Value
from npchip.program import bits
from npchip.program.bits import UNKNOWN, Bits

_MOST: Final = 256
_OPERATORS: Final = {
    "sub": "-",
    "and": "&",
    "or": "|",
    "xor": "^",
    "shl": "<<",
    "shr": ">>",
    "not": "not",
    "both": "and",
    "either": "or",
    "bit": "bit",
    "byte": "byte",
    "select": "select",
    "eq": "==",
    "ge": ">=",
}
"""Names of the intermediate form for what nodes compute."""


class TripCount(NamedTuple):
    """What is known of a loop.

    Attributes:
        times: passes each time that it is entered.
        most: see `Block.most`.
    """

    times: int
    most: dict[int, int]


def trip_count(block: Block, claims: Claims) -> TripCount | None:
    """Count the passes of a loop; None where a block is none, or not always passed as often.

    Args:
        block: any but the first, which may be entered from outside the program.
        claims: what is known of the program's variables.
    """
    done = claims.summaries[block.number]
    if done is None or done.wire is None or block.exposes or block.port is not None:
        return None
    if len(block.after) != 2 or block.after.count(block.number) != 1:
        return None
    again = block.after[0] == block.number  # whether a set wire leads to another pass
    variables, order = _needed(done, done.wire)
    now = _entry(block, claims, variables)
    table: dict[Value, Bits] = {}
    moving: list[Value] = []  # nodes that a pass may change
    changes: set[Value] = set()
    for node in order:
        if node.op == "leaf" or not changes.isdisjoint(operands(node)):
            moving.append(node)
            changes.add(node)
        else:
            table[node] = known_bits(node, table, now)
    most = {variable: bits.most(known) for variable, known in now.items()}
    for times in range(1, _MOST + 1):
        for node in moving:
            table[node] = known_bits(node, table, now)
        wire = bits.truth(table[done.wire])
        if wire is None:
            return None
        if wire is not again:
            return TripCount(times, {name: value for name, value in most.items() if value < 255})
        now = {
            variable: table[done.outs[variable]] if variable in done.outs else known
            for variable, known in now.items()
        }
        for variable, known in now.items():
            most[variable] = max(most[variable], bits.most(known))
    return None


def _needed(done: Summary, wire: Value) -> tuple[set[int], list[Value]]:
    """What is needed of a block: variables and nodes, in an order of evaluation.

    It is what the wire depends on, in this pass or a later one, and what becomes of the variables
    that addresses begin with.
    """
    variables: set[int] = set()
    order: dict[Value, None] = {}
    work = [wire, *bases(done)]
    while work:
        node = work[-1]
        missing = [arg for arg in operands(node) if arg not in order]
        if node not in order and missing:
            work += missing
            continue
        work.pop()
        if node in order:
            continue
        order[node] = None
        if node.op == "leaf":
            variables.add(node.value)
            if node.value in done.outs:
                work.append(done.outs[node.value])
    return variables, list(order)


def bases(done: Summary) -> set[Value]:
    """Uniform variables that addresses of a block begin with."""
    addresses = [item.nodes[0].args[0] for item in done.items if item.kind == "load"]
    addresses += [item.nodes[0] for item in done.items if item.kind == "store"]
    bases = {node.args[0] if node.op == "add" else node for node in addresses}
    return {node for node in bases if node.op == "leaf" and node.kind == UNIFORM}


def operands(node: Value) -> Sequence[Value]:
    """What can tell something of a node."""
    return () if node.op in {"load", "neighbour"} else node.args


def _entry(block: Block, claims: Claims, variables: set[int]) -> dict[int, Bits]:
    """What is known of variables where the loop is entered."""
    found: dict[int, Bits] = {}
    for number in block.before:
        if number == block.number:
            continue
        done = claims.summaries[number]
        assert done is not None
        for variable in variables:
            node = done.outs.get(variable)
            claim = claims.begins[number].get(variable, SAME)
            if node is not None:
                claim = node.value if node.kind == CONSTANT else SAME
            known = bits.constant(claim) if claim < SAME else UNKNOWN
            found[variable] = bits.join(found.get(variable, known), known)
    return found


def known_bits(node: Value, table: Mapping[Value, Bits], now: Mapping[int, Bits]) -> Bits:
    """What is known of the bits of a node, given what is of its operands and of variables."""
    args = [table[arg] for arg in operands(node)]
    match node.op:
        case "const":
            return bits.constant(node.value)
        case "leaf":
            return now[node.value]
        case "any":  # of all NPs: where only some are asked, their mask is part of the bit
            return args[0]
        case "mask":
            return bits.constant(255 * args[0][1]) if args[0][0] & 1 else UNKNOWN
        case "add":
            return _sum(node, table)
        case "sub":
            if node.args[1].op == "mask":  # -1 where its bit is set
                return bits.transfer("+", args[0], bits.byte(table[node.args[1].args[0]]))
        case "shl" | "shr" | "bit":
            return bits.transfer(_OPERATORS[node.op], args[0], node.value)
    return bits.transfer(_OPERATORS.get(node.op, ""), *args)


def _sum(node: Value, table: Mapping[Value, Bits]) -> Bits:
    """Of a sum: more is known where a mask stands for a carry than where it is -1."""
    left, right = node.args
    if right.kind == CONSTANT and right.value == 1 and left.op == "add":  # x - b + 1: x + not b
        for mask, other in (left.args, left.args[::-1]):
            if mask.op == "mask":
                carry = bits.byte(bits.complement(table[mask.args[0]], 1))
                return bits.transfer("+", table[other], carry)
    for mask, other in (node.args, node.args[::-1]):
        if mask.op == "mask":
            return bits.transfer("-", table[other], bits.byte(table[mask.args[0]]))
    return bits.transfer("+", table[left], table[right], same=left is right)
