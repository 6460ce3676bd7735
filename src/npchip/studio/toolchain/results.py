"""A run that the page has made, as the judge of expectations wants it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.graph import Place
from npchip.program.model import Program
from npchip.run.result import FrameRecord, RunError, Status
from npchip.run.stuck import Stuck, stuck_at


@dataclass(frozen=True)
class PageResult:
    """A run in plain lists; see `npchip.run.result.Measured`."""

    status: Status
    error: RunError | None
    setup: FrameRecord
    frame_cycles: Sequence[int]
    frame_instructions: Sequence[int]
    outputs: Mapping[str, Sequence[Any]]
    first_frame: int = 0

    @property
    def cycles(self) -> int:
        """Cycles of the whole run."""
        return self.setup.cycles + sum(self.frame_cycles)

    @property
    def instructions(self) -> int:
        """Instructions executed in the whole run."""
        return self.setup.instructions + sum(self.frame_instructions)

    @property
    def frames(self) -> int:
        """Number of frames taken."""
        return len(self.frame_cycles)

    def value(self, name: str, frame: int) -> Any:
        """Return output `name` of frame `frame`; arrays are lists of rows."""
        return self.outputs[name][frame]


def result_of(document: Mapping[str, Any], program: Program) -> PageResult:
    """Return what a ``RunDocument`` says."""
    frames, setup = document["frames"], document["setup"]
    names = dict.fromkeys(name for frame in frames for name in frame["outputs"])
    error = document.get("error")
    place = program.place(error["address"]) if error else None
    return PageResult(
        status=document["status"],
        error=error
        and RunError(
            error["code"],
            error["message"],
            error["address"],
            place.file if place else None,
            place.line if place else None,
        ),
        setup=FrameRecord(setup["cycles"], setup["instructions"], setup["outputs"]),
        frame_cycles=[frame["cycles"] for frame in frames],
        frame_instructions=[frame["instructions"] for frame in frames],
        outputs={name: [frame["outputs"].get(name) for frame in frames] for name in names},
    )


def stuck_in(document: Mapping[str, Any], program: Program, machine: Machine, isa: Isa) -> Stuck:
    """Return where a run stands that reached the cycle limit, if the document says it."""
    at = document.get("stoppedAt")
    if at is None:
        return Stuck("", "at a place that is not known")
    return stuck_at(program, machine, isa, Place(at["address"], tuple(at["stack"]), at["depth"]))
