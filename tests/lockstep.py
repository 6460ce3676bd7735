"""Both engines on the same case: every result and all of the state, and where they part."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from npchip import Chip, RunResult
from npchip.engines.state import ChipState
from npchip.engines.wasm.compile import translate
from npchip.engines.wasm.graph import Place
from npchip.engines.wasm.session import Session
from npchip.machine import SensorModel

if TYPE_CHECKING:
    from typing import Literal

    from npchip.engines import FrameBatch, RawFrame
    from tests.random_programs import Case

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


class DivergenceError(AssertionError):
    """The engines differ."""


def assert_engines_agree(case: Case) -> None:
    """Run a case on both engines.

    Raises:
        DivergenceError: names the first instruction after which the states differ, an NP and a
            register, or the part of the result that differs.
    """
    slow, fast = case.chip("reference"), case.chip("wasm")
    clip = case.clip() if case.frames else None
    for _ in range(1 + case.again):
        expected = slow.run(clip, max_cycles=case.limit)
        found = fast.run(clip, max_cycles=case.limit)
        difference = result_difference(expected, found) or state_difference(
            state(slow), state(fast)
        )
        if difference:
            raise DivergenceError(f"{difference}\n{first_divergence(case)}\n{case.text}")


def state(chip: Chip) -> ChipState:
    """All that a chip remembers."""
    return chip._engine.state  # noqa: SLF001 - snapshots are opaque on purpose


def result_difference(expected: RunResult, found: RunResult) -> str:
    """What differs first between two results; empty if nothing."""
    for name in ("status", "error", "setup", "first_frame", "last_complete"):
        a, b = getattr(expected, name), getattr(found, name)
        if name == "setup":
            a, b = _plain(vars(a)), _plain(vars(b))
        if a != b:
            return f"{name}: expected {a}, found {b}"
    for name in ("frame_cycles", "frame_instructions"):
        if not np.array_equal(getattr(expected, name), getattr(found, name)):
            return f"{name}: expected {getattr(expected, name)}, found {getattr(found, name)}"
    a, b = _plain(expected.outputs), _plain(found.outputs)
    for key in a | b:
        if a.get(key) != b.get(key):
            return f"output {key}: expected {a.get(key)}, found {b.get(key)}"
    return ""


def _plain(value: Any) -> Any:
    """A value that ``==`` compares as a whole."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        missing = np.ma.getmaskarray(value) if np.ma.isMaskedArray(value) else None
        return (
            str(value.dtype),
            np.ma.filled(value, 0).tolist(),
            missing is not None and (missing.tolist()),
        )
    return value


def state_difference(expected: ChipState, found: ChipState) -> str:
    """What differs first between two states; empty if nothing."""
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
    def plain(item: ChipState) -> list[Any]:
        return [
            (s.port, s.address, s.data.tolist(), None if s.active is None else s.active.tolist())
            for s in item.sends
        ]

    a, b = plain(expected), plain(found)
    return "" if a == b else f"sends: expected {a}, found {b}"


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

    def take(self, _raw: RawFrame) -> None:
        self.taken += 1

    def take_batch(self, batch: FrameBatch) -> None:
        self.taken += len(batch.cycles)


def first_divergence(case: Case) -> str:
    """Run both engines side by side, instruction by instruction, else block by block."""
    probes: tuple[Literal["step", "block"], ...] = ("step", "block")
    for probe in probes:
        found = _divergence(case, probe)
        if found:
            return f"first divergence ({probe} by {probe}): {found}"
    return "side by side the engines agree"


def _divergence(case: Case, probe: Literal["step", "block"]) -> str:
    slow, fast = case.chip("reference"), case.chip("wasm")
    clip = case.clip() if case.frames else None
    slow.feed(clip)
    fast.feed(clip)
    begin = fast._engine._known()  # type: ignore[attr-defined]  # noqa: SLF001
    translation = translate(slow.program, case.machine, slow.isa, Place(0), begin, probe=probe)
    sensor = SensorModel(case.machine.sensor, case.machine.np_rows, case.machine.np_cols)
    report: list[str] = []
    last = 0

    def compare(place: Place, found: ChipState) -> None:
        nonlocal last
        for _ in range(100_000):  # the reference engine catches up
            if slow.pc == place.address and (probe == "step" or _beginning(place)):
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

    def _beginning(place: Place) -> bool:
        return tuple(slow.stack) == place.stack

    session = Session(translation, sensor, compare)
    with suppress(_FoundError):
        session.run(state(fast), fast._feed, case.limit, _Nothing())  # noqa: SLF001
    return report[0] if report else ""


class _FoundError(Exception):
    """Ends the search."""
