"""What a program spends its cycles on: the timing classes of its instructions, grouped."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.model import Program

OTHER: Final = "other"
"""Timing classes that only a user's own instruction set has."""

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
"""Timing classes of each task. ``reduction`` is what many NPs find out together."""

_TASK_OF: Final = {name: task for task, classes in TASKS.items() for name in classes}


def task_of(timing: str) -> str:
    """The task that a timing class belongs to."""
    return _TASK_OF.get(timing, OTHER)


def cycles_by_task(
    program: Program, machine: Machine, isa: Isa, executions: NDArray[np.int64]
) -> dict[str, int]:
    """Add up the cycles of a run by task.

    Args:
        program: what ran.
        machine: where, for the cycles of each instruction.
        isa: its instruction set.
        executions: from `Chip.executions`.

    Returns:
        Cycles for each task of `TASKS`; together those that the chip counted.
    """
    totals = dict.fromkeys(TASKS, 0)
    for word, count in zip(program.decoded(isa), executions.tolist(), strict=True):
        if count and word:  # an undefined word is never executed
            timing = word.form.timing
            totals[task_of(timing)] += count * machine.cycles(timing)
    return totals
