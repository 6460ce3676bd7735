"""Frames from video files, by PyAV (the optional extra `video`)."""

from __future__ import annotations

import logging
from collections.abc import Container, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames.extent import StatedPart
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
_WITH_ALPHA = {"vp8": "libvpx", "vp9": "libvpx-vp9"}
"""Decoders that read the transparency of a stream, which FFmpeg's own leave out."""
_DETECT = "crccheck+explode"
"""The damage that demuxers and decoders look for, where they end."""


class VideoFrames(FrameSource):
    """All frames of the first video stream of a file.

    Frames are the luma of the stream (ITU-R 601 or 709), stretched to 0..255, turned and mirrored
    as the metadata says. `count` is None, as the count in a video's header
    is often wrong.
    """

    def __init__(self, path: Path, rows: int, cols: int, fit: Fit | None) -> None:
        super().__init__(str(path), rows, cols, fit)
        self._path = path
        self.check_first()

    def pictures(self) -> Generator[tuple[str, Frame], None, None]:
        """Yield each frame with its name, in the order of presentation."""
        av = _pyav(self.name)
        with open_binary(self._path) as file:
            hint = resemblance(file, self.name)
            part = StatedPart(file)
            with decoding(self.name, hint), _errors(av) as errors:
                options = {"format_whitelist": _CONTAINERS, "err_detect": _DETECT}
                container = av.open(part, "r", container_options=options, io_open=_refuse)
            with container:
                unsure = part.missing > 0 and container.format.name == "mpeg"
                index = yield from self._decode(av, container, errors, unsure=unsure)
            if part.missing:
                raise damaged(
                    f"{self.name}, frame {index}",
                    f"the file is cut short: {part.missing} bytes are missing",
                )

    def _decode(
        self, av: Any, container: Any, said: list[tuple[str, str]], *, unsure: bool
    ) -> Generator[tuple[str, Frame], None, int]:
        """Yield the frames of an open file; return their number.

        Args:
            av: PyAV.
            container: the file.
            said: errors that FFmpeg reported when it was opened.
            unsure: the last picture may be a part of one, which nothing else tells.
        """
        with decoding(self.name):
            stream = _moving(container)
            if stream is None:
                raise InputError("NP227", f"{self.name}: holds no video, only other streams")
            if stream.width * stream.height > MAX_PIXELS:
                raise too_large(self.name, (stream.height, stream.width))
            others = _others(container, stream)
            _stop(self.name, [error for error in said if error[0] not in others])
            codec = _codec(av, stream)
            packets = container.demux(stream)
        index, following, time, timed = 0, None, None, False
        while True:
            name = f"{self.name}, frame {index}"
            with decoding(name), _errors(av, others) as errors:
                packet = next(packets, None) if following is None else following
                following = next(packets, None) if unsure and packet is not None else None
            _stop(name, errors)
            if packet is None:
                return index
            # Some files give decoding times only; MPG files behind one another begin anew.
            timed |= packet.pts != packet.dts and container.format.name.startswith("mov")
            with decoding(name), _errors(av, others) as errors:
                decoded = list(codec.decode(packet if packet.size else None))
            if packet.is_corrupt or (following is not None and not following.size):
                errors.append(("", "the file seems cut short here"))
            for frame in decoded:
                name = f"{self.name}, frame {index}"
                if errors and not _before(frame.pts, packet.pts):
                    break
                if timed and _before(frame.pts, time):
                    raise damaged(name, "its time lies before that of the frame before it")
                time = frame.pts
                with decoding(name):
                    picture = _luma(frame, name)
                yield name, picture
                index += 1
            _stop(f"{self.name}, frame {index}", errors)


def _codec(av: Any, stream: Any) -> Any:
    """Return the decoder of a stream, which stops at the damage that it notices."""
    codec = stream.codec_context
    library = _WITH_ALPHA.get(codec.name) if stream.metadata.get("alpha_mode") == "1" else None
    if library is not None:
        codec = av.CodecContext.create(library, "r")
    # Not passed to `open`: there, stream options crash PyAV 15 if streams appear late.
    codec.thread_count = 1  # what another thread logs cannot be told from another file's
    codec.options = {"max_pixels": str(MAX_PIXELS), "err_detect": _DETECT}
    return codec


