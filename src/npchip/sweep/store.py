"""Store of finished runs: a folder whose journal grows with every run; tables come from it.

The journal has a line for each run, so whatever ends the process loses at most that one.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import ExitStack, closing
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
    """The place of a run in the journal, and of its frames in theirs (size -1 for none)."""

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
        try:
            with ExitStack() as opened:
                self._journal, self._frames = (
                    opened.enter_context(closing(_Growing(folder / name)))
                    for name in (JOURNAL, FRAMES)
                )
                self._read()
                self._files = opened.pop_all()
        except OSError as error:
            raise _cannot_write(folder, error) from None

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
        end = 0
        for line in self._journal.lines():
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
                frames, size = self._frames.append(text), len(text)
                data["frames"] = [frames, size]
            if done.again:
                data["again"] = True
            line = f"{one_line(data)}\n".encode()
            start = self._journal.append(line)
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
        text = self._frames.part(entry.frames, entry.frames_size)
        return json.loads(text)  # type: ignore[no-any-return]

    def _line(self, entry: _Entry) -> Any:
        return json.loads(self._journal.part(entry.start, entry.size))

    def __contains__(self, key: str) -> bool:
        return key in self._entries


class _Growing:
    """A file that is added to and read; nothing waits in a buffer when the disk is full."""

    def __init__(self, path: Path) -> None:
        with ExitStack() as opened:
            self._end = opened.enter_context(path.open("ab", buffering=0))
            self._all = opened.enter_context(path.open("rb"))
            self._files = opened.pop_all()

    def lines(self) -> Iterator[bytes]:
        """Yield the lines from the first on."""
        self._all.seek(0)
        for line in self._all:  # noqa: UP028 - who stops early must not close the file
            yield line

    def part(self, start: int, size: int) -> bytes:
        """Return a part."""
        self._all.seek(start)
        return self._all.read(size)

    def append(self, data: bytes) -> int:
        """Add to the end, and return where that was; what is only half written is taken back."""
        start = self._end.seek(0, os.SEEK_END)
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[self._end.write(rest) :]
        except BaseException:
            self.truncate(start)
            raise
        return start

    def truncate(self, size: int) -> None:
        """Drop what lies behind `size` bytes."""
        self._end.truncate(size)

    def close(self) -> None:
        """Close the file."""
        self._files.close()


def _plain(values: Any) -> list[int | None]:
    return np.ma.asarray(values).tolist()  # type: ignore[no-any-return]


def _cannot_write(folder: Path, error: OSError) -> InputError:
    return InputError(
        "NP250",
        f"cannot write in {folder}: {error.strerror or error}",
        hint="what is done is kept: make room, and run the same command again",
    )
