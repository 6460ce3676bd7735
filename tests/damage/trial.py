"""One damaged file: what npchip makes of it, in how much time and memory."""

from __future__ import annotations

import random
import resource
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import NpchipError
from npchip.formats import load_program
from npchip.frames import open_frames
from npchip.frames.memory import read_memory
from npchip.host.scenes.files import read_scene
from npchip.host.scenes.stereo import read_space_scene
from npchip.host.vision.fusion import load_rig
from npchip.isa.loader import read_isa
from npchip.machine import load_machine
from tests.damage.bases import SIZE, bases
from tests.damage.mutate import damage
from tests.damage.oracles import complaint
from tests.support.patience import at_most

SECONDS = 10
MEGABYTES = 1000


@dataclass(frozen=True)
class Fault:
    """A fault of npchip with a damaged file.

    Attributes:
        seed: of the damage.
        base: name of the whole file.
        kind: `traceback`, `slow`, `memory`, or `silent` for a frame that differs from the whole
            file's without an error, though another decoder reports one.
        text: what was said.
    """

    seed: int
    base: str
    kind: str
    text: str


class _SlowError(BaseException):
    """Ends what takes too long."""


def try_one(form: str, seed: int, folder: Path) -> Fault | None:
    """Damage a file of a format; return what npchip does wrong with it."""
    path, name = make(form, seed, folder)
    before, started = _peak(), time.perf_counter()
    frames: list[NDArray[np.uint8]] = []
    error: str | None = None
    try:
        with at_most(SECONDS, _SlowError(), by="clock"):
            frames.extend(np.array(frame) for frame in _read(path, name))
    except NpchipError as known:
        error = str(known)
    except _SlowError:
        return Fault(seed, name, "slow", f"more than {SECONDS} s")
    except Exception:  # noqa: BLE001 - the very thing that is looked for
        return Fault(seed, name, "traceback", traceback.format_exc())
    if _peak() - before > MEGABYTES:
        return Fault(seed, name, "memory", f"{_peak() - before:.0f} MB more; {error}")
    if error is None and (taken := time.perf_counter() - started) > SECONDS:
        return Fault(seed, name, "slow", f"{taken:.1f} s")
    if error is not None or path.suffix in (".yaml", ".npo"):
        return None
    if differs(frames, whole(form, name, folder)) and (said := complaint(path, folder / name)):
        return Fault(seed, name, "silent", said)
    return None


def make(form: str, seed: int, folder: Path) -> tuple[Path, str]:
    """Write a damaged file; return its path and the name of the whole one."""
    draw = random.Random(f"{form} {seed}")
    name, content = draw.choice(bases(form))
    path = folder / f"damaged-{name}"
    path.write_bytes(damage(content, draw))
    return path, name


def whole(form: str, name: str, folder: Path) -> list[NDArray[np.uint8]]:
    """Return the frames of a whole file; none if npchip refuses it."""
    path = folder / name
    path.write_bytes(dict(bases(form))[name])
    try:
        return list(_read(path, name))
    except NpchipError:
        return []


def differs(found: list[NDArray[np.uint8]], wanted: list[NDArray[np.uint8]]) -> bool:
    """Tell whether a frame is missing, new or another."""
    return len(found) != len(wanted) or any(
        not np.array_equal(*pair) for pair in zip(found, wanted, strict=True)
    )


def _read(path: Path, name: str) -> Iterator[NDArray[np.uint8]]:
    if path.suffix == ".npo":
        load_program(path)
    elif path.suffix == ".yaml":
        _YAML[name.partition("-")[0]](path)
    elif name.startswith("memory"):
        yield from read_memory(0, path, load_machine("default"))
    else:
        yield from open_frames(path, *SIZE, "resize")


_YAML: dict[str, Callable[[Path], Any]] = {
    "machine": load_machine,
    "isa": read_isa,
    "scene": read_scene,
    "space": read_space_scene,
    "rig": load_rig,
}


def _peak() -> float:
    """Return the largest amount of memory that the process has had, in MB."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1 << 20 if sys.platform == "darwin" else 1 << 10)
