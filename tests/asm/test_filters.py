"""The filters and measurements of asm/ against SciPy and NumPy, on real and on random scenes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip import Chip, Machine, RunResult, assemble, assemble_text, load_machine
from tests.oracles import dct, filters
from tests.oracles.correlation import correlation
from tests.oracles.frame_difference import frame_difference
from tests.oracles.imaging import imaging
from tests.oracles.statistics import statistics
from tests.oracles.tracking import tracking
from tests.support.clips import bundled_clips, synthetic_clip
from tests.support.profiles import THOROUGH
from tests.support.programs import assembled

ASM = Path(__file__).parents[2] / "asm"
SCENES = 1000 if THOROUGH else 60
CHUNK = 20  # random scenes to a test, so that several processes share them

Frames = NDArray[np.uint8]


@dataclass(frozen=True)
class Task:
    """A program with what it must send.

    Attributes:
        oracle: the outputs of frames of shape (T, rows, columns).
        spoiled: a piece of the source, and what makes a wrong program of it.
        defines: values for constants of the source.
        memory: bytes of the NPs from `TEMPLATE` on, by NP rows and columns.
    """

    oracle: Callable[[Frames], Mapping[str, Any]]
    spoiled: tuple[str, str]
    defines: Mapping[str, int] | None = None
    memory: Callable[[int, int], Frames] | None = None


TEMPLATE = 128  # where asm/correlate.s expects it


def template(np_rows: int, np_cols: int) -> Frames:
    """A template of its own for every NP; that of the first NP is as large as can be."""
    numbers = np.random.default_rng(3).integers(0, 256, (64, np_rows, np_cols), np.uint8)
    numbers[:, 0, 0] = 255
    return numbers


TASKS = {
    "imaging": Task(
        lambda frames: {"picture": imaging(frames)},
        ("SAMPLE  signal, SIGNAL", "SAMPLE  reset, SIGNAL"),
    ),
    "frame_difference": Task(
        lambda frames: {"difference": frame_difference(frames)},
        ("WHERE   LO              ; it has", "WHERE   HI              ; it has"),
    ),
    "edges": Task(
        lambda frames: {"edges": filters.edges(frames)},
        ("ADC   h, #0           ; 255", "ADC   h, #1           ; 255"),
    ),
    "smooth": Task(
        lambda frames: {"smooth": filters.smooth(frames)},
        ("ADC     sum, #0", "ADD     sum, #0"),
    ),
    "median": Task(
        lambda frames: {"median": filters.median(frames)},
        ("CMP   t, a", "CMP   t, b"),
    ),
    "dct": Task(
        lambda frames: {"dct": dct.dct(frames)},
        ("ADC     xh, #0", "ADD     xh, #0"),
    ),
    "correlate": Task(
        lambda frames: correlation(frames, template(frames.shape[1] // 8, frames.shape[2] // 8)),
        ("ADC     high, #0", "MOV     high, #0"),
        memory=template,
    ),
    "statistics": Task(statistics, ("#(PIXELS / 2) >> 8", "#0")),
    "tracking": Task(
        lambda frames: tracking(frames, 128), ("ADC     areah, #0", "MOV     areah, #0")
    ),
    "tracking.low": Task(
        lambda frames: tracking(frames, 1),
        ("CMP     f, level", "CMP     level, f"),
        {"THRESHOLD": 1},
    ),
    "tracking.dark": Task(
        lambda frames: tracking(frames, 64, dark=True),
        ("THRESHOLD - DARK", "THRESHOLD"),
        {"THRESHOLD": 64, "DARK": 1},
    ),
}


@cache
def large_machine() -> Machine:
    """16 × 20 NPs: frames of 128 × 160."""
    return replace(load_machine("default"), name="large", np_rows=16, np_cols=20)


@cache
def chip(name: str, *, large: bool = False, fixed_pattern: int = 0) -> Chip:
    machine = large_machine() if large else load_machine("default")
    if fixed_pattern:
        machine = replace(machine, sensor=replace(machine.sensor, fixed_pattern=fixed_pattern))
    return Chip(assemble(source(name), machine, TASKS[name].defines), machine)


def source(name: str) -> Path:
    """The file of a task: what comes before a dot in its name."""
    return ASM / f"{name.partition('.')[0]}.s"


def differences(result: RunResult, expected: Mapping[str, Any]) -> list[str]:
    """Names of the outputs that are not as expected."""
    assert result.status == "frames-exhausted"
    assert list(result.outputs) == list(expected)
    return [
        name
        for name, values in expected.items()
        if not np.array_equal(np.array(list(result.outputs[name])), np.array(values))
    ]


def run(name: str, chip: Chip, frames: Frames) -> RunResult:
    """Run a task from the start."""
    assert len(frames) > 0
    chip.reset()
    memory = TASKS[name].memory
    if memory:
        chip.load_memory(TEMPLATE, memory(*chip.machine.geometry))
    return chip.run(frames)


def check(name: str, chip: Chip, frames: Frames) -> None:
    assert differences(run(name, chip, frames), TASKS[name].oracle(frames)) == []


def scenes(first: int, rows: int = 64, cols: int = 80) -> Frames:
    """Frames of `CHUNK` random scenes; one in four is noise of a random range."""
    frames = []
    for seed in range(first, first + CHUNK):
        if seed % 4:
            frames.append(synthetic_clip(seed, rows, cols, frames=2)[1])
        else:
            rng = np.random.default_rng(seed)
            low, high = sorted(rng.integers(0, 256, 2).tolist())
            frames.append(rng.integers(low, high + 1, (rows, cols), np.uint8))
    return np.array(frames)


@pytest.mark.parametrize("clip", bundled_clips())
@pytest.mark.parametrize("name", TASKS)
def test_on_real_clips(name: str, clip: str) -> None:
    check(name, chip(name), bundled_clips()[clip])


@pytest.mark.parametrize("first", range(0, SCENES, CHUNK))
@pytest.mark.parametrize("name", TASKS)
def test_on_random_scenes(name: str, first: int) -> None:
    check(name, chip(name), scenes(first))


@pytest.mark.parametrize("name", TASKS)
def test_on_flat_and_extreme_frames(name: str) -> None:
    frames = np.zeros((7, 64, 80), np.uint8)
    y, x = np.mgrid[:64, :80]
    frames[1] = 255
    frames[2] = (y + x) % 2 * 255
    frames[3] = (x % 16 >= 8) * 255  # steps at the borders of the NPs
    frames[4] = (y % 16 >= 8) * 255
    frames[5, ::63, ::79] = 255  # the four corners
    frames[6] = 255 - frames[5]
    check(name, chip(name), frames)


@pytest.mark.parametrize("name", TASKS)
def test_on_a_larger_array(name: str) -> None:
    large = chip(name, large=True)
    real = np.kron(bundled_clips()["coin_slide"][3:5], np.ones((1, 2, 2), np.uint8))
    check(name, large, np.concatenate([real, scenes(0, 128, 160)]))


@pytest.mark.parametrize("name", TASKS)
def test_with_a_fixed_pattern(name: str) -> None:
    """Double sampling gives the frame again, but for what the converter has clipped."""
    chip_ = chip(name, fixed_pattern=40)
    frames = bundled_clips()["city_night"][::40]
    assert frames.max() > 200
    pictures = Chip(assembled("imaging"), chip_.machine).run(frames).outputs["picture"]
    assert np.mean(pictures == frames) > 0.9
    expected = TASKS[name].oracle(np.array(list(pictures)))
    assert differences(run(name, chip_, frames), expected) == []


@pytest.mark.parametrize("name", TASKS)
def test_a_spoiled_program_is_noticed(name: str) -> None:
    task = TASKS[name]
    text = source(name).read_text(encoding="utf-8")
    assert task.spoiled[0] in text
    spoiled = assemble_text(text.replace(*task.spoiled), defines=task.defines, include_paths=[ASM])
    frames = np.concatenate([scenes(first) for first in (0, CHUNK)])
    assert differences(run(name, Chip(spoiled), frames), task.oracle(frames))


@pytest.mark.parametrize("name", TASKS)
def test_no_frame_takes_longer_than_the_budget(name: str) -> None:
    corners = np.zeros((2, 64, 80), np.uint8)
    corners[:, 0, 0] = 255
    corners[0, 63, 63] = corners[1, 63, 79] = 255
    frames = np.concatenate([scenes(0), corners, 255 - corners])
    cycles = run(name, chip(name), frames).frame_cycles
    assert int(cycles.max()) == chip(name).program.budget.cycles


# ---- accuracy of the cosine transform: its integers against SciPy's floating-point numbers

DCT_BOUND = 2.1  # as derived in the head of the program


def dct_of(frames: Frames) -> NDArray[np.int8]:
    """Blocks of coefficients as the program sends them."""
    outputs = run("dct", chip("dct"), frames).outputs
    return dct.to_blocks(np.array(list(outputs["dct"]))).view(np.int8)


@pytest.mark.parametrize("clip", bundled_clips())
def test_coefficients_and_inverse_on_real_clips(clip: str) -> None:
    frames = bundled_clips()[clip]
    sent, exact = dct_of(frames), dct.quotients(frames)
    assert np.abs(sent - exact).max() < 0.95
    assert np.mean(sent == np.rint(exact)) > 0.97
    noise, least = (
        ((dct.picture(found).astype(float) - frames) ** 2).mean(axis=(1, 2))
        for found in (sent.astype(float), np.rint(exact))
    )
    assert (10 * np.log10(255**2 / noise)).min() >= 40.7
    assert 10 * np.log10(noise.mean() / least.mean()) < 0.2  # most of it is the rounding to 8 bits


def test_coefficients_never_miss_by_more_than_the_bound() -> None:
    error = dct.error_of_constants()
    assert round(float(np.abs(error).sum(axis=(2, 3)).max()) * 128, 2) == 1.38
    blocks = np.where(error > 0, 255, 0).astype(np.uint8)  # (v, u) misses most in block (v, u)
    frames = np.zeros((2, 64, 80), np.uint8)
    frames[0, :, :64] = blocks.swapaxes(1, 2).reshape(64, 64)
    frames[1] = 255 - frames[0]
    noise = np.random.default_rng(8).integers(0, 2, (10, 64, 80), np.uint8) * 255
    frames = np.concatenate([frames, noise])
    missed = np.abs(dct_of(frames) - dct.quotients(frames)).max()
    assert 1.2 < missed < DCT_BOUND
