"""Frames to planes and back, against indexing by hand."""

from __future__ import annotations

import numpy as np
import pytest

from npchip.machine.layout import to_frames, to_planes


def test_plane_holds_its_pixel_of_every_np() -> None:
    frame = np.random.default_rng(1).integers(0, 256, (64, 80), np.uint8)
    planes = to_planes(frame)
    assert planes.shape == (64, 8, 10)
    assert planes.dtype == np.uint8
    assert planes.flags.c_contiguous
    for y in range(8):
        for x in range(8):
            assert (planes[8 * y + x] == frame[y::8, x::8]).all()


@pytest.mark.parametrize("lead", [(), (3,), (2, 3), (0,)])
@pytest.mark.parametrize("size", [(8, 8), (64, 80), (16, 8), (128, 160)])
def test_round_trip(lead: tuple[int, ...], size: tuple[int, int]) -> None:
    frames = np.random.default_rng(2).integers(0, 256, (*lead, *size), np.uint8)
    planes = to_planes(frames)
    assert planes.shape == (*lead, 64, size[0] // 8, size[1] // 8)
    back = to_frames(planes)
    assert back.flags.c_contiguous
    assert (back == frames).all()


def test_leading_axes_are_independent() -> None:
    frames = np.random.default_rng(3).integers(0, 256, (5, 64, 80), np.uint8)
    assert (to_planes(frames)[3] == to_planes(frames[3])).all()


def test_sizes_that_no_array_has_are_refused() -> None:
    with pytest.raises(ValueError, match="multiples of 8, found 60 x 80"):
        to_planes(np.zeros((60, 80), np.uint8))
    with pytest.raises(ValueError, match="64 planes, found 63"):
        to_frames(np.zeros((63, 8, 10), np.uint8))
