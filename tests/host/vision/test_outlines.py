"""npchip.host.vision.outlines: corners that the tracers miss, and what they cannot tell."""

from __future__ import annotations

import numpy as np
import pytest

from examples.sweeps import outlines as measures
from npchip.host.vision.keypoints import Point, find_key_points
from npchip.host.vision.outlines import corners, find_outlines, is_regular, objects
from npchip.host.vision.polygons import Mask, random_regular_polygon, raster
from npchip.host.vision.signs import GROUNDS, stop_sign
from tests.support.profiles import THOROUGH

SQUARE = np.array([[10, 10], [10, 40], [40, 40], [40, 10]])


def test_a_square_has_its_four_corners_clockwise() -> None:
    mask = np.zeros((64, 80), bool)
    mask[10:41, 10:41] = True
    (found,) = find_outlines(mask)
    begin = found.index(Point(10, 10))
    assert np.array_equal([*found[begin:], *found[:begin]], SQUARE)
    assert is_regular(found)


def test_a_ring_with_a_square_in_it_is_two_objects() -> None:
    """To the scan tracer it is one: it takes all up to the ring's other side for its inside."""
    mask = np.zeros((64, 80), bool)
    mask[5:60, 5:60] = True
    mask[10:55, 10:55] = False
    mask[20:40, 20:40] = True
    assert len(find_key_points(mask)) == 1
    assert [len(found) for found in find_outlines(mask)] == [4, 4]


def test_objects_come_in_the_order_of_the_scan_and_touch_by_corners() -> None:
    mask = np.zeros((64, 80), bool)
    mask[0, 5] = mask[1, 4] = mask[3:5, 0:2] = True
    assert [np.argwhere(each)[0].tolist() for each in objects(mask)] == [[0, 5], [1, 4], [3, 0]]
    assert [int(each.sum()) for each in objects(mask)] == [1, 1, 4]


@pytest.mark.parametrize("size", [(1, 1), (1, 60), (60, 1), (2, 2)])
def test_what_is_thinner_than_the_tolerance_is_no_object(size: tuple[int, int]) -> None:
    mask: Mask = np.ones(size, bool)
    assert corners(mask) == []


def test_a_single_raised_pixel_is_no_corner() -> None:
    mask = np.zeros((64, 80), bool)
    mask[20:40, 25:60] = mask[19, 40] = True
    (points,) = find_key_points(mask)
    assert len(points) == 5
    assert [len(found) for found in find_outlines(mask)] == [4]


def test_a_rhombus_and_a_rectangle_are_not_regular() -> None:
    rhombus = [Point(0, 20), Point(10, 40), Point(20, 20), Point(10, 0)]
    assert not is_regular(rhombus)
    rectangle = [Point(0, 0), Point(0, 40), Point(20, 40), Point(20, 0)]
    assert not is_regular(rectangle)


def test_regular_octagons_have_eight_corners() -> None:
    """Wanted are .85. docs/polygons.md has 1,000 of them, and 1,000 that are not regular."""
    rng = np.random.default_rng(12)
    counts = [
        [len(found) for found in find_outlines(raster(random_regular_polygon(rng, 8)))]
        for _ in range(60)
    ]
    assert np.mean([count == [8] for count in counts]) >= 0.85


@pytest.mark.long
def test_of_octagons_85_in_100_have_eight_corners() -> None:
    """Of 200; of 1,000 in the thorough profile, as docs/polygons.md has them."""
    seeds = range(11, 16 if THOROUGH else 12)
    found = [measures.polygons_found("convex", 8, seed)["outline"] for seed in seeds]
    assert np.mean(found) >= 0.85


@pytest.mark.parametrize("ground", GROUNDS)
def test_a_sign_is_drawn_where_it_says(ground: str) -> None:
    picture, vertices = stop_sign(np.random.default_rng(1), ground)
    inside = raster(vertices, coverage=1.0)
    assert abs(inside.sum() / (64 * 80) - 0.2) < 0.2
    outside = ~raster(vertices, coverage=0.01)
    assert set(picture[outside].tolist()) == {GROUNDS[ground]}
    assert picture[inside].max() > 150
    assert picture[inside].min() < 80
