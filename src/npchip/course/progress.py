"""A learner's progress: one JSON file in the learner's folder."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from npchip.base.errors import InputError
from npchip.base.files import read_bytes, write_text
from npchip.base.json import indented

FILE = "npchip-learn.json"
SCHEMA = 1
MAX_BYTES = 1 << 20
_MOST = 1 << 40


@dataclass
class Record:
    """The work of a learner in one exercise.

    Attributes:
        checks: number of checks.
        failed: number of those that did not pass.
        hints: number of hints that were shown.
        points: most points that were reached.
        points_of: all points.
        solved: whether all checks passed, the hidden ones too.
        cycles: least cycles of a program that passed all checks; 0 before there was one.
        percent: these cycles in percent of the reference solution's, rounded up.
    """

    checks: int = 0
    failed: int = 0
    hints: int = 0
    points: int = 0
    points_of: int = 0
    solved: bool = False
    cycles: int = 0
    percent: int = 0


@dataclass
class Progress:
    """The progress of a learner.

    Attributes:
        folder: the learner's folder, which the exercises are written into.
        current: name of the present exercise: the one that was started last.
        records: what was done, by exercise.
    """

    folder: Path
    current: str = ""
    records: dict[str, Record] = field(default_factory=dict)

    def program(self, name: str) -> Path:
        """Return where the learner's program of an exercise is kept."""
        return self.folder / name / f"{name}.s"

    def solved(self, name: str) -> bool:
        """Return whether an exercise is solved."""
        return name in self.records and self.records[name].solved

    def record(self, name: str) -> Record:
        """Return the record of an exercise, a new one before it was begun."""
        return self.records.setdefault(name, Record())

    def save(self) -> None:
        """Write the file.

        Raises:
            InputError: NP250, it cannot be written.
        """
        exercises = {name: asdict(record) for name, record in self.records.items()}
        document = {"schema": SCHEMA, "current": self.current, "exercises": exercises}
        write_text(self.folder / FILE, indented(document), over=True)


def find_progress(start: Path | None = None) -> Progress:
    """Return the progress kept in a folder or in the one above, else that of a new learner.

    Args:
        start: where to look first; the present folder by default. Above is the learner's folder
            where this is the folder of an exercise.

    Raises:
        InputError: NP662, the file cannot be read or is damaged.
    """
    here = Path() if start is None else start
    for folder in (here, here / ".."):
        if (folder / FILE).exists():
            return _read(folder)
    return Progress(here)


def _read(folder: Path) -> Progress:
    path = folder / FILE
    try:
        document = json.loads(read_bytes(path, MAX_BYTES).decode())
        return _progress(folder, document)
    except OSError as error:
        raise InputError("NP662", f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, TypeError, RecursionError):
        hint = "rename it to begin anew: your programs are not in it"
        raise InputError("NP662", f"{path}: not a learner's progress", hint=hint) from None


def _progress(folder: Path, document: Any) -> Progress:
    """Return the progress of a document.

    Raises:
        ValueError, TypeError: it is not as `Progress.save` writes it.
    """
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        raise ValueError
    current, exercises = document.get("current"), document.get("exercises")
    if not isinstance(current, str) or not isinstance(exercises, dict):
        raise TypeError
    return Progress(folder, current, {name: _record(each) for name, each in exercises.items()})


def _record(values: Any) -> Record:
    known: dict[str, Any] = asdict(Record())
    if not isinstance(values, Mapping) or values.keys() - known.keys():
        raise ValueError
    for name, value in values.items():
        if type(value) is not type(known[name]) or not 0 <= int(value) < _MOST:
            raise ValueError
    return Record(**values)
