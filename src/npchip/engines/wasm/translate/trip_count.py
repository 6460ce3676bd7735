"""Counts the iterations of loops that always take the same number of them.

It looks at loops of one block. Their values are followed from iteration to iteration, bit by bit:
all bits of a counter are known, and of a shifted sentinel all but those that were shifted in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

from npchip.engines.wasm.translate.analysis import Analysis
from npchip.engines.wasm.translate.steps import Block
from npchip.engines.wasm.translate.summary import SAME, Summary
from npchip.engines.wasm.translate.values import CONSTANT, UNIFORM, Value
from npchip.program import bits
from npchip.program.bits import UNKNOWN, Bits

_MOST: Final = 256
_OPERATORS: Final = {
    "sub": "-",
    "xor": "^",
    "shl": "<<",
    "shr": ">>",
    "both": "and",
    "either": "or",
    "eq": "==",
    "ge": ">=",
}
"""Names of operations in the intermediate form, where they differ."""


class TripCount(NamedTuple):
    """Number of iterations of a loop, and its variables.

    Attributes:
        times: iterations each time that the loop is entered.
        bounds: see `Block.bounds`.
    """

    times: int
    bounds: dict[int, int]


def trip_count(block: Block, analysis: Analysis) -> TripCount | None:
    """Count the iterations of a loop.

    Args:
        block: any block but the first, which may be entered from outside the program.
        analysis: facts about the program's variables.

    Returns:
        None if the block is no loop, or its number of iterations is not constant.
    """
    done = analysis.summaries[block.number]
    if done is None or done.wire is None or block.exposes or block.port is not None:
        return None
    if len(block.after) != 2 or block.after.count(block.number) != 1:
        return None
    again = block.after[0] == block.number  # whether a set wire leads to another iteration
    variables, order = _needed(done, done.wire)
    now = _entry(block, analysis, variables)
    table: dict[Value, Bits] = {}
    bounds = {variable: bits.most(known) for variable, known in now.items()}
    for times in range(1, _MOST + 1):
        for value in order:
            table[value] = known_bits(value, table, now)
        wire = bits.truth(table[done.wire])
        if wire is None:
            return None
        if wire is not again:
            return TripCount(times, {name: most for name, most in bounds.items() if most < 255})
        for variable in now.keys() & done.outs.keys():
            known = now[variable] = table[done.outs[variable]]
            bounds[variable] = max(bounds[variable], bits.most(known))
    return None


def _needed(done: Summary, wire: Value) -> tuple[set[int], list[Value]]:
    """Return the needed variables of a block, and the needed values in an order of evaluation.

    The wire depends on them, in this iteration or a later one, or an address begins with them.
    """
    variables: set[int] = set()
    order: dict[Value, None] = {}
    work = [wire, *bases(done)]
    while work:
        value = work[-1]
        missing = [arg for arg in operands(value) if arg not in order]
        if value not in order and missing:
            work += missing
            continue
        work.pop()
        if value in order:
            continue
        order[value] = None
        if value.op == "leaf":
            variables.add(value.number)
            if value.number in done.outs:
                work.append(done.outs[value.number])
    return variables, list(order)


def bases(done: Summary) -> set[Value]:
    """Return the uniform variables with which addresses of a block begin."""
    addresses = [item.values[0].args[0] for item in done.items if item.kind == "load"]
    addresses += [item.values[0] for item in done.items if item.kind == "store"]
    found = {value.args[0] if value.op == "add" else value for value in addresses}
    return {value for value in found if value.op == "leaf" and value.kind == UNIFORM}


def operands(value: Value) -> Sequence[Value]:
    """Return the operands from which bits of a value can be known."""
    return () if value.op in {"load", "neighbour"} else value.args


def _entry(block: Block, analysis: Analysis, variables: set[int]) -> dict[int, Bits]:
    """Return the known bits of variables where a loop is entered."""
    found: dict[int, Bits] = {}
    for number in block.before:
        if number == block.number:
            continue
        done = analysis.summaries[number]
        assert done is not None
        for variable in variables:
            value = done.outs.get(variable)
            fact = analysis.begins[number].get(variable, SAME)
            if value is not None:
                fact = value.number if value.kind == CONSTANT else SAME
            known = bits.constant(fact) if fact < SAME else UNKNOWN
            found[variable] = bits.join(found.get(variable, known), known)
    return found


def known_bits(value: Value, table: Mapping[Value, Bits], now: Mapping[int, Bits]) -> Bits:
    """Return the known bits of a value.

    Args:
        value: the value.
        table: known bits of its operands.
        now: known bits of the variables.
    """
    args = [table[arg] for arg in operands(value)]
    match value.op:
        case "const":
            return bits.constant(value.number)
        case "leaf":
            return now[value.number]
        case "any":  # of all NPs: the mask of a region is part of the bit
            return args[0]
        case "mask":
            return bits.constant(255 * args[0][1]) if args[0][0] & 1 else UNKNOWN
        case "add":
            return _sum(value, table)
        case "sub":
            if value.args[1].op == "mask":  # -1 where its bit is set
                return bits.transfer("+", args[0], bits.byte(table[value.args[1].args[0]]))
        case "shl" | "shr" | "bit":
            return bits.transfer(_OPERATORS.get(value.op, value.op), args[0], value.number)
    return bits.transfer(_OPERATORS.get(value.op, value.op), *args)


def _sum(value: Value, table: Mapping[Value, Bits]) -> Bits:
    """Return the known bits of a sum. More are known if a mask counts as a carry than as -1."""
    left, right = value.args
    if right.kind == CONSTANT and right.number == 1 and left.op == "add":  # x - b + 1: x + not b
        for mask, other in (left.args, left.args[::-1]):
            if mask.op == "mask":
                carry = bits.byte(bits.complement(table[mask.args[0]], 1))
                return bits.transfer("+", table[other], carry)
    for mask, other in (value.args, value.args[::-1]):
        if mask.op == "mask":
            return bits.transfer("-", table[other], bits.byte(table[mask.args[0]]))
    return bits.transfer("+", table[left], table[right], same=left is right)
