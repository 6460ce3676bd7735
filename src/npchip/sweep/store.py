"""What is done, in a folder: a journal that grows with every run, from which tables are written.

The journal has a line for each run, so whatever ends the process loses at most that one.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Final, NamedTuple, Self

import numpy as np

from npchip.base.errors import InputError
from npchip.base.files import make_directory
from npchip.base.json import one_line
from npchip.sweep.work import Done

JOURNAL: Final = "journal.jsonl"
FRAMES: Final = "journal.frames"


class _Entry(NamedTuple):
    """Where a run stands in the journal, and its frames in theirs (size -1 for none)."""

    start: int
    size: int
    frames: int
    frames_size: int


class Store:
    """The folder of a sweep, opened to read and to add.

    Args:
        folder: the folder, which is made if it is not there.

    Raises:
        InputError: NP250 it cannot be written.
    """

    def __init__(self, folder: Path) -> None:
        make_directory(folder)
        self.folder = folder
        self._entries: dict[str, _Entry] = {}
        with ExitStack() as opened:
            try:
                self._journal = opened.enter_context((folder / JOURNAL).open("a+b"))
                self._frames = opened.enter_context((folder / FRAMES).open("a+b"))
            except OSError as error:
                raise _cannot_write(folder, error) from None
            self._files = opened.pop_all()
        self._read()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self._files.close()

    def _read(self) -> None:
        """Find what is done; drop a last line that was cut short."""
        self._journal.seek(0)
        end = 0
        for line in self._journal:
            entry = self._entry(line, end)
            if entry is None:
                break
            key, place = entry
            if place is not None:
                self._entries[key] = place
            end += len(line)
        self._journal.truncate(end)

    def _entry(self, line: bytes, start: int) -> tuple[str, _Entry | None] | None:
        """Return a line's run, and its place if it need not be made again; None for a cut line."""
        if not line.endswith(b"\n"):
            return None
        try:
            data = json.loads(line)
            key, (frames, size) = data["run"], data.get("frames", (0, -1))
        except (ValueError, LookupError, TypeError):
            return None
        if data.get("again"):
            return key, None
        return key, _Entry(start, len(line), frames, size)

    def has(self, key: str, *, frames: bool) -> bool:
        """Return whether a run is done, with its frames if they are wanted."""
        entry = self._entries.get(key)
        return entry is not None and (not frames or entry.frames_size >= 0 or self._failed(entry))

    def _failed(self, entry: _Entry) -> bool:
        return bool(self._line(entry)["row"]["status"] == "failed")

    def add(self, done: Done) -> None:
        """Add a run that has been made; one that is there already is not added twice.

        Raises:
            InputError: NP250 it cannot be written, such as on a full disk.
        """
        data: dict[str, Any] = {"run": done.key, "row": done.row}
        frames, size = 0, -1
        try:
            if done.frames is not None:
                text = one_line({name: _plain(item) for name, item in done.frames.items()}).encode()
                frames, size = self._frames.seek(0, os.SEEK_END), len(text)
                self._frames.write(text)
                self._frames.flush()
                data["frames"] = [frames, size]
            if done.again:
                data["again"] = True
            line = f"{one_line(data)}\n".encode()
            start = self._journal.seek(0, os.SEEK_END)
            self._journal.write(line)
            self._journal.flush()
        except OSError as error:
            raise _cannot_write(self.folder, error) from None
        self._entries[done.key] = _Entry(start, len(line), frames, size)

    def row(self, key: str) -> dict[str, Any] | None:
        """Return the columns of a run but for its axes; None if it is not done."""
        entry = self._entries.get(key)
        return None if entry is None else self._line(entry)["row"]

    def columns(self, key: str) -> dict[str, list[int | None]]:
        """Return the columns of the frames of a run; none if they were not kept."""
        entry = self._entries.get(key)
        if entry is None or entry.frames_size < 0:
            return {}
        self._frames.seek(entry.frames)
        return json.loads(self._frames.read(entry.frames_size))  # type: ignore[no-any-return]

    def _line(self, entry: _Entry) -> Any:
        self._journal.seek(entry.start)
        return json.loads(self._journal.read(entry.size))

    def __len__(self) -> int:
        return len(self._entries)

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)


def _plain(values: Any) -> list[int | None]:
    return np.ma.asarray(values).tolist()  # type: ignore[no-any-return]


def _cannot_write(folder: Path, error: OSError) -> InputError:
    return InputError(
        "NP250",
        f"cannot write in {folder}: {error.strerror or error}",
        hint="what is done is kept: make room, and run the same command again",
    )
