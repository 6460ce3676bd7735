"""The compiled engine: runs translated programs, and leaves the rest to the reference engine.

A session ends before an instruction that compiled code does not execute: a halt, a trap, or an
expose without input. The reference engine executes that one, so only it raises errors. If a frame
reaches the cycle limit or the sink refuses one, the state goes back to the last refill and the
frames up to that point are run again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from threading import Lock
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.engines.base import Feed, Partner, Sink, Stop
from npchip.engines.batch import FrameBatch
from npchip.engines.reference.engine import ReferenceEngine
from npchip.engines.state import Write
from npchip.engines.wasm.host.session import Rewound, Session
from npchip.engines.wasm.translate.steps import TooLargeError, is_foreign
from npchip.engines.wasm.translate.summary import ANY, MASKS, SAME
from npchip.engines.wasm.translation import Translation, translate
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.graph import Place, word_at
from npchip.program.model import Program

_SESSIONS: Final = 4
"""Sessions that are cached: each place where a run begins needs its own translation."""
_MOST_TRANSLATIONS: Final = 16
"""Limit of translations in a run: with more, they take longer than they save."""
_LARGEST_PROFILED: Final = 4080
"""Largest number of NPs for a profile, which counts active NPs in the bytes of a vector."""


class WasmEngine:
    """Executes a program as WebAssembly SIMD.

    The reference engine takes over, and `name` and `notice` say so, if the array has more than
    4,080 NPs and `profile` is on, if the module would be too large, if routines can neither be
    inlined nor shared, or if the program stops at too many places.

    Args:
        program: the program.
        machine: the machine.
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
        self._words = program.decoded(isa)
        self.notice = ""
        self._translations = 0  # in this run
        if profile and self.state.zero.size > _LARGEST_PROFILED:
            self._fall_back(f"a profile of more than {_LARGEST_PROFILED:,} NPs")
        self._translated = _Translations(program, machine, isa, profile=profile)
        self._sessions: dict[_Key, tuple[dict[int, int], Session]] = {}

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
        """See `Engine.step`. The reference engine executes the instruction."""
        return self._reference.step(feed, on_frame, written)

    def refresh(self) -> None:
        """See `Engine.refresh`."""
        self._reference.refresh()

    def run(self, feed: Feed, limit: int, sink: Sink) -> Stop:
        """See `Engine.run`.

        A frame may take just the limit, so sessions stop above it; the reference engine, where.
        """
        state = self.state
        handover = _Handover(sink)
        self._translations = 0
        while not state.halted and state.frame_cycles < limit:
            if self._is_foreign():  # needs no session
                stop = self._reference.step(feed, handover.take)
                if stop is not None:
                    return stop
                continue
            session = self._session()
            if session is None:
                break
            rewound = self._then_refresh(partial(session.run, state, feed, limit + 1, handover))
            if rewound is not None:
                handover.skip = rewound.skip
                if rewound.error is None:
                    self._run_to_limit(feed, limit, handover)
                    break
                self._replay(rewound, feed, limit, handover)
                raise rewound.error
            if state.frame_cycles >= limit:
                break
            stop = self._reference.step(feed, handover.take)
            if stop is not None:
                return stop
        return self._reference.run(feed, limit, handover)

    def another(self) -> WasmEngine | None:
        """See `Engine.another`. The two share what they translate."""
        if self.notice:
            return None
        profile = self.state.counts is not None
        other = WasmEngine(self._program, self._machine, self._isa, profile=profile)
        other._translated = self._translated
        return other

    def _fall_back(self, reason: str) -> None:
        self.name = self._reference.name
        self.notice = f"{reason}: the reference engine runs the program, which is much slower"

    def _is_foreign(self) -> bool:
        word = word_at(self._words, self.state.pc)
        return word is not None and is_foreign(word, self._machine)

    def _then_refresh(self, run: Callable[[], Rewound | None]) -> Rewound | None:
        try:
            return run()
        finally:
            self._reference.refresh()

    def _session(self, *, exact: bool = False) -> Session | None:
        """Return a session that begins at the state's place, or None if there can be none."""
        state = self.state
        if self.notice:
            return None
        key = Place(state.pc, tuple(state.stack), state.depth), exact
        begin = self._known()
        found = self._sessions.get(key)
        if found is not None and _hold(found[0], begin):
            return found[1]
        self._translations += 1
        if self._translations > _MOST_TRANSLATIONS:
            self._fall_back("it stops at too many places")
            return None
        try:
            facts, translation = self._translated.get(key, begin)
            session = Session(translation, hear=self._reference.hear)
        except TooLargeError as error:
            self._fall_back(str(error))
            return None
        while len(self._sessions) >= _SESSIONS:
            del self._sessions[next(iter(self._sessions))]
        self._sessions[key] = facts, session
        return session

    def _known(self) -> dict[int, int]:
        """Return for each variable whether it is uniform (`SAME`) or not (`ANY`)."""
        state = self.state
        planes = np.stack([*state.registers, state.zero, state.carry]).reshape(MASKS, -1)
        agree = (planes == planes[:, :1]).all(axis=1).tolist()
        known = {variable: SAME if same else ANY for variable, same in enumerate(agree)}
        return known | {MASKS + region: ANY for region in range(state.depth)}

    def _run_to_limit(self, feed: Feed, limit: int, handover: _Handover) -> None:
        """Run to just before the cycle limit, for the reference engine to go on."""
        session = self._session(exact=True)
        if session is None:
            return
        check = limit - session.longest
        if check > self.state.frame_cycles:
            self._then_refresh(
                lambda: session.run(self.state, feed, limit + 1, handover, check=check)
            )

    def _replay(self, rewound: Rewound, feed: Feed, limit: int, handover: _Handover) -> None:
        """Run again up to the end of the frame that the sink refused."""
        state = self.state
        session = self._session()
        until = _LimitedFeed(feed, state.frames_taken + rewound.frames)
        if session is None:
            self._reference.run(until, limit, handover)
        else:
            again = self._then_refresh(partial(session.run, state, until, limit + 1, handover))
            assert again is None
        state.close_frame()


