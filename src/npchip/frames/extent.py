"""The length that a video file states for itself, to tell whether it is cut short."""

from __future__ import annotations

from typing import BinaryIO

_BOXES = (
    b"ftyp moov mdat moof free skip wide udta mfra sidx styp uuid meta pnot emsg ssix prft".split()
)
"""What stands outermost in MP4 and MOV; anything else is behind the end."""
_EBML = b"\x1aE\xdf\xa3"
_SEGMENT = b"\x18S\x80g"


def missing_bytes(file: BinaryIO) -> int:
    """Return how many bytes an AVI, MP4, MOV, MKV or WebM file lacks at its end; 0 if unknown."""
    size = file.seek(0, 2)
    end = 0
    while end < size:
        file.seek(end)
        step = _step(file.read(16))
        if step is None:
            return 0
        end += step
    return end - size


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
    return None
