"""npchip.host.vision.shapes: lengths, and how well triangles are told apart (thesis 3.3.3).

Quick runs compare 1,000 pairs of triangles; NPCHIP_PROFILE=thorough compares 5,000. All sides are
20 to 60 pixels long, no angle is below 20 degrees. A pair is the same triangle in another size,
orientation and place, or two random ones.
"""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

import numpy as np
import pytest

from examples.sweeps.keypoint_measures import (
    corner_rate,
    pairs,
    pixels,
    polygon_rates,
    polygons,
    recognised,
    recognised_from_pixels,
)
from npchip.host.vision.polygons import BEND, SHORTEST_SIDE, hinged
from npchip.host.vision.shapes import (
    TOLERANCE,
    Length,
    Match,
    best_match,
    distance,
    length,
    scaled,
    side_lengths,
    thesis_distance,
)
from tests.support.profiles import THOROUGH

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip.host.vision.polygons import Vertices

PAIRS = 5_000 if THOROUGH else 1_000
DRAWN = 1_000 if THOROUGH else 150


def test_recognition_with_lengths_by_shifts_alone() -> None:
    """Wanted is .88. Measured on 5,000 pairs: .955; exact .996, thesis .66."""
    assert recognised("shifts", PAIRS) >= 0.92
    assert recognised("exact", PAIRS) >= 0.98


def test_recognition_as_the_thesis_has_it() -> None:
    """Measured on 5,000 pairs: .72; with lengths by shifts .91, with exact ones .96.

    With the triangles of the project's prototypes the thesis's rule finds .53 and ours .91.
    """
    by_thesis = recognised("thesis", PAIRS, thesis=True)
    ours = recognised("shifts", PAIRS)
    assert 0.6 <= by_thesis <= 0.8
    assert by_thesis < ours - 0.15
    assert recognised("shifts", PAIRS, thesis=True) < ours


def test_recognition_of_drawn_triangles() -> None:
    """From pixels to match: raster, tracer, lengths. A triangle without 3 key points is none."""
    assert recognised_from_pixels(DRAWN) >= 0.88


def test_the_tolerance_admits_one_in_twenty() -> None:
    lists = [[scaled(side_lengths(pixels(v))) for v in three] for three in pairs(PAIRS)]
    same = np.mean([(distance(a, b) or 0) <= TOLERANCE for a, b, _ in lists])
    others = np.mean([(distance(a, c) or 0) <= TOLERANCE for a, _, c in lists])
    assert same > 0.95
    assert others < 0.075


@pytest.mark.parametrize(
    ("how", "rms", "worst"), [("thesis", 0.039, 0.081), ("shifts", 0.016, 0.07)]
)
def test_errors_of_the_lengths(how: Length, rms: float, worst: float) -> None:
    legs = [(y, x) for y in range(20, 61) for x in range(y + 1) if 20 <= hypot(y, x) <= 60]
    errors = np.array([length(y, x, how) / hypot(y, x) - 1 for y, x in legs])
    assert np.sqrt((errors**2).mean()) < rms
    assert abs(errors).max() < worst + 0.5 / 20
    assert np.sqrt((errors**2).mean()) > rms / 2


@pytest.mark.parametrize("how", ["thesis", "shifts", "exact"])
def test_lengths_along_an_axis_are_exact(how: Length) -> None:
    assert [length(0, n, how) for n in range(80)] == list(range(80))
    assert [length(-n, 0, how) for n in range(80)] == list(range(80))
    assert length(-3, 40, how) == length(40, 3, how)


def test_thirds_are_rounded() -> None:
    assert [length(9, x, "thesis") for x in range(8)] == [9, 9, 10, 10, 10, 11, 11, 11]


def test_scaled_and_rotated_lists_are_the_same() -> None:
    assert scaled([20, 30, 40]) == [64, 96, 128]
    assert distance(scaled([20, 30, 40]), scaled([60, 80, 40])) == 0
    assert distance(scaled([20, 30, 40]), scaled([30, 20, 40])) == 32  # the mirror image
    assert thesis_distance([20, 30, 40], [15, 20, 10]) == 0


