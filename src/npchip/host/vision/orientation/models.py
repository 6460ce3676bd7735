"""From vertices to positions: the four networks of thesis 3.4, and one more.

| model | inputs | outputs | needs |
| --- | --- | --- | --- |
| ``sides`` (3.4.3) | the side lengths in random order | x, y, z | |
| ``vertices`` (3.4.4) | row and column of each vertex | x, y, z | highlight |
| ``spherical`` (3.4.5) | the side lengths in order | radial distance, polar, azimuth | highlight |
| ``hybrid`` (3.4.6) | the side lengths in order | radial distance | highlight, compass, pitch |
| ``ratios`` (decision) | two sides over the perimeter | radial distance times perimeter | same |

The size of a picture is inversely proportional to the distance, and its shape depends on the
direction: ``ratios`` leaves only the shape to the network.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from itertools import permutations
from pathlib import Path
from typing import Any, Final
from zlib import crc32

import numpy as np

from npchip.base.files import write_text
from npchip.base.json import indented
from npchip.host.vision.orientation.dataset import DataSet
from npchip.host.vision.orientation.files import KIND, read_document
from npchip.host.vision.orientation.network import Network, Split, train
from npchip.host.vision.orientation.scene import (
    Camera,
    Floats,
    cartesian,
    polar_and_azimuth,
    spherical,
)

SCHEMA: Final = 2
_CORNERS: Final = 1
"""The schema whose whole numbers were corners of pixels, not middles."""

_ORDERS: Final = np.array(list(permutations(range(3))))


def side_lengths(vertices: Floats) -> Floats:
    """Return the lengths of the sides from the highlighted vertex on: shape (N, 3), in pixels."""
    return np.asarray(np.linalg.norm(np.roll(vertices, -1, axis=1) - vertices, axis=2))


def shuffled_side_lengths(vertices: Floats) -> Floats:
    """Return the lengths of the sides in an arbitrary order: shape (N, 3), in pixels.

    Without a highlight neither the first side of a triangle nor the direction is known. The order
    follows from a checksum of the vertices (decision): it is the same for the same picture.
    """
    numbers = [crc32(triangle.tobytes()) % len(_ORDERS) for triangle in vertices]
    return np.take_along_axis(side_lengths(vertices), _ORDERS[numbers], axis=1)


def _ratios(vertices: Floats) -> Floats:
    sides = side_lengths(vertices)
    return np.asarray(sides[:, :2] / sides.sum(axis=1, keepdims=True))


@dataclass(frozen=True)
class Model:
    """Inputs and outputs of a network.

    Attributes:
        inputs: function from vertices, shape (N, 3, 2), to inputs, shape (N, inputs).
        targets: function from positions and vertices to targets, shape (N, outputs).
        positions: function from outputs, vertices and directions (yaw and pitch in degrees, shape
            (N, 2)) to positions, shape (N, 3), in mm.
        directed: whether it needs directions.
        neurons: number of hidden neurons: that of the thesis, or the fewest that suffice.
        extra: multiplications and divisions besides those of the network.
    """

    inputs: Callable[[Floats], Floats]
    targets: Callable[[Floats, Floats], Floats]
    positions: Callable[[Floats, Floats, Floats | None], Floats]
    directed: bool = False
    neurons: int = 15
    extra: int = 0


def from_radial(radial: Floats, directions: Floats | None) -> Floats:
    """Return positions at radial distances, shape (N,), in known directions."""
    assert directions is not None
    return cartesian(np.column_stack([radial, polar_and_azimuth(directions)]))


def _perimeter(vertices: Floats) -> Floats:
    return np.asarray(side_lengths(vertices).sum(axis=1))


MODELS: Final[dict[str, Model]] = {
    "sides": Model(shuffled_side_lengths, lambda p, _v: p, lambda y, _v, _d: y),
    "vertices": Model(lambda v: v.reshape(len(v), 6), lambda p, _v: p, lambda y, _v, _d: y),
    "spherical": Model(side_lengths, lambda p, _v: spherical(p), lambda y, _v, _d: cartesian(y)),
    "hybrid": Model(
        side_lengths,
        lambda p, _v: spherical(p)[:, :1],
        lambda y, _v, d: from_radial(y[:, 0], d),
        directed=True,
    ),
    "ratios": Model(
        _ratios,
        lambda p, v: spherical(p)[:, :1] * _perimeter(v)[:, np.newaxis],
        lambda y, v, d: from_radial(y[:, 0] / _perimeter(v), d),
        directed=True,
        neurons=6,
        extra=3,
    ),
}


@dataclass(frozen=True)
class Estimator:
    """A trained model.

    Attributes:
        model: a key of `MODELS`.
        camera: camera of the pictures.
        network: the network.
        trained: settings of the data set, seed, steps, and RMS error on the test set.
    """

    model: str
    camera: Camera
    network: Network
    trained: dict[str, Any]

    def __call__(self, vertices: Floats, directions: Floats | None = None) -> Floats:
        """Estimate positions.

        Args:
            vertices: vertices in pixels, shape (N, 3, 2).
            directions: yaw and pitch in degrees, shape (N, 2), if the model needs them.

        Returns:
            shape (N, 3), in mm.
        """
        kind = MODELS[self.model]
        return kind.positions(self.network(kind.inputs(vertices)), vertices, directions)


def train_model(
    name: str,
    data: DataSet,
    parts: Split,
    *,
    neurons: int | None = None,
    seed: int = 0,
    progress: Callable[[], None] = lambda: None,
) -> Estimator:
    """Train a model; the same data, parts and seed give the same one on one BLAS thread.

    Args:
        name: a key of `MODELS`.
        data: the data set.
        parts: samples to train, validate and test with.
        neurons: number of neurons in the hidden layer; None for that of the model.
        seed: seed of the first weights.
        progress: called at every step.

    Raises:
        InputError: NP453, `neurons` out of range; NP455, SciPy is not installed.
    """
    kind = MODELS[name]
    neurons = kind.neurons if neurons is None else neurons
    inputs, targets = kind.inputs(data.vertices), kind.targets(data.positions, data.vertices)
    network, steps = train(inputs, targets, parts, neurons=neurons, seed=seed, progress=progress)
    trained = {"data": asdict(data.settings), "seed": seed, "steps": steps}
    return Estimator(name, data.settings.camera, network, trained)


def rms(errors: Floats) -> Floats:
    """Return the RMS along each axis: shape (3,)."""
    return np.asarray(np.sqrt(np.mean(errors**2, axis=0)))


# ---- files


def save(path: Path, estimator: Estimator) -> None:
    """Write a trained model as JSON, whole or not at all.

    Raises:
        InputError: NP250, it cannot be written.
    """
    document = {
        "kind": KIND,
        "schema": SCHEMA,
        "model": estimator.model,
        "camera": asdict(estimator.camera),
        "network": estimator.network.document(),
        "trained": estimator.trained,
    }
    write_text(path, indented(document))


def load(path: Path) -> Estimator:
    """Read a trained model.

    Raises:
        InputError: NP456, it is not such a file, or damaged.
    """
    return read_document(path, KIND, (_CORNERS, SCHEMA), _checked)


def _checked(document: dict[str, Any]) -> Estimator:
    name = document["model"]
    if name not in MODELS:
        raise ValueError(f"unknown model {name!r}")
    network = Network.of_document(document["network"])
    if document["schema"] == _CORNERS and name == "vertices":
        network = replace(network, middle=network.middle - 0.5)
    kind, sample = MODELS[name], np.array([[[10.0, 10], [30, 12], [12, 40]]])
    outputs = network(kind.inputs(sample))
    if outputs.shape != kind.targets(np.zeros((1, 3)), sample).shape:
        raise ValueError(f"{outputs.shape[1]} outputs are not those of model {name}")
    return Estimator(name, Camera(**document["camera"]), network, dict(document["trained"]))
