"""Tasks on which cycles are spent: the timing classes of instructions, grouped."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.isa import Decoded, Isa
from npchip.machine import Machine
from npchip.program.model import Program

OTHER: Final = "other"
"""Task of the timing classes that only a user's own instruction set has."""

TASKS: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {
        "sampling": ("sample",),
        "compute": ("move", "alu", "mask"),
        "memory": ("memory",),
        "reduction": ("global_or", "neighbour"),
        "flow": ("branch", "control"),
        "output": ("output", "input"),
        OTHER: (),
    }
)
"""Timing classes of each task; a ``reduction`` combines values of many NPs."""

_TASK_OF: Final = {name: task for task, classes in TASKS.items() for name in classes}


def sum_by_task(words: Iterable[tuple[Decoded | None, int]]) -> dict[str, int]:
    """Add up the cycles of words by task; the result has all `TASKS` in their order."""
    totals = dict.fromkeys(TASKS, 0)
    for decoded, cycles in words:
        if decoded:  # an undefined word is never executed
            totals[_TASK_OF.get(decoded.form.timing, OTHER)] += cycles
    return totals


def cycles_by_task(
    program: Program, machine: Machine, isa: Isa, executions: NDArray[np.int64]
) -> dict[str, int]:
    """Add up the cycles of a run by task.

    Args:
        program: the program that ran.
        machine: the machine, for the cycles of each instruction.
        isa: the program's instruction set.
        executions: executions of each address, from `Chip.executions`.

    Returns:
        Cycles for each task of `TASKS`; their sum is `Chip.cycles`.
    """
    words = program.decoded(isa)
    costs = (machine.cycles(word.form.timing) if word else 0 for word in words)
    cycles = (cost * count for cost, count in zip(costs, executions.tolist(), strict=True))
    return sum_by_task(zip(words, cycles, strict=True))
