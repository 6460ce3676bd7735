"""Frames from a list of image files, or from one with several pictures (GIF, TIFF, APNG, WebP)."""

from __future__ import annotations

import re
from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from PIL import Image, ImageOps, UnidentifiedImageError

from npchip.base.errors import InputError
from npchip.frames.fit import Fit
from npchip.frames.gif import gif_pictures
from npchip.frames.jpeg import jpeg_damage
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
from npchip.frames.tiff import pixel_damage, tiff_pages
from npchip.frames.whole import bmp_damage, png_damage, webp_damage

_FORMATS = ("PNG", "JPEG", "BMP", "TIFF", "GIF", "WEBP", "PPM")
"""Allowed decoders of Pillow; none of them runs another program, as EPS does."""

_EIGHT_BIT_MODES = frozenset(
    {"1", "L", "LA", "La", "P", "PA", "RGB", "RGBA", "RGBa", "RGBX", "CMYK", "YCbCr"}
)
_JPEG = "JPEG", "MPO"
"""MPO is a camera's JPEG, followed by a thumbnail or a depth map."""
_LONGEST = 8 * MAX_PIXELS
"""Bytes that are read of a JPEG; a film of any length may follow the picture."""
_HEAD = 1 << 16
"""Bytes read at once; they hold the header of a PGM, with its comments."""
_NO_NUMBER = re.compile(rb"[^0-9\s]")
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
            self.count: int = len(_pictures(file, self.name))
        self.check_first()

    def __len__(self) -> int:
        return self.count

    def pictures(self) -> Generator[tuple[str, Frame], None, None]:
        """Yield each picture of the file with its name."""
        with open_binary(self._path) as file:
            with decoding(self.name):
                pictures = _pictures(file, self.name)
            for index in range(len(pictures)):
                name = f"{self.name}, frame {index}"
                with decoding(name):
                    luma = pictures.take(index)
                yield name, luma


def _only_picture(path: Path) -> Frame:
    name = str(path)
    with open_binary(path) as file, decoding(name):
        pictures = _pictures(file, name)
        if pictures.whole > 1:
            raise InputError(
                "NP223",
                f"{name}: expected one picture in each image of a list, found {pictures.whole}",
                hint="name an animation by itself to take all of its pictures",
            )
        if pictures.damage is not None:
            raise pictures.damage
        return pictures.take(0)


@dataclass
class _Pictures:
    """The pictures of a file up to its damage.

    Attributes:
        whole: number of pictures before the damage.
        lumas: these, decoded one by one.
        damage: the error for the picture after them; None if there is no damage.
    """

    whole: int
    lumas: Iterator[Frame]
    damage: InputError | None = None

    def __len__(self) -> int:
        return self.whole + (self.damage is not None)

    def take(self, index: int) -> Frame:
        """Return the next picture, whose number the caller knows.

        Raises:
            InputError: the damage, if that is next.
        """
        if index == self.whole and self.damage is not None:
            raise self.damage
        return next(self.lumas)


def _pictures(file: BinaryIO, name: str) -> _Pictures:
    """Return the pictures in a file.

    Raises:
        InputError: NP214 damaged from its beginning or not an image, NP222 too large.
    """
    if _is_tiff(file):
        found, damage = tiff_pages(file, name)
        if damage is not None and not found:
            raise damage  # Pillow's own error would not tell as much
        file.seek(0)
        image = _open(file, name)
        return _Pictures(len(found), _tiff_lumas(image, file, found, name), damage)
    image = _open(file, name)
    if image.format == "GIF":
        return _Pictures(*gif_pictures(file, name))
    if image.format == "PPM":
        parts, damage = _portable_parts(file, name)
        lumas = (_luma(_open(_cut(file, *part), name), name) for part in parts)
        return _Pictures(len(parts), lumas, damage)
    if image.format in _JPEG:
        return _Pictures(1, (_photo(image, file, name) for _ in range(1)))
    pages = range(getattr(image, "default_image", False), _pages(image))
    place, reason = _damage(image, file) or (len(pages), None)
    if reason is None:
        return _Pictures(len(pages), (_page(image, index, name) for index in pages))
    where = f"{name}, frame {place}" if len(pages) > 1 else name
    return _Pictures(
        place, (_page(image, index, name) for index in pages[:place]), damaged(where, reason)
    )


