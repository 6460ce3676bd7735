"""Results of programs of ``asm/`` by NumPy (a moving box, differences) and OpenCV (edges)."""

from __future__ import annotations

import importlib

import numpy as np
from numpy.typing import NDArray

Boxes = NDArray[np.int64]
"""int64, shape (T, 5): whether a pixel moves, then top, bottom, left, right (0 if none)."""


def each_frame(frames: NDArray[np.uint8], threshold: int = 32) -> Boxes:
    """One frame at a time, differences in 16 bits, as most people would write it."""
    boxes = np.zeros((len(frames), 5), np.int64)
    before = frames[0].astype(np.int16)
    for index in range(1, len(frames)):
        now = frames[index].astype(np.int16)
        moving = np.abs(now - before) >= threshold
        before = now
        rows = np.flatnonzero(moving.any(axis=1))
        if len(rows):
            columns = np.flatnonzero(moving.any(axis=0))
            boxes[index] = 1, rows[0], rows[-1], columns[0], columns[-1]
    return boxes


def batched(frames: NDArray[np.uint8], threshold: int = 32, size: int = 256) -> Boxes:
    """Many frames at a time, differences as maximum - minimum in 8 bits."""
    boxes = np.zeros((len(frames), 5), np.int64)
    for start in range(1, len(frames), size):
        now = frames[start : start + size]
        before = frames[start - 1 : start - 1 + len(now)]
        change = np.maximum(now, before) - np.minimum(now, before)
        part = boxes[start : start + len(now)]
        for axis, first in ((2, 1), (1, 3)):
            moving = change.max(axis=axis) >= threshold
            some = moving.any(axis=1)
            part[:, 0] = some
            part[:, first] = np.where(some, moving.argmax(axis=1), 0)
            last = moving.shape[1] - 1 - moving[:, ::-1].argmax(axis=1)
            part[:, first + 1] = np.where(some, last, 0)
    return boxes


def differences(frames: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the pictures of ``asm/frame_difference.s``, one at a time, differences in 16 bits."""
    pictures = np.zeros_like(frames)
    before = frames[0].astype(np.int16)
    for index in range(1, len(frames)):
        now = frames[index].astype(np.int16)
        pictures[index] = np.abs(now - before)
        before = now
    return pictures


def sobel(frames: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the pictures of ``asm/edges.s`` by OpenCV, one at a time.

    Raises:
        ModuleNotFoundError: OpenCV is not installed.
    """
    cv2 = importlib.import_module("cv2")
    pictures = np.empty_like(frames)
    options = {"ksize": 3, "borderType": cv2.BORDER_CONSTANT}
    for frame, picture in zip(frames, pictures, strict=True):
        across = cv2.convertScaleAbs(cv2.Sobel(frame, cv2.CV_16S, 1, 0, **options))
        down = cv2.convertScaleAbs(cv2.Sobel(frame, cv2.CV_16S, 0, 1, **options))
        cv2.add(across, down, picture)  # at most 255
    return pictures


def gradient(frames: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the same pictures by OpenCV's function for both gradients, which knows no border of 0.

    Raises:
        ModuleNotFoundError: OpenCV is not installed.
    """
    cv2 = importlib.import_module("cv2")
    pictures = np.empty_like(frames)
    padded = np.zeros([size + 2 for size in frames.shape[1:]], np.uint8)
    inside = padded[1:-1, 1:-1]
    for frame, picture in zip(frames, pictures, strict=True):
        inside[:] = frame
        parts = (part[1:-1, 1:-1] for part in cv2.spatialGradient(padded))
        cv2.add(*map(cv2.convertScaleAbs, parts), picture)
    return pictures