def test_shapes_of_different_numbers_of_sides_do_not_match() -> None:
    assert distance([128, 128, 128], [128, 128, 128, 128]) is None
    assert thesis_distance([1, 1, 1], [1, 1, 1, 1]) is None
    assert best_match([9, 9, 9, 9], [[128, 128, 128]]) is None


def test_a_square_and_a_rhombus_have_the_same_sides() -> None:
    """The limit that 3.3.3 admits: lengths do not determine a quadrilateral."""
    square = side_lengths([(0, 0), (0, 25), (25, 25), (25, 0)], "exact")
    rhombus = side_lengths([(0, 15), (20, 30), (40, 15), (20, 0)], "exact")
    assert distance(scaled(square), scaled(rhombus)) == 0
    rectangle = side_lengths([(0, 0), (0, 40), (20, 40), (20, 0)])
    assert best_match(rectangle, [scaled(square), [128, 64, 128, 64]]) == Match(1, 0)


# ---- more than three sides


POLYGONS = 500 if THOROUGH else 60


@pytest.mark.parametrize("corners", [4, 5, 6])
def test_polygons_are_recognised_unless_they_are_hinged(corners: int) -> None:
    """Random others are told apart better than triangles; others with the same sides never."""
    found, bent = polygon_rates(corners, POLYGONS)
    assert found >= 0.97
    assert bent >= 0.97


@pytest.mark.parametrize(("corners", "least"), [(4, 0.9), (5, 0.75), (6, 0.65)])
def test_the_tracer_finds_the_corners_of_polygons(corners: int, least: float) -> None:
    """Measured on 500: see docs/keypoints.md."""
    assert least <= corner_rate(corners, POLYGONS) < 1


@pytest.mark.parametrize("corners", [4, 5, 6])
def test_hinged_polygons_keep_their_sides_and_change_their_angles(corners: int) -> None:
    rng = np.random.default_rng(corners)
    checked = 0
    for shape, *_ in polygons(corners, 8):
        bent = hinged(rng, shape)
        if bent is None:
            continue
        checked += 1
        assert np.allclose(lengths_of(bent), lengths_of(shape))
        changed = abs(angles_of(bent) - angles_of(shape))
        assert changed.max() >= BEND
        assert np.isclose(angles_of(bent).sum(), 180 * (corners - 2))  # convex
    assert checked >= 6


@pytest.mark.parametrize("corners", range(3, 9))
def test_convex_polygons(corners: int) -> None:
    for shape, *_ in polygons(corners, 8):
        assert shape.shape == (corners, 2)
        assert (shape >= 0.5).all()
        assert (shape <= (62.5, 78.5)).all()
        assert lengths_of(shape).min() >= SHORTEST_SIDE
        angles = angles_of(shape)
        assert np.isclose(angles.sum(), 180 * (corners - 2))
        assert 20 <= angles.min() <= angles.max() <= 160


def lengths_of(vertices: Vertices) -> NDArray[np.float64]:
    return np.array(
        [np.hypot(*(b - a)) for a, b in zip(vertices, np.roll(vertices, -1, 0), strict=True)]
    )


def angles_of(vertices: Vertices) -> NDArray[np.float64]:
    """Inner angles by the scalar product, in degrees."""
    before, after = np.roll(vertices, 1, 0) - vertices, np.roll(vertices, -1, 0) - vertices
    norms = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    found: NDArray[np.float64] = np.degrees(np.arccos((before * after).sum(axis=1) / norms))
    return found


def test_the_first_of_equal_matches_is_taken() -> None:
    references = [[128, 60, 90], [128, 64, 96], [64, 96, 128]]
    assert best_match([20, 30, 40], references) == Match(1, 0)
    assert best_match([20, 30, 40], references[:1], 5) is None
    assert best_match([20, 30, 40], references[:1], 6) == Match(0, 6)
    assert best_match([20, 30, 40], []) is None