_Key = tuple[Place, bool]
"""The place where a run begins, and whether it must end at a cycle limit."""


class _Translations:
    """Translations of a program, for engines in several threads: see `WasmEngine`."""

    def __init__(self, program: Program, machine: Machine, isa: Isa, *, profile: bool) -> None:
        self._translate = partial(translate, program, machine, isa, profile=profile)
        self._lock = Lock()
        self._found: dict[_Key, tuple[dict[int, int], Translation]] = {}

    def get(self, key: _Key, begin: dict[int, int]) -> tuple[dict[int, int], Translation]:
        """Return a translation, and the facts under which it holds; `begin` is one of them.

        Raises:
            TooLargeError: the program cannot be translated.
        """
        with self._lock:
            found = self._found.get(key)
            if found is not None:
                facts = found[0]
                if _hold(facts, begin):
                    return found
                begin = {v: max(fact, begin[v]) for v, fact in facts.items()}
            while len(self._found) >= _SESSIONS:
                del self._found[next(iter(self._found))]
            place, exact = key
            self._found[key] = begin, self._translate(place, begin, exact=exact)
            return self._found[key]


def _hold(facts: dict[int, int], begin: dict[int, int]) -> bool:
    """Return whether a translation that assumes `facts` can begin at `begin`."""
    return all(begin[variable] <= fact for variable, fact in facts.items())


class _Handover:
    """Passes frames on to a sink, except the next `skip` ones, which it has had already."""

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
class _LimitedFeed:
    """Ends a feed before frame number `end` since reset."""

    feed: Feed
    end: int

    def planes(self, index: int) -> NDArray[np.uint8] | None:
        return self.feed.planes(index) if index < self.end else None

    def frames(self, index: int, most: int) -> NDArray[np.uint8]:
        most = min(most, self.end - index)
        return self.feed.frames(index, most) if most > 0 else np.empty((0, 0, 0), np.uint8)
