"""Frames from a list of image files, or from one with several pictures (GIF, TIFF, APNG, WebP)."""

from __future__ import annotations

import re
import zlib
from collections.abc import Generator, Iterator, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from PIL import Image, ImageOps, UnidentifiedImageError

from npchip.base.errors import InputError
from npchip.frames.fit import Fit
from npchip.frames.gif import gif_pictures
from npchip.frames.source import (
    MAX_PIXELS,
    Frame,
    FrameSource,
    IndexedFrames,
    damaged,
    decoding,
    open_binary,
    resemblance,
    too_large,
)
from npchip.frames.tiff import tiff_pages

_FORMATS = ("PNG", "JPEG", "BMP", "TIFF", "GIF", "WEBP", "PPM")
"""Allowed decoders of Pillow; none of them runs another program, as EPS does."""

_EIGHT_BIT_MODES = frozenset(
    {"1", "L", "LA", "La", "P", "PA", "RGB", "RGBA", "RGBa", "RGBX", "CMYK", "YCbCr"}
)
_HEAD = 1 << 16
"""Bytes read at once; they hold the header of a PGM, with its comments."""
_ORIENTATION = 0x0112
"""EXIF tag of the camera's orientation."""


class ImageList(IndexedFrames):
    """One frame per image file."""

    def __init__(
        self, paths: Sequence[Path], name: str, rows: int, cols: int, fit: Fit | None
    ) -> None:
        super().__init__(name, rows, cols, fit)
        self._paths = paths
        self.count = len(paths)
        self.check_first()

    def picture(self, index: int) -> tuple[str, Frame]:
        """See `IndexedFrames.picture`."""
        path = self._paths[index]
        return str(path), _only_picture(path)


class ImagePages(FrameSource):
    """All pictures of one image file; an animation's are composed as viewers show them."""

    def __init__(self, path: Path, rows: int, cols: int, fit: Fit | None) -> None:
        super().__init__(str(path), rows, cols, fit)
        self._path = path
        with open_binary(path) as file, decoding(self.name):
            self.count: int = _pictures(file, self.name)[0]
        self.check_first()

    def __len__(self) -> int:
        return self.count

    def pictures(self) -> Generator[tuple[str, Frame], None, None]:
        """Yield each picture of the file with its name."""
        with open_binary(self._path) as file:
            with decoding(self.name):
                count, pictures = _pictures(file, self.name)
            for index in range(count):
                name = f"{self.name}, frame {index}"
                with decoding(name):
                    luma = next(pictures)
                yield name, luma


def _only_picture(path: Path) -> Frame:
    name = str(path)
    with open_binary(path) as file, decoding(name):
        count, pictures = _pictures(file, name)
        if count > 1:
            raise InputError(
                "NP223",
                f"{name}: expected one picture in each image of a list, found {count}",
                hint="name an animation by itself to take all of its pictures",
            )
        return next(pictures)


def _pictures(file: BinaryIO, name: str) -> tuple[int, Iterator[Frame]]:
    """Return the number of pictures in a file, and their lumas, decoded one by one.

    Raises:
        InputError: NP214 damaged or not an image, NP222 too large.
    """
    tiff = None
    if _is_tiff(file):
        tiff = tiff_pages(file, name)
        file.seek(0)
    image = _open(file, name)
    if tiff is not None:
        return len(tiff), (_page(image, index, name) for index in tiff)
    if image.format == "PNG":
        _check_sums(file, name)
    if image.format == "GIF":
        return gif_pictures(file, name)
    if image.format == "PPM":
        parts = _portable_parts(file, name)
        return len(parts), (_luma(_open(_cut(file, *part), name), name) for part in parts)
    pages: Sequence[int] = range(getattr(image, "default_image", False), _pages(image))
    return len(pages), (_page(image, index, name) for index in pages)


def _is_tiff(file: BinaryIO) -> bool:
    """Tell a TIFF, classic or big, by its first bytes."""
    start = file.read(4)
    file.seek(0)
    return start in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")


def _check_sums(file: BinaryIO, name: str) -> None:
    """Raise InputError (NP214) for a PNG with a wrong checksum, which Pillow passes over in pixels.

    A file that is cut short is left to Pillow.
    """
    back = file.tell()
    file.seek(8)
    while len(head := file.read(8)) == 8 and head[4:] != b"IEND":
        left, total = int.from_bytes(head[:4], "big"), zlib.crc32(head[4:])
        while left and (data := file.read(min(left, _HEAD))):
            left, total = left - len(data), zlib.crc32(data, total)
        stated = file.read(4)
        if len(stated) == 4 and int.from_bytes(stated, "big") != total:
            raise damaged(name, f"the checksum of a part {head[4:]!r} is wrong")
    file.seek(back)


