"""Both engines on the same case: every result and all of the state, and where they part."""

from __future__ import annotations

from contextlib import contextmanager, nullcontext, suppress
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple
from unittest.mock import patch

import numpy as np

from npchip import Chip, RunResult
from npchip.engines.base import TrapError
from npchip.engines.state import ChipState
from npchip.engines.wasm.emit import layout, vector_loop
from npchip.engines.wasm.emit.layout import CHECK, FIRST_CHECK
from npchip.engines.wasm.host.session import RewoundError, Session
from npchip.engines.wasm.translate import unroll
from npchip.engines.wasm.translation import Translation, translate
from npchip.program.graph import Place

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import Literal

    from numpy.typing import NDArray

    from npchip.engines.batch import FrameBatch
    from npchip.engines.counts import Counts
    from npchip.run.result import FrameRecord
    from tests.support.random_cases import Case

ARRAYS = ("registers", "zero", "carry", "activity", "memory")
NUMBERS = (
    "pc",
    "stack",
    "depth",
    "halted",
    "frames_taken",
    "conversions",
    "cycles",
    "instructions",
    "frame_cycles",
    "frame_instructions",
    "received",
)


_COUNTS = ("executions", "active NPs", "branches taken", "NPs that enter")
_SESSIONS = 50
"""Number of entries into compiled code in the search for the first divergence."""


class DivergenceError(AssertionError):
    """The engines differ."""


def assert_engines_agree(case: Case) -> list[RunResult]:
    """Run a case on both engines.

    Returns:
        The results, one for each run of each of the case's states that nothing interrupted.

    Raises:
        DivergenceError: names the first instruction after which the states differ, an NP and a
            register, or the part of the result that differs.
    """
    with tight() if case.tight else nullcontext(), cramped(case.ring):
        return _agreed(case)


@contextmanager
def tight() -> Iterator[None]:
    """Let every program be compiled as a large one is; see `Case.tight`."""
    with (
        patch.object(unroll, "_MOST", 0),
        patch.object(vector_loop, "LOOPED", 1),
    ):
        yield


@contextmanager
def cramped(ring: int) -> Iterator[None]:
    """Give every module little room for frames and sends; see `Case.ring`."""
    if not ring:
        yield
        return
    with (
        patch.object(layout, "_RING_FRAMES", ring),
        patch.object(layout, "_LOG_BYTES", 0),
        patch.object(layout, "_DATA_BYTES", 0),
        patch.object(layout, "_PICTURES", ring),
    ):
        yield


def _agreed(case: Case) -> list[RunResult]:
    slow, fast = case.chip("reference"), case.chip("wasm")
    clip = case.clip() if case.frames else None
    results: list[RunResult] = []
    for run in range(case.states * (1 + case.again)):
        begin, again = divmod(run, 1 + case.again)
        if begin and not again:
            for chip in (slow, fast):
                chip.reset()
                case.fill(chip, begin)
        for expected, found in zip(_runs(slow, clip, case), _runs(fast, clip, case), strict=True):
            difference = _run_difference(expected, found) or state_difference(
                state(slow), state(fast)
            )
            if difference:
                where = first_divergence(case, run)
                raise DivergenceError(f"{difference}\n{where}\n{case.text}")
            difference = counts_difference(slow.counts, fast.counts)
            if difference:
                raise DivergenceError(f"{difference}\n{case.text}")
            results += [] if expected.result is None else [expected.result]
    return results


class _Run(NamedTuple):
    """A run and what its listener heard of; no result where the listener has ended it."""

    result: RunResult | None
    heard: list[FrameRecord]


class _ListenerError(Exception):
    """The listener does not bear a frame."""


def _runs(chip: Chip, clip: NDArray[np.uint8] | None, case: Case) -> Iterator[_Run]:
    """Run a chip; where its listener ends that, go on without it from there."""
    heard: list[FrameRecord] = []

    def hear(record: FrameRecord) -> None:
        heard.append(record)
        if len(heard) == case.hears:
            raise _ListenerError

    try:
        result = chip.run(clip, max_cycles=case.limit, on_frame=hear if case.hears else None)
    except _ListenerError:
        yield _Run(None, heard)
        result = chip.run(max_cycles=case.limit)
    yield _Run(result, heard)


