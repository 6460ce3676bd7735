"""Compile kernels: write the plans that there are, and take the one with the fewest cycles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from npchip.assembler import assemble_text
from npchip.base.errors import InputError
from npchip.isa import load_isa
from npchip.kernels.columns import columns_of, passes_of, pixels_of
from npchip.kernels.finish import Finish, finish_of
from npchip.kernels.model import Kernel
from npchip.kernels.padded import SHAPES, padded, rows_of
from npchip.kernels.parts import PIXELS, Plan
from npchip.kernels.two_passes import MANNERS, columns_first
from npchip.kernels.write import source
from npchip.machine import Machine, load_machine
from npchip.program.model import Program

PORTS = 16


class Compiled(NamedTuple):
    """A program for some kernels.

    Attributes:
        kernels: what it computes.
        plan: how.
        text: its source.
        program: the source assembled.
        cycles: cycles of a frame, by name of the machine.
    """

    kernels: tuple[Kernel, ...]
    plan: Plan
    text: str
    program: Program
    cycles: dict[str, int]


def plans(finishes: Sequence[Finish], most: int) -> Iterator[Plan]:
    """Yield programs for some kernels, among them the quickest and the shortest.

    Args:
        finishes: the kernels.
        most: words that there are.
    """
    width = max(how.width for how in finishes)
    for split in (True, False):
        for columns in (columns_of(finishes), pixels_of(finishes)):
            passes = passes_of(columns, width, split=split)
            if passes is not None:
                found = (columns_first(finishes, passes, manner) for manner in MANNERS)
                yield from (plan for plan in found if plan is not None)
        sums = rows_of(finishes, split=split)
        for shape in SHAPES:
            plan = padded(finishes, sums, shape)
            if plan is not None:
                yield plan
                if plan.words <= most and shape.copied == PIXELS:
                    break  # those that follow take more cycles


def compile_kernels(
    kernels: Sequence[Kernel], machines: Sequence[str] = ("default", "conservative")
) -> Compiled:
    """Compile kernels to one program.

    Args:
        kernels: what it is to compute, each sent to the port of its number.
        machines: machines whose cycles are wanted; the program has to fit the first.

    Raises:
        InputError: NP532, a sum needs more than 16 bits; NP533, the program needs more words than
            there are; NP534, two kernels have one name, or there are too many of them.
    """
    _check(kernels)
    loaded = [load_machine(name) for name in machines]
    finishes = [finish_of(kernel) for kernel in kernels]
    most = loaded[0].rom_words
    plan = _best(list(plans(finishes, most)), most)
    text = source(plan, kernels, {})
    program = assemble_text(text, machine=loaded[0])
    assert len(program.words) == plan.words, (len(program.words), plan.words)
    cycles = {machine.name: _cycles(plan, program, machine) for machine in loaded}
    text = source(plan, kernels, cycles)
    return Compiled(tuple(kernels), plan, text, assemble_text(text, machine=loaded[0]), cycles)


def _check(kernels: Sequence[Kernel]) -> None:
    if not 1 <= len(kernels) <= PORTS:
        raise InputError("NP534", f"expected 1 to {PORTS} kernels, one for each port")
    names = [kernel.name for kernel in kernels]
    for name in names:
        if names.count(name) > 1:
            raise InputError("NP534", f"two kernels are called {name}", hint="--name each of them")


def _best(found: Sequence[Plan], most: int) -> Plan:
    fitting = [plan for plan in found if plan.words <= most]
    if fitting:
        return min(fitting, key=lambda plan: (plan.steps, plan.words))
    if not found:
        raise InputError(
            "NP533",
            "the sums need more numbers at once than registers and memory hold",
            hint="ask for fewer kernels at once",
        )
    smallest = min(found, key=lambda plan: plan.words)
    raise InputError(
        "NP533",
        f"the program needs {smallest.words} words, {smallest.words - most} more than the ROM's "
        f"{most}",
        hint="ask for fewer kernels at once, or for weights with fewer signed digits",
    )


def _cycles(plan: Plan, program: Program, machine: Machine) -> int:
    """Cycles of a frame, which are the same for all frames, as the program has no other jumps."""
    times = [1, 1, 1]  # expose, two conversions
    for section in plan.sections:
        times += [section.times] * section.words
    times.append(1)
    costs = program.cycles(machine, load_isa())
    return sum(cost * count for cost, count in zip(costs, times, strict=True))
