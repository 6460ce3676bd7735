"""Clips to files: arrays or GIFs, with the truth beside them."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from PIL import GifImagePlugin, Image

from npchip.base import files
from npchip.base.json import in_rows
from npchip.host.scenes.files import scene_as_data
from npchip.host.scenes.model import Scene
from npchip.host.scenes.render import Truth

SCHEMA: Final = 1
SUFFIXES: Final = (".npy", ".gif")
_FRAME_MS: Final = 40
DIGITS: Final = 6


def check_suffix(path: Path) -> None:
    """Refuse a file name that `write_clip` cannot write.

    Raises:
        InputError: NP288.
    """
    files.check_suffix(path, SUFFIXES, "NP288", what="clips are", example="clip.npy")


def truth_path(path: Path) -> Path:
    """Where the truth about the clip `path` is kept: ``clip.truth.json`` beside ``clip.npy``."""
    return path.with_suffix(".truth.json")


def write_clip(path: Path, clip: NDArray[np.uint8], scene: Scene, truth: Truth) -> None:
    """Write a clip and the truth about it, each whole or not at all.

    Args:
        path: ends in one of `SUFFIXES`.
        clip: frames from `npchip.host.scenes.render`.
        scene: what was drawn.
        truth: from `npchip.host.scenes.render` too.

    Raises:
        InputError: NP288 as `check_suffix`; NP250, a file cannot be written.
    """
    check_suffix(path)
    files.write_bytes(truth_path(path), to_text(truth_document(scene, truth)).encode())
    write_frames(path, clip)


def write_frames(path: Path, clip: NDArray[np.uint8]) -> None:
    """Write the frames alone, as the suffix says, whole or not at all; errors as `write_clip`."""
    check_suffix(path)
    files.write_bytes(path, _gif(clip) if path.suffix.lower() == ".gif" else _npy(clip))


def truth_document(scene: Scene, truth: Truth) -> dict[str, Any]:
    """Truth as plain dicts, lists and numbers, schema 1 of ``docs/scenes.md``."""
    return {
        "schema": SCHEMA,
        "scene": scene_as_data(scene),
        "frames": [
            {
                "index": k,
                "objects": [_object(truth, k, n) for n in range(len(scene.objects))],
            }
            for k in range(scene.frames)
        ],
    }


def _object(truth: Truth, k: int, n: int) -> dict[str, Any]:
    visible = bool(truth.visible[k, n])
    form = {
        "center": truth.centers[k, n].round(DIGITS).tolist(),
        "box": truth.boxes[k, n].tolist() if visible else None,
        "visible": visible,
    }
    corners = truth.outlines[k][n]
    return form if corners is None else form | {"corners": corners.round(DIGITS).tolist()}


def to_text(document: dict[str, Any]) -> str:
    """Return JSON with one line for each key and each frame; ``frames`` is the last key."""
    return in_rows(document, ("frames",))


def _npy(clip: NDArray[np.uint8]) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, clip, allow_pickle=False)
    return buffer.getvalue()


def _gif(clip: NDArray[np.uint8]) -> bytes:
    """Write every frame; Pillow's own `save` would leave out one that equals the one before."""
    images = [Image.fromarray(frame) for frame in clip]
    head, _ = GifImagePlugin.getheader(images[0], info={"loop": 0})
    parts = list(head)
    for image in images:
        parts += GifImagePlugin.getdata(image, duration=_FRAME_MS)
    return b"".join([*parts, b";"])