def _run_difference(expected: _Run, found: _Run) -> str:
    """Return the first difference between two runs; empty if there is none."""
    counts = [len(run.heard) for run in (expected, found)]
    if counts[0] != counts[1]:
        return f"frames heard of: expected {counts[0]}, found {counts[1]}"
    for number, pair in enumerate(zip(expected.heard, found.heard, strict=True)):
        difference = _difference(*(vars(record) for record in pair))
        if difference:
            return f"record {number}, {difference}"
    if expected.result is None or found.result is None:
        return "" if expected.result is found.result else "only one run is interrupted"
    return result_difference(expected.result, found.result)


def counts_difference(expected: Counts | None, found: Counts | None) -> str:
    """Return the first difference between two profiles' counts; empty if there is none to find."""
    if expected is None or found is None:
        return ""
    for stack in sorted({*expected.tables, *found.tables}):
        a, b = expected.table(stack), found.table(stack)
        for row, address in np.argwhere(a != b):
            return (
                f"{_COUNTS[row]} at address {address}, called from {stack}: "
                f"expected {a[row, address]}, found {b[row, address]}"
            )
    return ""


def state(chip: Chip) -> ChipState:
    """All that a chip remembers."""
    return chip._engine.state  # noqa: SLF001 - snapshots are opaque on purpose


def result_difference(expected: RunResult, found: RunResult) -> str:
    """Return the first difference between two results; empty if there is none."""
    a, b = vars(expected) | {"engine": ""}, vars(found) | {"engine": ""}
    for told, result in ((a, expected), (b, found)):
        told["setup"] = vars(result.setup)
    return _difference(a, b)


def _difference(expected: Any, found: Any) -> str:
    """Return where two values differ first, the types of arrays and the order of names included."""
    if type(expected) is not type(found):
        return f"type: expected {expected!r}, found {found!r}"
    if isinstance(expected, dict):
        if [*expected] != [*found]:
            return f"names: expected {[*expected]}, found {[*found]}"
        for name in expected:
            difference = _difference(expected[name], found[name])
            if difference:
                return f"{name}: {difference}"
        return ""
    if isinstance(expected, np.ndarray):
        return _difference_of_arrays(expected, found)
    return "" if expected == found else f"expected {expected}, found {found}"


def _difference_of_arrays(expected: NDArray[Any], found: NDArray[Any]) -> str:
    kinds = [(str(array.dtype), array.shape) for array in (expected, found)]
    if kinds[0] != kinds[1]:
        return f"expected {kinds[0]}, found {kinds[1]}"
    for what, read in (
        ("missing", np.ma.getmaskarray),
        ("value", partial(np.ma.filled, fill_value=0)),
    ):
        a, b = read(expected), read(found)
        if not np.array_equal(a, b):
            place = tuple(np.argwhere(a != b)[0])
            where = tuple(map(int, place))
            return f"{what} at {where}: expected {a[place]}, found {b[place]}"
    return ""


def state_difference(expected: ChipState, found: ChipState) -> str:
    """Return the first difference between two states; empty if there is none."""
    difference = array_difference(expected, found)
    if difference:
        return difference
    for name in NUMBERS:
        a, b = getattr(expected, name), getattr(found, name)
        if a != b:
            return f"{name}: expected {a}, found {b}"
    if not np.array_equal(expected.executions, found.executions):
        return f"executions: expected {expected.executions}, found {found.executions}"
    if (expected.pixels is None) != (found.pixels is None):
        return "pixels of one are missing"
    if (
        expected.pixels is not None
        and found.pixels is not None
        and not np.array_equal(expected.pixels, found.pixels)
    ):
        return "pixels differ"
    return _sends_difference(expected, found)


def _sends_difference(expected: ChipState, found: ChipState) -> str:
    a, b = ([send._asdict() for send in item.sends] for item in (expected, found))
    if len(a) != len(b):
        return f"sends: expected {len(a)}, found {len(b)}"
    for number, pair in enumerate(zip(a, b, strict=True)):
        difference = _difference(*pair)
        if difference:
            return f"send {number}, {difference}"
    return ""


