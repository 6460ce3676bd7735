"""The frames of a session, which can be read again from any source."""

from __future__ import annotations

import tempfile
import weakref
from collections.abc import Generator, Iterator

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames import FrameSource
from npchip.frames.source import Frame

MOST_BYTES = 2 << 30
"""Largest size of the temporary file: 400,000 frames of 64 x 80 pixels."""


class Recorded(FrameSource):
    """The frames of a source, copied to a temporary file if they are slow to read again.

    Args:
        source: the source, which may be an iterator or endless.

    Attributes:
        until: first frame to hold back; None for none.
    """

    cheap_access = True

    def __init__(self, source: FrameSource) -> None:
        super().__init__(source.name, source.rows, source.cols)
        self._source = source
        self.until: int | None = None
        self._size = source.rows * source.cols
        self._kept = 0
        self._stream: Iterator[Frame] | None = None
        self._failure: InputError | None = None  # raised after the frames that are kept
        self._file = None if source.cheap_access else tempfile.TemporaryFile()  # noqa: SIM115
        if self._file is not None:
            weakref.finalize(self, self._file.close)

    def has(self, index: int) -> bool:
        """Return whether the source has frame `index`, held back or not; read up to it.

        Raises:
            InputError: NP106, too many frames to keep; or as the source.
        """
        if self._source.count is not None and index >= self._source.count:
            return False
        if self._file is None:
            return True
        if self._stream is None:
            self._stream = iter(self._source)
        while self._kept <= index:
            if self._failure is not None:
                raise self._failure
            try:
                frame = next(self._stream, None)
            except InputError as error:
                self._failure = error
                raise
            if frame is None:
                return False
            if (self._kept + 1) * self._size > MOST_BYTES:
                raise InputError(
                    "NP106",
                    f"{self.name}: {self._kept} frames are kept to go back to, and more do not fit",
                    hint="save the clip as .npy, which needs no keeping",
                )
            self._file.seek(self._kept * self._size)
            self._file.write(frame.tobytes())
            self._kept += 1
        return True

    def span(self, start: int, size: int) -> NDArray[np.uint8]:
        """Return at most `size` frames from `start`, without those held back."""
        stop = start + size if self.until is None else min(start + size, self.until)
        if self._source.count is not None:
            stop = min(stop, self._source.count)
        if stop <= start or not self.has(start):
            return np.empty((0, self.rows, self.cols), np.uint8)
        if self._file is None:
            return self._source.span(start, stop - start)
        self.has(stop - 1)
        stop = min(stop, self._kept)
        self._file.seek(start * self._size)
        data = self._file.read((stop - start) * self._size)
        return np.frombuffer(data, np.uint8).reshape(-1, self.rows, self.cols)

    def pictures(self) -> Generator[tuple[str, Frame], None, None]:
        """Yield each frame with its name."""
        index = 0
        while self.has(index):
            yield f"{self.name}, frame {index}", self.span(index, 1)[0]
            index += 1
