"""Values of a block as nodes of a graph, each constant, uniform or varying."""

from __future__ import annotations

from typing import Final

CONSTANT: Final = 0
UNIFORM: Final = 1
VARYING: Final = 2


class Node:
    """A value.

    Attributes:
        op: what it computes; `args` are its operands.
        value: a number that belongs to the operation: a constant, a leaf's variable, a count.
        kind: constant, uniform or varying.
        deps: a bit for each variable of the block's beginning that it depends on.
        level: longest chain of operations below it.
        crosses: whether it needs values of other NPs, or needs a node that does; the emitter
            takes it back where these have been computed.
        uses: set by the emitter: how often needed code refers to it.
        temp: set by the emitter: the local that holds it, or of a varying node the number of its
            value (`Strip`); -1 where none does.
    """

    __slots__ = ("args", "crosses", "deps", "kind", "level", "op", "temp", "uses", "value")

    def __init__(  # noqa: PLR0917 - made by the thousand; keywords would cost time
        self, op: str, args: tuple[Node, ...], value: int, kind: int, deps: int, level: int = 0
    ) -> None:
        self.op = op
        self.args = args
        self.value = value
        self.kind = kind
        self.deps = deps
        self.level = level
        self.crosses = False
        self.uses = 0
        self.temp = -1


NUMBERS: Final = [Node("const", (), value, CONSTANT, 0) for value in range(256)]
"""The constants; all blocks share them."""
