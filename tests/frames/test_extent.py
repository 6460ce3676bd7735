"""The length that a video file states for itself: known, unknown, or cut short."""

from __future__ import annotations

import io

import pytest

from npchip.frames.extent import StatedPart

EBML = b"\x1aE\xdf\xa3\x84abcd"
SEGMENT = b"\x18S\x80g"
FTYP = b"\0\0\0\x10ftyp" + bytes(8)

STATED = {
    "AVI": (b"RIFF\x0c\0\0\0AVI " + bytes(8), 8),
    "AVI of a recorder that was stopped": (b"RIFF\0\0\0\0AVI " + bytes(8), 0),
    "Matroska": (EBML + SEGMENT + b"\x88" + bytes(8), 8),
    "Matroska, length in two bytes": (EBML + SEGMENT + b"\x40\x08" + bytes(8), 8),
    "Matroska of a live stream": (EBML + SEGMENT + b"\x01" + b"\xff" * 7 + bytes(8), 0),
    "Matroska of a live stream, one byte": (EBML + SEGMENT + b"\xff" + bytes(8), 0),
    "MP4": (FTYP + b"\0\0\0\x10mdat" + bytes(8), 8),
    "MP4, long length": (FTYP + b"\0\0\0\x01mdat" + bytes(7) + b"\x18" + bytes(8), 8),
    "MP4 to the end": (FTYP + b"\0\0\0\0mdat" + bytes(8), 0),
    "another format": (b"\0\0\1\xba" + bytes(20), 0),
}
"""A file of each kind, and how many of its last bytes can be seen to be missing."""


@pytest.mark.parametrize("kind", STATED)
def test_bytes_that_are_missing_at_the_end(kind: str) -> None:
    whole, seen = STATED[kind]
    assert StatedPart(io.BytesIO(whole)).missing == 0
    assert StatedPart(io.BytesIO(whole[:-3])).missing == min(3, seen)
