"""The directories of a TIFF: which pages are frames, and what forbids to read them."""

from __future__ import annotations

import logging
import lzma
import math
from typing import Any, BinaryIO, Literal

from npchip.base.errors import InputError
from npchip.frames.jpeg import jpeg_damage
from npchip.frames.opinion import second_opinion
from npchip.frames.source import damaged, decoding

_PLAIN, _JPEG, _PACKBITS, _LZMA, _FAX = 1, 7, 32773, 34925, (2, 3, 4)
"""Ways to pack pixels."""
_BITS = 258
"""Tag of the bits of each channel."""
_YCBCR = 6
"""Colours of which some are left out."""
_LONGEST = 1 << 26
"""Bytes of a file of fax pages that are looked at."""
_REDUCED_OR_MASK = 1 | 4
_NEEDED = frozenset(
    {*range(254, 260), 262, 266, 273, 274, *range(277, 280), 284, 292, 293, 317}
    | {*range(320, 326), 338, 339, 347, *range(512, 522), *range(529, 533)}
)
"""Tags that say how pixels are stored."""
_UNSIGNED = 1, 4
"""Sample formats: unsigned and undefined."""


def tiff_pages(file: BinaryIO, name: str) -> tuple[list[tuple[int, Any]], InputError | None]:
    """Return the pages of a TIFF that are frames, with numbers, after a check of what they state.

    Pages of reduced resolution and masks are no frames. The second item is the error for the frame
    behind these: NP214 damaged or cut short, NP224 other than up to 8 unsigned bits in a channel.

    Raises:
        InputError: NP214 damaged from its beginning, NP216 several pictures in one directory.
    """
    import tifffile  # noqa: PLC0415 - imports slowly

    logging.getLogger("tifffile").addHandler(logging.NullHandler())  # the checks below tell
    size = file.seek(0, 2)
    file.seek(0)
    tiff: Any = tifffile.TiffFile(file)
    pages = list(tiff.pages)
    wholes: list[Any] = []
    frames: list[tuple[int, Any]] = []
    for number, page in enumerate(pages):
        where = f"{name}, frame {len(frames)}"
        try:
            with decoding(where):
                whole = page.aspage()
                _check_tags(_tags(file, tiff, page), whole, where)
                _check_page(whole, size, where)
        except InputError as error:
            return frames, error
        reduced = int(whole.subfiletype) & _REDUCED_OR_MASK or whole.tags.valueof(255) == 2
        if not reduced and not _is_level(whole, pages[0]):
            frames.append((number, whole))
        wholes.append(whole)
    _check_stack(tiff, pages, name)
    return frames or list(enumerate(wholes)), _chain_damage(file, tiff, pages, name)


def pixel_damage(file: BinaryIO, page: Any) -> str | None:
    """Return what is wrong with the packed pixels of a page where libtiff would only warn."""
    packing = int(page.compression)
    for start, size in zip(page.dataoffsets, page.databytecounts, strict=False):
        file.seek(start)
        if packing == _JPEG:
            reason = jpeg_damage(file.read(size), page.jpegtables or b"")
            if reason is not None:
                return reason
        if packing == _PACKBITS and not page.is_tiled and int(page.planarconfig) == 1:
            most = _row_bytes(page) * int(page.chunks[0])
            if _unpacked_length(file.read(size)) > most:
                return "its data holds more than its pixels"
        if packing == _LZMA and not _is_lzma(file.read(size)):
            return "its packed data is damaged"
    if packing in _FAX:
        file.seek(0)
        return second_opinion("tiff", file.read(_LONGEST), page=str(page.index + 1))
    return None


def _unpacked_length(data: bytes) -> int:
    """Return how many bytes data in PackBits stands for; the last bytes may fill it up."""
    length = at = 0
    while at < len(data):
        code = data[at]
        if code == 128:
            at += 1
            continue
        at += code + 2 if code < 128 else 2
        if at <= len(data):
            length += code + 1 if code < 128 else 257 - code
    return length


def _is_lzma(data: bytes) -> bool:
    """Tell whether checksums hold, which libtiff leaves out."""
    try:
        unpack = lzma.LZMADecompressor(memlimit=1 << 28)
        while not unpack.eof and (data or not unpack.needs_input):
            unpack.decompress(data, 1 << 20)
            data = b""
    except lzma.LZMAError:
        return False
    return unpack.eof


