"""Several clips at once: the results are those of single runs, in order, and every call ends."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from dataclasses import replace
from threading import Event, get_ident
from threading import enumerate as living
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip import Chip, InputError, load_machine
from npchip.engines.wasm import translation
from npchip.engines.wasm.host import engine as wasm
from npchip.frames import open_frames
from npchip.frames.feed import Frames
from npchip.run import many
from tests.support.chips import LOOP, chip_of, clip_of, machine_of, summary
from tests.support.programs import assembled

Clip = NDArray[np.uint8]
MACHINE = machine_of()
SECONDS = 60.0


@pytest.fixture(autouse=True)
def _eager(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let every thread help at once, and see that it ends."""
    monkeypatch.setattr(many, "_SHORTEST", 0.0)
    yield
    assert not [thread for thread in living() if thread.name == "npchip"]


def waiting(begun: Event | None, until: Event | None, then: Callable[[], Any]) -> Iterator[Clip]:
    """Frames that tell when they are begun, wait, and do something."""
    frame = clip_of(1, MACHINE)[0]
    yield frame
    if begun is not None:
        begun.set()
    assert until is None or until.wait(SECONDS)
    then()
    yield frame


def endless(begun: Event) -> Iterator[Clip]:
    while True:
        yield from waiting(begun, None, lambda: None)


@pytest.mark.parametrize("machine", ["default", "conservative"])
@pytest.mark.parametrize("name", ["trajectory", "imaging", "statistics"])
def test_results_are_those_of_single_runs(name: str, machine: str) -> None:
    description = load_machine(machine)
    clips = [clip_of(40 + 30 * n, description, seed=n) for n in range(5)]
    program = assembled(name, machine)
    chip, alone = Chip(program, machine), Chip(program, machine)
    for found, clip in zip(chip.run_many(clips, jobs=3), clips, strict=True):
        alone.reset()
        assert summary(found) == summary(alone.run(clip))
    assert chip.cycles == chip.frames_taken == 0


@pytest.mark.parametrize("engine", ["wasm", "reference"])
def test_noise_memory_and_frame_numbers_are_those_of_the_present_state(engine: Any) -> None:
    sensor = replace(MACHINE.sensor, noise_rms=5.0, fixed_pattern=20)
    chip = chip_of(
        LOOP.replace("OUT 1, r0", "OUT 1, r0\nOUT 2, r1"), replace(MACHINE, sensor=sensor), engine
    )
    chip.load_memory(0, np.full((1, 3, 4), 7, np.uint8))
    chip.run(clip_of(3, MACHINE))
    before = chip.snapshot()
    clips = [clip_of(20, MACHINE, seed=n) for n in range(4)]
    found = chip.run_many(clips, jobs=2)
    assert chip.frames_taken == 3
    for result, clip in zip(found, clips, strict=True):
        chip.restore(before)
        assert result.first_frame == 3
        assert summary(result) == summary(chip.run(clip))


def test_clips_run_at_the_same_time_and_are_translated_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls: list[object] = []
    translate = translation.translate

    def counted(*args: Any, **options: Any) -> Any:
        calls.append(args)
        return translate(*args, **options)

    monkeypatch.setattr(wasm, "translate", counted)
    first, second = Event(), Event()
    threads: list[int] = []
    clips = [
        waiting(first, second, lambda: threads.append(get_ident())),
        waiting(second, first, lambda: threads.append(get_ident())),
    ]
    results = chip_of(LOOP, engine="wasm").run_many(iter(clips), jobs=2)
    assert [result.frames for result in results] == [2, 2]
    assert len(set(threads)) == 2
    assert len(calls) == 1


def test_progress_comes_in_order_in_this_thread() -> None:
    seen: list[tuple[int, int, int]] = []
    clips = [clip_of(1 + n % 3, MACHINE) for n in range(30)]
    results = chip_of(LOOP, engine="wasm").run_many(
        clips, jobs=4, on_clip=lambda n, result: seen.append((n, result.frames, get_ident()))
    )
    assert seen == [(n, len(clip), get_ident()) for n, clip in enumerate(clips)]
    assert [result.frames for result in results] == [len(clip) for clip in clips]


def test_short_clips_stay_in_this_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(many, "_SHORTEST", SECONDS)
    monkeypatch.setattr(many, "Thread", None)  # to make one would fail
    threads: set[int] = set()

    def clips() -> Iterator[Clip]:
        for _ in range(40):
            threads.add(get_ident())
            yield clip_of(1, MACHINE)

    assert len(chip_of(LOOP, engine="wasm").run_many(clips(), jobs=4)) == 40
    assert threads == {get_ident()}


