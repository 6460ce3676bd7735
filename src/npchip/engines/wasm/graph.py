"""Control-flow graph: the words that a program can reach from where it stands, as blocks.

A *place* is an address together with the open calls and the open masked regions, so that a
routine is cloned for each of its callers, every return has one known successor and every place
one mask depth. Instructions that may stop the program (traps, the end of the run), or that the
translation does not know, become places that *leave*: the module hands the state back to its
host before them, and the reference engine executes them. So errors have one author.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from npchip.isa import Decoded, Isa, ir
from npchip.isa.model import Form
from npchip.machine import Machine
from npchip.machine.layout import PIXELS
from npchip.program import Program

MAX_PLACES = 4096
"""Beyond this the clones of a program's routines would take too long to compile."""


class TooLargeError(Exception):
    """The program cannot be compiled; the text says why."""


class Place(NamedTuple):
    """Where a program can be: address, return addresses (newest last), open masked regions."""

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


@dataclass(eq=False)
class Block:
    """Steps that follow one another. Only the first may be an expose or an input, or leave.

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
    def leaves(self) -> bool:
        """Whether the module hands its state back here."""
        return self.first.decoded is None

    @property
    def exposes(self) -> bool:
        """Whether the first step takes a frame."""
        return self.first.decoded is not None and takes_frame(self.first.decoded.form)

    @property
    def port(self) -> int | None:
        """The port from which the first step takes a byte; None if it takes none."""
        return self.first.port


def takes_frame(form: Form) -> bool:
    """Whether a form is an expose."""
    return "expose" in form.effects


def build(program: Program, machine: Machine, isa: Isa, entry: Place, longest: int) -> list[Block]:
    """The blocks of up to `longest` steps that `entry` reaches, in reverse postorder.

    Raises:
        TooLargeError: there are too many.
    """
    steps: dict[Place, Step] = {}
    decoded = _Decoder(program, machine, isa)
    work = [entry]
    while work:
        place = work.pop()
        if place in steps:
            continue
        if len(steps) >= MAX_PLACES:
            raise TooLargeError("its routines would have to be copied too often")
        step = decoded.step(place)
        steps[place] = step
        work.extend(step.following)
    return _blocks(steps, entry, longest)


class _Decoder:
    """Makes steps of places."""

    def __init__(self, program: Program, machine: Machine, isa: Isa) -> None:
        self._words = program.words
        self._isa = isa
        self._machine = machine
        self._known: dict[int, tuple[Decoded | None, int, int | None]] = {}

    def step(self, place: Place) -> Step:
        known = self._known.get(place.address)
        if known is None:
            known = self._known[place.address] = self._look_at(place.address)
        decoded, cycles, port = known
        following = None if decoded is None else self._following(place, decoded)
        if following is None:
            return Step(place, None)
        return Step(place, decoded, cycles, following, port=port)

    def _look_at(self, address: int) -> tuple[Decoded | None, int, int | None]:
        """The word at an address unless it is foreign, its cycles, and the port it asks."""
        decoded = self._isa.decode(self._words[address]) if address < len(self._words) else None
        if decoded is None or is_foreign(decoded.form):
            return None, 0, None
        ports = [constant(node.port, decoded.values) for node in _inputs(decoded.form)]
        cycles = self._machine.cycles(decoded.instruction.timing)
        return decoded, cycles, ports[0] if ports else None

    def _following(self, place: Place, decoded: Decoded) -> tuple[Place, ...] | None:
        """The places that come next; None where the instruction traps or may trap."""
        if not decoded.form.effects:
            return (Place(place.address + 1, place.stack, place.depth),)
        depth, limits = place.depth, self._machine
        stack: tuple[int, ...] = place.stack
        after = place.address + 1
        target, guard = after, None
        for statement in decoded.form.statements:
            if not isinstance(statement, ir.Effect):
                continue
            match statement.name:
                case "mask_push":
                    depth += 1
                case "mask_pop":
                    depth -= 1
                case "jump" | "call":
                    target, guard = constant(statement.args[0], decoded.values), statement.guard
                    if statement.name == "call":
                        stack = (*stack, after)
                case "ret":
                    if not stack:
                        return None
                    guard = statement.guard
                    target, stack = stack[-1], stack[:-1]
                case "sample":
                    bank = constant(statement.args[1], decoded.values)
                    if not 0 <= bank <= limits.memory_bytes - PIXELS * PIXELS:
                        return None
            lowest = 1 if statement.name == "mask_invert" else 0
            if not lowest <= depth <= limits.mask_depth:
                return None
        if len(stack) > limits.stack_depth:
            return None
        taken = Place(target, stack, depth)
        if guard is None:
            return (taken,)
        other = Place(after, place.stack, depth)
        return (taken, other)


def is_foreign(form: Form) -> bool:
    """Whether a form is left to the reference engine: a halt, or an odd expose or input."""
    effects, inputs = form.effects, _inputs(form)
    if "halt" in effects or len(inputs) > 1:
        return True
    if inputs and form.guarded:
        return True
    expose = effects.get("expose")
    return expose is not None and (len(form.statements) > 1 or expose.guard is not None)


def _inputs(form: Form) -> list[ir.Input]:
    return [node for node in form.nodes() if isinstance(node, ir.Input)]


def constant(node: ir.Expr, values: Mapping[str, int | str]) -> int:
    """The number that a constant expression is in a decoded word."""
    match node:
        case ir.Const(value=value):
            return value
        case ir.Field(name=name):
            return int(values[name])
        case ir.Binary(op=op, left=left, right=right):
            a, b = constant(left, values), constant(right, values)
            return _ARITHMETIC[op](a, b)
    raise AssertionError(node)


_ARITHMETIC = {
    "+": int.__add__,
    "-": int.__sub__,
    "&": int.__and__,
    "|": int.__or__,
    "^": int.__xor__,
}


def _blocks(steps: Mapping[Place, Step], entry: Place, longest: int) -> list[Block]:
    """Join steps that only follow one another."""
    counts: dict[Place, int] = {entry: 2}
    for step in steps.values():
        joins = 1 if len(step.following) == 1 else 2  # what a branch leads to begins a block
        for place in step.following:
            counts[place] = counts.get(place, 0) + joins

    def begins(step: Step) -> bool:
        alone = step.decoded is None or takes_frame(step.decoded.form)
        return alone or counts[step.place] != 1 or step.port is not None

    runs: dict[Place, list[Step]] = {}
    first = [step for step in steps.values() if begins(step)]
    for step in first:
        run = [step]
        while len(run[-1].following) == 1:
            following = steps[run[-1].following[0]]
            if begins(following):
                break
            if len(run) == longest:
                first.append(following)
                break
            run.append(following)
        runs[step.place] = run
    order = _reverse_postorder(entry, {place: run[-1].following for place, run in runs.items()})
    blocks = [Block(number, runs[place]) for number, place in enumerate(order)]
    numbers = {place: number for number, place in enumerate(order)}
    for block in blocks:
        block.after = [numbers[place] for place in block.steps[-1].following]
        for number in block.after:
            blocks[number].before.append(block.number)
    return blocks


def joined(blocks: Sequence[Block], longest: int, gone: Collection[int] = ()) -> list[Block]:
    """Blocks that only follow one another as one, numbered anew.

    Args:
        blocks: in reverse postorder.
        longest: steps up to which they are joined.
        gone: numbers of those that nothing leads to any more.
    """
    ways = [0] * len(blocks)
    for block in blocks:
        for number in () if block.number in gone else block.after:
            ways[number] += 1
    ways[0] += 1
    inside = set(gone)
    found: list[Block] = []
    for block in blocks:
        if block.number in inside:
            continue
        steps, after = block.steps, block.after
        while not block.leaves and len(after) == 1 and ways[after[0]] == 1:
            following = blocks[after[0]]
            if following.leaves or following.exposes or following.port is not None:
                break
            if len(steps) + len(following.steps) > longest:
                break
            inside.add(following.number)
            steps = steps + following.steps  # the list of the block stays as it is
            after = following.after
        found.append(Block(block.number, steps, list(after), most=block.most))
    numbers = {block.number: index for index, block in enumerate(found)}
    for block in found:
        block.number = numbers[block.number]
        block.after = [numbers[number] for number in block.after]
    for block in found:
        for number in block.after:
            found[number].before.append(block.number)
    return found


def _reverse_postorder(entry: Place, following: Mapping[Place, Sequence[Place]]) -> list[Place]:
    done: list[Place] = []
    seen = {entry}
    path: list[tuple[Place, Iterator[Place]]] = [(entry, iter(following[entry]))]
    while path:
        place, rest = path[-1]
        unseen = next((item for item in rest if item not in seen), None)
        if unseen is None:
            done.append(place)
            path.pop()
        else:
            seen.add(unseen)
            path.append((unseen, iter(following[unseen])))
    return done[::-1]
