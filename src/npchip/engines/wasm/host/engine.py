"""The compiled engine: runs translated programs, and leaves the rest to the reference engine.

A session ends before an instruction that compiled code does not execute: a halt, a trap, or an
expose without input. The reference engine executes that one, so only it raises errors. If a frame
reaches the cycle limit or the sink refuses one, the state goes back to the last refill and the
frames up to that point are run again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from threading import Lock
from typing import Any, Final, TypeVar

import numpy as np

from npchip.engines.base import Feed, Partner, Sink, Stop
from npchip.engines.batch import FrameBatch
from npchip.engines.reference.engine import ReferenceEngine
from npchip.engines.state import Write
from npchip.engines.wasm.host.session import RewoundError, Session
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


class WasmEngine:
    """Executes a program as WebAssembly SIMD.

    The reference engine takes over, and `name` and `notice` say so, if the module would be too
    large, if routines would have to be copied too often, or if it stops at too many places.

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
        self._translated = _Translations(partial(translate, program, machine, isa, profile=profile))
        self._sessions: dict[_Key, Session] = {}

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
        """See `Engine.run`."""
        state = self.state
        handover = _Handover(sink)
        self._translations = 0
        while not state.halted and state.frame_cycles < limit:
            word = word_at(self._words, state.pc)
            if word is not None and is_foreign(word, self._machine):  # needs no session
                stop = self._reference.step(feed, handover.take)
                if stop is not None:
                    return stop
                continue
            session = self._session()
            if session is None:
                break
            try:
                ended = self._run(session, feed, limit, handover)
            except RewoundError as rewound:
                handover.skip, handover.error = rewound.skip, rewound.error
                session = self._session(steps=rewound.error is None)
                if session is not None:
                    self._run(session, feed, limit, handover, single=True)
                break
            if ended is not None:
                return ended
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

    def _run(self, session: Session, *about: Any, single: bool = False) -> Stop | None:
        try:
            return session.run(self.state, *about, single=single)
        finally:
            self._reference.refresh()

    def _session(self, *, steps: bool = False) -> Session | None:
        """Return a session that begins at the state's place, or None if there can be none."""
        state = self.state
        if self.notice:
            return None
        key = Place(state.pc, tuple(state.stack), state.depth), steps or state.counts is not None
        begin = self._known()
        session = self._sessions.get(key)
        if session is not None and session.translation.holds(begin):
            return session
        self._translations += 1
        if self._translations > _MOST_TRANSLATIONS:
            self._fall_back("it stops at too many places")
            return None
        try:
            session = Session(self._translated.get(key, begin), hear=self._reference.hear)
        except TooLargeError as error:
            self._fall_back(str(error))
            return None
        _keep(self._sessions, key, session)
        return session

    def _known(self) -> dict[int, int]:
        """Return for each variable whether it is uniform (`SAME`) or not (`ANY`)."""
        state = self.state
        planes = np.stack([*state.registers, state.zero, state.carry]).reshape(MASKS, -1)
        agree = (planes == planes[:, :1]).all(axis=1).tolist()
        known = {variable: SAME if same else ANY for variable, same in enumerate(agree)}
        return known | {MASKS + region: ANY for region in range(state.depth)}


_Key = tuple[Place, bool]
"""The place where a run begins, and whether it can stop before every step."""
_Kept = TypeVar("_Kept", Session, Translation)


def _keep(cache: dict[_Key, _Kept], key: _Key, value: _Kept) -> None:
    while len(cache) >= _SESSIONS:
        del cache[next(iter(cache))]
    cache[key] = value


class _Translations:
    """Translations of a program, for engines in several threads: see `WasmEngine.another`."""

    def __init__(self, translated: Callable[..., Translation]) -> None:
        self._translated = translated
        self._lock = Lock()
        self._found: dict[_Key, Translation] = {}

    def get(self, key: _Key, begin: Mapping[int, int]) -> Translation:
        """Return a translation that holds where `begin` does.

        Raises:
            TooLargeError: the program cannot be translated.
        """
        with self._lock:
            found = self._found.get(key)
            if found is not None:
                if found.holds(begin):
                    return found
                begin = {v: max(fact, begin[v]) for v, fact in found.begins[0].items()}
            place, steps = key
            found = self._translated(place, begin, stops="step" if steps else "never")
            _keep(self._found, key, found)
            return found


class _Handover:
    """Passes frames on to a sink, except the next `skip` ones, which it has had already.

    The last of these raises `error`, if there is one.
    """

    def __init__(self, sink: Sink) -> None:
        self._sink = sink
        self._before = sink.taken
        self._skipped = 0
        self.skip = 0
        self.error: BaseException | None = None

    @property
    def taken(self) -> int:
        return self._sink.taken - self._before + self._skipped

    def take(self, batch: FrameBatch) -> None:
        count = len(batch.cycles)
        skipped = min(self.skip, count)
        self.skip -= skipped
        self._skipped += skipped
        if self.error is not None and not self.skip:
            raise self.error
        if skipped < count:
            self._sink.take(batch.part(skipped, count))
