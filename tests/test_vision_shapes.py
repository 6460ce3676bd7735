"""npchip.vision.shapes: lengths, and how well triangles are told apart (thesis 3.3.3).

Quick runs compare 1,000 pairs of triangles; NPCHIP_PROFILE=thorough compares 5,000. All sides are
20 to 60 pixels long, no angle is below 20 degrees. A pair is the same triangle in another size,
orientation and place, or two random ones.
"""

from __future__ import annotations

import os
from functools import cache
from math import acos, degrees, hypot
from typing import TYPE_CHECKING

import numpy as np
import pytest

from npchip.vision.keypoints import find_key_points
from npchip.vision.polygons import Vertices, raster
from npchip.vision.shapes import (
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

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Points = Sequence[tuple[int, int]]

THOROUGH = os.environ.get("NPCHIP_PROFILE") == "thorough"
PAIRS = 5_000 if THOROUGH else 1_000
DRAWN = 1_000 if THOROUGH else 150


def random_sides(rng: np.random.Generator) -> NDArray[np.float64]:
    while True:
        sides = rng.uniform(20, 60, 3)
        a, b, c = sorted(sides)
        if a + b > c and degrees(acos((b * b + c * c - a * a) / (2 * b * c))) >= 20:
            return sides


def place(rng: np.random.Generator, sides: NDArray[np.float64]) -> Vertices:
    """Turn a triangle at random, until it fits into the frame."""
    a, b, c = sides
    along = (a * a + c * c - b * b) / (2 * a)
    corners = np.array([[0, 0], [0, a], [np.sqrt(c * c - along * along), along]])
    while True:
        angle = rng.uniform(0, 2 * np.pi)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        turned = corners @ turn.T
        turned -= turned.min(axis=0)
        room = np.array([62, 78]) - turned.max(axis=0)
        if (room >= 0).all():
            placed: Vertices = turned + 1 + rng.uniform((0, 0), room)
            return placed


@cache
def pairs() -> list[tuple[Vertices, Vertices, Vertices]]:
    """A triangle, the same in another pose and size, and another one."""
    rng = np.random.default_rng(3)
    found = []
    for _ in range(PAIRS):
        sides, others = random_sides(rng), random_sides(rng)
        again = sides * rng.uniform(20 / sides.min(), 60 / sides.max())
        found.append((place(rng, sides), place(rng, again), place(rng, others)))
    return found


def pixels(vertices: Vertices) -> Points:
    return [(int(row), int(col)) for row, col in vertices]


def true_positives(same: Sequence[float | None], others: Sequence[float | None]) -> float:
    """Part of the same pairs that match where at most 5 % of the others do."""
    a, b = np.array(same, float), np.array(others, float)
    return max(float((a <= t).mean()) for t in np.unique([*a, *b]) if (b <= t).mean() <= 0.05)


def ours(how: Length) -> float:
    lists = [[scaled(side_lengths(pixels(v), how)) for v in three] for three in pairs()]
    return true_positives(
        [distance(a, b) for a, b, _ in lists], [distance(a, c) for a, _, c in lists]
    )


def of_thesis(how: Length) -> float:
    lists = [[side_lengths(pixels(v), how) for v in three] for three in pairs()]
    return true_positives(
        [thesis_distance(a, b) for a, b, _ in lists], [thesis_distance(a, c) for a, _, c in lists]
    )


def test_recognition_with_lengths_by_shifts_alone() -> None:
    """The issue asks for .88. Measured on 5,000 pairs: .955; exact .996, thesis .66."""
    assert ours("shifts") >= 0.92
    assert ours("exact") >= 0.98


def test_recognition_as_the_thesis_has_it() -> None:
    """Measured on 5,000 pairs: .72; with lengths by shifts .91, with exact ones .96.

    With other triangles (reproduction.md) the thesis's rule finds .53 and ours .91.
    """
    assert 0.6 <= of_thesis("thesis") <= 0.8
    assert of_thesis("thesis") < ours("shifts") - 0.15
    assert of_thesis("shifts") < ours("shifts")


def test_recognition_of_drawn_triangles() -> None:
    """From pixels to match: raster, tracer, lengths. A triangle without 3 key points is none."""
    same, others = [], []
    for three in pairs()[:DRAWN]:
        found = [find_key_points(raster(vertices)) for vertices in three]
        lists = [
            scaled(side_lengths(points[0])) if [len(p) for p in points] == [3] else None
            for points in found
        ]
        a, b, c = lists
        same.append(999 if a is None or b is None else distance(a, b))
        others.append(999 if a is None or c is None else distance(a, c))
    assert true_positives(same, others) >= 0.88


def test_the_tolerance_admits_one_in_twenty() -> None:
    lists = [[scaled(side_lengths(pixels(v))) for v in three] for three in pairs()]
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


def test_the_first_of_equal_matches_is_taken() -> None:
    references = [[128, 60, 90], [128, 64, 96], [64, 96, 128]]
    assert best_match([20, 30, 40], references) == Match(1, 0)
    assert best_match([20, 30, 40], references[:1], 5) is None
    assert best_match([20, 30, 40], references[:1], 6) == Match(0, 6)
    assert best_match([20, 30, 40], []) is None