def _chain_damage(file: BinaryIO, tiff: Any, pages: list[Any], name: str) -> InputError | None:
    """Return the error (NP214) unless the last directory says that it is the last."""
    form = tiff.tiff
    if not pages:
        return None
    count = len(_tags(file, tiff, pages[-1]))
    file.seek(pages[-1].offset + form.tagnosize + count * form.tagsize)
    following = file.read(form.offsetsize)
    if len(following) == form.offsetsize and not any(following):
        return None
    return damaged(f"{name}, frame {len(pages)}", "the next directory cannot be read")


def _tags(file: BinaryIO, tiff: Any, page: Any) -> list[int]:
    """Return the tags that a directory lists."""
    order: Literal["big", "little"] = "big" if tiff.byteorder == ">" else "little"
    form = tiff.tiff
    file.seek(page.offset)
    count = int.from_bytes(file.read(form.tagnosize), order)
    entries = file.read(count * form.tagsize)
    return [
        int.from_bytes(entries[at : at + 2], order) for at in range(0, len(entries), form.tagsize)
    ]


def _check_tags(listed: list[int], page: Any, name: str) -> None:
    """Raise InputError (NP214) for a tag that cannot be read, which decoders take as not there."""
    lost = [tag for tag in listed if tag in _NEEDED and tag not in page.tags]
    if lost:
        raise damaged(name, f"its tag {lost[0]} cannot be read")


def _check_page(page: Any, size: int, name: str) -> None:
    bits = page.bitspersample
    deepest = max(bits) if isinstance(bits, tuple) else int(bits)
    form = page.sampleformat
    forms = set(form) if isinstance(form, tuple) else {int(form)}
    if deepest > 8 or not forms <= set(_UNSIGNED):
        found = "more" if deepest > 8 else "signed numbers or floats"
        if 3 in forms:
            found = "pixels of type F"
        raise InputError(
            "NP224",
            f"{name}: expected 8 bits per channel, found {found}",
            hint="scale its values to 0-255 and save it with 8 bits, or as a uint8 .npy",
        )
    ends = (at + count for at, count in zip(page.dataoffsets, page.databytecounts, strict=False))
    if max(ends, default=0) > size or not all(page.databytecounts):
        raise damaged(name, "its pixels lie behind the end of the file")
    if min(len(page.dataoffsets), len(page.databytecounts)) < math.prod(page.chunked):
        raise damaged(name, "parts of its pixels are missing")
    needed, stored = page.imagelength * _row_bytes(page), sum(page.databytecounts)
    plain = int(page.compression) == _PLAIN and int(page.photometric) != _YCBCR
    twice = stored > 2 * needed and _BITS not in page.tags  # one bit a pixel, as it is not stated
    if plain and not page.is_tiled and (stored < needed or twice):
        raise damaged(name, f"its pixels take {needed} bytes, it has {stored}")


def _row_bytes(page: Any) -> int:
    bits = page.bitspersample
    deepest = max(bits) if isinstance(bits, tuple) else int(bits)
    return int((page.imagewidth * page.samplesperpixel * deepest + 7) // 8)


def _is_level(page: Any, first: Any) -> bool:
    """Tell a page that is the first, halved: a level of a pyramid that does not say so."""
    return any(
        abs((first.imagelength >> k) - page.imagelength) <= 1
        and abs((first.imagewidth >> k) - page.imagewidth) <= 1
        for k in range(1, 12)
        if min(first.imagelength, first.imagewidth) >> k > 4
    )


def _check_stack(tiff: Any, pages: list[Any], name: str) -> None:
    """Raise InputError (NP216) for several pictures in one directory."""
    stated = 1
    if tiff.is_imagej and tiff.imagej_metadata:
        stated = int(tiff.imagej_metadata.get("images", 1))
    if tiff.is_stk and tiff.stk_metadata:
        stated = int(tiff.stk_metadata.get("NumberPlanes", 1))
    deep = any(int(page.aspage().imagedepth) > 1 for page in pages)
    if deep or len(pages) < stated:
        raise InputError(
            "NP216",
            f"{name}: expected a directory for each picture, found {len(pages)} for {stated}",
            hint="save it as an array: np.save('clip.npy', tifffile.imread(path))",
        )
