"""Answers to all exercises, computed in NumPy: from a clip (T, 64, 80) to its outputs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Clip = NDArray[np.uint8]
Outputs = dict[str, NDArray[np.integer]]
DARK = 100
NOTHING = 255


def _planes(clip: Clip) -> NDArray[np.int64]:
    """Pixels by NP: (T, 8, 10, 64), the last axis as they lie in memory."""
    blocks = clip.astype(np.int64).reshape(-1, 8, 8, 10, 8)
    return blocks.transpose(0, 1, 3, 2, 4).reshape(-1, 8, 10, 64)


def _white(mask: NDArray[np.bool_]) -> NDArray[np.uint8]:
    return np.where(mask, 255, 0).astype(np.uint8)


def _west(clip: Clip) -> NDArray[np.int64]:
    shifted = np.zeros(clip.shape, np.int64)
    shifted[:, :, 1:] = clip[:, :, :-1]
    return shifted


def _dark_nps(clip: Clip) -> NDArray[np.bool_]:
    return np.asarray((_planes(clip) < DARK).any(axis=3))


def pixel(clip: Clip) -> Outputs:
    return {"corner": clip[:, ::8, ::8]}


def negative(clip: Clip) -> Outputs:
    return {"picture": 255 - clip}


def threshold(clip: Clip) -> Outputs:
    return {"bright": _white(clip > 128)}


def between(clip: Clip) -> Outputs:
    return {"middle": _white((clip >= 64) & (clip <= 192))}


def brighten(clip: Clip) -> Outputs:
    return {"picture": np.minimum(clip.astype(np.int64) + 60, 255)}


def distance(clip: Clip) -> Outputs:
    return {"distance": np.abs(clip.astype(np.int64) - 100)}


def board(clip: Clip) -> Outputs:
    assert not clip.size
    rows, cols = np.indices((8, 10))
    return {"board": _white((rows + cols) % 2 == 1)}


def alarm(clip: Clip) -> Outputs:
    return {"alarm": np.asarray((clip > 200).any(axis=(1, 2))).astype(np.uint8)}


def count(clip: Clip) -> Outputs:
    return {"dark": (_planes(clip) < DARK).sum(axis=3)}


def brightest(clip: Clip) -> Outputs:
    return {"most": _planes(clip).max(axis=3)}


def maximum(clip: Clip) -> Outputs:
    return {"most": clip.max(axis=(1, 2))}


def spread(clip: Clip) -> Outputs:
    own = _dark_nps(clip)
    near = own.copy()
    near[:, 1:] |= own[:, :-1]
    near[:, :-1] |= own[:, 1:]
    near[:, :, 1:] |= own[:, :, :-1]
    near[:, :, :-1] |= own[:, :, 1:]
    return {"near": _white(near)}


def tally(clip: Clip) -> Outputs:
    return {"nps": _dark_nps(clip).sum(axis=(1, 2))}


def total(clip: Clip) -> Outputs:
    return {"dark": (clip < DARK).sum(axis=(1, 2))}


def mean(clip: Clip) -> Outputs:
    return {"mean": _planes(clip).sum(axis=3) >> 6}


def shift(clip: Clip) -> Outputs:
    return {"shifted": _west(clip)}


def edges(clip: Clip) -> Outputs:
    return {"edges": np.abs(clip.astype(np.int64) - _west(clip))}


def cds(clip: Clip) -> Outputs:
    """The picture itself: offsets are the same in both conversions."""
    return {"picture": clip}


def motion(clip: Clip) -> Outputs:
    before = np.concatenate([clip[:1], clip[:-1]]).astype(np.int64)
    return {"moving": _white(np.abs(clip.astype(np.int64) - before) >= 32)}


def _rows(clip: Clip) -> list[NDArray[np.intp]]:
    return [np.flatnonzero((frame < DARK).any(axis=1)) for frame in clip]


def top(clip: Clip) -> Outputs:
    return {"top": np.array([rows[0] if rows.size else NOTHING for rows in _rows(clip)])}


def centre(clip: Clip) -> Outputs:
    found = [(rows[0] + rows[-1]) >> 1 if rows.size else NOTHING for rows in _rows(clip)]
    return {"center_row": np.array(found)}


def predict(clip: Clip) -> Outputs:
    now = clip[:, ::8, ::8].astype(np.int64)
    before = np.concatenate([now[:1], now[:-1]])
    return {"next": np.clip(2 * now - before, 0, 255)}


def keypoint(clip: Clip) -> Outputs:
    """The first dark pixel in reading order."""
    found = [np.argwhere(frame < DARK) for frame in clip]
    points = [tuple(each[0]) if each.size else (NOTHING, NOTHING) for each in found]
    rows, cols = np.array(points).T
    return {"row": rows, "col": cols}


def budget(clip: Clip) -> Outputs:
    return threshold(clip)


ORACLES: dict[str, Callable[[Clip], Outputs]] = {
    each.__name__: each
    for each in (
        pixel, negative, threshold, between, brighten, distance, board, alarm, count, brightest,
        maximum, spread, tally, total, mean, shift, edges, cds, motion, top, centre, predict,
        keypoint, budget,
    )
}  # fmt: skip
