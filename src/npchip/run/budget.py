"""Cycle budgets of programs: ``.budget cycles N`` bounds the worst frame."""

from __future__ import annotations

from npchip.program.model import Program
from npchip.run.result import RunError, RunResult


def over_budget(result: RunResult, program: Program) -> RunError | None:
    """Error NP320 where the worst frame takes more cycles than ``.budget cycles`` allows.

    Budgets hold under the default machine; the caller knows which one it was.
    """
    budget = program.budget.cycles
    if budget is None or not result.frames:
        return None
    worst = int(result.frame_cycles.argmax())
    cycles = int(result.frame_cycles[worst])
    if cycles <= budget:
        return None
    return RunError(
        "NP320",
        f"{program.name}: frame {result.first_frame + worst} took {cycles:,} cycles,"
        f" '.budget cycles' allows {budget:,}",
    )
