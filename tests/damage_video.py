"""Damaged videos, read by npchip and by FFmpeg: ``python -m tests.damage_video --format mp4``.

Where FFmpeg reports an error npchip must not give a frame that differs from the whole file's.
"""

from __future__ import annotations

import random
import resource
import shutil
import subprocess
import tempfile
import time
from collections import Counter
from contextlib import closing
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import av
import click
import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames import open_frames

SIZE = (64, 80)
FRAMES = 14
SECONDS, BYTES = 10, 1 << 30
"""Limits of time and memory for reading a file."""
LOSSLESS = {"level": "3", "slicecrc": "1"}
GROUPS = {"g": "6", "bf": "2"}
STREAMS: dict[str, list[tuple[str, str, dict[str, str]]]] = {
    "mp4": [("libx264", "yuv420p", {}), ("mpeg4", "yuv420p", GROUPS), ("libx265", "yuv420p", {})],
    "mov": [("libx264", "yuv420p", {}), ("mjpeg", "yuvj420p", {}), ("prores", "yuv422p10le", {})],
    "avi": [("mpeg4", "yuv420p", GROUPS), ("mjpeg", "yuvj420p", {}), ("ffv1", "gray", LOSSLESS)],
    "mkv": [("libx264", "yuv420p", {}), ("ffv1", "gray", LOSSLESS), ("mpeg2video", "yuv420p", {})],
    "webm": [("libvpx", "yuv420p", {}), ("libvpx-vp9", "yuv420p", {})],
    "mpg": [("mpeg2video", "yuv420p", GROUPS), ("mpeg1video", "yuv420p", GROUPS)],
}
"""By suffix: codec, layout, options."""


@dataclass
class Found:
    """The outcome of reading a damaged file.

    Attributes:
        given: numbers of npchip's frames.
        wrong: numbers of those that differ from the whole file's.
        code: error at the end, if any; a text of another exception.
        said: its message.
        reported: first error that the independent decoder reported, if any.
        seconds: time that it took.
        size: most memory that the process took so far.
    """

    given: int = 0
    wrong: list[int] = field(default_factory=list)
    code: str = ""
    said: str = ""
    reported: str | None = None
    seconds: float = 0.0
    size: int = 0

    def verdict(self) -> str:
        """Name what happened; what is in capitals must not."""
        if self.code not in ("", "ended") and not self.code.startswith("NP2"):
            return "FAULT"
        if self.seconds > SECONDS or self.size > BYTES:
            return "FAULT"
        if self.wrong and self.code.startswith("NP2"):
            return "refused after a change that nobody noticed"
        if self.wrong:
            return "nobody noticed" if self.reported is None else "WRONG"
        if self.code == "ended":
            return "shorter" if self.reported is None else "SHORTER"
        return "refused" if self.code else "read"


def peak() -> int:
    """Return the most memory that this process has had, in bytes.

    What `getrusage` says begins with the memory of the process that started this one.
    """
    status = Path("/proc/self/status")
    if status.exists():
        lines = dict(line.split(":", 1) for line in status.read_text().splitlines())
        return 1024 * int(lines["VmHWM"].split()[0])
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def clip() -> NDArray[np.uint8]:
    """Noise behind a square that moves."""
    frames = np.random.default_rng(5).integers(60, 160, (FRAMES, *SIZE), np.uint8)
    frames[1:] = frames[:1] // 2 + frames[1:] // 2
    for index, frame in enumerate(frames):
        frame[20:40, 4 * index : 4 * index + 20] = 240
    return frames


def write(path: Path, codec: str, layout: str, options: dict[str, str]) -> None:
    """Write the clip as a video."""
    with av.open(str(path), "w") as container:
        stream: Any = container.add_stream(codec, rate=25, options=options)
        (stream.height, stream.width), stream.pix_fmt = SIZE, layout
        for picture in clip():
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, "gray")))
        container.mux(stream.encode())


def damage(content: bytes, seed: int) -> bytes:
    """Change bytes of a file, cut it or extend it."""
    draw = random.Random(seed)
    changed = bytearray(content)
    kind = seed % 4
    if kind == 0:
        return bytes(changed[: draw.randrange(len(changed))])
    if kind == 1:
        place = draw.randrange(len(changed))
        extra = draw.randbytes(draw.randrange(1, 5000))
        return content + (extra if seed % 8 == 1 else content[place : place + 5000])
    for _ in range(draw.choice((1, 1, 2, 5, 20))):
        place = draw.randrange(draw.choice((200, len(changed))))
        changed[min(place, len(changed) - 1)] = draw.randrange(256)
    return bytes(changed)


