"""The length that a video file states for itself, to tell whether it is cut short."""

from __future__ import annotations

from typing import BinaryIO

_BOXES = (
    b"ftyp moov mdat moof free skip wide udta mfra sidx styp uuid meta pnot emsg ssix prft".split()
)
"""Outermost boxes of MP4 and MOV; anything else is behind the end."""
_EBML = b"\x1aE\xdf\xa3"
_SEGMENT = b"\x18S\x80g"
_PACK = b"\0\0\1\xba"
_TAIL = 1 << 17
"""Bytes at the end of an MPG to be looked at: two of its longest parts."""


class StatedPart:
    """The content that a video file declares, to be read in its place.

    A decoder would go on behind the end of a Matroska file, into whatever follows.

    Attributes:
        missing: bytes that the file lacks at its end; 0 if unknown.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._end, self.missing = _extent(file)
        file.seek(0)

    def read(self, size: int = -1) -> bytes:
        """Read up to `size` bytes; all that is left if below 0."""
        left = max(self._end - self._file.tell(), 0)
        return self._file.read(left if size < 0 else min(size, left))

    def seek(self, offset: int, whence: int = 0) -> int:
        """Go to a place, as in a file."""
        if whence == 2:
            return self._file.seek(self._end + offset)
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """Return the place in the file."""
        return self._file.tell()


def _extent(file: BinaryIO) -> tuple[int, int]:
    """Return where a file ends as it says itself, and how many bytes are missing."""
    size = file.seek(0, 2)
    file.seek(0)
    if file.read(4) == _PACK:
        file.seek(max(size - _TAIL, 0))
        return size, _missing_of_part(file.read())
    end, segments = 0, 0
    while end < size:
        file.seek(end)
        start = file.read(16)
        step = _step(start)
        if step is None:
            behind = segments and start[:4] not in (_EBML, _SEGMENT)
            return (end if behind else size), 0
        segments += start[:4] == _SEGMENT
        end += step
    return size, end - size


def _missing_of_part(tail: bytes) -> int:
    """Return how many bytes the last part of an MPG lacks, from what stands at its end."""
    first = tail.find(_PACK)
    while first >= 0:
        end: int = first
        while end < len(tail) and (step := _step(tail[end : end + 16])):
            end += step
        if end >= len(tail):
            return end - len(tail)
        first = tail.find(_PACK, first + 1)
    return 0


def _step(start: bytes) -> int | None:
    """Return the length of an outermost part from its first bytes; None if they do not tell."""
    size, kind = int.from_bytes(start[:4], "big"), start[4:8]
    if start[:4] == b"RIFF":
        little = int.from_bytes(start[4:8], "little")
        return 8 + little if little else None  # 0 if the recorder was stopped
    if start[:4] in (_EBML, _SEGMENT) and len(start) > 4:
        length = 9 - start[4].bit_length()
        value = int.from_bytes(start[4 : 4 + length], "big") & ((1 << 7 * length) - 1)
        unknown = length > 8 or value == (1 << 7 * length) - 1  # as in a live stream
        return None if unknown else 4 + length + value
    if kind in _BOXES:
        if size == 1:
            size = int.from_bytes(start[8:16], "big")
        return size if size >= 8 else None  # 0 reaches to the end
    if start[:4] == _PACK:
        return 14 + (start[13] & 7 if len(start) > 13 else 0) if start[4:5] >= b"\x40" else 12
    if start[:3] == _PACK[:3] and start[3:4] > _PACK[3:]:
        return 6 + int.from_bytes(start[4:6].ljust(2, b"\0"), "big")
    return None
