"""A second opinion on packed pixels, for formats whose own library only warns of damage."""

from __future__ import annotations

from typing import Any

from npchip.frames.source import MAX_PIXELS


def second_opinion(decoder: str, data: bytes, **options: str) -> str | None:
    """Return the error of one of FFmpeg's decoders; None if there is none, or no PyAV."""
    try:
        import av  # noqa: PLC0415 - optional, and 100 MB of libraries to load
    except ImportError:
        return None
    codec: Any = av.CodecContext.create(decoder, "r")
    codec.thread_count = 1
    codec.options = {"err_detect": "crccheck+explode", "max_pixels": str(MAX_PIXELS)} | options
    try:
        codec.decode(av.Packet(data))
    except av.error.InvalidDataError as error:
        log: Any = error.log
        return f"FFmpeg says '{log[2].strip() if log else error.strerror}'"
    except av.error.FFmpegError:  # it has not learnt this kind, or lacks memory
        return None
    return None
