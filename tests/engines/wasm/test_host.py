"""The compiled engine around its module: frames, results, partners, signals, limits."""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
import pytest
import wasmtime
from numpy.typing import NDArray

from npchip import Chip, assemble_text
from npchip.engines.base import Request
from npchip.engines.wasm import translation
from npchip.engines.wasm.emit.encode import module
from npchip.engines.wasm.host.signals import Signals
from npchip.engines.wasm.translate import graph
from npchip.engines.wasm.translate.steps import Block, TooLargeError
from npchip.isa import Isa, parse_isa
from npchip.run.result import FrameRecord
from tests.engines.wasm.test_extended import entry
from tests.support.chips import clip_of, machine_of
from tests.support.lockstep import state, state_difference

MACHINE = machine_of()
EngineName = Literal["auto", "wasm", "reference"]
ENGINES: tuple[EngineName, ...] = ("reference", "wasm")
COUNTING = ".output x, 0, scalar\nframe: EXPOSE\nADD r0, #1\nOUT 0, r0\nJMP frame\n"


def own(*instructions: tuple[str, str, str, str]) -> Isa:
    """An instruction set with instructions of one's own."""
    entries = "".join(entry(*item) for item in instructions)
    return parse_isa(f"extends: npchip\nname: test\ninstructions:\n{entries}", "test.yaml")


def chip_of(source: str, engine: EngineName, isa: Isa | None = None) -> Chip:
    return Chip(assemble_text(source, "test.s", MACHINE, isa=isa), MACHINE, engine, isa)


# ---- frames


@pytest.mark.parametrize("engine", ENGINES)
def test_an_iterator_may_use_the_memory_of_its_frame_again(engine: EngineName) -> None:
    def camera() -> Iterator[NDArray[np.uint8]]:
        frame = np.empty((MACHINE.rows, MACHINE.cols), np.uint8)
        for number in range(200):
            frame[:] = number
            yield frame

    chip = chip_of(
        ".output x, 0, scalar\nframe: EXPOSE\nSAMPLE signal, 0\nLD r0, [0]\nOUT 0, r0\nJMP frame",
        engine,
    )
    assert chip.run(camera()).outputs["x"].tolist() == [*range(200)]


@pytest.mark.parametrize("at", [1, 5, 64, 70, 299])
@pytest.mark.parametrize("engine", ENGINES)
def test_a_listener_that_fails_on_frames_of_an_iterator(engine: EngineName, at: int) -> None:
    heard: list[FrameRecord] = []

    def listen(record: FrameRecord) -> None:
        heard.append(record)
        if len(heard) == at:
            raise ZeroDivisionError

    chip = chip_of(COUNTING, engine)
    with pytest.raises(ZeroDivisionError):
        chip.run(iter(clip_of(300, MACHINE)), on_frame=listen)
    result = chip.run()
    assert (chip.frames_taken, result.first_frame, result.frames) == (300, at, 300 - at)
    assert result.outputs["x"].tolist() == [(k + 1) % 256 for k in range(at, 300)]


@pytest.mark.parametrize("count", [0, 1, 10, 64, 70])
@pytest.mark.parametrize("engine", ENGINES)
def test_frames_before_an_iterator_fails_count(engine: EngineName, count: int) -> None:
    def broken() -> Iterator[NDArray[np.uint8]]:
        yield from clip_of(count, MACHINE) if count else ()
        raise ZeroDivisionError

    chip, heard = chip_of(COUNTING, engine), list[FrameRecord]()
    with pytest.raises(ZeroDivisionError):
        chip.run(broken(), on_frame=heard.append)
    assert (chip.frames_taken, len(heard)) == (count, max(0, count - 1))
    with pytest.raises(ZeroDivisionError):  # what is broken does not pass for complete
        chip.run()


@pytest.mark.parametrize("engine", ENGINES)
def test_an_interrupt_of_an_iterator_is_raised_by_this_run(engine: EngineName) -> None:
    def interrupted() -> Iterator[NDArray[np.uint8]]:
        yield from clip_of(5, MACHINE)
        raise KeyboardInterrupt

    chip = chip_of(COUNTING, engine)
    with pytest.raises(KeyboardInterrupt):
        chip.run(interrupted())
    assert chip.run().status == "frames-exhausted"
    assert chip.frames_taken == 5