def _damage(image: Image.Image, file: BinaryIO) -> tuple[int, str] | None:
    """Return the number of the first damaged picture, and the reason; None if nothing is known."""
    back = file.tell()
    reason = None
    if image.format == "PNG":
        found = png_damage(file)
        file.seek(back)
        return found
    if image.format == "BMP":
        reason = bmp_damage(file, image.height)
    if image.format == "WEBP":
        reason = webp_damage(file)
    file.seek(back)
    return None if reason is None else (0, reason)


def _tiff_lumas(
    image: Image.Image, file: BinaryIO, pages: list[tuple[int, Any]], name: str
) -> Iterator[Frame]:
    for place, (index, page) in enumerate(pages):
        image.seek(index)
        _check_size(image, name)
        reason = pixel_damage(file, page)
        if reason is not None:
            raise damaged(f"{name}, frame {place}", reason)
        yield _luma(image, name)


def _photo(image: Image.Image, file: BinaryIO, name: str) -> Frame:
    _check_size(image, name)
    back = file.tell()
    file.seek(0)
    reason = jpeg_damage(file.read(_LONGEST))
    if reason is not None:
        raise damaged(name, reason)
    file.seek(back)
    return _page(image, 0, name)


def _is_tiff(file: BinaryIO) -> bool:
    """Tell a TIFF, classic or big, by its first bytes."""
    start = file.read(4)
    file.seek(0)
    return start in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")


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


def _portable_parts(file: BinaryIO, name: str) -> tuple[list[tuple[int, int]], InputError | None]:
    """Return where the pictures of a PGM, PPM or PBM begin and end; text holds only one.

    The second item is the error for what stands behind them and is no picture.
    """
    size = file.seek(0, 2)
    parts: list[tuple[int, int]] = []
    image: Any
    start = 0
    while start < size:
        head = _cut(file, start, min(size, start + _HEAD))
        if parts and not head.getvalue().strip():
            break  # blanks at the end
        try:
            image = _open(head, f"{name}, frame {len(parts)}")
            _check_size(image, f"{name}, frame {len(parts)}")
        except InputError as error:
            return parts, error
        kind = head.getvalue()[:2]
        if kind not in (b"P4", b"P5", b"P6"):
            wrong = _text_error(file, start, size, image, name)
            return ([*parts, (start, size)], None) if wrong is None else (parts, wrong)
        deep = 2 if _stored_deep(image) or image.mode == "I" else 1
        width = -(-image.width // 8) if kind == b"P4" else image.width * len(image.getbands())
        end = start + image.tile[0][2] + width * image.height * deep
        parts.append((start, min(end, size)))
        start = end
    return parts, None


def _text_error(
    file: BinaryIO, start: int, end: int, image: Image.Image, name: str
) -> InputError | None:
    """Return the error for a picture in text, if other things than numbers follow its header."""
    most = 16 * image.width * image.height * len(image.getbands()) + _HEAD
    if end - start > most:
        return damaged(name, "it holds more text than its pixels need")
    text = re.sub(rb"#[^\r\n]*", b"", _cut(file, start + 2, end).getvalue())
    return (
        damaged(name, "other things stand among its numbers") if _NO_NUMBER.search(text) else None
    )


def _cut(file: BinaryIO, start: int, end: int) -> BytesIO:
    file.seek(start)
    return BytesIO(file.read(end - start))


def _pages(image: Image.Image) -> int:
    return int(getattr(image, "n_frames", 1))


def _luma(image: Image.Image, name: str) -> Frame:
    """Return the current picture of an image as luma (ITU-R 601): uint8, shape (rows, columns).

    Transparent parts are black (decision). The picture is rotated by its EXIF orientation, as
    viewers do (decision).

    Raises:
        InputError: NP222 too large, NP224 more than 8 bits per channel.
    """
    _check_size(image, name)
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


def _check_size(image: Image.Image, name: str) -> None:
    """Raise InputError (NP222) for too many pixels."""
    if image.width * image.height > MAX_PIXELS:
        raise too_large(name, (image.height, image.width))


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
