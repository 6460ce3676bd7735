"""Videos that PyAV makes, for the page and for npchip to read."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

FRAMES: Final = 24
BT709: Final = 1
"""The number of a matrix, which says how colours are made of luma."""
FULL: Final = 2
"""The number of a range: values take all of 0-255."""

KINDS: Final[dict[str, tuple[str, str, dict[str, str], dict[str, str]]]] = {
    # name: encoder, pixel format, encoder's options, container's options
    "vp8.webm": ("libvpx", "yuv420p", {"auto-alt-ref": "1", "lag-in-frames": "8"}, {}),
    "vp9.webm": ("libvpx-vp9", "yuv420p", {"lag-in-frames": "8"}, {}),
    "live.webm": ("libvpx", "yuv420p", {}, {"live": "1"}),
    "dense.webm": ("libvpx-vp9", "yuv444p", {}, {}),
    "vp9.mp4": ("libvpx-vp9", "yuv420p", {}, {}),
    "av1.webm": ("libsvtav1", "yuv420p", {"preset": "12"}, {}),
    "av1.mp4": ("libsvtav1", "yuv420p", {"preset": "12"}, {}),
    "declared.webm": ("libsvtav1", "yuv420p", {"preset": "12"}, {}),
    "declared.mp4": ("libx264", "yuv420p", {}, {}),
    "declared_vp9.webm": ("libvpx-vp9", "yuv420p", {}, {}),
    "full_vp9.webm": ("libvpx-vp9", "yuv420p", {}, {}),
    "h264.mp4": ("libx264", "yuv420p", {"bf": "3"}, {}),
    "h264.mkv": ("libx264", "yuv420p", {"bf": "2"}, {}),
    "fast.mp4": ("libx264", "yuv420p", {}, {"movflags": "faststart"}),
    "pieces.mp4": ("libx264", "yuv420p", {"g": "8"}, {"movflags": "frag_keyframe+empty_moov"}),
    "moof.mp4": (
        "libx264",
        "yuv420p",
        {"g": "8"},
        {"movflags": "frag_keyframe+empty_moov+default_base_moof"},
    ),
    "full.mp4": ("libx264", "yuvj420p", {}, {}),
    "film.mov": ("libx264", "yuv420p", {}, {}),
    "png.mov": ("png", "rgb24", {}, {}),
}
"""Videos that browsers may read."""


def moving(size: tuple[int, int], count: int = FRAMES) -> list[NDArray[np.uint8]]:
    """Return colour pictures, each with a bar in another place, so that none looks like another."""
    rows, cols = np.mgrid[: size[0], : size[1]]
    frames = []
    for index in range(count):
        base = 90 + 60 * np.sin(cols / 9 + index / 5) + 30 * np.cos(rows / 7)
        frame = np.stack([base, base[::-1], 255 - base], -1).clip(0, 255).astype(np.uint8)
        frame[:, (3 * index) % size[1] : (3 * index) % size[1] + 6] = 240
        frame[: 1 + 2 * index] //= 2
        frames.append(frame)
    return frames


def make(path: Path, size: tuple[int, int], rate: int = 25) -> bool:
    """Write a video of `KINDS`; False if PyAV has no encoder for it."""
    import av

    encoder, layout, options, container = KINDS[path.name]
    try:
        av.Codec(encoder, "w")
    except Exception:  # noqa: BLE001 - PyAV names its errors in more than one place
        return False
    with av.open(str(path), "w", options=container) as file:
        stream: Any = file.add_stream(encoder, rate=rate, options=options)
        stream.width, stream.height, stream.pix_fmt = size[1], size[0], layout
        stream.thread_count = 1
        if path.stem.startswith("declared"):
            stream.colorspace = BT709
        if path.stem == "full_vp9":
            stream.color_range = FULL
        for picture in moving(size):
            frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
            file.mux(stream.encode(frame))
        file.mux(stream.encode(None))
    return True
