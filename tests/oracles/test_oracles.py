"""The oracles against examples worked out by hand, and the synthetic clips for variety."""

from __future__ import annotations

import numpy as np
import pytest

from tests.oracles.frame_difference import frame_difference
from tests.oracles.imaging import imaging
from tests.oracles.trajectory import trajectory
from tests.support.clips import CLIPS, THRESHOLDS, bundled_clips, synthetic_clip

SEEDS = range(200)


def test_trajectory_worked_out_by_hand() -> None:
    clip = np.zeros((6, 64, 80), np.uint8)
    clip[1, 10, 20] = 32  # appears: the centre is the pixel, nothing to extrapolate from
    clip[2, 12, 25] = 32  # moves: box (10..12, 20..25), centre (11, 22), predicted (12, 24)
    clip[3] = clip[2]  # stands still: nothing valid, history kept
    clip[4] = clip[2]
    clip[4, 12, 25] = 0  # disappears: centre (12, 25), predicted (13, 28)
    clip[5, 0, 79] = 31  # one below the threshold
    assert trajectory(clip, 32) == {
        "valid": [0, 1, 1, 0, 1, 0],
        "center_row": [0, 10, 11, 0, 12, 0],
        "center_col": [0, 20, 22, 0, 25, 0],
        "predicted_row": [0, 10, 12, 0, 13, 0],
        "predicted_col": [0, 20, 24, 0, 28, 0],
    }


@pytest.mark.parametrize(("rows", "cols"), [(64, 80), (128, 160)])
def test_prediction_is_clamped_to_the_frame(rows: int, cols: int) -> None:
    clip = np.zeros((4, rows, cols), np.uint8)
    clip[1, rows // 2, cols // 2] = 200
    clip[2] = clip[1]
    clip[2, rows - 1, cols - 1] = 200
    clip[3] = clip[2]
    clip[3, 0, 0] = 200
    sent = trajectory(clip, 32)
    assert (sent["predicted_row"][2], sent["predicted_col"][2]) == (rows - 1, cols - 1)
    assert (sent["predicted_row"][3], sent["predicted_col"][3]) == (0, 0)


def test_imaging_and_frame_difference() -> None:
    clip = np.array([[[3, 200]], [[255, 0]]], np.uint8)
    assert imaging(clip).tolist() == clip.tolist()
    assert frame_difference(clip).tolist() == [[[0, 0]], [[252, 200]]]


def test_bundled_clips_are_all_there() -> None:
    clips = bundled_clips()
    assert len(clips) == len(list(CLIPS.glob("*.npy"))) >= 6
    for clip in clips.values():
        assert clip.dtype == np.uint8
        assert clip.shape[1:] == (64, 80)


def test_synthetic_clips_depend_on_the_seed_alone() -> None:
    assert np.array_equal(synthetic_clip(7), synthetic_clip(7))
    assert not np.array_equal(synthetic_clip(7), synthetic_clip(8))
    clip = synthetic_clip(7, rows=128, cols=160, frames=3)
    assert clip.shape == (3, 128, 160)
    assert clip.dtype == np.uint8


def test_synthetic_clips_are_varied() -> None:
    """All that a tracker may get wrong occurs in the first few hundred seeds."""
    seen: set[str] = set()
    for seed in SEEDS:
        clip = synthetic_clip(seed)
        changes = frame_difference(clip)
        for threshold in THRESHOLDS:
            peaks = {int(picture.max()) for picture in changes[1:]}
            seen |= {f"exactly {threshold}"} if threshold in peaks else set()
            seen |= {f"just below {threshold}"} if threshold - 1 in peaks else set()
        sent = trajectory(clip, 32)
        for moving in changes[1:] >= 32:
            where = np.argwhere(moving)
            seen.add({0: "nothing", 1: "one pixel", 5120: "everything"}.get(len(where), "some"))
            if len(where) == 1:
                row, col = where[0].tolist()
                corner = row in (0, 63) and col in (0, 79)
                seen |= {f"corner {row} {col}"} if corner else set()
        seen |= {"edge"} if {0, 63} & set(sent["predicted_row"][1:]) else set()
        seen |= {"gap"} if [1, 0, 1] in [sent["valid"][k : k + 3] for k in range(4)] else set()
    assert seen == {
        *(f"{how} {threshold}" for how in ("exactly", "just below") for threshold in THRESHOLDS),
        *("nothing", "one pixel", "some", "everything", "edge", "gap"),
        *("corner 0 0", "corner 0 79", "corner 63 0", "corner 63 79"),
    }
