"""Limits of the array, the sensor and the ports on the arguments of a semantics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import product
from math import prod
from typing import Final, NamedTuple

from npchip.isa import ir
from npchip.isa.model import Operand


class _Domain(NamedTuple):
    """The values that an argument may have: names, or numbers."""

    text: str = ""
    numbers: range = range(0)
    names: tuple[str, ...] = ()


_PORT: Final = _Domain("a port, 0 to 15", range(16))
_BANK: Final = _Domain("a bank, 0, 64, 128 or 192", range(0, 256, 64))
_TARGET: Final = _Domain("a program address, 0 to 1023", range(1024))
_LIMITED: Final[Mapping[str, Mapping[int, _Domain]]] = {
    "neighbour": {1: _Domain(names=("north", "east", "south", "west"))},
    "input": {0: _PORT},
    "sample": {0: _Domain(names=("reset", "signal")), 1: _BANK},
    "output": {0: _PORT},
    "jump": {0: _TARGET},
    "call": {0: _TARGET},
}
"""Arguments with a domain, by the name of the operation or effect and by position."""
_MOST_CASES: Final = 1 << 16


def misuse(statements: Iterable[ir.Statement], operands: Mapping[str, Operand]) -> str | None:
    """Return a message about the first argument that a device cannot take; None if all fit.

    Args:
        statements: the semantics of one form.
        operands: its operands, by their names in the semantics.
    """
    for node in (node for statement in statements for node in ir.walk(statement)):
        if isinstance(node, ir.Operation | ir.Effect):
            name = node.op if isinstance(node, ir.Operation) else node.name
            for position, domain in _LIMITED.get(name, {}).items():
                if fault := _fault(name, node.args[position], domain, operands):
                    return fault
    return None


def _fault(
    name: str, argument: ir.Expr, domain: _Domain, operands: Mapping[str, Operand]
) -> str | None:
    if domain.numbers:
        for value in _values(argument, operands):
            if value not in domain.numbers:
                return f"{name}() takes {domain.text}; this may be {value}"
        return None
    assert isinstance(argument, ir.Field)  # only operands are names of choices
    for choice in operands[argument.name].choices:
        if choice not in domain.names:
            names = ", ".join(domain.names)
            return f"operand '{argument.name}' may only be {names}; found '{choice}'"
    return None


def _values(expr: ir.Expr, operands: Mapping[str, Operand]) -> Iterable[int]:
    """Return all values that a constant can have; none if there are too many combinations."""
    ranges = {
        node.name: _range(operands[node.name])
        for node in ir.walk(expr)
        if isinstance(node, ir.Field)
    }
    if isinstance(expr, ir.Field):
        return ranges[expr.name]
    if prod(map(len, ranges.values())) > _MOST_CASES:
        return ()
    cases = product(*ranges.values())
    return {ir.constant(expr, dict(zip(ranges, case, strict=True))) for case in cases}


def _range(operand: Operand) -> range:
    if operand.kind == "number":
        return range(operand.least, operand.most + 1, operand.step)
    return _TARGET.numbers if operand.kind == "label" else range(0)
