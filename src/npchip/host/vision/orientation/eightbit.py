"""The radial-distance network in 8-bit integers, as ``asm/orientation.s`` computes it (4.1.2).

All of it is a decision. Sides are in half pixels: the root of four times the sum of the squares,
rounded down, at most 255. Each neuron adds three products of a side with a weight of 7 bits (-63 to
63) to a bias of 16 bits; the sum fits into 16 bits for all sides. Its activation is a straight line
between two clamps: bits 4 to 11 of the sum plus 128, or 0, or 255. Weights of 8 bits (-128 to 127)
and an offset of 16 bits combine the neurons to the distance in eighths of a millimetre. Overflows
of partial sums do not matter, since the total counts modulo 2^16; at 8,192 mm it would wrap to 0.

Training adds the rounding step by step: the network is trained with tanh and limited weights, then
with the clamp; its hidden weights are rounded and the rest is trained again; then the output
weights are rounded one at a time, the largest first, and linear least squares adjusts the others.
The start with the smallest validation error wins.
"""

from __future__ import annotations

import io
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.base.files import write_bytes, write_text
from npchip.base.json import indented
from npchip.host.vision.orientation.dataset import DataSet
from npchip.host.vision.orientation.files import numbers, read_document
from npchip.host.vision.orientation.network import Parameters, Samples, Split, fit
from npchip.host.vision.orientation.scene import Camera, Floats, spherical

Ints = NDArray[np.int64]

SCHEMA: Final = 1
KIND: Final = "npchip-orientation-8bit"

SHIFT: Final = 4
"""Bits of a neuron's sum below its output."""

FRACTION: Final = 3
"""Bits of the distance below a millimetre."""

MOST_WEIGHT: Final = 63
MOST_OUT: Final = 127
STARTS: Final = 4

BYTES: Final = 8
"""Bytes in each NP: three weights, bias low and high, output weight, offset low and high."""

ADDRESS: Final = 208
"""Address of the bytes in the NPs' memory, for ``--memory 208=FILE.npy``."""

_MIDDLE = 127.5
_UNIT = 127.5 * 2**SHIFT  # a neuron's sum at which it is clamped
_RANGE = 2_000.0  # mm, for the targets


def half_pixel_sides(points: NDArray[np.integer[Any]]) -> Ints:
    """Compute the lengths of the sides from the highlighted vertex on.

    Args:
        points: row and column of the pixels of the vertices, shape (N, 3, 2).

    Returns:
        int64, shape (N, 3), in half pixels rounded down, at most 255.
    """
    steps = np.roll(points, -1, axis=1).astype(np.int64) - points
    squares = 4 * (steps * steps).sum(axis=2)
    root = np.sqrt(squares.astype(np.float64)).astype(np.int64)  # exact far beyond these numbers
    return np.asarray(np.minimum(root, 255))


