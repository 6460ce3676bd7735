"""Limits of programs and cameras: experiments of the sweeps in this folder.

Each function is called with the values along the axes of its sweep file. Noise, pattern and light
are those of the machine's sensor, whose seed is replaced, so that seeds are other chips.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import permutations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from npchip import Chip, Machine, assemble
from npchip.bundle import find
from npchip.host.scenes import read_scene
from npchip.host.scenes import render as draw
from npchip.host.vision.fusion.experiment import SETTINGS, Experiment, rms
from npchip.host.vision.orientation import eightbit
from npchip.host.vision.orientation.pictures import render
from npchip.host.vision.orientation.scene import CAMERAS, random_positions, spherical
from npchip.host.vision.polygons import Vertices, random_triangle, raster

if TYPE_CHECKING:
    from numpy.typing import NDArray

BACKGROUND, CONTRAST = 30, 120
"""Levels of the pictures of triangles."""

TRIANGLES, POSES, PATHS = 60, 100, 100
WEIGHTS = Path(__file__).parents[1] / "orientation" / "weights-64x80.npy"


def chip(program: str, machine: Machine, seed: int, threshold: int) -> Chip:
    """Make a chip whose sensor has another seed."""
    other = replace(machine, sensor=replace(machine.sensor, seed=seed))
    defines = {"THRESHOLD": threshold}
    return Chip(assemble(find("program", program), other, defines=defines), other)


def followed(machine: Machine, program: str, threshold: int, seed: int) -> dict[str, float | None]:
    """Return the error of the prediction of the next frame in pixels, of a ball on a circle.

    Args:
        machine: machine with its sensor.
        program: ``follow`` or ``follow_many``, of whose objects the first one counts.
        threshold: its ``THRESHOLD``.
        seed: of the sensor.

    Returns:
        ``rms``: over the frames in which an object is seen, None without any; ``seen``: their
        part of all frames.
    """
    frames, truth = _ball()
    sent = chip(program, machine, seed, threshold).run(frames)
    errors = []
    for frame in range(len(frames) - 1):
        names = ("count" if program == "follow_many" else "valid", "predicted_row", "predicted_col")
        there, *expected = (sent.value(name, frame) for name in names)
        if there:
            place = [np.ravel(np.array(axis))[0] for axis in expected]
            errors.append(np.subtract(place, truth[frame + 1]))
    return {
        "rms": float(np.sqrt(np.square(errors).sum(axis=-1).mean())) if errors else None,
        "seen": len(errors) / (len(frames) - 1),
    }


@cache
def _ball() -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """Return the frames of ``circling-quiet.yaml`` and the true centres, (T, 2)."""
    scene = read_scene(Path(__file__).parent / "circling-quiet.yaml")
    frames, truth = draw(scene)
    return frames, truth.centers[:, 0]


def corners(machine: Machine, program: str, threshold: int, seed: int) -> dict[str, float]:
    """Return in which part of the pictures of a triangle all corners are found within 3 pixels.

    Args:
        machine: machine with its sensor.
        program: ``keypoints`` or ``keypoints_farthest``.
        threshold: its ``THRESHOLD``.
        seed: of the triangles and of the sensor.
    """
    vertices, frames = triangles(seed)
    result = chip(program, machine, seed, threshold).run(frames)
    found = [_points(result.value("points", frame)) for frame in range(len(frames))]
    errors = np.array([_error(*pair) for pair in zip(found, vertices, strict=True)])
    return {"within_3": float((errors < 3).mean()), "three": float(np.isfinite(errors).mean())}


@cache
def triangles(seed: int) -> tuple[list[Vertices], NDArray[np.uint8]]:
    """Return the corners of `TRIANGLES` triangles, and their frames of 64 x 80 pixels."""
    rng = np.random.default_rng(seed)
    vertices = [random_triangle(rng, ("acute", "obtuse")[k % 2]) for k in range(TRIANGLES)]
    masks = np.array([raster(each) for each in vertices])
    return vertices, np.where(masks, BACKGROUND + CONTRAST, BACKGROUND).astype(np.uint8)


def _points(sent: object) -> NDArray[np.int64]:
    return np.reshape(np.array(sent or [], np.int64), (-1, 2))


def _error(points: NDArray[np.int64], vertices: Vertices) -> float:
    """Return the largest distance of three points from three vertices, in the best order."""
    if len(points) != 3:
        return np.inf
    return min(
        float(np.linalg.norm(points - vertices[list(order)], axis=1).max())
        for order in permutations(range(3))
    )


def distance(machine: Machine, threshold: int, seed: int) -> dict[str, float]:
    """Return the error of the distance in mm that ``orientation.s`` sends, at 64 x 80 pixels.

    Args:
        machine: machine with its sensor.
        threshold: the program's ``THRESHOLD``.
        seed: of the poses and of the sensor.
    """
    made = chip("orientation", machine, seed, threshold)
    made.load_memory(eightbit.ADDRESS, np.load(WEIGHTS))
    radial, frames = poses(seed)
    sent: Any = np.ma.asarray(made.run(frames).outputs["distance"], float)
    errors = np.abs(sent.filled(0) - radial)
    return {"rms": float(np.sqrt((errors**2).mean())), "median": float(np.median(errors))}


@cache
def poses(seed: int) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
    """Return the distances in mm of `POSES` poses, and their frames of 64 x 80 pixels."""
    camera = CAMERAS["64x80"]
    positions = random_positions(POSES, seed, camera)
    return spherical(positions)[:, 0], render(positions, camera)


def misaligned(algorithm: str, turned: str, degrees: float, seed: int) -> dict[str, float]:
    """Return the RMS error in metres where camera 2 is not as the algorithm takes it to be.

    Args:
        algorithm: a name of `npchip.host.vision.fusion.registry.ALGORITHMS`.
        turned: ``pan`` about the vertical, ``tilt`` about the horizontal across its view, ``roll``
            about its view.
        degrees: by how much camera 2 is turned.
        seed: of the paths.
    """
    drawn = Experiment.draw(SETTINGS["thesis"], PATHS, seed)
    camera = drawn.setting.rig.camera2  # it looks along x
    axis = {"pan": 2, "tilt": 1, "roll": 0}[turned]
    angle = np.radians(degrees)
    turn = np.eye(3)
    one, two = (axis + 1) % 3, (axis + 2) % 3
    turn[[one, two], [one, two]] = np.cos(angle)
    turn[one, two], turn[two, one] = -np.sin(angle), np.sin(angle)
    seen = camera.observe((drawn.truth - camera.position) @ turn.T + camera.position)
    real = replace(drawn, seen2=seen)
    integers = algorithm not in ("midpoint", "reprojection")
    form = drawn.setting.form if integers else None
    found = real.locate(algorithm, form)
    return {
        "rms": rms(found.points, drawn.truth),
        "seen": float(np.isfinite(seen[..., 0]).mean()),
    }
