"""Frames as a chip takes them: from anything that gives frames, counted since reset."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any, Final, cast

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames.arrays import frames_from_array, frames_from_iterable
from npchip.frames.source import FrameSource
from npchip.machine import Machine
from npchip.machine.layout import to_planes

Frames = FrameSource | NDArray[Any] | Iterable[NDArray[Any]]
"""What `Chip.run` takes: a frame source, an array (T, rows, columns), or an iterable of frames."""


def frame_source(frames: Frames, machine: Machine) -> FrameSource:
    """What `Chip.feed` makes of frames.

    Raises:
        InputError: frames of another size or type.
    """
    rows, cols = machine.rows, machine.cols
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
    """Frames of a source, counted on from those that the chip took before.

    Args:
        source: gives the frames.
        start: number of its first frame since reset.
    """

    def __init__(self, source: FrameSource | None, start: int) -> None:
        self._source = source
        self._start = start
        self._stream: Iterator[NDArray[np.uint8]] | None = None
        # The last frames of the stream in two batches, each with the position of its first frame.
        self._held = _NONE, _NONE
        self._failure: Exception | None = None  # comes after them, whenever these are asked for

    def planes(self, index: int) -> NDArray[np.uint8] | None:
        """Frame `index` since reset as planes; None where the input ends."""
        frames = self.frames(index, 1)
        return to_planes(frames[0]) if len(frames) else None

    def frames(self, index: int, most: int) -> NDArray[np.uint8]:
        """Frames from `index` since reset on, as `engines.Feed` says."""
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
        """Read the stream's frames from `position` on."""
        first, last = self._held[1]
        behind = first + len(last)  # position of the stream
        if self._stream is not None and position < behind:
            if source.once:
                raise InputError(
                    "NP106",
                    f"{source.name}: frames of an iterator cannot be taken twice",
                    hint="pass an array or a file to go back",
                )
            self._stream = None
        if self._stream is None:
            self._stream, self._failure, behind = iter(source), None, 0
        if self._failure is not None:
            raise self._failure
        for _ in islice(self._stream, position - behind):
            pass
        frames, failure = source.read(self._stream, most)
        if len(frames):
            self._held = self._held[1], (position, frames)
        if isinstance(failure, Exception):
            self._failure = failure
        if failure is not None and not (len(frames) and self._failure):
            raise failure  # at once, where it is an interrupt: the frames before it are held
        return frames