@dataclass(frozen=True)
class ChipNetwork:
    """Weights of the network on the array.

    Attributes:
        hidden: weights of the sides, -63 to 63, int64, shape (neurons, 3).
        bias: biases of 16 bits with sign, shape (neurons,).
        out: output weights, -128 to 127, shape (neurons,).
        offset: offset in eighths of a millimetre, modulo 2^16.
        camera: camera of the pictures.
        trained: conditions and results of the training.
    """

    hidden: Ints
    bias: Ints
    out: Ints
    offset: int
    camera: Camera
    trained: dict[str, Any]

    def __post_init__(self) -> None:
        """Check that no sum can leave its 16 bits.

        Raises:
            ValueError: a sum can, or a weight is out of range.
        """
        highest = 255 * np.maximum(self.hidden, 0).sum(axis=1) + self.bias
        lowest = 255 * np.minimum(self.hidden, 0).sum(axis=1) + self.bias
        if (highest >= 2**15).any() or (lowest < -(2**15)).any():
            raise ValueError("a neuron's sum can leave 16 bits")
        if (abs(self.hidden) > MOST_WEIGHT).any() or (abs(self.out) > MOST_OUT).any():
            raise ValueError("a weight is out of range")

    def activations(self, sides: Ints) -> Ints:
        """Compute the outputs of hidden neurons, 0 to 255, shape (N, neurons), of sides (N, 3)."""
        sums = sides @ self.hidden.T + self.bias
        return np.asarray(np.clip((sums >> SHIFT) + 128, 0, 255))

    def eighths(self, sides: Ints) -> Ints:
        """Compute the radial distance in eighths of a millimetre, 16 bits, shape (N,)."""
        total: Ints = self.activations(sides) @ self.out + self.offset
        return total & 0xFFFF

    def radial(self, sides: Ints) -> Floats:
        """Compute the radial distance in mm, shape (N,), of sides in half pixels, shape (N, 3)."""
        return self.eighths(sides) / 2**FRACTION

    def millimetres(self, sides: Ints) -> Ints:
        """Compute the radial distance to the nearest mm, as the array sends it: shape (N,)."""
        half = 1 << (FRACTION - 1)
        return (self.eighths(sides) + half & 0xFFFF) >> FRACTION

    def planes(self, np_rows: int, np_cols: int) -> NDArray[np.uint8]:
        """Arrange the neurons in the memories of the NPs, one for each, row by row; else 0.

        Returns:
            uint8, shape (8, np_rows, np_cols).

        Raises:
            InputError: NP453, there are more neurons than NPs.
        """
        neurons = len(self.out)
        if neurons > np_rows * np_cols:
            raise InputError(
                "NP453", f"{neurons} neurons need as many NPs, found {np_rows * np_cols}"
            )
        words = np.zeros((np_rows * np_cols, BYTES), np.uint8)
        words[:neurons, 0:3] = self.hidden & 0xFF
        words[:neurons, 3] = self.bias & 0xFF
        words[:neurons, 4] = self.bias >> 8 & 0xFF
        words[:neurons, 5] = self.out & 0xFF
        words[0, 6:8] = self.offset & 0xFF, self.offset >> 8 & 0xFF
        return np.ascontiguousarray(words.T.reshape(BYTES, np_rows, np_cols))


def train_chip(
    data: DataSet,
    parts: Split,
    *,
    neurons: int = 15,
    seed: int = 0,
    starts: int = STARTS,
) -> ChipNetwork:
    """Train the network in 8-bit integers.

    Args:
        data: the data set; its vertices are rounded to whole pixels.
        parts: samples to train and validate with.
        neurons: number of neurons in the hidden layer.
        seed: seed of the first weights.
        starts: number of trainings, of which the best counts.

    Raises:
        InputError: NP455, SciPy is not installed.
    """
    sides = half_pixel_sides(np.rint(data.vertices).astype(np.int64))
    radial = spherical(data.positions)[:, 0]
    best: ChipNetwork | None = None
    least = np.inf
    for start in range(starts):
        rng = np.random.default_rng((seed, 2, start))
        network = _train_once(sides, radial, parts, neurons, rng)
        wrong = network.radial(sides[parts.validate]) - radial[parts.validate]
        error = float(np.mean(wrong**2))
        if error < least:
            best, least = network, error
    assert best is not None
    trained = {"data": asdict(data.settings), "seed": seed, "starts": starts}
    return replace(best, camera=data.settings.camera, trained=trained)


