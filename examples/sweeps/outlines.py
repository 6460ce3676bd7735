"""Classification of convex shapes by their outlines: experiments of sweeps in this folder.

Shapes are drawn as those of `keypoint_measures`. Masks are judged by the host's models, which the
programs equal; signs run on the emulated chip, with the noise of its sensor.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from npchip import Chip, Machine, assemble
from npchip.bundle import find
from npchip.host.vision.keypoints import find_key_points
from npchip.host.vision.outlines import find_outlines, is_regular
from npchip.host.vision.polygons import (
    FRAME,
    Vertices,
    random_convex_polygon,
    random_regular_polygon,
    raster,
)
from npchip.host.vision.signs import stop_sign

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

SHAPES, NESTED, SIGNS = 200, 100, 40
"""Numbers of pictures in a set."""

THRESHOLDS = {"trees": {"THRESHOLD": 90}, "sky": {"THRESHOLD": 128, "DARK": 1}}
"""Constants of the programs: before trees the white border is the object, else the red."""


def within(found: Sequence[Sequence[float]], vertices: Vertices, pixels: float) -> bool:
    """Return whether there are as many corners as vertices, each vertex near one."""
    if len(found) != len(vertices):
        return False
    apart = np.linalg.norm(np.asarray(found, float)[:, np.newaxis] - vertices, axis=2)
    return bool((apart.min(axis=0) <= pixels).all())


def polygons_found(kind: str, sides: int, seed: int) -> dict[str, float]:
    """Return how often a set of polygons has the right number of corners.

    Args:
        kind: ``convex`` for `random_convex_polygon`, ``regular`` for `random_regular_polygon`.
        sides: number of sides.
        seed: of the polygons.

    Returns:
        parts: ``tracer`` and ``outline`` find exactly the corners, the outline ``fewer`` or
        ``more``, all ``within_3`` pixels; ``regular``: of those with all corners.
    """
    rng = np.random.default_rng((sides, seed))
    draw = random_convex_polygon if kind == "convex" else random_regular_polygon
    tracer, counts, near, regular = [], [], [], []
    for _ in range(SHAPES):
        vertices = draw(rng, sides)
        mask = raster(vertices)
        tracer.append([len(points) for points in find_key_points(mask)] == [sides])
        found = max(find_outlines(mask), key=len, default=[])
        counts.append(len(found))
        near.append(within(found, vertices, 3))
        if len(found) == sides:
            regular.append(is_regular(found))
    each = np.array(counts)
    return {
        "tracer": float(np.mean(tracer)),
        "outline": float(np.mean(each == sides)),
        "fewer": float(np.mean(each < sides)),
        "more": float(np.mean(each > sides)),
        "within_3": float(np.mean(near)),
        "regular": float(np.mean(regular)),
    }


def nested_found(seed: int) -> dict[str, float]:
    """Return how often a ring with a square in it is two objects, and with all corners.

    The ring has 4 to 8 sides, a radius of 26 to 30 pixels outside and 18 inside; the square is
    turned at random.
    """
    rng = np.random.default_rng(seed)
    tracer, outline, corners = [], [], []
    for _ in range(NESTED):
        sides = int(rng.integers(4, 9))
        ring = random_regular_polygon(rng, sides, (26, 30))
        middle = ring.mean(axis=0)
        hole = (ring - middle) * 18 / np.linalg.norm(ring[0] - middle) + middle
        square = random_regular_polygon(rng, 4, (7, 9))
        mask = raster(ring) & ~raster(hole) | raster(square - square.mean(axis=0) + middle)
        tracer.append(len(find_key_points(mask)) == 2)
        counts = [len(found) for found in find_outlines(mask)]
        outline.append(len(counts) == 2)
        corners.append(counts == [sides, 4])
    return {
        "tracer": float(np.mean(tracer)),
        "outline": float(np.mean(outline)),
        "corners": float(np.mean(corners)),
    }


def signs_found(machine: Machine, ground: str, seed: int) -> dict[str, float]:
    """Return how often the chip finds STOP signs.

    Args:
        machine: machine with its sensor.
        ground: ``trees`` or ``sky``.
        seed: of the signs and of the sensor.

    Returns:
        parts: ``octagon``, exactly one object with 8 corners, all within 3 pixels of the sign's;
        ``stop``: and it is regular; ``tracer``: exactly one object with 8 key points.
    """
    corners, frames = _signs(ground, seed)
    other = replace(machine, sensor=replace(machine.sensor, seed=seed))
    defines = THRESHOLDS[ground]
    sent = {
        name: Chip(assemble(find("program", name), other, defines=defines), other).run(frames)
        for name in ("polygons", "keypoints")
    }
    octagons, stops, tracer = [], [], []
    for frame, vertices in enumerate(corners):
        counts = np.array(sent["polygons"].value("count", frame) or [], int)
        regular = np.array(sent["polygons"].value("regular", frame) or [], int)
        points = np.array(sent["polygons"].value("points", frame) or [], float).reshape(-1, 2)
        each = np.split(points, np.cumsum(counts)[:-1])
        eight = np.flatnonzero(counts == 8)
        right = len(eight) == 1 and within(each[eight[0]].tolist(), vertices, 3)
        octagons.append(right)
        stops.append(right and bool(regular[eight[0]]))
        traced = np.array(sent["keypoints"].value("count", frame) or [], int)
        tracer.append(int((traced == 8).sum()) == 1)
    return {
        "octagon": float(np.mean(octagons)),
        "stop": float(np.mean(stops)),
        "tracer": float(np.mean(tracer)),
    }


@cache
def _signs(ground: str, seed: int) -> tuple[list[Vertices], NDArray[np.uint8]]:
    rng = np.random.default_rng(seed)
    drawn = [stop_sign(rng, ground) for _ in range(SIGNS)]
    return [corners for _, corners in drawn], np.array([picture for picture, _ in drawn])


def disc_corners(radius: float) -> int:
    """Return the number of corners that the outline of a disc has."""
    rows, cols = np.indices(FRAME)
    (found,) = find_outlines((rows - 32) ** 2 + (cols - 40) ** 2 <= radius**2)
    return len(found)