@pytest.mark.parametrize("engine", ENGINES)
def test_what_fails_behind_a_listener_that_fails_is_not_forgotten(engine: EngineName) -> None:
    def broken() -> Iterator[NDArray[np.uint8]]:
        yield from clip_of(70, MACHINE)
        raise ZeroDivisionError

    def listen(_: FrameRecord) -> None:
        heard.append(1)
        if len(heard) == 68:
            raise LookupError

    chip, heard = chip_of(COUNTING, engine), list[int]()
    with pytest.raises(LookupError):
        chip.run(broken(), on_frame=listen)
    with pytest.raises(ZeroDivisionError):
        chip.run()
    assert chip.frames_taken == 70


# ---- results


def test_a_listener_hears_of_ports_without_a_name_where_something_was_sent() -> None:
    source = (
        "frame: EXPOSE\nADD r0, #1\nMOV r1, r0\nSHR r1, #1\nJANY CS, frame\nOUT 5, r0\nJMP frame"
    )
    for engine in ENGINES:
        heard: list[FrameRecord] = []
        chip_of(source, engine).run(clip_of(9, MACHINE), on_frame=heard.append)
        assert [[*record.outputs] for record in heard] == [[], ["port5"]] * 4 + [[]]


# ---- partners


@pytest.mark.parametrize(
    "semantics", ["rd = rd + 1\nrs = input(2)", "output(3, rd)\nrs = input(2)"]
)
def test_an_input_that_fails_has_done_nothing(semantics: str) -> None:
    isa = own(("GET", "{rd}, {rs}", "1111 dddd ssss 0000", semantics))

    def partner(request: Request) -> NDArray[np.uint8]:
        if request.frame == 1:
            raise ZeroDivisionError
        return np.zeros(MACHINE.geometry, np.uint8)

    chips = [chip_of("frame: EXPOSE\nGET r0, r1\nJMP frame", engine, isa) for engine in ENGINES]
    for chip in chips:
        chip.connect(partner)
        with pytest.raises(ZeroDivisionError):
            chip.run(clip_of(3, MACHINE))
    assert not state_difference(*map(state, chips))


# ---- signals


def waits_for_a_frame() -> Iterator[NDArray[np.uint8]]:
    yield clip_of(1, MACHINE)[0]
    time.sleep(20)


def waits(_about: object) -> None:
    time.sleep(20)


@pytest.mark.skipif(sys.platform == "win32", reason="sends itself a signal")
@pytest.mark.parametrize("what", ["frame", "listener", "partner"])
def test_an_interrupt_reaches_what_the_chip_waits_for(what: str) -> None:
    asking = COUNTING.replace("JMP frame", "IN r1, 1\nJMP frame")
    chip = chip_of(asking if what == "partner" else COUNTING, "wasm")
    chip.connect(waits)
    frames = waits_for_a_frame() if what == "frame" else clip_of(3, MACHINE)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        chip.run(frames, on_frame=waits if what == "listener" else None)
    assert time.monotonic() - start < 10
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.skipif(sys.platform == "win32", reason="sends itself a signal")
def test_a_handler_may_make_way_for_another() -> None:
    """The first Ctrl-C is noted, the second one ends."""

    def first(_number: int, _frame: object) -> None:
        noted.append(1)
        signal.signal(signal.SIGINT, signal.default_int_handler)

    noted: list[int] = []
    before = signal.signal(signal.SIGINT, first)
    for seconds in (0.3, 0.6):
        threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT)).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            chip_of("l: ADD r0, #1\nJMP l", "wasm").run(max_cycles=10**12)
        assert noted == [1]
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)


