"""Whole files: what the structure of PNG, BMP and WebP says that decoders pass over."""

from __future__ import annotations

import os
import zlib
from typing import BinaryIO

_AT_ONCE = 1 << 16


def png_damage(file: BinaryIO) -> tuple[int, str] | None:
    """Return the number of the frame at which a PNG is damaged, and why; None if it is whole.

    A wrong checksum, a part that is cut short and a missing end are damage. What follows the end
    is left out.
    """
    file.seek(8)
    begun = 0  # frames of an animation
    while True:
        head = file.read(8)
        if len(head) < 8:
            return max(begun - 1, 0), "the PNG has no end; it may be cut short"
        kind, left, total = head[4:], int.from_bytes(head[:4], "big"), zlib.crc32(head[4:])
        begun += kind == b"fcTL"
        while left and (data := file.read(min(left, _AT_ONCE))):
            left, total = left - len(data), zlib.crc32(data, total)
        stated = file.read(4)
        if left or len(stated) < 4:
            return max(begun - 1, 0), f"a part {kind!r} is cut short"
        if int.from_bytes(stated, "big") != total:
            return max(begun - 1, 0), f"the checksum of a part {kind!r} is wrong"
        if kind == b"IEND":
            return None


def bmp_damage(file: BinaryIO, rows: int) -> str | None:
    """Return what is wrong with the length of a BMP of so many rows; None if nothing is."""
    file.seek(0)
    head = file.read(34)
    stated, pixels = (int.from_bytes(head[at : at + 4], "little") for at in (2, 10))
    if pixels < 14 + int.from_bytes(head[14:18], "little"):
        return "its pixels begin within its header"
    end = stated if stated > pixels else 0  # some programs write 0
    if head[14] >= 40:  # since Windows 3
        cols = abs(int.from_bytes(head[18:22], "little", signed=True))
        bits, packed = (int.from_bytes(head[at : at + 2], "little") for at in (28, 30))
        if packed in (0, 3):
            end = max(end, pixels + (cols * bits + 31) // 32 * 4 * rows)
    return _length_damage(file, end) if end else None


def webp_damage(file: BinaryIO) -> str | None:
    """Return what is wrong with the length of a WebP; None if nothing is."""
    file.seek(4)
    return _length_damage(file, 8 + int.from_bytes(file.read(4), "little"))


def _length_damage(file: BinaryIO, end: int) -> str | None:
    size = file.seek(0, os.SEEK_END)
    if size < end:
        return f"it is {end - size} bytes shorter than it says; it may be cut short"
    file.seek(end)
    while data := file.read(_AT_ONCE):
        if data.strip(b"\0"):
            return f"{size - end} bytes follow its end"
    return None
