"""Measure how well key points are found and shapes told apart: thesis 3.3 on random shapes.

Triangles have no angle below 20 degrees; pixels belong to a shape that covers at least 20 % of
them; a key point is compared with a true vertex from the centre of its pixel. The functions at the
end are the experiments of sweeps, which `examples.keypoint_page` writes into docs/keypoints.md; the
others are tested in tests/host/vision/.
"""

from __future__ import annotations

from functools import cache
from itertools import permutations
from math import acos, degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from npchip.host.vision.keypoints import (
    BEST,
    LITERAL,
    REVERSAL,
    RUN_LENGTHS,
    Reading,
    Step,
    farthest_points,
    find_key_points,
    key_points,
    trace_edges,
)
from npchip.host.vision.polygons import (
    Kind,
    Mask,
    Vertices,
    hinged,
    random_convex_polygon,
    random_triangle,
    random_triangles,
    raster,
)
from npchip.host.vision.shapes import Length, distance, scaled, side_lengths, thesis_distance

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Points = Sequence[tuple[int, int]]
    Numbers = Sequence[float | None] | NDArray[np.float64]
    Distance = Callable[[Sequence[int], Sequence[int]], float | None]

# ---- finding corners


@cache
def triangles(kind: Kind, count: int, seed: int = 1) -> list[tuple[Vertices, Mask]]:
    """Random triangles and their pixels; the longest side has 15 to 60."""
    rng = np.random.default_rng(seed)
    shapes = [random_triangle(rng, kind) for _ in range(count)]
    return [(vertices, raster(vertices)) for vertices in shapes]


@cache
def traces(kind: Kind, count: int, seed: int = 1) -> list[list[list[Step]]]:
    """Trace the edges of random triangles."""
    return [trace_edges(mask) for _, mask in triangles(kind, count, seed)]


def error(points: Points, vertices: Vertices) -> float:
    """Largest distance of three points from three vertices, in the best order."""
    if len(points) != 3:
        return np.inf
    return min(
        float(np.linalg.norm(points - vertices[list(order)], axis=1).max())
        for order in permutations(range(3))
    )


def rates(errors: Sequence[float]) -> tuple[float, float, float]:
    """Parts of the triangles with three points, all within 2 pixels, all within 3."""
    three, two_pixels, three_pixels = (float(np.mean(np.array(errors) < d)) for d in (1e9, 2, 3))
    return three, two_pixels, three_pixels


def tracer_rates(
    kind: Kind, reading: Reading, count: int, seed: int = 1
) -> tuple[float, float, float]:
    """`rates` of the key points of `count` random triangles."""
    pairs = zip(traces(kind, count, seed), triangles(kind, count, seed), strict=True)
    return rates([error(key_points(found[0], reading), vertices) for found, (vertices, _) in pairs])


def complete_scenes(objects: int, scenes: int, seed: int = 0) -> tuple[float, float]:
    """Scenes with several triangles: parts with the right number, and with all corners.

    All corners: each triangle has three key points within 3 pixels of its vertices.
    """
    rng = np.random.default_rng((objects, seed) if seed else objects)
    counted, complete = [], []
    for _ in range(scenes):
        shapes, mask = random_triangles(rng, objects)
        found = find_key_points(mask)
        counted.append(len(found) == objects)
        complete.append(all(min(error(points, v) for points in found) < 3 for v in shapes))
    return float(np.mean(counted)), float(np.mean(complete))


# ---- telling shapes apart


def random_sides(rng: np.random.Generator) -> NDArray[np.float64]:
    """Sides of a triangle, 20 to 60 pixels each."""
    while True:
        sides = rng.uniform(20, 60, 3)
        a, b, c = sorted(sides)
        if a + b > c and degrees(acos((b * b + c * c - a * a) / (2 * b * c))) >= 20:
            return sides


def place(rng: np.random.Generator, corners: Vertices) -> Vertices:
    """Turn and move a shape at random, until it fits into the frame."""
    while True:
        angle = rng.uniform(0, 2 * np.pi)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        turned = corners @ turn.T
        turned -= turned.min(axis=0)
        room = np.array([62, 78]) - turned.max(axis=0)
        if (room >= 0).all():
            placed: Vertices = turned + 1 + rng.uniform((0, 0), room) - 0.5
            return placed


def triangle_of(sides: NDArray[np.float64]) -> Vertices:
    """Corners of a triangle with these sides."""
    a, b, c = sides
    along = (a * a + c * c - b * b) / (2 * a)
    return np.array([[0, 0], [0, a], [np.sqrt(c * c - along * along), along]])


