"""A debugger without a screen: forward and backward, breakpoints, edits, who wrote what."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.debugger.clip import Recorded
from npchip.debugger.conditions import Condition, Stop, Watch
from npchip.debugger.history import Edit
from npchip.debugger.language import parse_condition
from npchip.debugger.names import Names
from npchip.debugger.runner import Runner
from npchip.debugger.search import Search, Written
from npchip.debugger.values import Cell, Pixel, Place
from npchip.frames.feed import Frames, frame_source
from npchip.program.graph import word_at
from npchip.run.chip import Chip

if TYPE_CHECKING:
    from npchip import Machine, Program
    from npchip.isa import Isa
    from npchip.program.model import SourceLine
    from npchip.run.result import FrameRecord, Value

MAX_CYCLES: Final = 1_000_000
"""Default cycle limit of a frame: an endless loop ends soon."""


@dataclass
class Breakpoint:
    """A condition with a number; `error` says why its text means nothing in this program."""

    number: int
    text: str
    condition: Condition | None
    enabled: bool = True
    error: str | None = None


class Debugger:
    """A program on a chip, at one moment of its run.

    Args:
        program: what to debug.
        frames: as `Chip.feed`; what could be read once only is kept in a temporary file.
        machine: as for `Chip`.
        isa: instruction set of the program; the built-in one if not given.
        memory: what `Chip.load_memory` writes first: pairs of address and planes.
        max_cycles: limit for the cycles of one frame.

    Attributes:
        chip: the chip; look at it, but change it with `edit` only.
        names: what conditions may speak of.
        breakpoints: by number.
        stop: why it stands where it stands.

    Raises:
        InputError: as `Chip` and `Chip.feed`.
    """

    def __init__(
        self,
        program: Program,
        frames: Frames | None = None,
        machine: str | Path | Machine = "default",
        isa: Isa | None = None,
        *,
        memory: Iterable[tuple[int, NDArray[np.uint8]]] = (),
        max_cycles: int = MAX_CYCLES,
    ) -> None:
        self.chip = Chip(program, machine, isa=isa)
        self.program = program
        self.names = Names.of(program, self.chip.machine, self.chip.isa)
        self.breakpoints: dict[int, Breakpoint] = {}
        self.stop = Stop("start", "at the beginning")
        clip = None if frames is None else Recorded(frame_source(frames, self.chip.machine))
        for address, planes in memory:
            self.chip.load_memory(address, planes)
        self.chip.feed(clip)
        self._runner = Runner(self.chip, clip, self.names.writers, max_cycles)
        self._search = Search(self._runner, self.names.writers)
        self._numbers = 0

    # ---- where it stands

    @property
    def time(self) -> int:
        """Instructions executed since reset."""
        return self.chip.instructions

    @property
    def line(self) -> SourceLine | None:
        """Source line of the next instruction."""
        return self.program.place(self.chip.pc)

    @property
    def outputs(self) -> dict[str, Value]:
        """Outputs of this frame so far; None where nothing can be read yet."""
        return self._runner.outputs()

    @property
    def records(self) -> dict[int, FrameRecord]:
        """Outputs and cycles of the last frames that lie behind, by number (-1: the set-up)."""
        taken = self.chip.frames_taken
        ended = self.stop.reason in {"halted", "frames-exhausted"}
        return {
            frame: record
            for frame, record in self._runner.records.items()
            if frame < taken - 1 or (ended and frame == taken - 1)
        }

    @property
    def snapshots(self) -> tuple[int, int]:
        """Return the number of snapshots and the bytes that they take."""
        return len(self._runner.history), self._runner.history.size

    def interrupt(self) -> None:
        """Stop what is going on in another thread; it then stands somewhere on its way."""
        self._runner.interrupted.set()

    # ---- where to stop

    def add(self, text: str) -> Breakpoint:
        """Add a breakpoint or watchpoint.

        Raises:
            CommandError: the text means nothing in this program.
        """
        return self.add_condition(parse_condition(text, self.names))

    def add_condition(self, condition: Condition) -> Breakpoint:
        """Add a breakpoint or watchpoint that has been read."""
        self._numbers += 1
        added = Breakpoint(self._numbers, condition.text, condition)
        self.breakpoints[added.number] = added
        return added

    def add_broken(self, text: str, error: str) -> Breakpoint:
        """Keep a text that means nothing in this program, switched off."""
        self._numbers += 1
        added = Breakpoint(self._numbers, text, None, enabled=False, error=error)
        self.breakpoints[added.number] = added
        return added

    # ---- forward

    def step(self, count: int = 1) -> Stop:
        """Execute so many instructions, or up to a breakpoint."""
        return self._forward("stepped", time=self.time + count)

    def step_over(self) -> Stop:
        """Execute one instruction; a call with all that it calls."""
        chip = self.chip
        word = word_at(self.program.decoded(chip.isa), chip.pc)
        if word is None or "call" not in word.form.effects:
            return self.step()
        depth = len(chip.stack)
        return self._forward("stepped over the call", goal=lambda: len(chip.stack) <= depth)

    def step_out(self) -> Stop:
        """Go on to where the routine returns to."""
        chip = self.chip
        depth = len(chip.stack)
        if not depth:
            return self._stopped(Stop("step", "no call is open"))
        return self._forward("returned", goal=lambda: len(chip.stack) < depth)

    def run(self) -> Stop:
        """Go on to a breakpoint or the end."""
        return self._forward("")

    def run_to(self, condition: Condition) -> Stop:
        """Go on to a place or condition, or a breakpoint before it."""
        return self._forward(f"reached {condition.text}", also=condition)

    def next_frame(self, count: int = 1) -> Stop:
        """Go on to just after the expose of a later frame, or a breakpoint before it."""
        frame = self.chip.frames_taken + count
        return self._forward(f"frame {frame - 1} is exposed", frame=frame)

    def _forward(
        self,
        message: str,
        *,
        time: int | None = None,
        frame: int | None = None,
        goal: Callable[[], bool] | None = None,
        also: Condition | None = None,
    ) -> Stop:
        self._runner.interrupted.clear()
        extra = [] if also is None else [(0, also)]
        watch = Watch(self.chip, [*self._enabled(), *extra])
        stop, found = self._runner.forward(watch, time=time, frame=frame, goal=goal)
        if stop.reason == "breakpoint":
            stop = self._hit(found, message)
        elif not stop.message:
            stop = Stop(stop.reason, message)
        return self._stopped(stop)

    def _enabled(self) -> list[tuple[int, Condition]]:
        return [
            (number, item.condition)
            for number, item in self.breakpoints.items()
            if item.enabled and item.condition is not None
        ]

    def _hit(self, found: list[int], message: str = "") -> Stop:
        numbers = tuple(number for number in found if number)
        if not numbers:
            return Stop("place", message)
        texts = [f"{number} ({self.breakpoints[number].text})" for number in numbers]
        return Stop("breakpoint", f"breakpoint {', '.join(texts)}", numbers)

    def _stopped(self, stop: Stop) -> Stop:
        self.stop = stop
        return stop

    # ---- backward

    def restart(self) -> Stop:
        """Go to the beginning; edits are forgotten."""
        self._runner.restart()
        return self._stopped(Stop("start", "at the beginning"))

    def seek(self, time: int) -> Stop:
        """Go to where so many instructions had been executed, whatever stops on the way."""
        self._runner.interrupted.clear()
        if time > self.time:
            nothing = Watch(self.chip, ())
            stop, _ = self._runner.forward(nothing, time=time)
            while stop.reason == "outputs":  # told once each time that it is come across
                stop, _ = self._runner.forward(nothing, time=time)
            return self._stopped(stop if stop.message else Stop("step", f"at instruction {time}"))
        return self._back(max(0, time), Stop("step", f"at instruction {time}"))

    def step_back(self, count: int = 1) -> Stop:
        """Undo so many instructions."""
        self._runner.interrupted.clear()
        return self._back(max(0, self.time - count), Stop("step", "stepped back"))

    def previous_frame(self, count: int = 1) -> Stop:
        """Go back to just after the expose of this frame, or of one further back."""
        self._runner.interrupted.clear()
        exposed = self._runner.history.exposed
        taken = self.chip.frames_taken
        taken -= bool(taken and exposed[taken - 1] == self.time) + count - 1
        if taken < 1:
            return self._back(0, Stop("step", ""))
        return self._back(exposed[taken - 1], Stop("frame", f"frame {taken - 1} is exposed"))

    def run_back(self) -> Stop:
        """Go back to the last moment at which a breakpoint would have stopped."""
        self._runner.interrupted.clear()
        conditions = self._enabled()
        if self.time and conditions:
            here = self.chip.snapshot()
            found = self._search.last_hit(Watch(self.chip, conditions))
            self.chip.restore(here)
            if self._runner.interrupted.is_set():
                return self._stopped(Stop("interrupted", "interrupted"))
            if found is not None:
                return self._back(found[0], self._hit(found[1]))
        return self._back(0, Stop("step", ""))

    def _back(self, time: int, stop: Stop) -> Stop:
        self._runner.seek(time)
        if self._runner.interrupted.is_set():
            return self._stopped(Stop("interrupted", "interrupted"))
        if not self.time and stop.reason != "breakpoint":
            stop = Stop("start", "at the beginning")
        return self._stopped(stop)

    # ---- edits, and who wrote what

    def edit(self, place: Cell | Place, value: int) -> int:
        """Set a value; what came after this moment has not happened.

        Returns:
            How many edits that had been made later are forgotten.

        Raises:
            InputError: NP352, a value that does not fit; no frame whose pixel could be set.
        """
        cell = place if isinstance(place, Cell) else getattr(place, "cell", None)
        most = 1 if cell is not None and cell.kind == "flag" else 255
        if not 0 <= value <= most:
            raise InputError("NP352", f"{place}: expected 0 to {most}, found {value}")
        if isinstance(place, Pixel) and self.chip.frame is None:
            raise InputError("NP352", f"{place}: no frame has been exposed yet")
        if cell is not None and cell.kind == "active":
            raise InputError("NP352", "the activity follows from the masks and cannot be set")
        old = place.plane(self.chip).copy() if isinstance(place, Cell) else place.value(self.chip)
        made = Edit(place, value, np.asarray(old))
        forgotten = self._runner.history.edit(self.time, made)
        made.apply(self.chip)
        self._runner.history.keep(self.chip)
        return forgotten

    def who(self, place: Place) -> Written | None:
        """Return the last write of a place, at or before this moment; None if interrupted."""
        self._runner.interrupted.clear()
        here = self.chip.snapshot()
        try:
            return self._search.last_write(place)
        finally:
            self.chip.restore(here)
