"""The compiled engine: sessions of translated programs, and the reference engine for the rest.

A session ends before every instruction that it does not know how to execute: the end of the
input, a halt, a trap. The reference engine then executes that one, so that errors and their texts
have one author. Where a frame reaches the cycle limit, or a frame cannot be handed over, the
state goes back to the last refill and the way from there is repeated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.engines.base import Feed, Partner, Sink, Stop
from npchip.engines.batch import FrameBatch
from npchip.engines.reference.engine import ReferenceEngine
from npchip.engines.state import Write
from npchip.engines.wasm.host.session import Rewound, Session
from npchip.engines.wasm.translate.executed import ANY, MASKS, SAME
from npchip.engines.wasm.translate.steps import Place, TooLargeError, is_foreign
from npchip.engines.wasm.translation import translate
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.machine.sensor import SensorModel
from npchip.program.model import Program

_SESSIONS: Final = 4
"""Translations that are kept: a program is translated anew for each place where a run begins."""
_MOST_TRANSLATIONS: Final = 16
"""In a run: with more, translating takes longer than what is translated saves."""
_LARGEST: Final = 4096
"""NPs: dealing the pixels out to planes takes code for each vector of 16 NPs."""
_LARGEST_PROFILED: Final = 4080
"""NPs of a profile: how many are active is counted in bytes, one for each lane of a vector."""


class WasmEngine:
    """Executes a program as WebAssembly SIMD.

    A program whose routines can neither be copied nor shared, whose module would be too large, or
    that often leaves it at ever other places, and an array of more than 4,096 NPs, are left to the
    reference engine; `name` and `notice` then say so.

    Args:
        program: what to execute.
        machine: geometry, memories, cycles and sensor.
        isa: the instruction set that the program was assembled with.
        profile: whether to count what a profile needs.
    """

    name = "wasm"

    def __init__(
        self, program: Program, machine: Machine, isa: Isa, *, profile: bool = False
    ) -> None:
        self._reference = ReferenceEngine(program, machine, isa, profile=profile)
        self.state = self._reference.state
        self._program = program
        self._machine = machine
        self._isa = isa
        self._sensor = SensorModel(machine.sensor, machine.np_rows, machine.np_cols)
        self.notice = ""
        self._translations = 0  # in this run
        largest = _LARGEST_PROFILED if profile else _LARGEST
        if self.state.zero.size > largest:
            self._leave(f"the array has more than {largest:,} NPs")
        self._sessions: dict[tuple[Place, bool], tuple[dict[int, int], Session]] = {}

    @property
    def partner(self) -> Partner | None:
        """See `Engine.partner`."""
        return self._reference.partner

    @partner.setter
    def partner(self, partner: Partner | None) -> None:
        self._reference.partner = partner

    def step(
        self, feed: Feed, on_frame: Callable[[FrameBatch], None], written: list[Write] | None = None
    ) -> Stop | None:
        """See `Engine.step`: one instruction is the reference engine's business."""
        return self._reference.step(feed, on_frame, written)

    def refresh(self) -> None:
        """See `Engine.refresh`."""
        self._reference.refresh()

    def run(self, feed: Feed, limit: int, sink: Sink) -> Stop:
        """See `Engine.run`."""
        state = self.state
        handover = _Handover(sink)
        self._translations = 0
        while not state.halted and state.frame_cycles < limit:
            if self._is_foreign():  # no session needs to be made to find that out
                stop = self._reference.step(feed, handover.take)
                if stop is not None:
                    return stop
                continue
            session = self._session()
            if session is None:
                break
            rewound = self._guarded(partial(session.run, state, feed, limit, handover))
            if rewound is not None:
                handover.skip = rewound.skip
                if rewound.error is None:
                    self._approach(feed, limit, handover)
                    break
                self._repeat(rewound, feed, limit, handover)
                raise rewound.error
            if state.frame_cycles >= limit:
                break
            stop = self._reference.step(feed, handover.take)
            if stop is not None:
                return stop
        return self._reference.run(feed, limit, handover)

    def _leave(self, reason: str) -> None:
        self.name = self._reference.name
        self.notice = f"{reason}: the reference engine runs the program, which is much slower"

    def _is_foreign(self) -> bool:
        words, pc = self._program.words, self.state.pc
        decoded = self._isa.decode(words[pc]) if pc < len(words) else None
        return decoded is not None and is_foreign(decoded.form)

    def _guarded(self, run: Callable[[], Rewound | None]) -> Rewound | None:
        try:
            return run()
        finally:
            self._reference.refresh()

    def _session(self, *, exact: bool = False) -> Session | None:
        """A session that begins where the state is; None if there can be none."""
        state = self.state
        if self.notice:
            return None
        place = Place(state.pc, tuple(state.stack), state.depth)
        begin = self._known()
        found = self._sessions.get((place, exact))
        if found is not None:
            claims, session = found
            if all(begin[variable] <= claim for variable, claim in claims.items()):
                return session
            begin = {v: max(claim, begin[v]) for v, claim in claims.items()}
        self._translations += 1
        if self._translations > _MOST_TRANSLATIONS:
            self._leave("it stops at too many places")
            return None
        try:
            translation = translate(
                self._program,
                self._machine,
                self._isa,
                place,
                begin,
                exact=exact,
                profile=state.counts is not None,
            )
            session = Session(translation, self._sensor, hear=self._reference.hear)
        except TooLargeError as error:
            self._leave(str(error))
            return None
        while len(self._sessions) >= _SESSIONS:
            del self._sessions[next(iter(self._sessions))]
        self._sessions[place, exact] = begin, session
        return session

    def _known(self) -> dict[int, int]:
        """For each variable whether all NPs agree: `SAME` or `ANY`."""
        state = self.state
        planes = np.stack([*state.registers, state.zero, state.carry]).reshape(MASKS, -1)
        agree = (planes == planes[:, :1]).all(axis=1).tolist()
        known = {variable: SAME if same else ANY for variable, same in enumerate(agree)}
        return known | {MASKS + region: ANY for region in range(state.depth)}

    def _approach(self, feed: Feed, limit: int, handover: _Handover) -> None:
        """Go near the cycle limit; the reference engine finds the instruction that reaches it."""
        session = self._session(exact=True)
        if session is None:
            return
        check = limit - session.longest
        if check > self.state.frame_cycles:
            self._guarded(lambda: session.run(self.state, feed, limit, handover, check=check))

    def _repeat(self, rewound: Rewound, feed: Feed, limit: int, handover: _Handover) -> None:
        """Go on to the end of the frame whose taking failed."""
        state = self.state
        session = self._session()
        until = _Until(feed, state.frames_taken + rewound.frames)
        if session is None:
            self._reference.run(until, limit, handover)
        else:
            again = self._guarded(partial(session.run, state, until, limit, handover))
            assert again is None
        state.close_frame()


class _Handover:
    """Passes frames on, but for those that the sink has already had."""

    def __init__(self, sink: Sink) -> None:
        self._sink = sink
        self._before = sink.taken
        self._skipped = 0
        self.skip = 0

    @property
    def taken(self) -> int:
        return self._sink.taken - self._before + self._skipped

    def take(self, batch: FrameBatch) -> None:
        count = len(batch.cycles)
        skipped = min(self.skip, count)
        self.skip -= skipped
        self._skipped += skipped
        if skipped < count:
            self._sink.take(batch.part(skipped, count))


@dataclass(eq=False)
class _Until:
    """A feed that ends before frame number `end` since reset."""

    feed: Feed
    end: int

    def planes(self, index: int) -> NDArray[np.uint8] | None:
        return self.feed.planes(index) if index < self.end else None

    def frames(self, index: int, most: int) -> NDArray[np.uint8]:
        most = min(most, self.end - index)
        return self.feed.frames(index, most) if most > 0 else np.empty((0, 0, 0), np.uint8)