def _train_once(
    sides: Ints, radial: Floats, parts: Split, neurons: int, rng: np.random.Generator
) -> ChipNetwork:
    inputs = (sides.astype(np.float64) - _MIDDLE) / _MIDDLE
    samples = Samples(inputs, (radial[:, np.newaxis] - _RANGE) / _RANGE)
    most = MOST_WEIGHT * _MIDDLE / _UNIT
    limits = Parameters(
        np.full((neurons, 3), most),
        np.full(neurons, (2**15 - 1 - 3 * MOST_WEIGHT * _MIDDLE - 2) / _UNIT),
        np.full((1, neurons), MOST_OUT * 127.5 / 2**FRACTION / _RANGE),
        np.full(1, np.inf),
    )
    hidden = rng.uniform(-1, 1, (neurons, 3)) * min(most, 1.5)
    hidden *= rng.uniform(0.5, 1, (neurons, 1))
    centres = samples.inputs[parts.train][rng.integers(len(parts.train), size=neurons)]
    out = rng.uniform(-0.5, 0.5, (1, neurons))
    start = Parameters(hidden, -(hidden * centres).sum(axis=1), out, np.zeros(1))

    train = partial(fit, samples=samples, parts=parts, limits=limits)
    smooth, _ = train(start)
    clamped, _ = train(smooth, activation="clamp")
    weights = np.rint(clamped.hidden * _UNIT / _MIDDLE)
    fixed = clamped._replace(hidden=weights * _MIDDLE / _UNIT)
    rounded, _ = train(fixed, activation="clamp", hidden_fixed=True)
    bias = np.rint(rounded.bias * _UNIT - weights.sum(axis=1) * _MIDDLE)
    blank = np.zeros(neurons, np.int64)
    network = ChipNetwork(weights.astype(np.int64), bias.astype(np.int64), blank, 0, Camera(), {})
    activations = network.activations(sides[parts.train])
    found, offset = _round_out(activations, radial[parts.train] * 2**FRACTION)
    return replace(network, out=found, offset=offset)


def _round_out(activations: Ints, targets: Floats) -> tuple[Ints, int]:
    """Round output weights one at a time, the largest first, and fit the others again."""
    neurons = activations.shape[1]
    found = np.zeros(neurons, np.int64)
    left, rest = list(range(neurons)), targets.copy()
    small = 1e-3 * len(targets)  # keeps weights of neurons that hardly differ from growing
    while left:
        known = np.column_stack([activations[:, left], np.ones(len(rest))])
        ridge = small * np.eye(len(left) + 1)
        ridge[-1, -1] = 0
        weights = np.linalg.solve(known.T @ known + ridge, known.T @ rest)[:-1]
        number = int(np.argmax(abs(weights)))
        neuron = left.pop(number)
        found[neuron] = np.clip(np.rint(weights[number]), -MOST_OUT, MOST_OUT)
        rest -= found[neuron] * activations[:, neuron]
    return found, int(np.rint(rest.mean()))


# ---- files


def save(path: Path, network: ChipNetwork) -> None:
    """Write a network as JSON, whole or not at all.

    Raises:
        InputError: NP250, it cannot be written.
    """
    document = {
        "kind": KIND,
        "schema": SCHEMA,
        "camera": asdict(network.camera),
        "hidden": network.hidden.tolist(),
        "bias": network.bias.tolist(),
        "out": network.out.tolist(),
        "offset": network.offset,
        "trained": network.trained,
    }
    write_text(path, indented(document))


def load(path: Path) -> ChipNetwork:
    """Read a network in 8-bit integers.

    Raises:
        InputError: NP456, it is not such a file, or damaged.
    """
    return read_document(path, KIND, (SCHEMA,), _checked)


def _checked(document: dict[str, Any]) -> ChipNetwork:
    hidden, bias, out, offset = (
        numbers(document, name, whole=True) for name in ("hidden", "bias", "out", "offset")
    )
    if out.ndim != 1 or hidden.shape != (len(out), 3) or bias.shape != (len(out),):
        raise ValueError(f"{hidden.shape} weights, {bias.shape} biases, {out.shape} outputs")
    if offset.ndim:
        raise ValueError(f"offset: expected a number, found {offset.shape}")
    camera, trained = Camera(**document["camera"]), dict(document["trained"])
    return ChipNetwork(hidden, bias, out, int(offset), camera, trained)


def save_planes(path: Path, network: ChipNetwork, np_rows: int, np_cols: int) -> None:
    """Write the file for ``--memory 208=FILE.npy``.

    Raises:
        InputError: NP250, it cannot be written; NP453, too many neurons.
    """
    buffer = io.BytesIO()
    np.save(buffer, network.planes(np_rows, np_cols), allow_pickle=False)
    write_bytes(path, buffer.getvalue())