def _page(image: Image.Image, index: int, name: str) -> Frame:
    image.seek(index)
    return _luma(image, name)


def _open(file: BinaryIO, name: str) -> Image.Image:
    """Read and check the header of an image, without decoding the pixels.

    Raises:
        InputError: NP214 damaged or not an image, NP222 too large.
    """
    try:
        image = Image.open(file, formats=_FORMATS)
    except Image.DecompressionBombError as error:
        pixels = re.search(r"[0-9]+", str(error))
        raise too_large(name, int(pixels[0]) if pixels else None) from None
    except UnidentifiedImageError:
        kinds = ", ".join(_FORMATS)
        raise damaged(name, f"not one of {kinds}", resemblance(file, name)) from None
    return image


def _portable_parts(file: BinaryIO, name: str) -> list[tuple[int, int]]:
    """Return where the pictures of a PGM, PPM or PBM begin and end; text holds only one."""
    size = file.seek(0, 2)
    parts: list[tuple[int, int]] = []
    image: Any
    start = 0
    while start < size:
        head = _cut(file, start, min(size, start + _HEAD))
        if parts and not head.getvalue().strip():
            break  # blanks at the end
        image = _open(head, f"{name}, frame {len(parts)}")
        if image.width * image.height > MAX_PIXELS:
            raise too_large(name, (image.height, image.width))
        kind = head.getvalue()[:2]
        if kind not in (b"P4", b"P5", b"P6"):
            return [*parts, (start, size)]
        deep = 2 if _stored_deep(image) or image.mode == "I" else 1
        width = -(-image.width // 8) if kind == b"P4" else image.width * len(image.getbands())
        end = start + image.tile[0][2] + width * image.height * deep
        parts.append((start, min(end, size)))
        start = end
    return parts


def _cut(file: BinaryIO, start: int, end: int) -> BytesIO:
    file.seek(start)
    return BytesIO(file.read(end - start))


def _pages(image: Image.Image) -> int:
    if image.format == "MPO":  # a camera's JPEG, followed by a thumbnail or a depth map
        return 1
    return int(getattr(image, "n_frames", 1))


def _luma(image: Image.Image, name: str) -> Frame:
    """Return the current picture of an image as luma (ITU-R 601): uint8, shape (rows, columns).

    Transparent parts are black (decision). The picture is rotated by its EXIF orientation, as
    viewers do (decision).

    Raises:
        InputError: NP222 too large, NP224 more than 8 bits per channel.
    """
    if image.width * image.height > MAX_PIXELS:
        raise too_large(name, (image.height, image.width))
    _check_depth(image, name)
    image.load()
    upright = image
    if image.getexif().get(_ORIENTATION, 1) != 1:
        upright = ImageOps.exif_transpose(image)
    if upright.has_transparency_data:
        colours = upright.convert("RGBA")
        if image.format == "BMP" and not colours.getchannel("A").getbbox():
            return np.asarray(colours.convert("RGB").convert("L"))  # as viewers: a byte left free
        upright = Image.new("RGB", colours.size)
        upright.paste(colours, mask=colours.getchannel("A"))
    return np.asarray(upright.convert("L"))


def _check_depth(image: Image.Image, name: str) -> None:
    """Raise InputError (NP224) for more than 8 bits per channel."""
    deep = _stored_deep(image)
    if deep or image.mode not in _EIGHT_BIT_MODES:
        found = "more" if deep else f"pixels of type {image.mode}"
        raise InputError(
            "NP224",
            f"{name}: expected 8 bits per channel, found {found}",
            hint="scale its values to 0-255 and save it with 8 bits, or as a uint8 .npy",
        )


def _stored_deep(image: Image.Image) -> bool:
    """Return whether a file has more than 8 bits per channel, which Pillow hides for colours.

    The tiles show it: ``"RGB;16B"`` in PNG and TIFF, the largest value in PPM (``("RGB", 65535)``).
    In a BMP, 16 would be the bits of all channels together.
    """
    layouts = [tile[3] for tile in getattr(image, "tile", [])]
    if image.format in ("PNG", "TIFF"):
        return any(";16" in str(layout) for layout in layouts)
    if image.format == "PPM":
        largest = [layout[-1] for layout in layouts if isinstance(layout, tuple)]
        return any(isinstance(value, int) and value > 255 for value in largest)
    return False
