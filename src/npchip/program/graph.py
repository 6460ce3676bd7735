"""All ways through a program from reset, and what is known on them.

A *place* is an address together with the open calls, so that a routine is looked at for each of
its callers apart and every return has one successor.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from npchip.isa import Decoded, Isa, ir
from npchip.machine import Machine
from npchip.program.known import FLOW
from npchip.program.model import Program

MAX_PLACES: Final = 4096
"""Beyond this nothing is said about a program."""

Place = tuple[int, tuple[int, ...]]
"""Address, and return addresses, the newest last."""
HALTED: Final[Place] = (-1, ())
"""Where a HALT leads."""
Edge = tuple[Place, Place]


class _Flow(NamedTuple):
    """What a word does to the flow, wherever it is reached from."""

    decoded: Decoded
    cycles: int
    deeper: int
    kind: ir.EffectName | None
    target: int
    conditional: bool


class TooManyWaysError(Exception):
    """The program has more places than can be looked at."""


class Node(NamedTuple):
    """An instruction at a place.

    Attributes:
        decoded: the word; None for an undefined one, which is a trap.
        cycles: of one execution.
        depth: masked regions open before.
        taken: where it leads; None where it traps.
        other: where else: where the wire of its guard is not set.
    """

    decoded: Decoded | None
    cycles: int
    depth: int
    taken: Place | None = None
    other: Place | None = None


class Ways:
    """The graph of a program's places.

    Args:
        program: the program.
        machine: for cycles, and the limits of its stack and masks.
        isa: the instruction set.

    Attributes:
        nodes: all places that some way leads to.

    Raises:
        TooManyWaysError: there are more than `MAX_PLACES`.
    """

    def __init__(self, program: Program, machine: Machine, isa: Isa) -> None:
        self.program = program
        self.machine = machine
        self.isa = isa
        self.nodes: dict[Place, Node] = {}
        self._words = [isa.decode(word) for word in program.words]
        self._flows: dict[int, _Flow | None] = {}
        self._build()

    def _build(self) -> None:
        start: Place = (0, ())
        work = [(start, 0)]
        while work:
            place, depth = work.pop()
            if place in self.nodes or place == HALTED:
                continue
            if len(self.nodes) >= MAX_PLACES:
                raise TooManyWaysError
            node, deeper = self._node(place, depth)
            self.nodes[place] = node
            work += [(after, deeper) for after in (node.other, node.taken) if after is not None]

    def _node(self, place: Place, depth: int) -> tuple[Node, int]:
        address, stack = place
        word = self._flow(address) if address < len(self._words) else None
        if word is None:
            return Node(None, 0, depth), depth
        deeper = depth + word.deeper
        if not 0 <= deeper <= self.machine.mask_depth:
            return Node(word.decoded, word.cycles, depth), depth
        following: Place | None = (address + 1, stack)
        other = following if word.conditional else None
        match word.kind:
            case "jump":
                following = (word.target, stack)
            case "call":
                full = len(stack) >= self.machine.stack_depth
                following = None if full else (word.target, (*stack, address + 1))
            case "ret":
                following = (stack[-1], stack[:-1]) if stack else None
            case "halt":
                following = HALTED
        return Node(word.decoded, word.cycles, depth, following, other), deeper

    def _flow(self, address: int) -> _Flow | None:
        """What a word does to the flow; None for an undefined one."""
        if address in self._flows:
            return self._flows[address]
        decoded = self._words[address]
        found: _Flow | None = None
        if decoded is not None:
            effects = decoded.form.effects
            deeper = ("mask_push" in effects) - ("mask_pop" in effects)
            kind = next((name for name in FLOW if name in effects), None)
            effect = None if kind is None else effects[kind]
            target = 0
            if effect is not None and effect.args:
                target = ir.constant(effect.args[0], decoded.values)
            conditional = effect is not None and effect.guard is not None
            cycles = self.machine.cycles(decoded.instruction.timing)
            found = _Flow(decoded, cycles, deeper, kind, target, conditional)
        self._flows[address] = found
        return found

    def following(self, place: Place) -> list[Place]:
        """The places that may follow one, as far as the graph tells; `HALTED` is none."""
        node = self.nodes[place]
        return [way for way in (node.taken, node.other) if way is not None and way != HALTED]

    def takes_frame(self, place: Place) -> bool:
        """Whether it is an expose."""
        node = self.nodes.get(place)
        return (
            node is not None
            and node.decoded is not None
            and ("expose" in node.decoded.form.effects)
        )
