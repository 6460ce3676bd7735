"""A translated program at work: state in, frames in, results out, state back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.engines.base import Feed, Hear, Request, Sink
from npchip.engines.state import ChipState
from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.runtime import CONVERT, DRAIN, PROBE, RECEIVE, REFILL, TICK
from npchip.engines.wasm.host.instance import Instance
from npchip.engines.wasm.host.log import Log
from npchip.engines.wasm.translate.steps import Place
from npchip.engines.wasm.translation import Translation
from npchip.machine.sensor import SensorModel

_SLICE: Final = 250_000
"""Cycles of a frame after which Python gets a turn, and with it Ctrl-C."""
_COUNTED: Final = 1 << 29
"""What a part of a mask's count may come to in a batch: an eighth of what 32 bits hold."""
_BATCH_CYCLES: Final = 20_000_000
"""Cycles that a ring of frames should take at most, for the same reason."""
_FIRST_BATCH: Final = 64
"""Frames of the first batch: what they take tells how many the next may be."""


@dataclass(eq=False)
class Rewound:
    """A run that did not end where the state can be taken: that is now as at the last refill.

    Attributes:
        skip: frames from here on that the sink has had, with one that is none: where a run
            begins at an expose, it begins by closing a frame without any cycle.
        frames: frames to take until the one whose taking failed is the next to be complete.
        error: what the sink raised; None where a frame has reached the cycle limit.
    """

    skip: int
    frames: int = 0
    error: BaseException | None = None


class _StopError(Exception):
    """Leaves the module."""


class _OutOfCyclesError(Exception):
    """Leaves the module where a frame has reached its limit."""


