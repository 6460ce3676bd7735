"""Moves a chip through time: forward by instructions or whole frames, and back."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Final, TypeVar

from npchip import Chip, RunResult
from npchip.base.errors import InputError
from npchip.debugger.clip import Recorded
from npchip.debugger.conditions import Stop, Watch
from npchip.debugger.history import SPACING, History, Moment
from npchip.debugger.values import Writers
from npchip.engines.base import TrapError
from npchip.engines.state import Write
from npchip.run.outputs import OutputError, read_frame
from npchip.run.result import FrameRecord, Value
from npchip.run.stuck import stuck

_T = TypeVar("_T")

INTERRUPTED: Final = Stop("interrupted", "interrupted")

_FINE: Final = SPACING // 16
"""Instructions between two snapshots just before the target of a way back."""
_LOOK: Final = 256
"""Instructions of a way back between two checks for an interruption."""
_CHUNK: Final = 20_000
"""Instructions that the compiled engine should execute between two snapshots."""
_MOST_FRAMES: Final = 64
_WORTH: Final = 4_000
"""Fewest instructions that are worth a call of the compiled engine."""
_RECORDS: Final = 1_000
"""Frames whose outputs are kept."""


class Runner:
    """Executes a program, records its past and goes back.

    The state at a moment does not depend on how it was reached. The compiled engine runs whole
    frames in which no condition can be met; all others are stepped.

    Args:
        chip: the chip, just reset and fed with `clip`.
        clip: the frames.
        writers: the writers of the chip's program.
        max_cycles: limit for the cycles of one frame.

    Attributes:
        history: snapshots and edits.
        records: outputs and cycles of the last complete frames, by number.
        interrupted: stops the present movement when another thread sets it.
        on_frame: called with each complete frame when it is executed, also when it is again.
    """

    def __init__(
        self, chip: Chip, clip: Recorded | None, writers: Writers, max_cycles: int
    ) -> None:
        self.chip = chip
        self.clip = clip
        self.max_cycles = max_cycles
        self.interrupted = threading.Event()
        self.on_frame: Callable[[int, FrameRecord], None] = lambda _frame, _record: None
        self._exposes = writers.exposes
        self._first = chip.snapshot()
        self._slow = 0  # frames to step before the compiled engine is tried again
        self._backoff = 1
        self._frames = _MOST_FRAMES  # frames to try at once
        self._begin()

    def _begin(self) -> None:
        self.history = History()
        self.history.keep(self.chip)
        self.records: dict[int, FrameRecord] = {}
        self._spacing = SPACING
        self._due = SPACING
        self._excused = -1  # time of the last message that outputs cannot be read

    def restart(self) -> None:
        """Go to the beginning and forget the past."""
        self.chip.restore(self._first)
        self._begin()

    # ---- forward

    def forward(
        self,
        watch: Watch,
        *,
        time: int | None = None,
        frame: int | None = None,
        goal: Callable[[], bool] | None = None,
    ) -> tuple[Stop, list[int]]:
        """Execute until there is a reason to stop.

        Args:
            watch: stop when it finds something.
            time: stop at this number of instructions since reset.
            frame: stop just after the expose with which this many frames have been taken.
            goal: stop when this returns True.

        Returns:
            the stop, and the numbers that the watch found there.
        """
        chip = self.chip
        self._slow, self._backoff, self._frames = 0, 1, _MOST_FRAMES
        self._spacing = SPACING
        self._due = self.history.due(chip.instructions)
        watch.begin()
        tried = -1  # frames taken when the compiled engine was tried last
        while True:
            if time is not None and chip.instructions >= time:
                return Stop("step", ""), []
            found = None
            if goal is None and tried != chip.frames_taken:
                tried = chip.frames_taken
                found = self._fast(watch, time, frame)
            if found is None:
                address = chip.pc
                ended = self.advance()
                if ended is not None and ended.reason != "halted":
                    return ended, []
                found = watch.after(address)
                if ended is not None:
                    return ended, found
                if chip.instructions in self.history.edits:
                    watch.begin()
            if found:
                return Stop("breakpoint", ""), found
            if frame is not None and chip.frames_taken >= frame:
                return Stop("frame", ""), []
            if goal is not None and goal():
                return Stop("step", ""), []
            if self.interrupted.is_set():
                return INTERRUPTED, []

    def advance(self, written: list[Write] | None = None, *, replay: bool = False) -> Stop | None:
        """Execute one instruction; return a stop if that is impossible or ends the run.

        Args:
            written: list to which the writes of the instruction are appended.
            replay: skip the checks of limit and outputs, which were made the first time.
        """
        chip = self.chip
        exposes = chip.pc in self._exposes
        if not replay and chip.frame_cycles >= self.max_cycles + exposes:
            what = f"frame {chip.frames_taken - 1}" if chip.frames_taken else "the set-up"
            reached = f"{what} has reached {self.max_cycles:,} cycles"
            return Stop("cycle-limit", f"{reached}, {stuck(chip).loops}")
        if exposes:
            wrong = None if replay else self._complete()
            if wrong is not None:
                return wrong
            if self.clip is None or not self.clip.has(chip.frames_taken):
                why = "no frames were given" if self.clip is None else "no frame is left"
                return Stop("frames-exhausted", why)
        try:
            ended = chip.step(written)
        except TrapError as fault:
            return Stop("trap", f"{fault} [{fault.code}]")
        now = chip.instructions
        if exposes:
            self.history.note_exposed(chip.frames_taken - 1, now)
        for edit in self.history.edits.get(now, ()):
            edit.apply(chip)
        if now >= self._due:
            self.history.keep(chip)
            self._due = now + self._spacing
        if ended is None:
            return None
        return (None if replay else self._complete()) or Stop("halted", "the program has halted")

    # ---- outputs

    def _complete(self) -> Stop | None:
        """Record the outputs of the frame that ends; return a stop once if they are unreadable."""
        chip = self.chip
        try:
            outputs = read_frame(chip.program, chip.sends)
        except OutputError as fault:
            if self._excused == chip.instructions:
                return None
            self._excused = chip.instructions
            return Stop("outputs", f"{fault}, sent at address {fault.address} [{fault.code}]")
        self._record(chip.frames_taken - 1, FrameRecord(chip.frame_cycles, 0, outputs))
        return None

    def outputs(self) -> dict[str, Value]:
        """Return the outputs of this frame so far; None for those that cannot be read yet."""
        chip = self.chip
        try:
            return read_frame(chip.program, chip.sends)
        except OutputError:
            values: dict[str, Value] = {}
            for output in chip.program.outputs:
                sends = [send for send in chip.sends if send.port == output.port]
                try:
                    values[output.name] = read_frame(chip.program, sends)[output.name]
                except OutputError:
                    values[output.name] = None
            return values

    def _record(self, frame: int, record: FrameRecord) -> None:
        self.records[frame] = record
        self.on_frame(frame, record)
        while len(self.records) > _RECORDS:
            del self.records[min(self.records)]

    # ---- whole frames

    def _fast(self, watch: Watch, time: int | None, frame: int | None) -> list[int] | None:
        """Let the compiled engine execute whole frames, if no condition can be met in them.

        Returns:
            numbers of the conditions met just after the expose reached; None if the chip has not
            moved.
        """
        chip = self.chip
        if self.clip is None or chip.pc in self._exposes:
            return None
        if self._slow:
            self._slow -= 1
            return None
        if time is not None and time - chip.instructions < _WORTH:
            return None
        count = self._count(time, frame)
        if count < 1:
            return None
        before, executions = chip.snapshot(), chip.executions
        while count >= 1:
            result = self._frames_done(count)
            if result is not None and not (
                watch.stops_at(chip.pc) or watch.touched(chip.executions - executions)
            ):
                end = chip.instructions + 1
                if time is None or end <= time:
                    self._frames = 4 * count
                    return self._finish(watch, result)
            chip.restore(before)
            count //= 4
        self._slow, self._backoff = self._backoff, min(2 * self._backoff, _MOST_FRAMES)
        return None

    def _count(self, time: int | None, frame: int | None) -> int:
        """Return the number of exposes that the compiled engine should pass."""
        now, taken, exposed = self.chip.instructions, self.chip.frames_taken, self.history.exposed
        if time is not None and exposed and time <= exposed[-1]:
            count = self.history.frame_at(time) - taken  # the past is known
        else:
            rate = max(1, now // max(1, taken))
            count = max(1, min(_MOST_FRAMES, self._frames, _CHUNK // rate))
            if time is not None:
                count = min(count, (time - now) // rate)
        if frame is not None:
            count = min(count, frame - taken)
        edit = min((at for at in self.history.edits if at > now), default=None)
        return count if edit is None else min(count, self.history.frame_at(edit) - taken)

    def _frames_done(self, count: int) -> RunResult | None:
        """Run to the expose number `count` from here; return None if the run ends otherwise."""
        chip, clip = self.chip, self.clip
        assert clip is not None
        last = chip.frames_taken + count - 1
        try:
            if not clip.has(last):
                return None
            clip.until = last
            result = chip.run(max_cycles=self.max_cycles)
        except InputError:  # a damaged frame: stepping finds it
            return None
        finally:
            clip.until = None
        done = result.status == "frames-exhausted" and result.frames == count - 1
        return result if done else None

    def _finish(self, watch: Watch, result: RunResult) -> list[int]:
        """Record the frames, and execute the next expose."""
        chip = self.chip
        lengths = result.frame_instructions[::-1].cumsum()[::-1]
        for index, length in enumerate(lengths.tolist()):
            self.history.note_exposed(result.first_frame + index, chip.instructions - length + 1)
        self._record(result.first_frame - 1, result.setup)
        for index in range(max(0, result.frames - _RECORDS), result.frames):
            outputs = {name: result.value(name, index) for name in result.outputs}
            cycles = int(result.frame_cycles[index])
            self._record(result.first_frame + index, FrameRecord(cycles, 0, outputs))
        self._due = self.history.due(chip.instructions, _CHUNK // 2)
        address = chip.pc
        self.advance(replay=True)
        found = watch.after(address)
        if chip.instructions in self.history.edits:
            watch.begin()
        return found

    # ---- backward

    def seek(self, time: int) -> None:
        """Go to a moment of the past, or less far if interrupted."""
        chip = self.chip
        moment = self.history.before(time)
        if not moment.time <= chip.instructions <= time:
            chip.restore(moment.snapshot)
        nothing = Watch(chip)
        self._slow, self._frames = 0, _MOST_FRAMES
        tried = -1
        while chip.instructions < time and not self.interrupted.is_set():
            if tried != chip.frames_taken:
                tried = chip.frames_taken
                if self._fast(nothing, time, None) is not None:
                    continue
            now = chip.instructions
            self._spacing = _FINE if time - now <= SPACING else SPACING
            self._due = self.history.due(now, self._spacing)
            end = min(time, now + _LOOK)
            while chip.instructions < end:
                if self.advance(replay=True) is not None and chip.instructions < end:
                    return

    def intervals(
        self, until: int, matters: Callable[[Moment, Moment], bool]
    ) -> Iterator[tuple[Moment, int]]:
        """Restore the snapshots of the past, newest first; yield each with its interval's end.

        Args:
            until: the end of the newest interval.
            matters: tells whether to visit the interval between two snapshots; the newest is
                always visited.
        """
        later: Moment | None = None
        for moment in self.history.moments(until):
            if later is None or matters(moment, later):
                self.chip.restore(moment.snapshot)
                yield moment, until
            until, later = moment.time, moment

    def replay(
        self, end: int, candidates: frozenset[int], before: Callable[[], _T]
    ) -> Iterator[tuple[_T, list[Write]]]:
        """Execute again from the present moment to a later one.

        Args:
            end: the later moment.
            candidates: addresses of the instructions to report.
            before: called before each of these.

        Yields:
            after each of these, the result of `before` and the writes of the instruction.
        """
        chip = self.chip
        self._spacing, self._due = SPACING, self.history.due(chip.instructions)
        while chip.instructions < end and not self.interrupted.is_set():
            if chip.pc in candidates:
                noted, written = before(), list[Write]()
                ended = self.advance(written, replay=True)
                yield noted, written
            else:
                ended = self.advance(replay=True)
            if ended is not None:
                return
