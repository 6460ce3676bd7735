"""Measurement of table 3.1: the thesis's networks and better estimators, on the same pictures.

Every row is the median of several seeds, each with its own split and first weights. Errors are
those on the 15 % that the training has not seen. The angles of compass and pitch are exact, or have
normally distributed errors of the size in the row (decision).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any, Final

import numpy as np

from npchip.host.vision.orientation import direct, eightbit
from npchip.host.vision.orientation.dataset import DataSet
from npchip.host.vision.orientation.models import MODELS, Estimator, from_radial, rms, train_model
from npchip.host.vision.orientation.network import Split, split
from npchip.host.vision.orientation.scene import (
    Floats,
    cartesian_bhaskara,
    polar_and_azimuth,
    yaw_and_pitch,
)

Errors = tuple[float, float]
"""Standard deviations of compass and pitch, in degrees."""

ANGLE_ERRORS: Final[tuple[Errors, ...]] = ((1.0, 1.0), (2.0, 1.0), (5.0, 2.0))
SCHEMA: Final = 1

THESIS_ROWS: Final = {
    "side lengths": (589.9, 530.1, 225.2),
    "vertices": (193.6, 172.9, 203.7),
    "hybrid": (34.2, 24.6, 47.4),
}
"""Table 3.1: RMS errors along x, y and z, in mm."""


@dataclass(frozen=True)
class Operations:
    """Operations of one estimate.

    Attributes:
        inputs: number of inputs.
        multiplications: multiplications, divisions and roots, without those of side lengths.
        activations: number of hidden neurons.
        constants: weights, biases and offsets.
    """

    inputs: int = 0
    multiplications: int = 0
    activations: int = 0
    constants: int = 0

    @staticmethod
    def of(estimator: Estimator) -> Operations:
        """Count the operations of a network whose weights include the scaling."""
        network = estimator.network
        neurons, inputs = network.hidden.shape
        outputs = len(network.offset)
        weights = neurons * (inputs + outputs)
        extra = MODELS[estimator.model].extra
        return Operations(inputs, weights + extra, neurons, weights + neurons + outputs)


@dataclass
class Row:
    """One line of the table.

    Attributes:
        name: the estimator.
        operations: operations of one estimate.
        angle_errors: errors of compass and pitch; None for an estimator without them.
        thesis: RMS errors along x, y and z in the thesis, if any.
        measured: RMS errors along x, y and z, for each seed.
    """

    name: str
    operations: Operations
    angle_errors: Errors | None = None
    thesis: tuple[float, float, float] | None = None
    measured: list[Floats] = field(default_factory=list)

    @property
    def median(self) -> Floats:
        """Median of all seeds along x, y and z, in mm: shape (3,)."""
        return np.median(self.measured, axis=0)

    @property
    def totals(self) -> Floats:
        """Root of the sum of the three squares, for each seed."""
        return np.asarray(np.linalg.norm(self.measured, axis=1))

    @property
    def total(self) -> float:
        """Median of `totals`."""
        return float(np.median(self.totals))


@dataclass(frozen=True)
class Table:
    """Rows, and the data set and number of seeds of their measurement."""

    data: dict[str, Any]
    seeds: int
    rows: list[Row]

    def row(self, name: str, angle_errors: Errors | None = None) -> Row:
        """Return the row of a name, with these errors of the angles if they are given.

        Raises:
            KeyError: there is no such row.
        """
        for row in self.rows:
            if row.name == name and angle_errors in (None, row.angle_errors):
                return row
        raise KeyError(name)

    def document(self) -> dict[str, Any]:
        """Return the table as plain data, schema 1 of ``docs/orientation.md``."""
        return {
            "schema": SCHEMA,
            "data": self.data,
            "seeds": self.seeds,
            "rows": [
                {
                    "name": row.name,
                    "angle_errors_deg": row.angle_errors and list(row.angle_errors),
                    "thesis_rms_mm": row.thesis and list(row.thesis),
                    "rms_mm": row.median.round(2).tolist(),
                    "total_mm": round(row.total, 2),
                    "totals_mm": row.totals.round(2).tolist(),
                    **asdict(row.operations),
                }
                for row in self.rows
            ],
        }


Estimate = Callable[[Floats, Floats], Floats]
"""Function of vertices, shape (N, 3, 2), and directions, shape (N, 2); positions (N, 3)."""

NETWORKS: Final = {
    "side lengths": ("sides", 15),
    "vertices": ("vertices", 15),
    "spherical": ("spherical", 15),
    "hybrid": ("hybrid", 15),
    "hybrid, 10 neurons": ("hybrid", 10),
    "side ratios, 6 neurons": ("ratios", 6),
}
EIGHT_BITS: Final = "hybrid, 8 bits"
EIGHT_BITS_10: Final = "hybrid, 8 bits, 10 neurons"
DIRECT: Final = "least squares"
STEPS: Final = len(NETWORKS) + 2
"""Number of trainings in `measure` for each seed."""


def measure(
    data: DataSet, seeds: int = 5, *, progress: Callable[[str], None] = lambda _: None
) -> Table:
    """Train and test all estimators.

    Args:
        data: the data set.
        seeds: number of seeds, from 0.
        progress: called with a name before each training, `STEPS` times for each seed.

    Raises:
        InputError: NP455, SciPy is not installed.
    """
    rows: dict[tuple[str, Errors | None], Row] = {}

    def take(
        name: str, cost: Operations, positions: Floats, true: Floats, angles: Errors | None = None
    ) -> None:
        row = rows.setdefault(
            (name, angles),
            Row(name, cost, angles, None if any(angles or ()) else THESIS_ROWS.get(name)),
        )
        row.measured.append(rms(positions - true))

    for seed in range(seeds):
        parts = split(len(data), seed)
        true, seen = data.positions[parts.test], data.vertices[parts.test]
        constant = np.broadcast_to(data.positions[parts.train].mean(axis=0), true.shape)
        take("constant guess", Operations(), constant, true)
        directed: dict[str, tuple[Operations, Estimate]] = {}
        for name, (model, neurons) in NETWORKS.items():
            progress(name)
            found = train_model(model, data, parts, neurons=neurons, seed=seed)
            if MODELS[model].directed:
                directed[name] = Operations.of(found), found
            else:
                take(name, Operations.of(found), found(seen), true)
        for name, neurons in ((EIGHT_BITS, 15), (EIGHT_BITS_10, 10)):
            progress(name)
            directed[name] = eight_bits(data, parts, neurons, seed)
        directed[DIRECT] = least_squares(data, parts)

        exact = yaw_and_pitch(true)
        for number, errors in enumerate(((0.0, 0.0), *ANGLE_ERRORS)):
            noise = np.random.default_rng((seed, 3, number)).normal(size=exact.shape)
            angles = exact + noise * errors
            for name, (cost, estimate) in directed.items():
                if not any(errors) or name in _JUDGED:
                    take(name, cost, estimate(seen, angles), true, errors)
        cost, hybrid = directed["hybrid"]
        assert isinstance(hybrid, Estimator)
        radial = hybrid.network(MODELS["hybrid"].inputs(seen))
        sines = cartesian_bhaskara(np.hstack([radial, polar_and_azimuth(exact)]))
        take("hybrid, Bhaskara's sine", cost, sines, true, (0.0, 0.0))
    ordered = sorted(rows.values(), key=lambda row: any(row.angle_errors or ()))
    settings = asdict(data.settings)
    described = {"poses": settings["poses"], "seed": settings["seed"]}
    described |= {"vertices": settings["source"], **settings["camera"]}
    return Table(described, seeds, ordered)


_JUDGED: Final = ("hybrid", EIGHT_BITS, "side ratios, 6 neurons", DIRECT)
"""Estimators that are measured with errors of the angles too."""


def eight_bits(data: DataSet, parts: Split, neurons: int, seed: int) -> tuple[Operations, Estimate]:
    """Train a network of the array's numbers; return its operations as well."""
    network = eightbit.train_chip(data, parts, neurons=neurons, seed=seed)

    def estimate(vertices: Floats, directions: Floats) -> Floats:
        pixels = np.rint(vertices).astype(np.int64)
        return from_radial(network.radial(eightbit.half_pixel_sides(pixels)), directions)

    return Operations(3, 4 * neurons, neurons, 5 * neurons + 1), estimate


def least_squares(data: DataSet, parts: Split) -> tuple[Operations, Estimate]:
    """Make an estimator by least squares for these pictures; return its operations as well."""
    camera = data.settings.camera
    inwards = direct.bias(data.vertices[parts.train], data.positions[parts.train], camera)

    def estimate(vertices: Floats, directions: Floats) -> Floats:
        angles = polar_and_azimuth(directions)
        return from_radial(direct.radial_distance(vertices, angles, inwards, camera), directions)

    return Operations(6, direct.multiplications(), 0, 3), estimate