def test_signals_that_wait_are_handled_in_their_order() -> None:
    numbers = (signal.SIGINT, signal.SIGTERM)
    noted: list[int] = []
    before = {n: signal.signal(n, lambda number, _: noted.append(number)) for n in numbers}
    signals = Signals()
    try:
        with signals.deferred():
            for number in (*numbers, signal.SIGINT):
                signal.raise_signal(number)
            assert noted == []
            signals.deliver()
            assert noted == [*numbers, signal.SIGINT]
            signal.raise_signal(signal.SIGTERM)
            signal.raise_signal(signal.SIGINT)
        assert noted == [*numbers, signal.SIGINT, signal.SIGTERM, signal.SIGINT]
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@pytest.mark.parametrize("handler", [signal.SIG_IGN, signal.SIG_DFL, lambda *_: None])
def test_a_listener_may_set_a_handler(handler: signal.Handlers) -> None:
    before = signal.getsignal(signal.SIGINT)
    try:
        chip = chip_of(COUNTING, "wasm")
        chip.run(clip_of(200, MACHINE), on_frame=lambda _: signal.signal(signal.SIGINT, handler))  # type: ignore[arg-type]
        assert signal.getsignal(signal.SIGINT) is handler
    finally:
        signal.signal(signal.SIGINT, before)


# ---- limits


def test_a_module_that_is_too_large_is_left_to_the_reference_engine_with_a_notice(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its function has more bytes than wasmtime takes: nops, as programs are not that long."""

    def long(*args: Any) -> bytes:
        args[1][-1].code[:0] = b"\x01" * 8_000_000
        return module(*args)

    monkeypatch.setattr("npchip.engines.wasm.translation.module", long)
    chips = [chip_of("COL r0\nADD r0, #200\nHALT", engine) for engine in ENGINES]
    for chip in chips:
        chip.run()
    assert "module would be too large: the reference engine" in chips[1].notice
    assert not state_difference(*map(state, chips))


def test_a_module_that_is_wrong_is_not_taken_for_one_that_is_too_large(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("npchip.engines.wasm.translation.module", lambda *_: b"\0asm\1\0\0\0\1")
    with pytest.raises(wasmtime.WasmtimeError):
        chip_of("ADD r0, #1\nHALT", "auto").run()


def test_long_blocks_for_many_nps_are_parted() -> None:
    machine = machine_of(28, 28)
    source = "".join(f"ADC r{k * 7 % 16}, r{(k * 5 + 3) % 16}\n" for k in range(200))
    program = assemble_text(f"COL r0\nROW r1\n{source}HALT", "test.s", machine)
    chips = [Chip(program, machine, engine) for engine in ENGINES]
    assert tuple(chip.run().engine for chip in chips) == ENGINES
    assert not chips[1].notice
    assert not state_difference(*map(state, chips))


def test_a_program_that_stops_at_many_places_is_left_to_the_reference_engine() -> None:
    isa = own(("STOP", "", "1111 0000 0001 1111", "if any(Z and C):\n    halt()"))
    body = "STOP\nADD r2, #3\n" * 8
    chip = chip_of(f"MOV r1, #50\nl: ADD r0, #1\n{body}SUB r1, #1\nJANY NE, l\nHALT", "auto", isa)
    result = chip.run()
    assert result.status == "halted"
    assert "stops at too many places: the reference engine" in chip.notice
    again = chip_of("MOV r1, #50\nl: ADD r0, #1\nSTOP\nSUB r1, #1\nJANY NE, l\nHALT", "auto", isa)
    again.run()
    assert not again.notice


@pytest.mark.parametrize("enabled", [True, False])
@pytest.mark.parametrize("fails", [True, False])
def test_garbage_is_not_collected_during_a_translation_only(
    monkeypatch: pytest.MonkeyPatch, *, enabled: bool, fails: bool
) -> None:
    def build(*args: Any) -> list[Block]:
        seen.append(gc.isenabled())
        if fails:
            raise TooLargeError("it is too large")
        return graph.build(*args)

    seen: list[bool] = []
    monkeypatch.setattr(translation, "build", build)
    chip, was = chip_of("ADD r0, #1\nHALT", "auto"), gc.isenabled()
    (gc.enable if enabled else gc.disable)()
    try:
        chip.run()
        after = gc.isenabled()
    finally:
        (gc.enable if was else gc.disable)()
    assert seen == [False]
    assert after == enabled
    assert bool(chip.notice) == fails
