"""Runs a translated program: loads the state, feeds frames, delivers results, reads the state."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.engines.base import Feed, Partner, Request, Sink, Stop
from npchip.engines.state import ChipState
from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.host.instance import Instance
from npchip.engines.wasm.host.log import Log
from npchip.engines.wasm.translation import Translation

_SLICE: Final = 250_000
"""Cycles of a frame after which the module calls the host, so that Ctrl-C works."""
_BATCH_CYCLES: Final = 20_000_000
"""Cycles that a batch should take at most, so that Ctrl-C works."""
_FIRST_BATCH: Final = 64
"""Frames of the first batch. Their cycles decide the size of the next."""


class RewoundError(Exception):
    """A run had to go back: the state is that of the last refill.

    Attributes:
        skip: frames from there on that the sink has had. An empty one counts too: a run that
            begins at an expose first closes a frame without cycles.
        error: the sink's exception for the last of them; None if the next one has reached the
            cycle limit.
    """

    def __init__(self, skip: int, error: BaseException | None) -> None:
        super().__init__()
        self.skip = skip
        self.error = error


class Session(Instance):
    """An instance of a translated program that can be run.

    Args:
        translation: the translated program.
        hear: asks the partner for an input.
    """

    def __init__(self, translation: Translation, hear: Partner = lambda _: None) -> None:
        self.translation = translation
        self._stops = translation.stops != "never"
        self._hear = hear
        super().__init__(translation)
        self._log = Log(translation, self._part, self._records, self._assemble)
        self._addresses, self._counters_of = _steps_of(translation)

    # ---- running

    def run(
        self, state: ChipState, feed: Feed, limit: int, sink: Sink, *, single: bool = False
    ) -> Stop | None:
        """Run from `state`, which must be at the place where the translation begins.

        Args:
            state: where to begin; updated at the end of the run.
            feed: provides the frames.
            limit: cycle limit of one frame. A translation that can stop before every step stops
                there.
            sink: takes the complete frames.
            single: whether frames are taken one at a time, so that an exception of the sink ends
                the run at the end of the frame.

        Returns:
            "frames-exhausted" if the run has ended, and None if the state is that before an
            instruction for the reference engine.

        Raises:
            RewoundError: the limit or an exception of the sink was passed.
            BaseException: raised by the feed, the partner or a signal handler.
        """
        self._state, self._feed, self._sink = state, feed, sink
        self._limit, self._single = limit, single
        self._error: BaseException | None = None
        self._ended = False
        self._load(state)
        self._start_batch(0, None)
        try:
            number = self._enter()
            if not (self._stops or self._within_limit(number)):
                self._over_limit()
            self._deliver()
        except RewoundError:
            raise
        except BaseException:
            self._rewind()
            raise
        self._leave(number)
        if self._error is not None:
            raise self._error
        return "frames-exhausted" if self._ended else None

    def _load(self, state: ChipState) -> None:
        self._load_arrays(state)
        self._words[at.CONVERSIONS // 4] = state.conversions
        self._words[at.FRAME // 4] = self._layout.first_frame
        self._longs[at.CYCLES // 8] = state.frame_cycles
        self._longs[at.INSTRUCTIONS // 8] = state.frame_instructions
        self._longs[at.CHECK // 8] = min(self._limit, state.frame_cycles + _SLICE)
        self._longs[at.FIRST_CHECK // 8] = min(self._limit, _SLICE)
        self._words[at.AVAILABLE // 4] = 0
        self._counts[:] = 0
        self._cycles = -state.frame_cycles  # of the run's closed frames
        self._instructions = -state.frame_instructions
        self._frames_before = state.frames_taken
        self._heard = state.frames_taken, dict(state.received)
        self._longs[at.TAKEN // 8] = self._frames_before
        self._prefix = list(state.sends)

    def _leave(self, number: int) -> None:
        """Read the state from the module, which has stopped at a block."""
        state, place = self._state, self.translation.blocks[number].first.place
        self._complete(number)
        self._unload_arrays(place.depth, state)
        taken = int(self._words[at.POSITION // 4])
        if self._frames_before + taken > state.frames_taken:
            state.pixels = self._pixels()
        state.frames_taken = self._frames_before + taken
        state.received = self._received(state.frames_taken)
        state.pc, state.stack, state.depth = place.address, list(place.stack), place.depth
        state.conversions = int(self._words[at.CONVERSIONS // 4])
        state.frame_cycles = int(self._longs[at.CYCLES // 8])
        state.frame_instructions = int(self._longs[at.INSTRUCTIONS // 8])
        state.cycles += self._cycles + state.frame_cycles
        state.instructions += self._instructions + state.frame_instructions
        state.sends = self._log.pending_sends()
        np.add.at(state.executions, self._addresses, self._counts[self._counters_of])
        if self.translation.rows is not None and state.counts is not None:
            state.counts.add(self.translation.rows, self._counts)

    # ---- batches

    def _start_batch(self, available: int, number: int | None) -> None:
        """Begin a batch at a block with an empty log, and save the state."""
        self._words[at.POSITION // 4] = 0
        self._words[at.AVAILABLE // 4] = available
        self._log.clear(self._prefix)
        self._saved_block = number
        self._saved = self._part(0, self._layout.records).copy()
        self._saved_totals = self._cycles, self._instructions
        self._saved_taken = self._sink.taken
        self._saved_heard = self._heard[0], dict(self._heard[1])

    def _refill(self, number: int) -> int:
        """Deliver the complete frames and refill the ring buffer. Answer 0 if the input ends."""
        available = int(self._words[at.AVAILABLE // 4])
        index = self._frames_before + available
        most = self._next_batch_size(available)
        try:
            with self._signals.immediate():
                frames = self._feed.frames(index, most)
        except BaseException as error:  # noqa: BLE001 - raised at the end of the run
            self._error = error
            self._reopen()
            return 0
        if not len(frames):
            self._ended = True
            return 0
        self._deliver()
        if self._error is not None:
            return 0
        self._prefix = []
        self._frames_before = self._longs[at.TAKEN // 8] = index
        if available:  # keep the exposed frame, as the ring buffer is overwritten
            self._words[at.FRAME // 4] = self._layout.first_frame
            self._part(self._layout.first_frame, self._layout.frame_bytes)[:] = self._ring[
                available - 1
            ]
        self._start_batch(len(frames), number)
        self._ring[: len(frames)] = frames.reshape(len(frames), -1)
        return 1

    def _next_batch_size(self, available: int) -> int:
        """Return the number of frames of the next batch, by the cycles of the last one."""
        if not available or self._single:
            return 1 if self._single else min(_FIRST_BATCH, self._layout.ring)
        closed = self._records[: self._words[at.CLOSED // 4], 0]
        cycles = self._cycles - self._saved_totals[0] + int(closed.sum())
        each = max(1, cycles // available)
        return max(1, min(self._layout.ring, 8 * available, _BATCH_CYCLES // each))

    def _drain(self, _about: int) -> int:
        """Deliver the complete frames, to make room in the log."""
        self._deliver()
        return 0

    def _reopen(self) -> None:
        """Open again the frame that the module has just closed."""
        closed = self._words[at.CLOSED // 4] = self._words[at.CLOSED // 4] - 1
        self._longs[at.CYCLES // 8], self._longs[at.INSTRUCTIONS // 8] = self._records[closed, :2]

    def _deliver(self) -> None:
        """Hand the complete frames to the sink.

        Raises:
            RewoundError: the sink has raised an exception.
        """
        batch = self._log.complete()
        if batch is not None:
            try:
                with self._signals.immediate():
                    self._sink.take(batch)
            except BaseException as error:  # noqa: BLE001 - raised at the end of the run
                if not self._single:
                    raise self._back(error) from None
                self._error = error
            self._cycles += int(batch.cycles.sum())
            self._instructions += int(batch.instructions.sum())
        self._log.discard()

    # ---- cycles

    def _tick(self, number: int) -> int:
        """Set the next check of a frame that takes long, or end the run at its limit.

        Answers 1 if the module must return.
        """
        if not self._within_limit(number):
            return 1
        cycles = int(self._longs[at.CYCLES // 8])
        self._longs[at.CHECK // 8] = min(max(self._limit, cycles), cycles + _SLICE)
        return 0

    def _within_limit(self, number: int) -> bool:
        """Return whether a block may begin. At the limit an expose may, which closes the frame."""
        more = self._limit - int(self._longs[at.CYCLES // 8])
        return more > 0 or (more == 0 and self.translation.blocks[number].exposes)

    def _over_limit(self) -> None:
        self._deliver()
        raise self._back(None)

    def _back(self, error: BaseException | None) -> RewoundError:
        skip = self._sink.taken - self._saved_taken + (self._saved_block is not None)
        self._rewind()
        return RewoundError(skip, error)

    def _rewind(self) -> None:
        """Set the state back to the last refill. Before the first, it has not changed."""
        if self._saved_block is None:
            return
        self._part(0, self._layout.records)[:] = self._saved
        self._cycles, self._instructions = self._saved_totals
        self._heard = self._saved_heard
        self._log.clear(self._prefix)
        self._leave(self._saved_block)

    # ---- inputs

    def _receive(self, number: int) -> int:
        """Get the input of a block from the partner. Answer 0 if there is none."""
        port = self.translation.blocks[number].port
        assert port is not None
        taken = self._frames_before + int(self._words[at.POSITION // 4])
        received = self._received(taken)
        before = received.get(port, 0)
        try:
            request = Request(port, taken - 1, before, int(self._longs[at.CYCLES // 8]))
            with self._signals.immediate():
                data = self._hear(request)
        except BaseException as error:  # noqa: BLE001 - raised at the end of the run
            self._error = error
            return 0
        if data is None:
            return 0
        received[port] = before + 1
        self._planes(self._layout.received, 1)[0, : self._layout.lanes] = data.reshape(-1)
        return 1

    def _received(self, taken: int) -> dict[int, int]:
        """Return the number of inputs by port since the latest of `taken` exposures."""
        if self._heard[0] != taken:
            self._heard = taken, {}
        return self._heard[1]


def _steps_of(translation: Translation) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the addresses and the execution counters of all steps."""
    pairs = [
        (step.place.address, counter)
        for block in translation.blocks
        if not block.leaves
        for _, step, counter in translation.counters.steps(block)
    ]
    addresses, counters = np.array(pairs, np.int64).reshape(-1, 2).T
    return addresses, counters
