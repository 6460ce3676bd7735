"""What a block does, as its variables, values and effects; and what is known of variables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple

from npchip.engines.wasm.translate.values import CONSTANT, UNIFORM, VARYING, Value
from npchip.isa import REGISTERS
from npchip.isa.ir import CARRY

MASKS: Final = CARRY + 1
"""Variables are numbered: the registers, Z, C, then the mask of each open region: bit MASKS + k
tells which NPs are active in the regions 0 to k."""

DIRECTIONS: Final = ("north", "east", "south", "west")

Known = Mapping[int, int]
"""What is known of variables: a number from 0 to 255, `SAME` or `ANY`."""
SAME: Final = 256
ANY: Final = 257

Terms = tuple[tuple[int, int], ...]
"""A number of active NPs: of the `count` item with this number in its block, or of all NPs (-1),
each times a sign."""


def is_bit(variable: int) -> bool:
    """Whether a variable is a flag or a mask."""
    return variable >= REGISTERS


def variables(depth: int) -> range:
    """All variables where `depth` regions are open."""
    return range(MASKS + depth)


class Site(NamedTuple):
    """An output instruction.

    Attributes:
        address: of the instruction.
        port: port number.
    """

    address: int
    port: int


@dataclass(eq=False)
class Item:
    """Something that a block does at its place in the order: nodes are computed when needed.

    Attributes:
        kind: ``load``, ``store``, ``send``, ``sample``, ``count``: add up how many NPs a mask
            lets through, or ``compute``: compute a node now.
        nodes: load, compute: the node. store: address, value. send: value. count: the mask.
        mask: which NPs it reaches; None for all.
        guard: a wire that must be set.
        number: count: of what it adds to.
        site: send: the output instruction.
        bank: sample: first byte.
        signal: sample: whether the light is converted too.
        needless: sample: whether the bank holds already what comes out.
    """

    kind: Literal["load", "store", "send", "sample", "count", "compute"]
    nodes: tuple[Value, ...] = ()
    mask: Value | None = None
    guard: Value | None = None
    number: int = -1
    site: Site | None = None
    bank: int = 0
    signal: bool = False
    needless: bool = False

    @property
    def planes(self) -> int:
        """Send: planes that follow its entry in the log: the bytes, and which NPs are active."""
        if self.mask is not None:
            return 2
        return int(self.nodes[0].kind == VARYING)

    def operands(self) -> list[Value]:
        """Nodes that must be computed for it, if it must be done at all."""
        extra = [node for node in (self.mask, self.guard) if node is not None]
        nodes = self.nodes[0].args if self.kind == "load" else self.nodes
        return [*nodes, *extra]


@dataclass(eq=False)
class Summary:
    """What a block does.

    Attributes:
        items: effects, loads and nodes to compute, in order.
        outs: variables that it writes, with their values at its end.
        reads: variables whose value at its beginning it asked for.
        wire: where it branches: the wire.
        guards: by the index of a step that guards others: the wire that lets them be done.
        masks: how many numbers there are that ``count`` items add to.
        reach: for a profile: how many NPs each step reaches, less what the number of the same
            step in an earlier pass holds as well.
        entered: for a profile: how many a step leaves active that opens a masked region.
    """

    items: list[Item] = field(default_factory=list)
    outs: dict[int, Value] = field(default_factory=dict)
    reads: set[int] = field(default_factory=set)
    wire: Value | None = None
    guards: dict[int, Value] = field(default_factory=dict)
    masks: int = 0
    reach: list[Terms] = field(default_factory=list)
    entered: dict[int, Terms] = field(default_factory=dict)

    def sends(self) -> list[Item]:
        """What it sends."""
        return [item for item in self.items if item.kind == "send"]

    def ends(self) -> dict[int, int]:
        """What is known of the written variables at its end."""
        return {variable: claim(node) for variable, node in self.outs.items()}


def claim(node: Value) -> int:
    """What is known of a value."""
    if node.kind == CONSTANT:
        return node.value
    return SAME if node.kind == UNIFORM else ANY
