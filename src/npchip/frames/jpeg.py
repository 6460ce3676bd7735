"""Damage in the data of a JPEG, which Pillow passes over: libjpeg only warns of it."""

from __future__ import annotations

import re

from npchip.frames.opinion import second_opinion

_MARKER = re.compile(rb"\xff+([\x01-\xfe])")
_ALONE = 0x01, 0xD8
"""Markers without a segment, besides restarts and the end."""
_RESTARTS = range(0xD0, 0xD8)
_END, _SCAN, _COMMENT = 0xD9, 0xDA, 0xFE
_FRAMES = range(0xC0, 0xC3)
"""Frames of the usual kinds: baseline, extended and progressive, in Huffman's code."""
_OTHER_FRAMES = (0xC3, *range(0xC5, 0xC8), *range(0xC9, 0xCC), *range(0xCD, 0xD0))
_NOTES = (*range(0xE0, 0xF0), _COMMENT)
"""Segments that describe the picture; no decoder needs them to unpack it."""


def jpeg_damage(data: bytes, tables: bytes = b"") -> str | None:
    """Return what is wrong with a JPEG; None if nothing is known.

    Its markers are followed to its end; what is behind that is left out. Where PyAV is installed,
    FFmpeg decodes the data too.

    Args:
        data: the file, or a strip of a TIFF.
        tables: tables that a TIFF keeps apart, as a JPEG without a picture.
    """
    if not data.startswith(b"\xff\xd8"):
        return "a JPEG does not begin so"
    kept = [b"\xff\xd8", tables[2:-2]]  # without the markers of their beginning and end
    at = begin = 2
    restarts, usual, scans = 0, True, 0
    while True:
        marker = _MARKER.search(data, at)
        if marker is None:
            return "the JPEG has no end; it may be cut short"
        kind, at = marker[1][0], marker.end()
        if kind == _END:
            break
        if kind in _RESTARTS:
            if not scans or kind - _RESTARTS.start != restarts % len(_RESTARTS):
                return "a part of the JPEG is missing: its restart markers are not in order"
            restarts += 1
        elif kind not in _ALONE:
            length = int.from_bytes(data[at : at + 2], "big")
            if length < 2 or at + length > len(data):
                return "a segment of the JPEG reaches behind its end"
            if kind == _SCAN:
                restarts, scans = 0, scans + 1
            usual = usual and kind not in _OTHER_FRAMES
            usual = usual and (kind not in _FRAMES or data[at + 2] == 8)
            at += length
            if kind in _NOTES:
                kept.append(data[begin : marker.start()])
                begin = at
    if not scans:
        return "the JPEG holds no pixels"
    kept.append(data[begin:at])
    return second_opinion("mjpeg", b"".join(kept)) if usual else None
