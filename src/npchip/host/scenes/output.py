"""Files of clips: arrays or GIFs, each with its truth in another file."""

from __future__ import annotations

import io
from collections.abc import Collection
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from PIL import GifImagePlugin, Image

from npchip.base import files
from npchip.base.errors import InputError
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
    """Return the path of the truth about a clip: ``clip.truth.json`` for ``clip.npy``."""
    return path.with_suffix(".truth.json")


def write_clip(path: Path, clip: NDArray[np.uint8], scene: Scene, truth: Truth) -> None:
    """Write a clip and the truth about it, each whole or not at all.

    Args:
        path: path with one of `SUFFIXES`.
        clip: frames from `npchip.host.scenes.render`.
        scene: the scene.
        truth: truth from `npchip.host.scenes.render`.

    Raises:
        InputError: NP288 as `check_suffix`; NP250, a file cannot be written.
    """
    check_suffix(path)
    write_files(truth_document(scene, truth), path, {path: clip})


def _check_truth(path: Path, clips: Collection[Path], text: str) -> None:
    """Refuse to replace another truth about another clip, as ``ball.gif`` would ``ball.npy``'s."""
    truth = truth_path(path)
    others = (path.with_suffix(f"{part}{end}") for part in ("", ".1", ".2") for end in SUFFIXES)
    other = next((file for file in others if file not in clips and file.exists()), None)
    if other is None or not truth.is_file():
        return
    if truth.read_text("utf-8") != text:
        raise InputError(
            "NP255",
            f"cannot write {truth}: it is the truth about {other}",
            hint="give the clip a name of its own, or remove that one",
        )


def write_files(document: dict[str, Any], path: Path, clips: dict[Path, NDArray[np.uint8]]) -> None:
    """Write the truth about `path` as JSON, one line for each frame, and the clips, or nothing."""
    text = in_rows(document, ("frames",))
    _check_truth(path, clips, text)
    data = {file: _gif(clip) if _is_gif(file) else _npy(clip) for file, clip in clips.items()}
    with files.uninterrupted():
        files.write_text(truth_path(path), text)
        for file, content in data.items():
            files.write_bytes(file, content)


def _is_gif(path: Path) -> bool:
    return path.suffix.lower() == ".gif"


def truth_document(scene: Scene, truth: Truth) -> dict[str, Any]:
    """Return the truth as plain data, schema 1 of ``docs/scenes.md``."""
    objects = range(len(scene.objects))
    return {
        "schema": SCHEMA,
        "scene": scene_as_data(scene),
        "frames": [
            {"index": k, "objects": [_object(truth, k, n) for n in objects]}
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


def _npy(clip: NDArray[np.uint8]) -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, clip, allow_pickle=False)
    return buffer.getvalue()


def _gif(clip: NDArray[np.uint8]) -> bytes:
    """Encode every frame; Pillow's `save` would drop a frame that equals the one before."""
    images = [Image.fromarray(frame) for frame in clip]
    parts, _ = GifImagePlugin.getheader(images[0], info={"loop": 0})
    for image in images:
        parts += GifImagePlugin.getdata(image, duration=_FRAME_MS)
    return b"".join([*parts, b";"])