@cache
def pairs(count: int, seed: int = 3) -> list[tuple[Vertices, Vertices, Vertices]]:
    """Triangles, each with the same one in another pose and size, and with another one."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        sides, others = random_sides(rng), random_sides(rng)
        again = sides * rng.uniform(20 / sides.min(), 60 / sides.max())
        three = (place(rng, triangle_of(each)) for each in (sides, again, others))
        found.append((next(three), next(three), next(three)))
    return found


def pixels(vertices: Vertices) -> Points:
    """The pixels that corners lie in."""
    return [(round(row), round(col)) for row, col in vertices.tolist()]


def true_positives(same: Numbers, others: Numbers) -> float:
    """Part of the same pairs that match where at most 5 % of the others do."""
    a, b = np.array(same, float), np.array(others, float)
    return max(float((a <= t).mean()) for t in np.unique([*a, *b]) if (b <= t).mean() <= 0.05)


def recognised(how: Length, count: int, seed: int = 3, *, thesis: bool = False) -> float:
    """True positives at 5 % false ones, by our distance or that of thesis 3.3.3."""
    lists = [[side_lengths(pixels(v), how) for v in three] for three in pairs(count, seed)]
    compare: Distance = thesis_distance
    if not thesis:
        lists = [[scaled(sides) for sides in three] for three in lists]
        compare = distance
    return true_positives(
        [compare(a, b) for a, b, _ in lists], [compare(a, c) for a, _, c in lists]
    )


def recognised_from_pixels(count: int, seed: int = 3) -> float:
    """The same from raster to match. A triangle without three key points matches none."""
    same, others = [], []
    for three in pairs(count, seed):
        found = [find_key_points(raster(vertices)) for vertices in three]
        a, b, c = (
            scaled(side_lengths(points[0])) if [len(p) for p in points] == [3] else None
            for points in found
        )
        same.append(999 if a is None or b is None else distance(a, b))
        others.append(999 if a is None or c is None else distance(a, c))
    return true_positives(same, others)


# ---- polygons with more sides


@cache
def polygons(
    corners: int, count: int, seed: int = 0
) -> list[tuple[Vertices, Vertices, Vertices, Vertices | None]]:
    """Convex polygons, each with itself in another pose, another one, and one of the same sides.

    The last is hinged: sides of the same lengths in the same order, other angles. A triangle has
    none, and a few others hardly bend.
    """
    rng = np.random.default_rng((corners, seed) if seed else corners)
    found = []
    for _ in range(count):
        shape, other = (random_convex_polygon(rng, corners) for _ in range(2))
        again = place(rng, shape * rng.uniform(0.7, 1))
        bent = hinged(rng, shape) if corners > 3 else None
        if bent is not None:
            across = np.linalg.norm(bent[:, np.newaxis] - bent, axis=2).max()
            bent = place(rng, bent * min(1, 60 / across))
        found.append((shape, again, other, bent))
    return found


def polygon_rates(corners: int, count: int, seed: int = 0) -> tuple[float, float]:
    """Return the rates at which polygons with true corners match: the same ones, and hinged ones.

    The threshold is the one at which 5 % of other polygons match.
    """
    lists = [
        [None if v is None else scaled(side_lengths(pixels(v))) for v in four]
        for four in polygons(corners, count, seed)
    ]
    same, others, bent = (
        np.array([distance(four[0] or [], four[k] or []) for four in lists if four[k]], float)
        for k in (1, 2, 3)
    )
    rate = true_positives(same, others)
    threshold = float(np.quantile(same, rate, method="inverted_cdf"))
    return rate, float(np.mean(bent <= threshold)) if len(bent) else np.nan


def corner_rate(corners: int, count: int, seed: int = 0) -> float:
    """Part of the drawn polygons in which the tracer finds exactly as many key points."""
    found = (find_key_points(raster(four[0])) for four in polygons(corners, count, seed))
    return float(np.mean([[len(p) for p in points] == [corners] for points in found]))


# ---- experiments; a set has so many shapes

TRIANGLES, SCENES, PAIRS, DRAWN, POLYGONS = 400, 100, 1_000, 200, 100
READINGS = {
    "literal": LITERAL,
    "reversal": REVERSAL,
    "run lengths": RUN_LENGTHS,
    "bends": BEST,
}


def corners_found(rule: str, kind: Kind, seed: int) -> dict[str, float]:
    """Return the rates of a set of triangles, by a reading of the tracer or by ``farthest``."""
    if rule == "farthest":
        shapes = triangles(kind, TRIANGLES, seed)
        found = rates([error(farthest_points(mask), vertices) for vertices, mask in shapes])
    else:
        found = tracer_rates(kind, READINGS[rule], TRIANGLES, seed)
    return dict(zip(("three", "within_2", "within_3"), found, strict=True))


def scenes_found(objects: int, seed: int) -> dict[str, float]:
    """Return the parts of a set of scenes with the right number of triangles, and all corners."""
    counted, complete = complete_scenes(objects, SCENES, seed)
    return {"counted": counted, "complete": complete}


def triangles_recognised(rule: str, lengths: str, seed: int) -> dict[str, float]:
    """Return the true positives at 5 % false ones in a set of pairs.

    Args:
        rule: ``ours`` or ``thesis``.
        lengths: how sides are measured.
        seed: of the pairs.
    """
    how: Any = lengths
    return {"rate": recognised(how, PAIRS, seed, thesis=rule == "thesis")}


def drawn_recognised(seed: int) -> dict[str, float]:
    """Return the same from drawn pixels to the match, by our rule and lengths."""
    return {"rate": recognised_from_pixels(DRAWN, seed)}


def polygons_told(sides: int, seed: int) -> dict[str, float | None]:
    """Return how polygons of as many sides are told apart, and how often all corners are found."""
    rate, bent = polygon_rates(sides, POLYGONS, seed)
    hinged = None if np.isnan(bent) else bent
    return {"rate": rate, "hinged": hinged, "corners": corner_rate(sides, POLYGONS, seed)}
