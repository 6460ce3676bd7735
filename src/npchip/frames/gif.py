"""Pictures of a GIF, each composed of what the file stores: Pillow only unpacks the pixels."""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np
from PIL import Image

from npchip.base.errors import InputError
from npchip.frames.source import MAX_PIXELS, Frame, damaged, too_large

_CONTROL = 0xF9
_TO_BACKGROUND, _TO_PREVIOUS = 2, 3
"""Ways to dispose of a part once it was shown."""


@dataclass(frozen=True)
class _Part:
    """A part of the screen that the file stores.

    Attributes:
        left, top, width, height: its place, in pixels.
        head: its descriptor as the file has it.
        palette: red, green and blue of each colour.
        hole: colour that is transparent; None if there is none.
        disposal: what becomes of it before the next part.
        start: place of its packed pixels in the file.
        end: place behind them.
    """

    left: int
    top: int
    width: int
    height: int
    head: bytes
    palette: bytes
    hole: int | None
    disposal: int
    start: int
    end: int


def gif_pictures(file: BinaryIO, name: str) -> tuple[int, Iterator[Frame], InputError | None]:
    """Read the structure of a GIF; return the number of its pictures, and them as luma.

    Transparent parts are black, so is an area that was disposed of. Bytes behind the end are left
    out. The last item is the error for the picture behind these, if the file is damaged there.

    Raises:
        InputError: NP222 too large.
    """
    size, parts, damage = _parts(file, name)
    if parts:  # as viewers do where the screen is smaller than the first part
        first = parts[0]
        size = max(size[0], first.top + first.height), max(size[1], first.left + first.width)
    if size[0] * size[1] > MAX_PIXELS:
        raise too_large(name, size)
    return len(parts), _compose(file, size, parts), damage


def _compose(file: BinaryIO, size: tuple[int, int], parts: list[_Part]) -> Iterator[Frame]:
    screen = np.zeros(size, np.uint8)
    for part in parts:
        before = screen.copy() if part.disposal == _TO_PREVIOUS else screen
        area = screen[part.top : part.top + part.height, part.left : part.left + part.width]
        pixels = _unpack(file, part)[: area.shape[0], : area.shape[1]]
        shown = _lumas(part.palette)[pixels]
        np.copyto(area, shown, where=True if part.hole is None else pixels != part.hole)
        yield screen.copy()
        if part.disposal == _TO_BACKGROUND:
            area[:] = 0
        screen = before


def _unpack(file: BinaryIO, part: _Part) -> Frame:
    """Return the colour numbers of a part, by Pillow from a file that holds nothing else."""
    file.seek(part.start)
    size = part.width.to_bytes(2, "little") + part.height.to_bytes(2, "little")
    # All colours black: Pillow then keeps the numbers as they are.
    alone = b"GIF89a" + size + b"\xf7\0\0" + bytes(range(256)) * 3 + b"," + bytes(4) + size
    alone += bytes([part.head[8] & 0x40]) + file.read(part.end - part.start) + b";"
    with Image.open(io.BytesIO(alone), formats=["GIF"]) as image:
        return np.asarray(image)


def _lumas(palette: bytes) -> Frame:
    colours = Image.frombytes("RGB", (256, 1), palette.ljust(768, b"\0"))
    return np.asarray(colours.convert("L")).ravel()


def _parts(file: BinaryIO, name: str) -> tuple[tuple[int, int], list[_Part], InputError | None]:
    """Return the screen's size and the parts of a GIF up to its damage, and that."""
    file.seek(0)
    parts: list[_Part] = []
    size = 0, 0
    try:
        start = _take(file, 13)
        common = _colours(file, start[10])
        size = int.from_bytes(start[8:10], "little"), int.from_bytes(start[6:8], "little")
        while (part := _next_part(file, common)) is not None:
            parts.append(part)
    except _DamageError as error:
        return size, parts, damaged(f"{name}, frame {len(parts)}", str(error))
    return size, parts, None


class _DamageError(Exception):
    """A GIF is damaged; the text says how."""


def _next_part(file: BinaryIO, common: bytes) -> _Part | None:
    """Read the next part of a GIF with what applies to it; None at the end."""
    hole, disposal = None, 0
    while (kind := _take(file, 1)) != b";":
        if kind == b"!":
            label, data = _take(file, 1)[0], _blocks(file)
            if label == _CONTROL and len(data) >= 4:
                hole, disposal = data[3] if data[0] & 1 else None, data[0] >> 2 & 7
        elif kind == b",":
            head = _take(file, 9)
            palette = _colours(file, head[8]) or common
            left, top, width, height = struct.unpack("<4H", head[:8])
            begin = file.tell()
            _take(file, 1)
            _blocks(file)
            if not palette or not width * height:
                missing = "colours" if not palette else "pixels"
                raise _DamageError(f"a part of the GIF has no {missing}")
            box = left, top, width, height
            return _Part(*box, head, palette, hole, disposal, begin, file.tell())
        else:
            raise _DamageError(f"no part of a GIF begins with {kind!r}")
    return None


def _take(file: BinaryIO, count: int) -> bytes:
    taken = file.read(count)
    if len(taken) < count:
        raise _DamageError("the GIF does not end where it should; it may be cut short")
    return taken


def _colours(file: BinaryIO, flags: int) -> bytes:
    return _take(file, 3 << (flags & 7) + 1) if flags & 0x80 else b""


def _blocks(file: BinaryIO) -> bytes:
    """Pass over data in blocks; return the first."""
    first = data = _take(file, _take(file, 1)[0])
    while data:
        data = _take(file, _take(file, 1)[0])
    return first
