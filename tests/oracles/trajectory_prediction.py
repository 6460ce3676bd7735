"""Outputs of ``asm/trajectory_*.s`` in every frame, from the words of their heads.

Written for checking, not for speed: every frame looks at all centres since the last restart and
uses the closed forms, where programs and `npchip.host.vision.prediction` step from frame to frame.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from tests.oracles.trajectory import trajectory

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]
    Sent = dict[str, list[int]]


def _inside(value: int, size: int) -> int:
    return sorted((0, value, size - 1))[1]


def _polynomial(known: list[int], steps: int) -> int:
    """Position `steps` after the last of up to three centres on the parabola through them."""
    x = known[-3:]
    if len(x) == 3:
        a = x[2] - 2 * x[1] + x[0]
        return x[2] + steps * (x[2] - x[1]) + a * steps * (steps + 1) // 2
    return x[-1] + steps * (x[-1] - x[0])  # at rest if it is the only one


def nonlinear_axis(centers: list[int], size: int, threshold: int, steps: int) -> list[list[int]]:
    """[predicted, inflection] for every centre of one axis."""
    sent: list[list[int]] = []
    start = 0  # first centre that is used
    for k in range(len(centers)):
        known = centers[start : k + 1]
        jerk = int(np.diff(known, 3)[-1]) if len(known) > 3 else 0
        if abs(jerk) >= threshold:
            start = k
            sent.append([centers[k], 1])
        else:
            sent.append([_inside(_polynomial(known, steps), size), 0])
    return sent


def mixed_axes(
    along: list[int], across: list[int], sizes: tuple[int, int], direction: int, retreat: int
) -> list[list[int]]:
    """[predicted along, predicted across, inflection] for every centre."""
    sent: list[list[int]] = []
    start = 0
    for k in range(len(along)):
        back = 0
        if k > 0:
            back = along[k - 1] - along[k] if direction == 0 else along[k] - along[k - 1]
        if back >= retreat:
            start = k
        ahead = _polynomial(along[start : k + 1], 1)
        beside = _polynomial(across[start : k + 1][-2:], 1)
        sent.append([_inside(ahead, sizes[0]), _inside(beside, sizes[1]), int(back >= retreat)])
    return sent


def robust_axis(centers: list[int], size: int) -> list[int]:
    """Predictions for every centre of one axis."""
    sent: list[int] = []
    for k in range(len(centers)):
        if k < 4:
            value = _polynomial(centers[: k + 1][-2:], 1)
        else:
            eighths = 15 * centers[k] - 10 * centers[k - 2] + 3 * centers[k - 4]
            value = int((Fraction(eighths, 8) + Fraction(1, 2)).__floor__())
        sent.append(_inside(value, size))
    return sent


def _fill(frames: Frames, threshold: int, predict: Callable[[list[int], list[int]], Sent]) -> Sent:
    """Outputs of all frames: centres, and what `predict` makes of those that are valid."""
    sent = trajectory(frames, threshold)
    valid = [k for k, flag in enumerate(sent["valid"]) if flag]
    rows = [sent["center_row"][k] for k in valid]
    cols = [sent["center_col"][k] for k in valid]
    for name, values in predict(rows, cols).items():
        whole = [0] * len(frames)
        for k, value in zip(valid, values, strict=True):
            whole[k] = value
        sent[name] = whole
    return sent


def trajectory_nonlinear(
    frames: Frames, threshold: int = 32, inflection: int = 3, steps: int = 1
) -> Sent:
    """Outputs of ``trajectory_nonlinear.s`` but for the picture."""
    _, height, width = frames.shape

    def predict(rows: list[int], cols: list[int]) -> Sent:
        down = nonlinear_axis(rows, height, inflection, steps)
        right = nonlinear_axis(cols, width, inflection, steps)
        return {
            "predicted_row": [value for value, _ in down],
            "predicted_col": [value for value, _ in right],
            "inflection": [r + 2 * c for (_, r), (_, c) in zip(down, right, strict=True)],
        }

    return _fill(frames, threshold, predict)


def nonlinear_picture(frames: Frames, sent: Sent) -> Frames:
    """Return the picture of ``trajectory_nonlinear.s``: a marked point in each valid frame."""
    picture = frames.copy()
    for k in range(len(frames)):
        if sent["valid"][k]:
            row, col = sent["predicted_row"][k], sent["predicted_col"][k]
            picture[k, row, col] = 255 if frames[k, row, col] < 128 else 0
    return picture


def trajectory_mixed(
    frames: Frames, threshold: int = 32, axis: int = 1, direction: int = 0, inflection: int = 1
) -> Sent:
    """Outputs of ``trajectory_mixed.s``."""
    sizes = (frames.shape[1 + axis], frames.shape[2 - axis])
    names = ["predicted_row", "predicted_col"]

    def predict(*centers: list[int]) -> Sent:
        found = mixed_axes(centers[axis], centers[1 - axis], sizes, direction, inflection)
        columns = [list(column) for column in zip(*found, strict=True)] or [[], [], []]
        return {
            names[axis]: columns[0],
            names[1 - axis]: columns[1],
            "inflection": columns[2],
        }

    return _fill(frames, threshold, predict)


def trajectory_robust(frames: Frames, threshold: int = 32) -> Sent:
    """Outputs of ``trajectory_robust.s``."""
    _, height, width = frames.shape

    def predict(rows: list[int], cols: list[int]) -> Sent:
        return {
            "predicted_row": robust_axis(rows, height),
            "predicted_col": robust_axis(cols, width),
        }

    return _fill(frames, threshold, predict)
