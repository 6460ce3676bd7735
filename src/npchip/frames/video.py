"""Frames from video files, by PyAV (the optional extra `video`)."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from npchip.base.errors import InputError
from npchip.frames.fit import Fit
from npchip.frames.source import (
    MAX_PIXELS,
    Frame,
    FrameSource,
    damaged,
    decoding,
    open_binary,
    resemblance,
    too_large,
)

SUFFIXES = (".mp4", ".m4v", ".mov", ".avi", ".mkv", ".webm", ".mpg", ".mpeg")
_CONTAINERS = "mov,mp4,m4a,3gp,3g2,mj2,avi,matroska,webm,mpeg,mpegvideo"
"""Allowed demuxers of FFmpeg; none of them reads a list of other files or addresses."""


class VideoFrames(FrameSource):
    """All frames of the first video stream of a file.

    Frames are the luma of the stream (ITU-R 601 or 709), stretched to 0..255, and rotated by
    multiples of 90 degrees as the metadata says. `count` is None, as the count in a video's header
    is often wrong.
    """

    def __init__(self, path: Path, rows: int, cols: int, fit: Fit | None) -> None:
        super().__init__(str(path), rows, cols, fit)
        self._path = path
        self._av = _pyav(self.name)
        self.check_first()

    def pictures(self) -> Generator[tuple[str, Frame], None, None]:
        """Yield each frame with its name, in the order of presentation."""
        with open_binary(self._path) as file:
            with decoding(self.name, resemblance(file, self.name)):
                container = self._open(file)
            with container:
                yield from self._decode(container)

    def _open(self, file: Any) -> Any:
        return self._av.open(
            file,
            mode="r",
            container_options={"format_whitelist": _CONTAINERS},
            io_open=_refuse,
        )

    def _decode(self, container: Any) -> Generator[tuple[str, Frame], None, None]:
        if not container.streams.video:
            raise InputError("NP227", f"{self.name}: holds no video, only other streams")
        with decoding(self.name):
            stream = container.streams.video[0]
            if stream.width * stream.height > MAX_PIXELS:
                raise too_large(self.name, (stream.height, stream.width))
            # Not passed to `open`: there, stream options crash PyAV 15 if streams appear late.
            stream.codec_context.options = {"max_pixels": str(MAX_PIXELS)}
            packets = container.demux(stream)
        index = 0
        while True:
            with decoding(f"{self.name}, frame {index}"):
                packet = next(packets, None)
                decoded = list(packet.decode()) if packet is not None else []
            if packet is None:
                return
            for frame in decoded:
                name = f"{self.name}, frame {index}"
                with decoding(name):
                    picture = _luma(frame, name)
                yield name, picture
                index += 1
            if packet.is_corrupt:
                raise damaged(f"{self.name}, frame {index}", "the file seems cut short here")


def _luma(frame: Any, name: str) -> Frame:
    if frame.is_corrupt:
        raise damaged(name, "the decoder could not restore it")
    if frame.width * frame.height > MAX_PIXELS:
        raise too_large(name, (frame.height, frame.width))
    luma: Frame = frame.to_ndarray(format="gray")
    turns, rest = divmod(int(getattr(frame, "rotation", 0)), 90)
    return luma if rest else np.rot90(luma, turns)


def _refuse(url: str, _flags: int, _options: dict[str, str]) -> NoReturn:
    """Raise PermissionError for another file that the video names."""
    raise PermissionError(f"a video may not name other files: {url}")


def _pyav(name: str) -> Any:
    try:
        import av  # noqa: PLC0415 - optional, and 100 MB of libraries to load
    except ImportError:
        raise InputError(
            "NP226",
            f"{name}: reading video needs PyAV, which is not installed",
            hint="pip install 'npchip[video]'",
        ) from None
    return av
