"""The words of a program as steps at places, and blocks of steps.

Where routines are shared places have no stack. Instructions that may stop the program (traps, the
end of the run), or that the translation does not know, become steps that *leave*: the module hands
the state back to its host before them, and the reference engine executes them. So errors have one
author.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from npchip.isa import Decoded, ir
from npchip.machine import PIXELS, Machine
from npchip.program.graph import Place


class TooLargeError(Exception):
    """The program cannot be compiled; the text says why."""


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
        return self.decoded.form.exposes


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
        return self.first.decoded is not None and self.first.decoded.form.exposes

    @property
    def returns(self) -> bool:
        """Whether the stack tells which block follows."""
        return self.steps[-1].returns

    @property
    def port(self) -> int | None:
        """The port from which the first step takes a byte; None if it takes none."""
        return self.first.port


def is_foreign(word: Decoded, machine: Machine) -> bool:
    """Return whether a word is left to the reference engine, whatever the state.

    It is a halt, an odd expose or input, or samples into memory that is not there.
    """
    form = word.form
    effects, inputs = form.effects, form.inputs
    if "halt" in effects or len(inputs) > 1 or (inputs and form.guarded):
        return True
    if "expose" in effects and (len(form.statements) > 1 or form.guarded):
        return True
    return "sample" in effects and not all(
        0 <= ir.constant(statement.args[1], word.values) <= machine.memory_bytes - PIXELS * PIXELS
        for statement in form.statements
        if isinstance(statement, ir.Effect) and statement.name == "sample"
    )