def independent(path: Path, ffmpeg: str | None) -> str | None:
    """Return the first error that FFmpeg reports of a file; None if there is none."""
    if ffmpeg is not None:
        command = [ffmpeg, "-v", "error", "-err_detect", "explode", "-i", str(path)]
        try:
            ended = subprocess.run(
                [*command, "-fps_mode", "passthrough", "-f", "null", "-"],
                check=False,
                capture_output=True,
                stdin=subprocess.DEVNULL,
                timeout=60,
            )
        except subprocess.TimeoutExpired:
            return "no answer"
        text = ended.stderr.decode(errors="replace").strip()[:160]
        return text or (f"exit {ended.returncode}" if ended.returncode else None)
    av.logging.set_level(av.logging.ERROR)
    av.logging.set_skip_repeated(False)
    with av.logging.Capture() as said:
        try:
            with av.open(str(path), options={"err_detect": "explode"}) as container:
                stream = container.streams.video[0]
                stream.codec_context.thread_count = 1
                stream.codec_context.options = {"err_detect": "explode"}
                for frame in container.decode(stream):
                    if frame.is_corrupt:
                        return "a corrupt frame"
        except (OSError, ValueError, IndexError) as error:
            return str(error)
    errors = [text for level, _, text in said if level <= av.logging.ERROR]
    return errors[0].strip() if errors else None


def read(path: Path, whole: NDArray[np.uint8]) -> Found:
    """Read a file as npchip does."""
    found, start = Found(), time.monotonic()
    try:
        for frame in open_frames(path, *SIZE):
            if found.given >= len(whole) or not np.array_equal(frame, whole[found.given]):
                found.wrong.append(found.given)
            found.given += 1
        found.code = "ended" if found.given < len(whole) else ""
    except InputError as error:
        found.code, found.said = error.code, error.message
    except BaseException as error:  # noqa: BLE001 - any other is a fault
        found.code = f"{type(error).__name__}: {error}"
    found.seconds = time.monotonic() - start
    found.size = peak()
    return found


def serve(connection: Connection) -> None:
    """Read the files that a connection names, until it is closed."""
    while True:
        connection.send(read(*connection.recv()))


class Reader:
    """A process that reads damaged files, and is replaced where one ends or stops it."""

    def __init__(self) -> None:
        self._start()

    def _start(self) -> None:
        context = get_context("spawn")
        self._connection, other = context.Pipe()
        self._process = context.Process(target=serve, args=(other,), daemon=True)
        self._process.start()
        other.close()

    def read(self, path: Path, whole: NDArray[np.uint8]) -> Found:
        """Return what `read` gives in the process."""
        self._connection.send((path, whole))
        try:
            found = Found(code="too slow")
            if self._connection.poll(2 * SECONDS):
                found = self._connection.recv()
        except (EOFError, OSError):
            found = Found(code="crashed")
        if found.verdict() == "FAULT":
            self.close()
            self._start()
        return found

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.join()


def campaign(
    suffix: str, count: int, seed: int, ffmpeg: str | None, *, show: bool = False
) -> Counter[str]:
    """Damage files of a kind, and count the verdicts."""
    verdicts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder, closing(Reader()) as reader:
        for stream in STREAMS[suffix]:
            path = Path(folder) / f"whole.{suffix}"
            write(path, *stream)
            content = path.read_bytes()
            whole = np.array(list(open_frames(path, *SIZE)))
            for number in range(seed, seed + -(-count // len(STREAMS[suffix]))):
                path = Path(folder) / f"{number}.{suffix}"
                path.write_bytes(damage(content, number))
                found = reader.read(path, whole)
                found.reported = independent(path, ffmpeg)
                verdict = found.verdict()
                verdicts[verdict] += 1
                if show and verdict.isupper():
                    click.echo(f"{stream[0]} {number} {verdict}: {found}")
                path.unlink()
    return verdicts


@click.command()
@click.option("--format", "suffix", type=click.Choice([*STREAMS]), required=True)
@click.option("--count", default=500)
@click.option("--seed", default=0)
@click.option("--ffmpeg", default=shutil.which("ffmpeg"), help="Without one, PyAV's libraries.")
def main(suffix: str, count: int, seed: int, ffmpeg: str | None) -> None:
    """Count what becomes of damaged videos, and show those that are read wrongly."""
    click.echo(f"{suffix}: {dict(campaign(suffix, count, seed, ffmpeg, show=True))}")


if __name__ == "__main__":
    main()
