"""Frame sources for tests: files that are right, and what is said of wrong ones."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.frames import Fit, frames_from_array, open_frames

Clip = NDArray[np.uint8]
CLIPS = Path(__file__).parents[2] / "examples" / "clips"
SIZE = (64, 80)


def noise(*shape: int) -> Clip:
    return np.random.default_rng(len(shape)).integers(0, 256, shape, np.uint8)


def load(source: str | Path, fit: Fit | None = None) -> Clip:
    return np.array(list(open_frames(source, *SIZE, fit)))


def refused(source: Any, code: str, *parts: str, fit: Fit | None = None) -> InputError:
    """The error for a source, which is read to its end if it opens."""
    with pytest.raises(InputError) as caught:
        list(frames_from_array(source, *SIZE, fit)) if isinstance(source, np.ndarray) else load(
            source, fit
        )
    error = caught.value
    assert error.code == code, error
    for part in parts:
        assert part in f"{error.message} | {error.hint}"
    return error


def save(path: Path, array: NDArray[Any]) -> Path:
    np.save(path, array)
    return path


def video(path: Path, clip: Clip, codec: str = "mpeg4", *, audio: bool = False) -> Path:
    with av.open(str(path), "w") as container:
        if audio:
            sound = container.add_stream("pcm_s16le", rate=8000, layout="mono")
            block = av.AudioFrame.from_ndarray(np.zeros((1, 800), np.int16), "s16", "mono")
            block.sample_rate = 8000
            container.mux(sound.encode(block))
            return path
        stream: Any = container.add_stream(codec, rate=25)
        stream.height, stream.width = clip.shape[1:]
        stream.pix_fmt = "yuv420p"
        stream.bit_rate = 4_000_000
        for picture in clip:
            rgb = np.repeat(picture[..., None], 3, axis=2)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(rgb, "rgb24")))
        container.mux(stream.encode())
    return path


def ramps(count: int, rows: int, cols: int) -> Clip:
    """Soft pictures, each brighter than the one before, darker on the left."""
    level = np.linspace(20, 120, cols)[None, None, :] + 10 * np.arange(count)[:, None, None]
    return np.broadcast_to(level, (count, rows, cols)).astype(np.uint8)
