"""The directories of a TIFF: which pages are frames, and what forbids to read them."""

from __future__ import annotations

import logging
from typing import Any, BinaryIO

from npchip.base.errors import InputError
from npchip.frames.source import damaged

_REDUCED_OR_MASK = 1 | 4
_UNSIGNED = 1, 4
"""Sample formats: unsigned and undefined."""


def tiff_pages(file: BinaryIO, name: str) -> list[int]:
    """Return the numbers of the pages of a TIFF that are frames, and check what all pages state.

    Pages of reduced resolution and masks are no frames.

    Raises:
        InputError: NP214 damaged or cut short, NP216 several pictures in one directory, NP224
            other than up to 8 unsigned bits in a channel.
    """
    import tifffile  # noqa: PLC0415 - imports slowly

    logging.getLogger("tifffile").addHandler(logging.NullHandler())  # the checks below tell
    size = file.seek(0, 2)
    file.seek(0)
    tiff: Any = tifffile.TiffFile(file)
    pages = list(tiff.pages)
    _check_chain(file, tiff, pages, name)
    frames: list[int] = []
    for number, page in enumerate(pages):
        whole = page.aspage()
        _check_page(whole, size, f"{name}, frame {len(frames)}")
        reduced = int(whole.subfiletype) & _REDUCED_OR_MASK or whole.tags.valueof(255) == 2
        if not reduced and not _is_level(whole, pages[0]):
            frames.append(number)
    _check_stack(tiff, pages, name)
    return frames or list(range(len(pages)))


def _check_chain(file: BinaryIO, tiff: Any, pages: list[Any], name: str) -> None:
    """Raise InputError (NP214) unless the last directory says that it is the last."""
    form = tiff.tiff
    if not pages:
        return
    file.seek(pages[-1].offset)
    count = int.from_bytes(file.read(form.tagnosize), "big" if tiff.byteorder == ">" else "little")
    file.seek(pages[-1].offset + form.tagnosize + count * form.tagsize)
    following = file.read(form.offsetsize)
    if len(following) < form.offsetsize or any(following):
        raise damaged(f"{name}, frame {len(pages)}", "the next directory cannot be read")


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
