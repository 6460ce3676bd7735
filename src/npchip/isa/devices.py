"""What the array, the sensor and the ports know: a semantics may ask them for nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from math import prod
from typing import Final, NamedTuple

from npchip.isa import ir
from npchip.isa.model import Operand


class _Known(NamedTuple):
    """What an argument may be: a choice of these names, or one of these numbers."""

    what: str = ""
    numbers: range = range(0)
    names: tuple[str, ...] = ()


_DIRECTIONS: Final = _Known(names=("north", "east", "south", "west"))
_LEVELS: Final = _Known(names=("reset", "signal"))
_PORTS: Final = _Known("a port, 0 to 15", range(16))
_BANKS: Final = _Known("a bank, 0, 64, 128 or 192", range(0, 256, 64))
_TARGETS: Final = _Known("a program address, 0 to 511", range(512))
_MOST_CASES: Final = 1 << 16


def misuse(statements: Iterable[ir.Statement], operands: Mapping[str, Operand]) -> str | None:
    """Say what a semantics asks of a device that the device cannot do; None if all is well.

    Args:
        statements: the semantics of one form.
        operands: of that form, by the names that the semantics uses.
    """
    found = (_fault(*demand, operands) for node in _nodes(statements) for demand in _demands(node))
    return next((fault for fault in found if fault), None)


def _nodes(statements: Iterable[ir.Statement]) -> Iterator[ir.Node]:
    for statement in statements:
        yield from ir.walk(statement)


def _demands(node: ir.Node) -> Iterator[tuple[str, ir.Expr, _Known]]:
    """Arguments of a node, each with what calls for it and what it may be."""
    match node:
        case ir.Operation(op="neighbour", args=(_, direction)):
            yield "neighbour", direction, _DIRECTIONS
        case ir.Operation(op="input", args=(port,)):
            yield "input", port, _PORTS
        case ir.Effect(name="sample", args=(level, bank)):
            yield "sample", level, _LEVELS
            yield "sample", bank, _BANKS
        case ir.Effect(name="output", args=(port, _)):
            yield "output", port, _PORTS
        case ir.Effect(name="jump" | "call" as name, args=(target,)):
            yield name, target, _TARGETS


def _fault(
    name: str, argument: ir.Expr, known: _Known, operands: Mapping[str, Operand]
) -> str | None:
    if known.numbers:
        wrong = next((v for v in _values(argument, operands) if v not in known.numbers), None)
        return None if wrong is None else f"{name}() takes {known.what}; this may be {wrong}"
    assert isinstance(argument, ir.Field)  # only operands are names of choices
    choices = operands[argument.name].choices
    other = next((choice for choice in choices if choice not in known.names), None)
    if other is None:
        return None
    return f"operand '{argument.name}' may only be {', '.join(known.names)}; found '{other}'"


def _values(expr: ir.Expr, operands: Mapping[str, Operand]) -> Iterable[int]:
    """Return every value that a constant of a semantics can have; none if there are too many."""
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
    return _TARGETS.numbers if operand.kind == "label" else range(0)
