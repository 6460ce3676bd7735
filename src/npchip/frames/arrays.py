"""Frames from NumPy arrays: in memory, in `.npy` files, or from an iterable."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Sized
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames.fit import Fit, check_size
from npchip.frames.npy import read_header, value_range
from npchip.frames.source import (
    Frame,
    FrameSource,
    IndexedFrames,
    damaged,
    decoding,
    no_frames,
    open_binary,
    resemblance,
)

_LOOK = 1 << 16
"""Number of elements used to guess the scale of floats."""


class ArrayFrames(IndexedFrames):
    """Frames of one array, which is not copied.

    Args:
        array: the frames.
        name: its name in messages.
        size: rows and columns of pixels of every frame.
        fit: method for frames of another size; None refuses them.
        file: the file that is mapped as the array, open; its values are then read from it.
    """

    def __init__(
        self,
        array: NDArray[Any],
        name: str,
        size: tuple[int, int],
        fit: Fit | None,
        file: BinaryIO | None = None,
    ) -> None:
        super().__init__(name, *size, fit)
        _check_type(array, name)
        self._array = _as_clip(array, size, fit, name)
        _check_values(array, name, file)
        self.count = len(self._array)

    def picture(self, index: int) -> tuple[str, Frame]:
        """See `IndexedFrames.picture`."""
        return f"{self.name}, frame {index}", _as_bytes(self._array[index])

    def span(self, start: int, size: int) -> NDArray[np.uint8]:
        """See `FrameSource.span`; a view of the array if that holds bytes of the right size."""
        if self._array.shape[1:] != (self.rows, self.cols):
            return super().span(start, size)
        return _as_bytes(self._array[start : start + size])


class IterableFrames(FrameSource):
    """Frames of an iterable of 2-D arrays, which are checked when they are read."""

    def __init__(
        self, frames: Iterable[Any], name: str, rows: int, cols: int, fit: Fit | None
    ) -> None:
        super().__init__(name, rows, cols, fit)
        self._frames = frames
        self.count = len(frames) if isinstance(frames, Sized) else None
        self.once = isinstance(frames, Iterator)

    def pictures(self) -> Generator[tuple[str, Frame], None, None]:
        """Yield each item of the iterable with its name, after a check."""
        for index, item in enumerate(self._frames):
            name = f"frame {index}"
            frame = _as_picture(item, name)
            _check_type(frame, name)
            check_size((frame.shape[0], frame.shape[1]), (self.rows, self.cols), self.fit, name)
            _check_values(frame, name)
            yield name, _as_bytes(frame)


def frames_from_array(
    array: NDArray[Any], rows: int, cols: int, fit: Fit | None = None
) -> FrameSource:
    """Make a frame source of an array, which is checked now and not copied.

    Args:
        array: shape (T, rows, cols) or (rows, cols), T >= 1; uint8, or any other integer type
            with every value in 0..255.
        rows: rows of pixels of the machine.
        cols: columns of pixels of the machine.
        fit: method for frames of another size; None refuses them.

    Raises:
        InputError: NP215 no frames, NP216 not such a shape, NP217/NP218 another size, NP219 not
            an integer type, NP220 values outside 0..255, NP225 unknown `fit`.
    """
    return ArrayFrames(np.asarray(array), "frames", (rows, cols), fit)


def frames_from_iterable(
    frames: Iterable[Any], rows: int, cols: int, fit: Fit | None = None
) -> FrameSource:
    """Make a frame source of an iterable, which may be endless. Frames are checked when read.

    Args:
        frames: yields arrays of shape (rows, cols), with values as for `frames_from_array`.
            An iterator can be read once. Its own exceptions pass through.
        rows: rows of pixels of the machine.
        cols: columns of pixels of the machine.
        fit: method for frames of another size; None refuses them.

    Raises:
        InputError: as `frames_from_array`, but while frames are read.
    """
    return IterableFrames(frames, "frames", rows, cols, fit)


def open_npy(path: Path, rows: int, cols: int, fit: Fit | None) -> FrameSource:
    """Map the frames of a `.npy` file into memory.

    Raises:
        InputError: NP211 unreadable, NP214 damaged or cut short, NP221 Python objects (never
            unpickled), or as `frames_from_array`.
    """
    name = str(path)
    with open_binary(path) as file:
        hint = resemblance(file, name)
        if file.read(1) == b"\x80":  # every pickle since protocol 2
            raise _objects(name)
        file.seek(0)
        with decoding(name, hint):
            array = _map(file, name)
        return ArrayFrames(array, name, (rows, cols), fit, file)


def _map(file: BinaryIO, name: str) -> NDArray[Any]:
    """Check the header of an open `.npy` file against the file's size and map the array."""
    shape, fortran, dtype = read_header(file)
    if dtype.hasobject:
        raise _objects(name)
    offset = file.tell()
    needed = dtype.itemsize
    for length in shape:
        needed *= length
    held = file.seek(0, 2) - offset
    if needed > held:
        raise damaged(name, f"shape {shape} of {dtype} takes {needed} bytes, the file holds {held}")
    if needed < held:
        raise _bytes_behind(file, offset + needed, name)
    if needed == 0:
        return np.empty(shape, dtype)  # nothing to map, and some systems refuse to
    array: NDArray[Any] = np.memmap(
        file, dtype=dtype, mode="r", offset=offset, shape=shape, order="F" if fortran else "C"
    )
    return array


