"""Frames of a scene, and the truth about them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.host.scenes.model import Object, Scene
from npchip.host.scenes.motions import Walls
from npchip.host.scenes.shapes import FULL, Points, Shape, coverage
from npchip.machine import PIXELS, Sensor
from npchip.machine.layout import to_frames
from npchip.machine.sensor import SensorModel

_STREAM: Final = 1 << 32
"""Conversion number of the noise of scenes. No chip reaches it, so a clip and a sensor of the same
seed have independent noise."""


@dataclass(frozen=True)
class Truth:
    """True positions of N objects in T frames.

    Attributes:
        centers: float64, shape (T, N, 2): (row, column); whole numbers are middles of pixels.
        boxes: int64, shape (T, N, 4): top, left, bottom, right, inclusive, of the pixels in the
            frame that the object touches, even hidden ones; -1 if it touches none.
        visible: bool, shape (T, N): whether it touches any.
        outlines: corners for each frame and object, float64, shape (n, 2); None for a disc.
    """

    centers: NDArray[np.float64]
    boxes: NDArray[np.int64]
    visible: NDArray[np.bool_]
    outlines: list[list[Points | None]]


def render(scene: Scene) -> tuple[NDArray[np.uint8], Truth]:
    """Draw a scene. The same scene gives the same clip.

    Args:
        scene: the scene.

    Returns:
        The clip, uint8, shape (T, rows, columns), and the truth about it.

    Raises:
        InputError: NP287, a bouncing object does not start inside the frame.
    """
    frames, (rows, cols), count = scene.frames, scene.size, len(scene.objects)
    clip = np.empty((frames, rows, cols), np.uint8)
    centers = np.empty((frames, count, 2))
    boxes = np.full((frames, count, 4), -1, np.int64)
    outlines: list[list[Points | None]] = []
    for index, item in enumerate(scene.objects):
        centers[:, index] = item.motion.centers(frames, _walls(item.shape, scene.size))
    behind = scene.background.picture(scene.size, scene.seed).clip(0, 255)
    still = np.floor(behind + 0.5).astype(np.int64)
    sensor = SensorModel(Sensor(0, scene.noise, scene.seed), rows // PIXELS, cols // PIXELS)
    for k in range(frames):
        picture = still.copy()
        for index, item in enumerate(scene.objects):
            boxes[k, index] = _draw(picture, item, tuple(centers[k, index]), k)
        if scene.noise:
            picture += to_frames(sensor.noise(k, _STREAM))
        clip[k] = picture.clip(0, 255)
        corners = (item.shape.outline(k) for item in scene.objects)
        outlines.append([c if c is None else c + centers[k, n] for n, c in enumerate(corners)])
    return clip, Truth(centers, boxes, boxes[:, :, 0] >= 0, outlines)


def _draw(
    picture: NDArray[np.int64], item: Object, center: tuple[float, float], frame: int
) -> NDArray[np.int64] | int:
    """Draw an object over `picture`; return its box, or -1."""
    size = (picture.shape[0], picture.shape[1])
    rows, cols, part = coverage(item.shape, center, frame, size)
    below = picture[rows, cols]
    picture[rows, cols] = (below * (FULL - part) + item.brightness * part + FULL // 2) // FULL
    touched = np.argwhere(part) + np.array([rows.start, cols.start])
    return np.concatenate([touched.min(0), touched.max(0)]) if len(touched) else -1


def _walls(shape: Shape, size: tuple[int, int]) -> Walls:
    (down, across), (rows, cols) = shape.reach, size
    return (down - 0.5, rows - 0.5 - down), (across - 0.5, cols - 0.5 - across)