def test_a_clip_that_is_read_slowly_does_not_keep_others_waiting(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(many, "_SHORTEST", SECONDS)
    begun = Event()
    clips = [waiting(None, begun, lambda: None), waiting(begun, None, lambda: None)]
    results = chip_of(LOOP, engine="wasm").run_many(clips, jobs=2)
    assert [result.frames for result in results] == [2, 2]


@pytest.mark.parametrize("jobs", [1, 2, 9])
def test_a_run_that_fails_is_a_result(jobs: int) -> None:
    chip = chip_of(LOOP, engine="wasm")
    clips = [clip_of(3, MACHINE), clip_of(200, MACHINE), clip_of(3, MACHINE)]
    found = chip.run_many(clips, jobs=jobs, max_cycles=300)
    statuses = [result.status for result in found]
    assert statuses == ["frames-exhausted", "cycle-limit", "frames-exhausted"]
    trap = chip_of("EXPOSE\nRET", engine="wasm").run_many(clips, jobs=jobs)
    assert [result.status for result in trap] == ["failed"] * 3
    assert chip.run_many([], jobs=jobs) == []


@pytest.mark.parametrize("jobs", [1, 4])
@pytest.mark.parametrize("engine", ["wasm", "reference"])
def test_the_first_clip_that_cannot_be_used_is_named(engine: Any, jobs: int) -> None:
    wrong = np.zeros((2, 5, 5), np.uint8)
    clips = [clip_of(20, MACHINE), clip_of(20, MACHINE), wrong, wrong]
    chip = chip_of(LOOP, engine=engine)
    shown: list[int] = []
    with pytest.raises(InputError, match="clip 2: ") as caught:
        chip.run_many(clips, jobs=jobs, on_clip=lambda index, _: shown.append(index))
    assert caught.value.hint
    assert shown == [0, 1]
    assert chip.frames_taken == 0


def test_an_error_in_one_clip_stops_the_others() -> None:
    begun = Event()

    def fail() -> None:
        raise ZeroDivisionError

    chip = chip_of(LOOP, engine="wasm")
    clips: list[Frames] = [waiting(None, begun, fail), endless(begun), clip_of(1, MACHINE)]
    with pytest.raises(ZeroDivisionError) as caught:
        chip.run_many(clips, jobs=2)
    assert caught.value.__notes__ == ["in clip 0"]
    assert chip.run(clip_of(2, MACHINE)).frames == 2


def test_an_error_of_the_iterable_or_of_another_thread_is_raised_here() -> None:
    begun = Event()

    def clips() -> Iterator[Any]:
        yield waiting(None, begun, lambda: None)
        begun.set()
        raise SystemExit(7)  # in the second thread

    with pytest.raises(SystemExit) as caught:
        chip_of(LOOP, engine="wasm").run_many(clips(), jobs=2)
    assert caught.value.__notes__ == ["in clip 1"]


def test_ctrl_c_ends_all_threads() -> None:
    begun = Event()
    chip = chip_of(LOOP, engine="wasm")
    clips = [waiting(None, begun, lambda: signal.raise_signal(signal.SIGINT)), endless(begun)]
    with pytest.raises(KeyboardInterrupt):
        chip.run_many(clips, jobs=2)
    assert chip.frames_taken == 0
    assert chip.run(clip_of(2, MACHINE)).frames == 2


def test_an_error_of_the_callback_ends_all_threads() -> None:
    begun = Event()

    def fail(_index: int, _result: object) -> None:
        raise ZeroDivisionError

    clips = [waiting(None, begun, lambda: None), endless(begun)]
    with pytest.raises(ZeroDivisionError):
        chip_of(LOOP, engine="wasm").run_many(clips, jobs=2, on_clip=fail)


def test_a_partner_is_refused() -> None:
    chip = chip_of("EXPOSE\nIN r0, 0")
    chip.connect(lambda _: np.zeros((3, 4), np.uint8))
    with pytest.raises(InputError, match="partner") as caught:
        chip.run_many([clip_of(1, MACHINE)])
    assert caught.value.code == "NP108"
    chip.connect(None)
    assert chip.run_many([clip_of(1, MACHINE)])[0].error is not None


def test_what_is_no_list_of_clips_is_refused() -> None:
    chip = chip_of(LOOP)
    clip = clip_of(3, MACHINE)
    source = open_frames("coin_slide", 64, 80)
    for clips in (clip, clip[0], source, "coin_slide"):
        with pytest.raises(InputError, match="several clips") as caught:
            chip.run_many(clips)  # type: ignore[arg-type]
        assert caught.value.code == "NP108"
    with pytest.raises(InputError, match="found 0"):
        chip.run_many([clip], jobs=0)
    stacked = chip.run_many(np.stack([clip, clip]))
    assert [result.frames for result in stacked] == [3, 3]


def test_a_further_chip_adds_no_callback(monkeypatch: pytest.MonkeyPatch) -> None:
    """The callbacks of wasmtime before 50 stand in a table that breaks if two threads add some."""
    clip = clip_of(3, MACHINE)
    chip_of(LOOP, MACHINE, "wasm").run(clip)
    monkeypatch.setattr("wasmtime._func.FUNCTIONS.allocate", None)
    assert chip_of(LOOP, MACHINE, "wasm").run(clip).engine == "wasm"


def test_a_run_raises_its_own_exception(monkeypatch: pytest.MonkeyPatch) -> None:
    """Wasmtime passes a callback's exception on in one variable for all threads."""

    def raise_another() -> None:
        raise LookupError("of another thread")

    monkeypatch.setattr("wasmtime._func.maybe_raise_last_exn", raise_another)

    def fail(_result: object) -> None:
        raise ArithmeticError("of this thread")

    with pytest.raises(ArithmeticError, match="of this thread"):
        chip_of(LOOP, MACHINE, "wasm").run(clip_of(100, MACHINE), on_frame=fail)
