"""Summaries of blocks (values of variables, and effects), and facts about variables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import chain
from typing import Final, Literal, NamedTuple

from npchip.engines.wasm.translate.values import CONSTANT, UNIFORM, VARYING, Value
from npchip.isa import REGISTERS
from npchip.isa.ir import CARRY

MASKS: Final = CARRY + 1
"""The first mask. Variables are numbered: the registers, Z, C, and the mask of each open region.
Variable MASKS + k is the bit of the NPs that are active in regions 0 to k."""

DIRECTIONS: Final = ("north", "east", "south", "west")

Facts = Mapping[int, int]
"""Facts about variables: the number (0 to 255), `SAME` if it is uniform, or `ANY`."""
SAME: Final = 256
ANY: Final = 257


def is_bit(variable: int) -> bool:
    """Return whether a variable is a flag or a mask."""
    return variable >= REGISTERS


class Site(NamedTuple):
    """An output instruction.

    Attributes:
        address: its address.
        port: its port number.
    """

    address: int
    port: int


@dataclass(eq=False)
class Item:
    """An action of a block whose order matters. Other values are computed when they are needed.

    Attributes:
        kind: ``load``, ``store``, ``send``, ``sample``, ``count`` (add up the NPs in a mask) or
            ``compute`` (compute a value now).
        values: the value of a load, compute or send; address and value of a store; the mask of
            a count.
        mask: bit of the NPs that it affects; None for all.
        number: of a count: 0 for the mask before the block's step, 1 for the one that it opens.
        site: output instruction of a send.
        bank: first byte of a sample.
        signal: whether a sample converts the light, not only the reset level.
        needless: whether the bank already holds the result of a sample.
    """

    kind: Literal["load", "store", "send", "sample", "count", "compute"]
    values: tuple[Value, ...] = ()
    mask: Value | None = None
    number: int = -1
    site: Site | None = None
    bank: int = 0
    signal: bool = False
    needless: bool = False

    @property
    def planes(self) -> int:
        """Planes that a send adds to the log: its bytes, and the active NPs."""
        if self.mask is not None:
            return 2
        return int(self.values[0].kind == VARYING)

    def operands(self) -> list[Value]:
        """Return the values that it needs."""
        values = self.values[0].args if self.kind == "load" else self.values
        return [*values] if self.mask is None else [*values, self.mask]


@dataclass(eq=False)
class Summary:
    """Variables and effects of a block.

    Attributes:
        items: its actions in order.
        outs: values of the variables that it writes, at its end.
        reads: variables that it reads from before its beginning.
        wire: condition of its branch; None without one.
        guards: condition of the steps after a guard, by the index of the guard's step.
    """

    items: list[Item] = field(default_factory=list)
    outs: dict[int, Value] = field(default_factory=dict)
    reads: set[int] = field(default_factory=set)
    wire: Value | None = None
    guards: dict[int, Value] = field(default_factory=dict)

    def sends(self) -> list[Item]:
        """Return its sends."""
        return [item for item in self.items if item.kind == "send"]

    def needs(self) -> list[Value]:
        """Return the values that its effects, its branch and its guards need, each as often."""
        kept = [item for item in self.items if item.kind not in {"load", "compute"}]
        wires = filter(None, (self.wire, *self.guards.values()))
        return [*chain.from_iterable(item.operands() for item in kept), *wires]

    def ends(self) -> dict[int, int]:
        """Return the facts about the written variables at its end."""
        return {variable: fact_of(value) for variable, value in self.outs.items()}


def fact_of(value: Value) -> int:
    """Return the fact about a value, as in `Facts`."""
    if value.kind == CONSTANT:
        return value.number
    return SAME if value.kind == UNIFORM else ANY
