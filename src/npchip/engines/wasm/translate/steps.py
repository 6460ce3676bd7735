"""The words of a program as steps at places, and basic blocks of steps.

A word that may stop the program (a trap, the end of
the run), or that cannot be translated, becomes a step that *leaves*: the module hands the state
back to the host, and the reference engine executes the word, so that only it raises errors.
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
        place: the place.
        decoded: the word; None if the module leaves.
        cycles: its cycles.
        following: places that may come next. The first one follows a branch whose wire is set.
        port: port of an input.
        guards: number of steps after a branch that are only done if its wire is `when`.
        when: see `guards`.
    """

    place: Place
    decoded: Decoded | None
    cycles: int = 0
    following: tuple[Place, ...] = ()
    port: int | None = None
    guards: int = 0
    when: bool = True

    @property
    def cost(self) -> int:
        """See `Block.cost`."""
        return 2 if self.decoded is None else 2 + self.decoded.form.size

    @property
    def alone(self) -> bool:
        """True if the module may leave before the step, which then begins a block."""
        if self.decoded is None or self.port is not None:
            return True
        return self.decoded.form.exposes


@dataclass(eq=False)
class Block:
    """A basic block: steps that follow one another. Only the first may be `Step.alone`.

    Attributes:
        number: index in `Flow.blocks`, which are in reverse postorder.
        steps: the steps.
        after: numbers of its successors, as in `Step.following`.
        before: numbers of its predecessors.
        bounds: known upper bounds of variables when the block begins.
    """

    number: int
    steps: list[Step]
    after: list[int] = field(default_factory=list)
    before: list[int] = field(default_factory=list)
    bounds: dict[int, int] = field(default_factory=dict)

    @property
    def first(self) -> Step:
        """The first step."""
        return self.steps[0]

    @property
    def cost(self) -> int:
        """Estimated time to translate it, in nodes of the intermediate form."""
        return 30 + sum(step.cost for step in self.steps)

    @property
    def leaves(self) -> bool:
        """True if the module leaves at this block."""
        return self.first.decoded is None

    @property
    def exposes(self) -> bool:
        """True if the first step takes a frame."""
        return self.first.decoded is not None and self.first.decoded.form.exposes

    @property
    def port(self) -> int | None:
        """Port from which the first step takes a byte; None if it takes none."""
        return self.first.port


def is_foreign(word: Decoded, machine: Machine) -> bool:
    """Return whether the reference engine must execute a word in any state.

    It is a halt, an effect that depends on the global OR, other than a jump, call or return, an
    expose or input with further effects, or a sample into addresses beyond the memory.
    """
    form = word.form
    effects, inputs = form.effects, form.inputs
    if "halt" in effects or len(inputs) > 1 or (inputs and form.guarded):
        return True
    if "expose" in effects and len(form.statements) > 1:
        return True
    found = [statement for statement in form.statements if isinstance(statement, ir.Effect)]
    if any(effect.guard is not None and effect is not form.flow for effect in found):
        return True
    return "sample" in effects and not all(
        0 <= ir.constant(statement.args[1], word.values) <= machine.memory_bytes - PIXELS * PIXELS
        for statement in found
        if statement.name == "sample"
    )
