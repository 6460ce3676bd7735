"""Measures that compare programs in docs/networks.md: how often they are right, and memory."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from examples.measure import ROOT, case_of
from examples.studies.study import FOLDER
from examples.sweeps import robustness
from npchip import Chip, Machine, assemble, load_machine
from npchip.host.vision.networks import accuracy, pictures, sets
from npchip.host.vision.orientation import eightbit

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from npchip import Program, RunResult

SEEDS = range(2, 7)
"""Seeds of scenes and of the sensor; not 1, whose poses ``orientation.s`` was trained on."""
SPLIT = 1
"""Seed of the pictures of digits that are kept aside."""
HALFWAY = robustness.BACKGROUND + robustness.CONTRAST // 2
"""Threshold of the programs that find corners: halfway between background and object."""
TRAINED, ROBUST = 44, 60
"""Thresholds of ``orientation.s``: its own, and one that holds with noise (docs/robustness.md)."""
REACH = 2
"""Pixels that block matching looks around."""
FRAMES = 20
"""Frames of a scene that moves."""


def noisy(sigma: float, seed: int, machine: str = "default") -> Machine:
    """Return a machine whose conversions have noise."""
    plain = load_machine(machine)
    return replace(plain, sensor=replace(plain.sensor, noise_rms=sigma, seed=seed))


@cache
def digits(sigma: float, machine: str = "default") -> tuple[accuracy.Share, RunResult]:
    """Read the handwritten digits that are kept aside; return how many are right, and the run."""
    data = pictures.split(sets.digits(), SPLIT).test
    chip = Chip(assemble(ROOT / "asm" / "digits.s"), noisy(sigma, SPLIT, machine))
    result = chip.run(accuracy.frames_of(data, accuracy.CONDITIONS[0]))
    right = int((np.array(result.outputs["digit"]) == data.labels).sum())
    return accuracy.Share(right, len(data)), result


def corners(program: str, sigma: float) -> float:
    """Return the part of random triangles of which a program finds all corners within 3 pixels."""
    found = [
        robustness.corners(noisy(sigma, seed), program, HALFWAY, seed)["within_3"] for seed in SEEDS
    ]
    return float(np.mean(found))


def distance(sigma: float, threshold: int) -> float:
    """Return the RMS error in mm of the distance that ``orientation.s`` sends."""
    found = [robustness.distance(noisy(sigma, seed), threshold, seed)["rms"] ** 2 for seed in SEEDS]
    return float(np.sqrt(np.mean(found)))


def cycles(program: str, machine: str) -> float:
    """Return the mean cycles of a frame where a triangle is seen, as it is judged above."""
    means = []
    for seed in SEEDS:
        poses = program == "orientation"
        threshold = TRAINED if poses else HALFWAY
        chip = robustness.chip(program, noisy(0, seed, machine), seed, threshold)
        if poses:
            chip.load_memory(eightbit.ADDRESS, np.load(robustness.WEIGHTS))
        _, frames = robustness.poses(seed) if poses else robustness.triangles(seed)
        means.append(chip.run(frames).frame_cycles.mean())
    return float(np.mean(means))


def blocks(sigma: float) -> float:
    """Return the part of the blocks whose motion block matching finds.

    A random soft pattern moves by up to 2 pixels a frame along both axes; blocks at the frame's
    border do not count, as they may leave it.
    """
    program = assemble(FOLDER / "block_matching.s", include_paths=[ROOT / "asm"])
    right: list[Any] = []
    for seed in SEEDS:
        frames, moves = moving(seed)
        result = Chip(program, noisy(sigma, seed)).run(frames)
        for frame in range(1, len(frames)):
            planes = [np.array(result.value(name, frame)) for name in ("down", "right")]
            agree = [p == m % 256 for p, m in zip(planes, moves[frame - 1], strict=True)]
            right.append((agree[0] & agree[1])[1:-1, 1:-1])
    return float(np.mean(right))


def moving(seed: int) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Return a scene that moves as a whole: frames, and rows and columns from each to the next."""
    rng = np.random.default_rng(seed)
    margin = REACH * FRAMES
    pattern = rng.standard_normal((64 + 2 * margin, 80 + 2 * margin))
    soft = scipy.ndimage.gaussian_filter(pattern, 2)
    scene = np.clip(128 + 50 * soft / soft.std(), 0, 255).astype(np.uint8)
    moves = rng.integers(-REACH, REACH + 1, (FRAMES - 1, 2))
    places = margin - np.concatenate([[[0, 0]], moves.cumsum(axis=0)])
    frames = np.array([scene[y : y + 64, x : x + 80] for y, x in places])
    return frames, moves


def planes_of(planes: Sequence[bytes]) -> NDArray[np.uint8]:
    """Return bytes of a program as they lie in the NPs."""
    return np.frombuffer(b"".join(planes), np.uint8).reshape(len(planes), 8, 10)


def memory_used(source: Path) -> int:
    """Return the bytes of an NP's memory that a program needs on its test run."""
    run = case_of(source, "default").run
    folder = source.parent
    program = assemble(source, defines=run.defines, include_paths=[ROOT / "asm"])
    loaded = [(at, np.load(folder / name)) for at, name in run.memory]
    return memory_needed(program, np.load(folder / str(run.frames)), loaded)


def memory_needed(
    program: Program, frames: NDArray[np.uint8], loaded: Sequence[tuple[int, Any]] = ()
) -> int:
    """Return the bytes of an NP's memory that a program writes, or finds written before it runs.

    A byte that is never written keeps what it held before: two runs that begin with different
    bytes tell.

    Args:
        program: the program.
        frames: what it sees.
        loaded: addresses and bytes of what the host writes before, besides what the program's
            ``.memory`` lines name.
    """
    own = [
        (each.address, np.load(each.file) if each.planes is None else planes_of(each.planes))
        for each in program.memory
    ]
    left = []
    for fill in (0x00, 0xA5):
        chip = Chip(program)
        chip.memory[:] = fill
        for address, planes in [*own, *loaded]:
            chip.memory[address : address + len(planes)] = planes
        chip.run(frames)
        left.append(chip.memory.copy())
    return int((left[0] == left[1]).any(axis=(1, 2)).sum())