class Session(Instance):
    """An instance of a translated program.

    Args:
        translation: the program.
        sensor: what a conversion reads.
        probe: called before every block of a translation with probes.
        hear: asks the partner.

    Attributes:
        longest: cycles that can pass at most between two looks at the limit.
    """

    def __init__(
        self,
        translation: Translation,
        sensor: SensorModel,
        probe: Callable[[Place, ChipState], None] | None = None,
        hear: Hear = lambda _: None,
    ) -> None:
        self._translation = translation
        self._sensor = sensor
        self._probe = probe
        self._hear = hear
        self.longest = sum(step.cycles for block in translation.blocks for step in block.steps)
        methods: dict[int, Callable[[Session, int], int]] = {
            REFILL: Session._refill,
            TICK: Session._tick,
            DRAIN: Session._give,
            CONVERT: Session._convert,
            RECEIVE: Session._receive,
            PROBE: Session._tell,
        }
        super().__init__(translation, [methods[number] for number in sorted(methods)])
        offsets = self._planes(self._layout.offsets, at.PLANES)
        offsets[:, : self._layout.lanes] = sensor.offsets.reshape(at.PLANES, -1)
        # Each cycle adds at most four for each vector of 16 NPs to a part of a mask's count.
        most = _COUNTED // (4 * self._layout.ring * self._layout.vectors)
        self._slice = min(_SLICE, most) if len(self._parts) else _SLICE
        self._log = Log(self._layout, self._part, self._records, translation.sites)
        self._addresses, self._counters_of = _steps_of(translation)

    # ---- running

    def run(
        self, state: ChipState, feed: Feed, limit: int, sink: Sink, *, check: int | None = None
    ) -> Rewound | None:
        """Run from `state` on, which must be where the translation begins.

        Args:
            state: taken over, and updated when the run ends.
            feed: gives the frames.
            limit: cycles of one frame.
            sink: takes the frames.
            check: cycles at which a module that ends exactly hands its state back.

        Returns:
            None where the state is that before an instruction for the reference engine.
        """
        self._state, self._feed, self._sink = state, feed, sink
        self._limit, self._ends = (limit, False) if check is None else (check, True)
        self._rewound: Rewound | None = None
        self._error: BaseException | None = None
        self._load(state)
        self._start_batch(0, None)
        try:
            number = self._enter()
        except _StopError:
            return self._rewound
        except _OutOfCyclesError:
            return self._out_of_cycles()
        except BaseException:
            self._restore()
            raise
        if not self._ends and int(self._longs[at.CYCLES // 8]) >= limit:
            return self._out_of_cycles()
        self._complete(number)
        rewound = self._deliver(pending=False)
        if rewound is None:
            self._unload(self._place(number))
            if self._error is not None:
                raise self._error
        return rewound

    def _load(self, state: ChipState) -> None:
        self._load_arrays(state)
        self._words[at.CONVERSIONS // 4] = state.conversions
        self._words[at.FRAME // 4] = self._layout.first_frame
        self._words[at.CALLS // 4] = len(state.stack)
        self._calls[: len(state.stack)] = state.stack
        self._longs[at.CYCLES // 8] = state.frame_cycles
        self._longs[at.INSTRUCTIONS // 8] = state.frame_instructions
        self._longs[at.CHECK // 8] = min(self._limit, state.frame_cycles + self._slice)
        self._longs[at.FIRST_CHECK // 8] = min(self._limit, self._slice)
        self._words[at.AVAILABLE // 4] = 0
        self._counts[:] = 0
        self._parts[:] = 0
        self._cycles = -state.frame_cycles  # since the run began, as frames are closed
        self._instructions = -state.frame_instructions
        self._frames_before = state.frames_taken
        self._heard = state.frames_taken, dict(state.received)
        self._prefix = list(state.sends)

    def _place(self, number: int) -> Place:
        """Where the program stands when a block begins."""
        place = self._translation.blocks[number].first.place
        if not self._layout.return_addresses:
            return place
        return place._replace(stack=tuple(self._calls[: self._words[at.CALLS // 4]].tolist()))

    def _unload(self, place: Place) -> None:
        """The state is that in the memory, at `place`."""
        state = self._state
        self._unload_arrays(place.depth, state)
        taken = int(self._words[at.POSITION // 4])
        if self._frames_before + taken > state.frames_taken:
            state.pixels = self._pixels()
        state.frames_taken = self._frames_before + taken
        state.received = self._received(state.frames_taken)
        state.pc, state.stack, state.depth = place.address, list(place.stack), place.depth
        state.conversions = int(self._words[at.CONVERSIONS // 4])
        self._carry()
        state.frame_cycles, state.frame_instructions = self._cycles_and_instructions()
        state.cycles += self._cycles + state.frame_cycles
        state.instructions += self._instructions + state.frame_instructions
        sends = self._log.of_pending()
        state.sends = sends if self._log.closed else [*self._prefix, *sends]
        np.add.at(state.executions, self._addresses, self._counts[self._counters_of])
        if self._translation.rows is not None and state.counts is not None:
            state.counts.add(self._translation.rows, self._counts)

    # ---- batches

    def _start_batch(self, available: int, place: Place | None) -> None:
        """Begin with an empty log, and remember where the program stands: at `place`."""
        self._words[at.POSITION // 4] = 0
        self._words[at.AVAILABLE // 4] = available
        self._log.clear()
        self._saved_place = place
        self._saved = self._part(0, self._layout.records).copy()
        self._saved_totals = self._cycles, self._instructions
        self._saved_heard = self._heard[0], dict(self._heard[1])

    def _refill(self, number: int) -> int:
        """The ring is empty: hand over what is complete and fill it again."""
        available = int(self._words[at.AVAILABLE // 4])
        index = self._frames_before + available
        most = self._most(available)
        try:
            with self._signals.in_place():
                frames = self._feed.frames(index, most)
        except BaseException as error:  # noqa: BLE001 - raised again where the state fits
            self._error = error
            return 0
        if not len(frames):
            return 0
        self._rewound = self._deliver(pending=True)
        if self._rewound is not None:
            raise _StopError
        self._prefix = []
        self._frames_before = index
        self._longs[at.CYCLES // 8] = self._longs[at.INSTRUCTIONS // 8] = 0
        if available:  # the frame that is exposed now, should nothing else be
            self._words[at.FRAME // 4] = self._layout.first_frame
            self._part(self._layout.first_frame, self._layout.frame_bytes)[:] = self._ring[
                available - 1
            ]
        self._complete(number)
        self._start_batch(len(frames), self._place(number))
        self._ring[: len(frames)] = frames.reshape(len(frames), -1)
        return 1

    def _most(self, available: int) -> int:
        """Frames of the next batch, by how long the last one took."""
        if not available:
            return min(_FIRST_BATCH, self._layout.ring)
        closed = self._records[: available - 1, 0]
        cycles = int(closed.sum()) + int(self._longs[at.CYCLES // 8])
        each = max(1, cycles // available)
        return max(1, min(self._layout.ring, 8 * available, _BATCH_CYCLES // each))

    def _carry(self) -> None:
        """Carry the counts of masks over to their counters.

        Before 32 bits can be full: see `_slice`.
        """
        if len(self._parts):
            self._counts[self._layout.plain :] += self._parts.sum(axis=1, dtype=np.int64)
            self._parts[:] = 0

    def _give(self, _about: int) -> int:
        """There is no room for more sends."""
        self._carry()
        self._log.drain()
        return 0

    def _deliver(self, *, pending: bool) -> Rewound | None:
        """Hand the complete frames over, and with `pending` the one at work."""
        before = self._sink.taken
        self._carry()
        work = self._cycles_and_instructions() if pending else None
        batch = self._log.batch(work, self._prefix)
        count = len(batch.cycles)
        if count:
            try:
                with self._signals.in_place():
                    self._sink.take(batch)
            except BaseException as error:  # noqa: BLE001 - raised again where the state fits
                had = self._sink.taken - before + (self._saved_place is not None)
                self._restore()
                # After an expose frame k of the batch ends where k + 1 frames are taken; the one
                # whose taking failed is not handed over again.
                return Rewound(had, had - 1, error)
        self._cycles += int(batch.cycles.sum())
        self._instructions += int(batch.instructions.sum())
        return None

    def _cycles_and_instructions(self) -> tuple[int, int]:
        """Of the frame at work."""
        return int(self._longs[at.CYCLES // 8]), int(self._longs[at.INSTRUCTIONS // 8])

    # ---- cycles

    def _tick(self, _about: int) -> int:
        """A frame takes long: say when to ask again, or end; 1 for a module that ends exactly."""
        self._carry()
        cycles = int(self._longs[at.CYCLES // 8])
        if cycles < self._limit:
            self._longs[at.CHECK // 8] = min(self._limit, cycles + self._slice)
            return 0
        if not self._ends:
            raise _OutOfCyclesError
        return 1

    def _out_of_cycles(self) -> Rewound:
        before = self._sink.taken
        rewound = self._deliver(pending=False)
        if rewound is not None:
            return rewound
        skip = self._sink.taken - before + (self._saved_place is not None)
        self._restore()
        return Rewound(skip)

    def _restore(self) -> None:
        """Take the state back to the last refill; without any it has not changed yet."""
        if self._saved_place is None:
            return
        self._part(0, self._layout.records)[:] = self._saved
        self._cycles, self._instructions = self._saved_totals
        self._heard = self._saved_heard
        self._log.forget()
        self._unload(self._saved_place)

    # ---- inputs

    def _receive(self, number: int) -> int:
        """The block of this number begins with an input."""
        port = self._translation.blocks[number].port
        assert port is not None
        taken = self._frames_before + int(self._words[at.POSITION // 4])
        received = self._received(taken)
        before = received.get(port, 0)
        try:
            request = Request(port, taken - 1, before, int(self._longs[at.CYCLES // 8]))
            with self._signals.in_place():
                data = self._hear(request)
        except BaseException as error:  # noqa: BLE001 - raised again where the state fits
            self._error = error
            return 0
        if data is None:
            return 0
        received[port] = before + 1
        self._planes(self._layout.received, 1)[0, : self._layout.lanes] = data.reshape(-1)
        return 1

    def _received(self, taken: int) -> dict[int, int]:
        """Inputs of the frame before which `taken` were taken, by port."""
        if self._heard[0] != taken:
            self._heard = taken, {}
        return self._heard[1]

    # ---- probes

    def _tell(self, number: int) -> int:
        """Show the probe the registers, flags and memory before a block."""
        assert self._probe is not None
        place = self._translation.blocks[number].first.place
        self._complete(number)
        state = self._state.copy()
        self._unload_arrays(place.depth, state)
        self._probe(place, state)
        return 0

    # ---- conversions

    def _convert(self, signal: int) -> int:
        """Convert all pixels into the buffer, with noise."""
        frame = self._frames_before + int(self._words[at.POSITION // 4])
        conversion = int(self._words[at.CONVERSIONS // 4])
        pixels = self._pixels() if signal else None
        data = self._sensor.sample(bool(signal), pixels, frame, conversion)
        where = self._layout
        self._planes(where.converted, at.PLANES)[:, : where.lanes] = data.reshape(at.PLANES, -1)
        return 0


def _steps_of(translation: Translation) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Address and counter of every step that is counted."""
    pairs = [
        (step.place.address, counter)
        for block in translation.blocks
        if not block.leaves
        for _, step, counter in translation.counters.steps(block)
    ]
    table = np.array(pairs, np.int64).reshape(-1, 2)
    return table[:, 0], table[:, 1]