def _bytes_behind(file: BinaryIO, end: int, name: str) -> InputError:
    """Return the error for bytes behind an array: the header is wrong, or another array follows."""
    size = file.seek(0, 2) - end
    file.seek(end)
    if file.read(6) == np.lib.format.MAGIC_PREFIX:
        return InputError(
            "NP216",
            f"{name}: expected one array, found another behind it",
            hint="join them into one file: np.save(path, np.concatenate(arrays))",
        )
    return damaged(name, f"{size} bytes follow the array that its header describes")


def _as_picture(item: Any, name: str) -> NDArray[Any]:
    """Return an item as a 2-D array (`InputError`, NP216)."""
    try:
        frame = np.asarray(item)
        found = f"shape {frame.shape}"
    except ValueError:  # rows of different lengths
        frame, found = np.empty(0), f"a {type(item).__name__} that is no array"
    if frame.ndim != 2:
        raise InputError("NP216", f"{name}: expected shape (rows, columns), found {found}")
    return frame


def _objects(name: str) -> InputError:
    return InputError(
        "NP221",
        f"{name}: holds pickled Python objects, which could run code and are never loaded",
        hint="save a plain array: np.save(path, np.asarray(frames, dtype=np.uint8))",
    )


def _as_bytes(frames: NDArray[Any]) -> NDArray[np.uint8]:
    """Return frames as contiguous uint8, copied only if necessary; their values must fit."""
    return np.asarray(frames, np.uint8, order="C")


def _check_type(array: NDArray[Any], name: str) -> None:
    """Raise InputError for other than integer types (NP219; NP221 for Python objects)."""
    kind = array.dtype.kind
    if kind in "ui":
        return
    if kind == "O":
        raise _objects(name)
    hint = None
    if kind == "b":
        hint = "convert it with frames.astype(np.uint8) * 255"
    elif kind == "f":
        some = array.flat[:_LOOK]
        unit = bool(np.all((some >= 0) & (some <= 1)))
        scaled = "frames * 255" if unit else "frames"
        hint = f"convert it with ({scaled}).round().clip(0, 255).astype(np.uint8)"
    raise InputError(
        "NP219", f"{name}: expected whole numbers (uint8), found {array.dtype}", hint=hint
    )


def _as_clip(
    array: NDArray[Any], size: tuple[int, int], fit: Fit | None, name: str
) -> NDArray[Any]:
    """Check the shape of an array and return it as (T, rows, columns).

    Raises:
        InputError: NP215 to NP218, NP222.
    """
    shape = array.shape
    if array.ndim == 2:
        array = array[None]
    if array.ndim != 3 or (len(shape) == 3 and 0 < shape[-1] <= 4):
        hint = None
        if len(shape) >= 3 and shape[-1] == 1:
            hint = "drop the last axis: frames[..., 0]"
        elif len(shape) == 4 and shape[1] == 1:
            hint = "drop the second axis: frames[:, 0]"
        elif len(shape) == 4 and shape[1] in (3, 4):
            hint = (
                "the second axis looks like colour: convert it to luma with np.tensordot("
                "frames[:, :3], [0.299, 0.587, 0.114], (1, 0)).round().astype(np.uint8)"
            )
        elif len(shape) >= 3 and shape[-1] in (3, 4):
            hint = (
                "the last axis looks like colour: convert it to luma with "
                "(frames[..., :3] @ [0.299, 0.587, 0.114]).round().astype(np.uint8)"
            )
        raise InputError(
            "NP216",
            f"{name}: expected shape (T, rows, columns) or (rows, columns), found {shape}",
            hint=hint,
        )
    if len(array) == 0:
        raise no_frames(name)
    found = (array.shape[1], array.shape[2])
    time_last = len(shape) == 3 and found != size and _looks_like_time_last(shape, size)
    try:
        check_size(found, size, None if time_last else fit, name)
    except InputError as error:
        if time_last:
            error.hint = "the frames seem to lie along the last axis: np.moveaxis(frames, -1, 0)"
        elif found == size[::-1]:
            error.hint = "rows and columns seem exchanged: frames.swapaxes(-1, -2)"
        raise
    return array


def _looks_like_time_last(shape: tuple[int, ...], size: tuple[int, int]) -> bool:
    """Guess that an array is (rows, columns, T): its first two axes are a picture's.

    They are the sensor's size, on its side or not, or pictures of a usual shape, where the last two
    would be slivers.
    """
    rows, cols, times = shape
    if (rows, cols) in (size, size[::-1]):
        return True
    usual = {size, (3, 4), (9, 16), (2, 3), (1, 1)}
    return (
        max(cols, times) > 3 * min(cols, times)
        and any(rows * b == cols * a or rows * a == cols * b for a, b in usual)
        and min(rows, cols) > times
    )


def _check_values(array: NDArray[Any], name: str, file: BinaryIO | None = None) -> None:
    """Raise InputError for values that do not fit 8 bits (NP220).

    The values of a mapped file are read from it, as pages of memory would stay.
    """
    if array.dtype.kind == "u" and array.dtype.itemsize == 1:
        return
    if file is not None and isinstance(array, np.memmap):
        file.seek(array.offset)
        low, high = value_range(file, array.dtype, array.nbytes)
    else:
        low, high = int(array.min()), int(array.max())
    if low < 0 or high > 255:
        bits = high.bit_length()
        hint = f"keep the upper 8 of {bits} bits: (frames >> {bits - 8}).astype(np.uint8)"
        raise InputError(
            "NP220",
            f"{name}: expected values from 0 to 255, found {low} to {high} ({array.dtype})",
            hint=hint if low >= 0 else None,
        )
