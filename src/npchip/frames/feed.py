"""Feeds of frames for engines, with frames numbered since reset."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from os import PathLike
from typing import Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames.arrays import frames_from_array, frames_from_iterable
from npchip.frames.source import FrameSource
from npchip.machine import Machine
from npchip.machine.layout import to_planes

Frames = FrameSource | NDArray[Any] | Iterable[NDArray[Any]]
"""Frames for `Chip.run`: a frame source, an array (T, rows, columns), or an iterable of frames."""


def frame_source(frames: Frames, machine: Machine) -> FrameSource:
    """Return frames as a frame source for a machine.

    Raises:
        InputError: NP106 a source of another size, NP216 a file's name, or as `frames_from_array`.
    """
    rows, cols = machine.rows, machine.cols
    if isinstance(frames, str | PathLike):
        raise InputError(
            "NP216",
            f"frames: expected arrays, found the name {str(frames)!r}",
            hint=f"npchip.frames.open_frames({str(frames)!r}, {rows}, {cols}) opens a file",
        )
    if isinstance(frames, FrameSource):
        if (frames.rows, frames.cols) != (rows, cols):
            raise InputError(
                "NP106",
                f"{frames.name}: opened as {frames.rows} × {frames.cols} pixels, but machine "
                f"{machine.name} has {rows} × {cols}",
            )
        return frames
    if isinstance(frames, np.ndarray):
        return frames_from_array(frames, rows, cols)
    return frames_from_iterable(cast("Iterable[NDArray[Any]]", frames), rows, cols)


_NONE: Final = 0, np.empty((0, 0, 0), np.uint8)


class SourceFeed:
    """Feeds the frames of a source, numbered since the chip's reset.

    Args:
        source: the frame source; None for no frames.
        start: number of its first frame.
    """

    def __init__(self, source: FrameSource | None, start: int) -> None:
        self._source = source
        self._start = start
        self._stream: Iterator[NDArray[np.uint8]] | None = None
        # The last two batches of the stream, each with the position of its first frame.
        self._held = _NONE, _NONE
        self._failure: Exception | None = None  # raised for the frames after them

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy needs: it reads the stream again from its start.

        Raises:
            InputError: NP106 the frames are an iterator's, of which there is no second one.
        """
        if self._source is not None and self._source.once:
            raise InputError(
                "NP106",
                f"{self._source.name}: frames of an iterator cannot be copied",
                hint="pass an array or a file to copy or send a chip",
            )
        return vars(self) | {"_stream": None, "_held": (_NONE, _NONE), "_failure": None}

    def known(self, index: int) -> int:
        """Return how many frames come from `index` on as far as is known; 0 if it is not."""
        count = self._source.count if self._source is not None else 0
        return max(0, (count or 0) - (index - self._start))

    def planes(self, index: int) -> NDArray[np.uint8] | None:
        """See `Feed.planes`."""
        frames = self.frames(index, 1)
        return to_planes(frames[0]) if len(frames) else None

    def frames(self, index: int, most: int) -> NDArray[np.uint8]:
        """See `Feed.frames`."""
        source, position = self._source, index - self._start
        if source is None or (source.count is not None and position >= source.count):
            return _NONE[1]
        if source.cheap_access:
            return source.span(position, most)
        for first, frames in self._held:
            if 0 <= position - first < len(frames):
                return frames[position - first :][:most]
        return self._read(source, position, most)

    def _read(self, source: FrameSource, position: int, most: int) -> NDArray[np.uint8]:
        """Read frames of the stream from `position` on; restart the stream to go back."""
        first, last = self._held[1]
        reached = first + len(last)  # position of the stream
        if self._stream is not None and position < reached:
            if source.once:
                raise InputError(
                    "NP106",
                    f"{source.name}: frames of an iterator cannot be taken twice",
                    hint="pass an array or a file to go back",
                )
            self._stream = None
        if self._stream is None:
            self._stream, self._failure, reached = iter(source), None, 0
        if self._failure is not None:
            raise self._failure
        for _ in islice(self._stream, position - reached):
            pass
        frames, failure = source.read(self._stream, most)
        if len(frames):
            self._held = self._held[1], (position, frames)
        if isinstance(failure, Exception):
            self._failure = failure
        if failure is not None and not (len(frames) and self._failure):
            raise failure  # an interrupt at once, an error after the frames before it
        return frames
