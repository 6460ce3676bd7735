"""The words of a program as steps at places, and blocks of steps.

A *place* is an address together with the open masked regions and, unless routines are shared, the
open calls. Instructions that may stop the program (traps, the end of the run), or
that the translation does not know, become places that *leave*: the module hands the state back to
its host before them, and the reference engine executes them. So errors have one author.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from npchip.isa import Decoded, Isa, ir
from npchip.isa.model import Form
from npchip.machine import PIXELS, Machine
from npchip.program.model import Program


class TooLargeError(Exception):
    """The program cannot be compiled; the text says why."""


class Place(NamedTuple):
    """Where a program can be: address, return addresses (newest last), open masked regions.

    Where routines are shared, return addresses are not told apart.
    """

    address: int
    stack: tuple[int, ...] = ()
    depth: int = 0


@dataclass(eq=False)
class Step:
    """One instruction at a place.

    Attributes:
        decoded: the word; None where the module leaves.
        following: the places that may come next: of a branch the one where its wire is set
            first, then the other.
        taken: of a branch whose wire is known: whether it is set.
        port: of an input: where the byte comes from.
        guards: of a branch within a block: how many of the next steps are only done where its
            wire is `when`.
        begins_loop: whether the first pass of an unrolled loop begins with it.
        ends_pass: of a branch in a block: whether a pass of an unrolled loop ends with it.
        pushes: of a call whose routine is shared: the return address; otherwise -1.
        returns: whether a routine that is shared ends with it: it leads to one of the places
            that may follow, as the stack tells.
    """

    place: Place
    decoded: Decoded | None
    cycles: int = 0
    following: tuple[Place, ...] = ()
    taken: bool | None = None
    port: int | None = None
    guards: int = 0
    when: bool = True
    begins_loop: bool = False
    ends_pass: bool = False
    pushes: int = -1
    returns: bool = False

    @property
    def cost(self) -> int:
        """See `Block.cost`."""
        return 2 if self.decoded is None else 2 + self.decoded.form.size

    @property
    def alone(self) -> bool:
        """Whether the module may hand its state back before the step, which begins a block then."""
        if self.decoded is None or self.port is not None or self.pushes >= 0 or self.returns:
            return True
        return takes_frame(self.decoded.form)


@dataclass(eq=False)
class Block:
    """Steps that follow one another. Only the first may hand the state back: see `Step.alone`.

    Attributes:
        number: index in `Flow.blocks`, which are in reverse postorder.
        after: numbers of the blocks that may follow, as `Step.following`.
        before: numbers of the blocks that it may follow.
        most: the greatest value that a variable can have when the block begins, of variables
            where something is known about it.
    """

    number: int
    steps: list[Step]
    after: list[int] = field(default_factory=list)
    before: list[int] = field(default_factory=list)
    most: dict[int, int] = field(default_factory=dict)

    @property
    def first(self) -> Step:
        """The first step."""
        return self.steps[0]

    @property
    def cost(self) -> int:
        """What it takes to translate it: in nodes, each about 5 us (measured)."""
        return 30 + sum(step.cost for step in self.steps)

    @property
    def leaves(self) -> bool:
        """Whether the module hands its state back here."""
        return self.first.decoded is None

    @property
    def exposes(self) -> bool:
        """Whether the first step takes a frame."""
        return self.first.decoded is not None and takes_frame(self.first.decoded.form)

    @property
    def returns(self) -> bool:
        """Whether the stack tells which block follows."""
        return self.steps[-1].returns

    @property
    def port(self) -> int | None:
        """The port from which the first step takes a byte; None if it takes none."""
        return self.first.port


def takes_frame(form: Form) -> bool:
    """Whether a form is an expose."""
    return "expose" in form.effects


class Way(NamedTuple):
    """Where an instruction leads.

    Attributes:
        flow: what it does to the flow, if anything.
        target: address that follows, unless it returns.
        depth: open masked regions behind it.
        guarded: whether the flow goes on behind it where its wire is not set.
    """

    flow: Literal["", "jump", "call", "ret"]
    target: int
    depth: int
    guarded: bool


class Decoder:
    """Makes steps of places."""

    def __init__(self, program: Program, machine: Machine, isa: Isa) -> None:
        self._words = program.words
        self._isa = isa
        self._machine = machine
        self._known: dict[int, tuple[Decoded | None, int, int | None]] = {}

    def step(self, place: Place) -> Step:
        """The step at a place; where it leads is left open."""
        known = self._known.get(place.address)
        if known is None:
            known = self._known[place.address] = self._look_at(place.address)
        decoded, cycles, port = known
        return Step(place, decoded, cycles, port=port)

    def _look_at(self, address: int) -> tuple[Decoded | None, int, int | None]:
        """The word at an address unless it is foreign, its cycles, and the port it asks."""
        decoded = self._isa.decode(self._words[address]) if address < len(self._words) else None
        if decoded is None or is_foreign(decoded.form):
            return None, 0, None
        ports = [ir.constant(port, decoded.values) for port in decoded.form.inputs]
        cycles = self._machine.cycles(decoded.instruction.timing)
        return decoded, cycles, ports[0] if ports else None

    def way(self, step: Step) -> Way | None:
        """Where a step leads; None where it leaves, because it traps or may trap."""
        decoded, limits = step.decoded, self._machine
        if decoded is None:
            return None
        depth, after = step.place.depth, step.place.address + 1
        way = Way("", after, depth, guarded=False)
        if not decoded.form.effects:
            return way
        for statement in decoded.form.statements:
            if not isinstance(statement, ir.Effect):
                continue
            match statement.name:
                case "mask_push":
                    depth += 1
                case "mask_pop":
                    depth -= 1
                case "jump" | "call":
                    target = ir.constant(statement.args[0], decoded.values)
                    way = Way(statement.name, target, depth, statement.guard is not None)
                case "ret":
                    way = Way("ret", after, depth, statement.guard is not None)
                case "sample":
                    bank = ir.constant(statement.args[1], decoded.values)
                    if not 0 <= bank <= limits.memory_bytes - PIXELS * PIXELS:
                        return None
            lowest = 1 if statement.name == "mask_invert" else 0
            if not lowest <= depth <= limits.mask_depth:
                return None
        return way._replace(depth=depth)

    def follow(self, step: Step) -> None:
        """Set where a step leads that has the stack in its place."""
        way, (address, stack, _) = self.way(step), step.place
        if way is None or (way.flow == "ret" and not stack):
            step.decoded = None
            return
        after = stack
        target = way.target
        if way.flow == "call":
            after = (*stack, address + 1)
        elif way.flow == "ret":
            target, after = stack[-1], stack[:-1]
        if len(after) > self._machine.stack_depth:
            step.decoded = None
            return
        step.following = (Place(target, after, way.depth),)
        if way.guarded:
            step.following += (Place(address + 1, stack, way.depth),)


def is_foreign(form: Form) -> bool:
    """Whether a form is left to the reference engine: a halt, or an odd expose or input."""
    effects, inputs = form.effects, form.inputs
    if "halt" in effects or len(inputs) > 1:
        return True
    if inputs and form.guarded:
        return True
    expose = effects.get("expose")
    return expose is not None and (len(form.statements) > 1 or expose.guard is not None)
