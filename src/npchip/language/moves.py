"""Reads from neighbours of an instruction: the arrows of an array."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

from npchip.isa import Decoded, ir

_STEPS: Final = {"north": (-1, 0), "east": (0, 1), "south": (1, 0), "west": (0, -1)}


class Move(NamedTuple):
    """A value that each active NP takes from a neighbour.

    Attributes:
        row, column: the neighbour's place, relative to the NP that reads.
        register: the register of the neighbour that holds the value before the instruction;
            None if the instruction works the value out first.
    """

    row: int
    column: int
    register: int | None


def moves(decoded: Decoded) -> tuple[Move, ...]:
    """Return what an instruction reads from neighbours, in the order in which it reads."""
    return tuple(_moves(decoded))


def _moves(decoded: Decoded) -> Iterator[Move]:
    values = decoded.values
    written: set[int | None] = set()
    for statement in decoded.form.statements:
        for node in ir.walk(statement):
            if isinstance(node, ir.Operation) and node.op == "neighbour":
                value, direction = node.args
                assert isinstance(direction, ir.Field)  # the language has no other names
                register = int(values[value.name]) if isinstance(value, ir.Register) else None
                # A register that an earlier statement wrote no longer holds what it held before.
                source = None if register in written else register
                yield Move(*_STEPS[str(values[direction.name])], source)
        if isinstance(statement, ir.SetRegister):
            written.add(int(values[statement.name]))