@contextmanager
def _errors(av: Any, others: Container[str] = ()) -> Iterator[list[tuple[str, str]]]:
    """Collect the errors that FFmpeg logs meanwhile, as some damage is told in the log only.

    Args:
        av: PyAV.
        others: names of decoders to leave out.

    Yields:
        a list, filled at the end: the name of who logs it, and the text.
    """
    errors: list[tuple[str, str]] = []
    with av.logging.Capture() as said:
        yield errors
    for level, who, text in said:
        if level <= av.logging.ERROR and who not in others:
            errors.append((who, text.strip()))


def _stop(name: str, errors: list[tuple[str, str]]) -> None:
    """Raise InputError (NP214) if there is an error."""
    if errors:
        raise damaged(name, errors[0][1])


def _others(container: Any, stream: Any) -> set[str]:
    """Return the decoders' names of a file's other streams, whose damage does not matter."""
    names = {other.name for other in container.streams if other.codec_context is not None}
    return names - {stream.name}


def _moving(container: Any) -> Any:
    """Return the first video stream that is no cover picture; None if there is none."""
    from av.stream import Disposition  # noqa: PLC0415 - as in `_pyav`

    still = Disposition.attached_pic | Disposition.timed_thumbnails
    for stream in container.streams.video:
        if not stream.disposition & still:
            return stream
    return None


def _before(time: int | None, other: int | None) -> bool:
    """Tell whether a time is known to be before another."""
    return time is not None and other is not None and time < other


def _luma(frame: Any, name: str) -> Frame:
    """Return a decoded frame as luma, upright, with black for what is transparent.

    Raises:
        InputError: NP214 damaged, NP222 too large, NP224 16 bits or floats, NP228 askew.
    """
    if frame.is_corrupt:
        raise damaged(name, "the decoder could not restore it")
    if frame.width * frame.height > MAX_PIXELS:
        raise too_large(name, (frame.height, frame.width))
    layout = frame.format
    # 9 to 14 bits are what a format says; in 16 there may be 10, 12 or 16, which nothing tells.
    if max(component.bits for component in layout.components) > 14:
        raise InputError(
            "NP224",
            f"{name}: expected up to 14 bits per channel, found {layout.name}",
            hint="16 bits do not say how many are used: convert it to 8 bits, -pix_fmt gray",
        )
    luma: Frame = frame.to_ndarray(format="gray")
    if any(component.is_alpha for component in layout.components):
        alpha = frame.to_ndarray(format="rgba")[..., 3].astype(np.uint16)
        luma = ((luma * alpha + 127) // 255).astype(np.uint8)
    matrix = frame.side_data.get("DISPLAYMATRIX")
    return luma if matrix is None else _upright(luma, np.frombuffer(matrix, np.int32), name)


def _upright(luma: Frame, matrix: NDArray[np.int32], name: str) -> Frame:
    """Turn and mirror a picture as the display matrix says: x' = ax + cy, y' = bx + dy.

    Raises:
        InputError: NP228, another angle than a multiple of 90 degrees.
    """
    a, b, c, d = (int(matrix[place]) for place in (0, 1, 3, 4))
    if a and d and not b and not c:
        return luma[:: _sign(d), :: _sign(a)]
    if b and c and not a and not d:
        return luma.T[:: _sign(b), :: _sign(c)]
    raise InputError(
        "NP228",
        f"{name}: expected an orientation in steps of 90 degrees, found another angle",
        hint="let a video editor turn it, and save it without a display matrix",
    )


def _sign(number: int) -> int:
    return 1 if number > 0 else -1


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
    # Some decoders tell of damage only in their log. A message like the last one counts too.
    level = av.logging.get_level()
    if level is None or level < av.logging.ERROR:
        logging.getLogger("libav").addHandler(logging.NullHandler())
        av.logging.set_level(av.logging.ERROR)
    av.logging.set_skip_repeated(False)
    return av
