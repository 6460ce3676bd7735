"""The base class of frame sources, and helpers that decode untrusted files."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Generator, Iterator
from contextlib import closing, contextmanager
from itertools import islice
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.base.files import open_input
from npchip.frames.fit import Fit, check_fit, fit_frame

Frame = NDArray[np.uint8]
"""uint8, shape (rows, columns); may be a read-only view of a file."""

MAX_PIXELS = 1 << 25
"""Greatest number of pixels of a picture; a frame of 8K video has a few less."""


class FrameSource(ABC):
    """Frames of one size, read on demand in constant memory.

    Iteration yields uint8 arrays of shape (rows, cols), which must not be changed. An error in a
    later frame (`InputError`) is raised when the frame is read.

    Args:
        name: its name in messages, usually the path as the user gave it.
        rows: rows of pixels of every frame.
        cols: columns of pixels of every frame.
        fit: method for frames of another size; None refuses them.

    Attributes:
        count: number of frames; None if unknown before the end.
        cheap_access: True if ``source[k]`` costs no more than reading one frame.
        once: True if the frames can be read only once.
    """

    count: int | None = None
    cheap_access = False
    once = False

    def __init__(self, name: str, rows: int, cols: int, fit: Fit | None = None) -> None:
        check_fit(fit)
        self.name = name
        self.rows = rows
        self.cols = cols
        self.fit: Fit | None = fit

    @abstractmethod
    def pictures(self) -> Generator[tuple[str, Frame], None, None]:
        """Yield each frame's name in messages and its luma, of any size."""

    def __iter__(self) -> Generator[Frame, None, None]:
        with closing(self.pictures()) as pictures:
            for name, picture in pictures:
                yield fit_frame(picture, (self.rows, self.cols), self.fit, name)

    def __getitem__(self, index: int) -> Frame:
        """Return frame `index`, 0-based (IndexError outside); read all frames before it."""
        if index >= 0:
            with closing(iter(self)) as frames:
                for frame in islice(frames, index, None):
                    return frame
        raise IndexError(f"{self.name}: no frame {index}")

    def span(self, start: int, size: int) -> NDArray[np.uint8]:
        """Return frames from `start` on: uint8, contiguous, shape (1 to `size`, rows, cols)."""
        stop = start + size if self.count is None else min(start + size, self.count)
        return np.stack([self[index] for index in range(start, stop)])

    def read(
        self, frames: Iterator[Frame], size: int
    ) -> tuple[NDArray[np.uint8], BaseException | None]:
        """Copy a batch of frames, as an iterator may reuse its memory.

        Args:
            frames: an iterator of this source.
            size: greatest number of frames.

        Returns:
            The frames, uint8, contiguous, shape (up to `size`, rows, cols), and the exception
            that followed them, if any.
        """
        batch = np.empty((size, self.rows, self.cols), np.uint8)
        filled = 0
        try:
            for frame in islice(frames, size):
                batch[filled] = frame
                filled += 1
        except BaseException as error:  # noqa: BLE001 - the caller raises it
            return batch[:filled], error
        return batch[:filled], None

    def check_first(self) -> None:
        """Read the first frame, which finds most mistakes before a run.

        Raises:
            InputError: NP215 no frames, or the error of the first frame.
        """
        try:
            self[0]
        except IndexError:
            raise no_frames(self.name) from None


class IndexedFrames(FrameSource):
    """Frames that can be read in any order."""

    cheap_access = True
    count: int

    @abstractmethod
    def picture(self, index: int) -> tuple[str, Frame]:
        """Return a frame's name in messages and its luma, of any size."""

    def pictures(self) -> Generator[tuple[str, Frame], None, None]:
        """See `FrameSource.pictures`."""
        for index in range(self.count):
            yield self.picture(index)

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, index: int) -> Frame:
        """Return frame `index`, 0-based (IndexError outside)."""
        if not 0 <= index < self.count:
            raise IndexError(f"{self.name}: no frame {index}")
        name, picture = self.picture(index)
        return fit_frame(picture, (self.rows, self.cols), self.fit, name)


def no_frames(name: str) -> InputError:
    """Return the error for a source without frames (NP215)."""
    return InputError("NP215", f"{name}: holds no frames", hint="one frame is the least")


def too_large(name: str, size: tuple[int, int] | int | None) -> InputError:
    """Return the error for a picture of more than `MAX_PIXELS` pixels (NP222).

    Args:
        name: the picture's name in messages.
        size: (rows, columns), or a number of pixels, if known.
    """
    if isinstance(size, tuple):
        rest = f" of {size[0]} x {size[1]} (rows x columns)"
    else:
        rest = "" if size is None else f" of {size} pixels"
    return InputError(
        "NP222",
        f"{name}: a picture{rest} is too large: at most {MAX_PIXELS} pixels",
        hint="scale it down first",
    )


@contextmanager
def decoding(name: str, hint: str | None = None) -> Iterator[None]:
    """Turn any exception of a decoder into `InputError`, and drop its warnings.

    A generator must not yield inside this block, as the warning filter is global.

    Raises:
        InputError: NP214, the decoder failed.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except InputError:
        raise
    except Exception as error:  # noqa: BLE001 - decoders of hostile bytes raise anything
        said = str(getattr(error, "strerror", None) or error) or type(error).__name__
        raise damaged(name, said.splitlines()[0][:200], hint) from None


def damaged(name: str, reason: str, hint: str | None = None) -> InputError:
    """Return the error for a file that is damaged, cut short or misnamed (NP214)."""
    return InputError("NP214", f"{name}: damaged, or not what its name says: {reason}", hint=hint)


def open_binary(path: Path) -> BinaryIO:
    """Open a file for reading (`InputError`, NP211, if the system refuses)."""
    try:
        return open_input(path)
    except OSError as error:
        raise InputError("NP211", f"{path}: cannot be read: {error.strerror or error}") from None


_SIGNATURES: tuple[tuple[int, bytes, str, tuple[str, ...]], ...] = (
    (0, b"\x93NUMPY", "an .npy array", (".npy",)),
    (0, b"PK\x03\x04", "a zip or .npz archive", ()),
    (0, b"\x89PNG", "a PNG image", (".png",)),
    (0, b"\xff\xd8\xff", "a JPEG image", (".jpg", ".jpeg")),
    (0, b"GIF8", "a GIF image", (".gif",)),
    (0, b"BM", "a BMP image", (".bmp",)),
    (0, b"II*\0", "a TIFF image", (".tif", ".tiff")),
    (0, b"MM\0*", "a TIFF image", (".tif", ".tiff")),
    (8, b"WEBP", "a WebP image", (".webp",)),
    (8, b"AVI ", "an AVI video", (".avi",)),
    (0, b"\x1aE\xdf\xa3", "a Matroska or WebM video", (".mkv", ".webm")),
    (4, b"ftyp", "an MP4 or MOV video", (".mp4", ".m4v", ".mov")),
)
"""Kinds of files: offset and bytes of the signature, name, suffixes."""


def resemblance(file: BinaryIO, path: str) -> str | None:
    """Return a hint if the first bytes of a file contradict its name; rewind the file."""
    file.seek(0)
    start = file.read(16)
    file.seek(0)
    for place, signature, kind, suffixes in _SIGNATURES:
        if start[place:].startswith(signature) and not path.lower().endswith(suffixes):
            return f"its content looks like {kind}"
    return None
