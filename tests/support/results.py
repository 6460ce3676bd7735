"""Programs and results built by hand, for tests of what is made out of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from npchip.program.model import Budget, Output, Program
from npchip.run.result import FrameRecord, RunResult
from tests.oracles.trajectory import OUTPUTS, trajectory

if TYPE_CHECKING:
    from numpy.typing import NDArray

TRAJECTORY = Program(
    "trajectory",
    words=(0,),
    symbols={"THRESHOLD": 32},
    outputs=tuple(Output(name, port, "scalar") for port, name in enumerate(OUTPUTS)),
    budget=Budget(cycles=2000),
)
IMAGING = Program("imaging", words=(0,), outputs=(Output("picture", 0, "picture"),))


def made(outputs: dict[str, Any], cycles: list[int], **other: Any) -> RunResult:
    """Result with one frame for each entry of `cycles`; `other` replaces further fields."""
    fields: dict[str, Any] = {
        "program": "made",
        "engine": "reference",
        "machine": "default",
        "status": "frames-exhausted",
        "error": None,
        "setup": FrameRecord(cycles=5, instructions=5, outputs=dict.fromkeys(outputs)),
        "first_frame": 0,
        "frame_cycles": np.array(cycles, np.int64),
        "frame_instructions": np.array(cycles, np.int64),
        "last_complete": True,
        "outputs": outputs,
    }
    return RunResult(**(fields | other))


def tracked(clip: NDArray[np.uint8], threshold: int = 32) -> RunResult:
    """Result of ``trajectory.s`` on `clip` by the oracle, with invented cycles."""
    columns = trajectory(clip, threshold)
    outputs = {name: np.array(column, np.int32) for name, column in columns.items()}
    cycles = [1900 + index for index in range(len(clip))]
    return made(outputs, cycles, program="trajectory")


def imaged(clip: NDArray[np.uint8]) -> RunResult:
    """Result of ``imaging.s`` on `clip`, with invented cycles."""
    return made({"picture": clip}, [1000] * len(clip), program="imaging")