def array_difference(expected: ChipState, found: ChipState) -> str:
    """The first register, flag or byte of the memory that differs in some NP."""
    for name in ARRAYS:
        a, b = getattr(expected, name), getattr(found, name)
        where = np.argwhere(a != b)
        if len(where):
            *number, row, col = (int(index) for index in where[0])
            which = f"{name}{number}" if number else name
            place = tuple(where[0])
            return f"{which} of NP ({row},{col}): expected {a[place]}, found {b[place]}"
    return ""


class _Nothing:
    """A sink."""

    def __init__(self) -> None:
        self.taken = 0

    def take(self, batch: FrameBatch) -> None:
        self.taken += len(batch.cycles)


def first_divergence(case: Case, run: int = 0) -> str:
    """Run both engines side by side, instruction by instruction, else block by block.

    Args:
        case: the case.
        run: the run in which they differ, counted through all states.
    """
    probes: tuple[Literal["step", "block"], ...] = ("step", "block")
    for probe in probes:
        found = _divergence(case, run, probe)
        if found:
            return f"first divergence in run {run} ({probe} by {probe}): {found}"
    return f"in run {run}, side by side, the engines agree"


def _chips_before(case: Case, run: int) -> tuple[Chip, Chip]:
    """Both chips in the state in which a run begins, as the reference engine leaves it."""
    slow, fast = case.chip("reference"), case.chip("wasm")
    clip = case.clip() if case.frames else None
    begin, runs = divmod(run, 1 + case.again)
    if begin:
        case.fill(slow, begin)
    for _ in range(runs):
        for _run in _runs(slow, clip, case):
            pass
    for chip in (slow, fast):
        state(chip).assign(state(slow))
        chip.feed(clip)
        chip._engine.refresh()  # noqa: SLF001 - as `Chip.restore` does
    return slow, fast


def _divergence(case: Case, run: int, probe: Literal["step", "block"]) -> str:
    slow, fast = _chips_before(case, run)
    report: list[str] = []
    last = slow.pc

    def compare(place: Place, found: ChipState) -> None:
        nonlocal last
        for _ in range(100_000):  # the reference engine catches up
            if slow.pc == place.address and (probe == "step" or tuple(slow.stack) == place.stack):
                break
            last = slow.pc
            if report or slow.step():
                return
        difference = array_difference(state(slow), found)
        if difference:
            source = slow.program.source
            text = source[last].text.strip() if source else ""
            report.append(f"after address {last} ({text}): {difference}")
            raise _FoundError
        last = slow.pc
        slow.step()

    with suppress(_FoundError, RewoundError, TrapError):
        for _ in range(_SESSIONS):
            here = state(fast)
            begin = fast._engine._known()  # type: ignore[attr-defined]  # noqa: SLF001
            place = Place(here.pc, tuple(here.stack), here.depth)
            translation = translate(slow.program, case.machine, slow.isa, place, begin, stops=probe)
            session = _Probing(translation, compare)
            ended = session.run(here, fast._feed, case.limit, _Nothing())  # noqa: SLF001
            fast._engine.refresh()  # noqa: SLF001
            if ended is not None or fast.step() is not None:  # what it leaves to the other
                break
    return report[0] if report else ""


class _Probing(Session):
    """A session that shows its state before every block of a translation that can stop there."""

    def __init__(self, translation: Translation, probe: Callable[[Place, ChipState], None]) -> None:
        super().__init__(translation)
        self._probe = probe

    def _tick(self, number: int) -> int:
        place = self.translation.blocks[number].first.place
        self._complete(number)
        shown = self._state.copy()
        self._unload_arrays(place.depth, shown)
        self._probe(place, shown)
        answer = super()._tick(number)
        self._longs[CHECK // 8] = 0
        return answer

    def _load(self, state: ChipState) -> None:
        super()._load(state)
        self._longs[CHECK // 8] = self._longs[FIRST_CHECK // 8] = 0


class _FoundError(Exception):
    """Ends the search."""
