"""A program on a machine, for an engine to run on frames."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from npchip.engines.base import Engine, Fault, TrapError
from npchip.frames.feed import SourceFeed
from npchip.machine import Machine
from npchip.program.model import Program
from npchip.run.collector import Collector
from npchip.run.outputs import OutputError
from npchip.run.result import FrameRecord, RunError, RunResult, Status


class Job(NamedTuple):
    """A program, its machine and the cycle limit of one frame."""

    program: Program
    machine: Machine
    max_cycles: int

    def run(
        self,
        engine: Engine,
        feed: SourceFeed,
        on_frame: Callable[[FrameRecord], None] | None = None,
    ) -> RunResult:
        """Run from the engine's state until the program halts, the frames end or a limit is met.

        Args:
            engine: an engine for the program.
            feed: provides the frames.
            on_frame: function called with each completed frame.

        Raises:
            InputError: frames that cannot be used.
        """
        state = engine.state
        first_frame = state.frames_taken
        expected = feed.known(first_frame)
        collector = Collector(self.program, self.machine.geometry, on_frame, expected)
        status: Status
        error: RunError | None = None
        try:
            status = engine.run(feed, self.max_cycles, collector)
            if status != "frames-exhausted":
                # The frame in which the program stopped; a halt completes it.
                collector.take(state.close_frame(), complete=status == "halted")
        except TrapError as fault:
            status, error = "failed", self._blame(fault)
            collector.take(state.close_frame(), complete=False)
        except OutputError as fault:
            status, error = "failed", self._blame(fault)
        return collector.result(engine.name, self.machine.name, status, error, first_frame)

    def _blame(self, fault: Fault) -> RunError:
        place = self.program.place(fault.address)
        return RunError(
            code=fault.code,
            message=f"at address {fault.address}: {fault}",
            address=fault.address,
            file=place.file if place else None,
            line=place.line if place else None,
            processor=fault.processor,
        )
