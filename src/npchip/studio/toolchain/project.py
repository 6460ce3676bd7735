"""The files of a project, in a folder where the tool chain finds them."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import Any, Final

from npchip.base.errors import InputError
from npchip.isa import Isa
from npchip.machine import Machine, load_machine, parse_machine

MOST_FILES: Final = 200
MOST_CHARACTERS: Final = 8 << 20
"""Most characters of all files: golden files are the largest."""
_LONGEST_NAME: Final = 200


class Folder:
    """A folder that holds the files of one project at a time.

    Args:
        path: the folder; it is made when it is needed.

    Attributes:
        path: the folder, with symbolic links resolved.
    """

    def __init__(self, path: Path) -> None:
        self.path = path.resolve()
        self._files: dict[str, str] = {}

    @contextlib.contextmanager
    def holding(self, project: Mapping[str, Any]) -> Iterator[Path]:
        """Put the files of a project there, and work in the folder; yield the path of the main one.

        Paths in messages are those of the project, as they are relative.

        Raises:
            InputError: NP025, a name or size that cannot be.
        """
        files: Mapping[str, str] = project["files"]
        main = project["main"]
        if main not in files:
            raise InputError("NP025", f"the project has no file {main}")
        _check(files)
        self._write(files)
        with contextlib.chdir(self.path):
            yield Path(main)

    def _write(self, files: Mapping[str, str]) -> None:
        self.path.mkdir(parents=True, exist_ok=True)
        for name in self._files.keys() - files.keys():
            (self.path / name).unlink(missing_ok=True)
            del self._files[name]
        for name, text in files.items():
            path = self.path / name
            if self._files.get(name) == text and path.is_file():
                continue
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8", errors="replace", newline="")
            except OSError as error:
                reason = error.strerror or error
                raise InputError("NP025", f"{name} cannot be a file: {reason}") from None
            self._files[name] = text


def _check(files: Mapping[str, str]) -> None:
    if len(files) > MOST_FILES:
        raise InputError("NP025", f"the project has {len(files)} files: at most {MOST_FILES}")
    if sum(map(len, files.values())) > MOST_CHARACTERS:
        raise InputError("NP025", f"the project is larger than {MOST_CHARACTERS >> 20} MiB")
    for name in files:
        path = PurePosixPath(name)
        plain = name == str(path) and not path.is_absolute() and ".." not in path.parts
        if not plain or name == "." or len(name) > _LONGEST_NAME or not name.isprintable():
            raise InputError(
                "NP025",
                f"{name[:_LONGEST_NAME]!r} is no name for a file of a project",
                hint="such as program.s or lib/maximum.s",
            )


def machine_of(choice: Mapping[str, Any], isa: Isa) -> Machine:
    """Return the machine of a ``MachineChoice``; a file of the project needs no text.

    Raises:
        InputError: it is not one.
    """
    name = choice["name"]
    if choice.get("text") is not None:
        return parse_machine(choice["text"], name, isa.timing_classes)
    return load_machine(name, isa.timing_classes)
