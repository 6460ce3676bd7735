"""Table 3.1 of the thesis: one estimator of the camera's position, trained once. Needs SciPy."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from npchip.host.vision.orientation import dataset, experiment
from npchip.host.vision.orientation.experiment import ANGLE_ERRORS, Estimate, Operations
from npchip.host.vision.orientation.models import MODELS, Estimator, rms, train_model
from npchip.host.vision.orientation.network import Split, split
from npchip.host.vision.orientation.scene import (
    CAMERAS,
    cartesian_bhaskara,
    polar_and_azimuth,
    yaw_and_pitch,
)

CONSTANT, SINE = "constant guess", "hybrid, Bhaskara's sine"


def error(estimator: str, pictures: str, poses: int, seed: int) -> dict[str, float | None]:
    """Return the RMS errors in mm on the poses that the training has not seen, and operations.

    Args:
        estimator: a row of the table.
        pictures: source of the vertices and size of the frame, such as ``rendered 100x100``.
        poses: seed of the poses.
        seed: of the split and of the first weights.
    """
    data = _data(pictures, poses)
    parts = split(len(data), seed)
    true, seen = data.positions[parts.test], data.vertices[parts.test]
    exact = yaw_and_pitch(true)
    cost, estimate = _trained(estimator, pictures, poses, seed)
    found = rms(estimate(seen, exact) - true)
    row: dict[str, float | None] = dict(zip("xyz", found.tolist(), strict=True))
    row["total"] = float(np.linalg.norm(found))
    for number, errors in enumerate(ANGLE_ERRORS, 1):
        angles = exact + np.random.default_rng((seed, 3, number)).normal(size=exact.shape) * errors
        off = np.linalg.norm(rms(estimate(seen, angles) - true))
        row["total_{:g}_{:g}".format(*errors)] = float(off) if _is_directed(estimator) else None
    return row | {
        "inputs": cost.inputs,
        "multiplications": cost.multiplications,
        "constants": cost.constants,
    }


def _is_directed(estimator: str) -> bool:
    if estimator == CONSTANT:
        return False
    network = experiment.NETWORKS.get(estimator)
    return network is None or MODELS[network[0]].directed


@lru_cache(maxsize=4)
def _data(pictures: str, poses: int) -> dataset.DataSet:
    source: Any
    source, size = pictures.split()
    return dataset.make(dataset.Settings(seed=poses, source=source, camera=CAMERAS[size]))


@lru_cache(maxsize=16)
def _trained(estimator: str, pictures: str, poses: int, seed: int) -> tuple[Operations, Estimate]:
    data = _data(pictures, poses)
    parts = split(len(data), seed)
    if estimator == CONSTANT:
        middle = data.positions[parts.train].mean(axis=0)
        return Operations(), lambda seen, _: np.broadcast_to(middle, (len(seen), 3))
    if estimator == experiment.DIRECT:
        return experiment.least_squares(data, parts)
    if estimator in (experiment.EIGHT_BITS, experiment.EIGHT_BITS_10):
        neurons = 10 if estimator == experiment.EIGHT_BITS_10 else 15
        return experiment.eight_bits(data, parts, neurons, seed)
    if estimator == SINE:
        cost, hybrid = _trained("hybrid", pictures, poses, seed)
        assert isinstance(hybrid, Estimator)
        return cost, lambda seen, angles: _with_sine(hybrid, seen, angles)
    return _network(estimator, data, parts, seed)


def _with_sine(hybrid: Estimator, seen: np.ndarray, angles: np.ndarray) -> np.ndarray:
    radial = hybrid.network(MODELS["hybrid"].inputs(seen))
    return cartesian_bhaskara(np.hstack([radial, polar_and_azimuth(angles)]))


def _network(
    name: str, data: dataset.DataSet, parts: Split, seed: int
) -> tuple[Operations, Estimate]:
    model, neurons = experiment.NETWORKS[name]
    found = train_model(model, data, parts, neurons=neurons, seed=seed)
    cost = Operations.of(found)
    if MODELS[model].directed:
        return cost, found
    return cost, lambda seen, _: found(seen)
