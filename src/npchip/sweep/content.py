"""Hashes of all that decides a result: bytes of programs and clips, values of machines, scenes."""

from __future__ import annotations

import hashlib
import importlib.util
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from npchip import __version__
from npchip.base.errors import InputError
from npchip.base.json import one_line
from npchip.frames.order import in_order
from npchip.host.scenes.files import scene_as_data
from npchip.host.scenes.output import truth_path
from npchip.machine.model import Machine, sections_of
from npchip.sweep.model import Clip, ClipFile, Experiment

_QUOTED = re.compile(rb'"([^"\n]+)"')


def digest(value: Any) -> str:
    """Return the hash of plain data: 20 hexadecimal digits."""
    return hashlib.sha256(one_line(value).encode()).hexdigest()[:20]


def of_program(path: Path) -> str:
    """Return the hash of a source and of every file that it names in quotes, or of an object.

    Raises:
        InputError: NP641 it cannot be read.
    """
    found = sorted((name, hashlib.sha256(data).hexdigest()) for name, data in _files(path))
    return digest(found)


def _files(path: Path) -> Iterator[tuple[str, bytes]]:
    """Yield a file and those that it names in quotes, with their names from its folder on."""
    folder = path.parent.resolve()
    waiting, seen = [path], {path.resolve()}
    while waiting:
        file = waiting.pop()
        data = _bytes(file)
        yield "" if file == path else file.resolve().relative_to(folder).as_posix(), data
        for name in _QUOTED.findall(data):
            named = (file.parent / name.decode(errors="replace")).resolve()
            if named not in seen and named.is_relative_to(folder) and named.is_file():
                seen.add(named)
                waiting.append(named)


def of_clip(clip: Clip | None) -> str:
    """Return the hash of a clip with the truth about it; that of its scene if it is drawn.

    Raises:
        InputError: NP641 it cannot be read.
    """
    if clip is None:
        return ""
    if not isinstance(clip, ClipFile):
        return digest([scene_as_data(clip.scene), clip.seed])
    truth = truth_path(clip.path)
    files = [truth] if truth.is_file() else []
    if clip.path.is_dir():
        files += in_order([item for item in clip.path.iterdir() if item.is_file()])
    else:
        files.append(clip.path)
    several = clip.path.is_dir()
    return digest([[file.name if several else file.suffix, _hash(file)] for file in files])


def of_machine(machine: Machine) -> str:
    """Return the hash of all that a machine is, but for its name and summary."""
    sections = sections_of(machine)
    timing = {
        name: cost if isinstance(cost, int) else cost._asdict()
        for name, cost in sections["timing"].items()
    }
    return digest({**sections, "timing": timing})


def of_experiment(experiment: Experiment) -> str:
    """Return the hash of the module in which an experiment's function is.

    Raises:
        InputError: NP647 there is no such module.
    """
    beside = experiment.folder / f"{experiment.module.replace('.', '/')}.py"
    if beside.is_file():
        return digest([experiment.function, _hash(beside)])
    try:
        spec = importlib.util.find_spec(experiment.module)
    except ImportError:
        spec = None
    if spec is None or spec.origin is None:
        raise InputError(
            "NP647",
            f"experiment: there is no module {experiment.module}",
            hint=f"{beside} would be it, or an installed module of this name",
        )
    return digest([experiment.function, _hash(Path(spec.origin))])


def version() -> str:
    """Return the version of npchip that decides results."""
    return __version__


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise _unreadable(path, error) from None


def _hash(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise _unreadable(path, error) from None


def _unreadable(path: Path, error: OSError) -> InputError:
    return InputError("NP641", f"cannot read {path}: {error.strerror or error}")
