"""Programs, machines, chips, results and errors travel between processes, and show themselves."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from npchip import Chip, assemble_text, load_machine
from npchip.base.errors import InputError, NpchipError
from npchip.engines.base import TrapError
from npchip.frames import open_frames
from npchip.isa import load_isa
from npchip.program.model import Program
from tests.frames.test_video import written

SOURCE = """\
.output value, 0, scalar
.reg    sum, r2
.equ    STEP, 3
frame:  EXPOSE
        SAMPLE  signal, 0
        LD      r0, [0]
        ADD     sum, r0
        ADD     sum, #STEP
        OUT     0, sum
        JMP     frame
"""
FRAMES = np.full((4, 64, 80), 7, np.uint8)


def pickled(protocol: int) -> Callable[[Any], Any]:
    return lambda it: pickle.loads(pickle.dumps(it, protocol))  # noqa: S301 - our own


COPIES = {f"pickle {k}": pickled(k) for k in (0, pickle.DEFAULT_PROTOCOL)}
each_copy = pytest.mark.parametrize(
    "copied", [*COPIES.values(), copy.deepcopy], ids=[*COPIES, "deepcopy"]
)


@pytest.fixture
def program() -> Program:
    return assemble_text(SOURCE)


def test_programs_and_machines_are_hashable_and_short(program: Program) -> None:
    """Fails before: hash(program) failed, repr(program) had all its words."""
    assert hash(program) == hash(assemble_text(SOURCE))
    machine = load_machine("default")
    chip = Chip(program)
    result = chip.run(FRAMES)
    assert isinstance(hash(result), int)
    for thing in (program, machine, chip, result, chip.snapshot(), load_isa()):
        assert len(repr(thing)) < 100


@each_copy
def test_programs_and_machines_come_back_equal(
    program: Program, copied: Callable[[Any], Any]
) -> None:
    """Fails before: a mappingproxy cannot be pickled."""
    again = copied(program)
    assert again == program
    assert again.symbols == {"STEP": 3}
    assert hash(again) == hash(program)
    with pytest.raises(TypeError):
        again.symbols["STEP"] = 4
    machine = load_machine("conservative")
    assert copied(machine) == machine
    assert copied(load_isa()).timing_classes == load_isa().timing_classes


@each_copy
def test_frame_sources_come_back_with_their_frames(
    tmp_path: Path, copied: Callable[[Any], Any]
) -> None:
    """Fails before: a video kept a module."""
    np.save(tmp_path / "a.npy", FRAMES)
    for number, frame in enumerate(FRAMES[:2]):
        Image.fromarray(frame).save(tmp_path / f"{number}.png")
    Image.fromarray(FRAMES[0]).save(tmp_path / "a.gif")
    written(tmp_path / "a.mkv", "ffv1", "gray", list(FRAMES), "gray")
    for name in ("a.npy", "*.png", "a.gif", "a.mkv"):
        source = open_frames(tmp_path / name, 64, 80)
        again = copied(source)
        assert np.array_equal(np.stack(list(again)), np.stack(list(source)))


def test_the_name_of_a_file_is_no_frames(program: Program) -> None:
    """Its characters were taken as frames, and a path ended in a TypeError."""
    for name in ("clip.npy", Path("clip.npy")):
        with pytest.raises(InputError, match=r"found the name 'clip.npy'(?s:.*)open_frames"):
            Chip(program).run(name)  # type: ignore[arg-type] # as people do


@each_copy
@pytest.mark.parametrize("engine", ["wasm", "reference"])
def test_a_copied_chip_goes_on_where_it_was(
    program: Program, engine: Any, copied: Callable[[Any], Any]
) -> None:
    """Fails before: a chip could not be copied."""
    chip = Chip(program, engine=engine, profile=True)
    chip.feed(FRAMES)
    for _ in range(9):
        chip.step()
    again = copied(chip)
    ends = [each.run() for each in (chip, again)]
    assert ends[0].outputs["value"].tolist() == ends[1].outputs["value"].tolist()
    assert (again.cycles, again.pc, again.frames_taken) == (chip.cycles, chip.pc, 4)
    assert again.counts == chip.counts or again.counts is not None
    assert not np.shares_memory(again.memory, chip.memory)
    result = copied(ends[0])
    assert result.frame_cycles.tolist() == ends[0].frame_cycles.tolist()


def test_the_frames_of_an_iterator_cannot_be_copied(program: Program) -> None:
    chip = Chip(program)
    chip.run(iter(FRAMES))
    with pytest.raises(InputError, match="cannot be copied"):
        pickle.dumps(chip)


def all_errors(kind: type[NpchipError]) -> list[type[NpchipError]]:
    return [kind, *(each for below in kind.__subclasses__() for each in all_errors(below))]


def _wrong(what: str) -> Any:
    if what == "machine":
        return load_machine("nix")
    if what == "trap":
        return Chip(assemble_text("  RET\n")).step()
    return assemble_text("  NPO\n.macro m\n  SUBX r1\n.endm\n  m\n")


@each_copy
@pytest.mark.parametrize("what", ["machine", "trap", "source"])
def test_errors_come_back_whole(what: str, copied: Callable[[Any], Any]) -> None:
    """Fails before: pickle called the class without the code."""
    with pytest.raises((NpchipError, TrapError)) as caught:
        _wrong(what)
    again = copied(caught.value)
    assert type(again) is caught.type
    assert (str(again), vars(again)) == (str(caught.value), vars(caught.value))


def test_every_kind_of_error_travels() -> None:
    for kind in all_errors(NpchipError):
        error = kind.__new__(kind, "message")
        vars(error).update(code="NP000", message="message", hint=None)
        again = pickle.loads(pickle.dumps(error))  # noqa: S301 - our own
        assert (type(again), vars(again)) == (kind, vars(error))


def _run(program: Program) -> Any:
    return Chip(program).run(FRAMES)


@pytest.mark.parametrize("method", ["spawn", "fork"])
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")  # here are other threads
def test_a_process_pool_runs_programs_and_hands_errors_back(program: Program, method: str) -> None:
    """Fails before: the pool broke, or waited for ever."""
    with ProcessPoolExecutor(1, mp_context=get_context(method)) as pool:
        wrong = pool.submit(_wrong, "source")
        right = pool.submit(_run, program)
        with pytest.raises(NpchipError, match="errors"):
            wrong.result(timeout=60)
        assert right.result(timeout=60).outputs["value"].tolist() == [10, 20, 30, 40]
