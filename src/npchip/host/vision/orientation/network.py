"""Networks with one hidden layer, and how they are trained (thesis 3.4.2).

*Thesis*: one hidden layer of 15 or 10 neurons, trained by MATLAB. *Decision*, after MATLAB's
defaults: tanh, Levenberg-Marquardt, 70 % of the samples to train, 15 % to validate, 15 % to test;
training ends when the validation error has not fallen for six steps, and the best step counts.
SciPy's `least_squares` is the optimiser; the Jacobian is analytic.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.host.vision.orientation.files import LARGEST, numbers
from npchip.host.vision.orientation.scene import Floats

Indexes = NDArray[np.intp]
Activation = Literal["tanh", "clamp"]

PATIENCE: Final = 6
MOST_STEPS: Final = 500
MOST_NEURONS: Final = 100
_ROWS: Final = 16


@dataclass(frozen=True)
class Network:
    """outputs = (tanh(x A^T + b) V^T + c) * target_scale + target_middle, with scaled inputs x.

    Attributes:
        hidden: A, float64, shape (neurons, inputs).
        bias: b, shape (neurons,).
        out: V, shape (outputs, neurons).
        offset: c, shape (outputs,).
        middle: middle of the inputs' range, shape (inputs,).
        scale: half of the inputs' range.
        target_middle: middle of the outputs' range, shape (outputs,).
        target_scale: half of the outputs' range.
    """

    hidden: Floats
    bias: Floats
    out: Floats
    offset: Floats
    middle: Floats
    scale: Floats
    target_middle: Floats
    target_scale: Floats

    def __call__(self, inputs: Floats) -> Floats:
        """Compute outputs, shape (N, outputs), from inputs, shape (N, inputs)."""
        x = (inputs - self.middle) / self.scale
        y = np.tanh(x @ self.hidden.T + self.bias) @ self.out.T + self.offset
        return y * self.target_scale + self.target_middle

    def document(self) -> dict[str, Any]:
        """Return the network as plain lists of numbers."""
        return {name: getattr(self, name).tolist() for name in self.__dataclass_fields__}

    @staticmethod
    def of_document(document: dict[str, Any]) -> Network:
        """Build a network from what `document` returned.

        Raises:
            ValueError: the lists do not fit together, or a number makes no sense.
        """
        fields = {name: numbers(document, name) for name in Network.__dataclass_fields__}
        if fields["hidden"].ndim != 2:
            raise ValueError("hidden: expected a list of weights for each neuron")
        neurons, inputs = fields["hidden"].shape
        outputs = len(fields["offset"])
        shapes = (
            *((neurons, inputs), (neurons,), (outputs, neurons), (outputs,)),
            *((inputs,), (inputs,), (outputs,), (outputs,)),
        )
        for (name, values), shape in zip(fields.items(), shapes, strict=True):
            if values.shape != shape:
                raise ValueError(f"{name}: expected {shape} numbers, found {values.shape}")
        if neurons > MOST_NEURONS:
            raise ValueError(f"a network has 1 to {MOST_NEURONS} neurons, found {neurons}")
        for name in ("scale", "target_scale"):
            least = fields[name].min()
            if not least >= 1 / LARGEST:
                raise ValueError(f"{name}: expected numbers above 0, found {least:g}")
        return Network(**fields)


class Split(NamedTuple):
    """Indexes of the samples to train, to validate and to test with."""

    train: Indexes
    validate: Indexes
    test: Indexes


def split(samples: int, seed: int) -> Split:
    """Divide samples at random: 70, 15 and 15 %."""
    order = np.random.default_rng((seed, 0)).permutation(samples)
    return Split(*np.split(order, [round(0.7 * samples), round(0.85 * samples)]))


class Parameters(NamedTuple):
    """The trained part of a network; shapes as in `Network`."""

    hidden: Floats
    bias: Floats
    out: Floats
    offset: Floats

    def flat(self) -> Floats:
        """Return all parameters in one row."""
        return np.concatenate([part.ravel() for part in self])

    def like(self, values: Floats) -> Parameters:
        """Return parameters of the same shapes from one row."""
        ends = np.cumsum([part.size for part in self])[:-1]
        parts = np.split(values, ends)
        return Parameters(*(v.reshape(p.shape) for v, p in zip(parts, self, strict=True)))


class Samples(NamedTuple):
    """Scaled inputs, shape (N, inputs), and targets, shape (N, outputs)."""

    inputs: Floats
    targets: Floats

    def at(self, numbers: Indexes) -> Samples:
        """Return the samples with these indexes."""
        return Samples(self.inputs[numbers], self.targets[numbers])


class _Enough(Exception):  # noqa: N818 - no error: leaves the optimiser
    """The validation error has not fallen for a while."""


class _Watch:
    """Parameters with the smallest validation error so far."""

    def __init__(self, error: Callable[[Floats], float], progress: Callable[[], None]) -> None:
        self._error, self._progress = error, progress
        self._least, self._failed = np.inf, 0
        self.best: Floats | None = None
        self.steps = 0

    def step(self, values: Floats) -> None:
        self.steps += 1
        self._progress()
        error = self._error(values)
        if error < self._least:
            self._least, self.best, self._failed = error, values.copy(), 0
            return
        self._failed += 1
        if self._failed >= PATIENCE:
            raise _Enough


def optimiser() -> Any:
    """Return SciPy's `least_squares`.

    Raises:
        InputError: NP455, SciPy is not installed.
    """
    try:
        from scipy.optimize import least_squares  # noqa: PLC0415 - optional
    except ImportError:
        raise InputError(
            "NP455", "training needs SciPy", hint="pip install 'npchip[orient]' installs it"
        ) from None
    return least_squares


def activate(sums: Floats, activation: Activation) -> tuple[Floats, Floats]:
    """Return the outputs of neurons, and their derivatives."""
    if activation == "tanh":
        value = np.tanh(sums)
        return value, 1 - value * value
    return np.clip(sums, -1, 1), (np.abs(sums) < 1).astype(np.float64)


class _Normal(NamedTuple):
    """J'J, J'f and f'f of all residuals f and their Jacobian J."""

    gram: Floats
    seen: Floats
    square: float

    def behind(self, first: int) -> _Normal:
        """Leave out the first parameters."""
        return _Normal(self.gram[first:, first:], self.seen[first:], self.square)


def _sums(a: Floats, b: Floats) -> Floats:
    """Compute a.T @ b in blocks of rows so small that no BLAS divides them among threads.

    The order of the additions, and so the last bits, would depend on the number of threads.
    """
    whole = len(a) // _ROWS * _ROWS
    left, right = (m[:whole].reshape(-1, _ROWS, m.shape[1]) for m in (a, b))
    blocks = left.transpose(0, 2, 1) @ right
    return np.asarray(blocks.sum(axis=0) + a[whole:].T @ b[whole:])


def _normal(parameters: Parameters, samples: Samples, activation: Activation) -> _Normal:
    """Compute the normal equations without the Jacobian, which has a row for each output.

    With z the derivative of a neuron's output by its weights and bias, that of output o is V[o] z,
    and by its own output weights it is the neurons' outputs, for every o. So J'J consists of three
    products of the samples, whatever the number of outputs.
    """
    value, slope = activate(samples.inputs @ parameters.hidden.T + parameters.bias, activation)
    wrong = value @ parameters.out.T + parameters.offset - samples.targets
    outputs, neurons = parameters.out.shape
    one = np.ones((len(value), 1))
    x, v = np.hstack([samples.inputs, one]), np.hstack([value, one])
    z = (slope[:, :, np.newaxis] * x[:, np.newaxis]).reshape(len(x), -1)
    width = x.shape[1]
    weight = np.repeat(parameters.out, width, axis=1)  # (outputs, neurons * width)
    own = neurons * width
    gram = np.zeros((own + outputs * (neurons + 1),) * 2)
    gram[:own, :own] = (weight.T @ weight) * _sums(z, z)
    mixed, square = _sums(z, v), _sums(v, v)
    for k, first in enumerate(range(own, len(gram), neurons + 1)):
        here = slice(first, first + neurons + 1)
        gram[:own, here] = weight[k][:, np.newaxis] * mixed
        gram[here, :own] = gram[:own, here].T
        gram[here, here] = square
    back = (wrong @ parameters.out) * slope
    seen = np.concatenate([_sums(back, x).ravel(), _sums(wrong, v).ravel()])
    order = _order(neurons, width, outputs)
    return _Normal(gram[np.ix_(order, order)], seen[order], float((wrong * wrong).sum()))


def _order(neurons: int, width: int, outputs: int) -> Indexes:
    """Return the places of hidden weights, biases, output weights and offsets in `_normal`."""
    hidden = np.arange(neurons * width).reshape(neurons, width)
    out = hidden.size + np.arange(outputs * (neurons + 1)).reshape(outputs, neurons + 1)
    parts = (hidden[:, :-1], hidden[:, -1], out[:, :-1], out[:, -1])
    return np.concatenate([part.ravel() for part in parts])


def _shortened(normal: _Normal) -> tuple[Floats, Floats]:
    """Find residuals and a Jacobian with the same normal equations, a row for each parameter.

    A least-squares solver needs only f'f, J'f and J'J, which no rotation changes. That of J = Q R
    leaves one row for each parameter, and one more for the rest of f: a hundred rows instead of
    thousands. R comes from the Cholesky decomposition of J'J, with a slightly larger diagonal
    because of idle neurons.

    Returns:
        shape (parameters + 1,) and (parameters + 1, parameters).
    """
    gram = normal.gram.copy()
    gram.flat[:: len(gram) + 1] += 1e-12 * np.trace(gram) + 1e-300
    lower = np.linalg.cholesky(gram)
    seen = np.linalg.solve(lower, normal.seen)
    rest = np.sqrt(max(normal.square - float(seen @ seen), 0.0))
    return np.append(seen, rest), np.vstack([lower.T, np.zeros(len(gram))])


class Fit(NamedTuple):
    """Parameters with the smallest validation error, and the number of steps."""

    parameters: Parameters
    steps: int


def fit(
    start: Parameters,
    samples: Samples,
    parts: Split,
    *,
    activation: Activation = "tanh",
    limits: Parameters | None = None,
    hidden_fixed: bool = False,
    progress: Callable[[], None] = lambda: None,
) -> Fit:
    """Train by Levenberg-Marquardt with early stopping.

    Args:
        start: first parameters.
        samples: all samples.
        parts: samples to train and validate with.
        activation: activation of the hidden neurons.
        limits: largest size of each parameter; may be infinite.
        hidden_fixed: whether to keep the hidden weights.
        progress: called at every step.
    """
    least_squares = optimiser()
    whole = start.flat()
    first = start.hidden.size if hidden_fixed else 0
    train, validate = samples.at(parts.train), samples.at(parts.validate)

    def parameters(values: Floats) -> Parameters:
        return start.like(np.concatenate([whole[:first], values]))

    def residuals(values: Floats, part: Samples) -> Floats:
        p = parameters(values)
        value, _ = activate(part.inputs @ p.hidden.T + p.bias, activation)
        wrong: Floats = value @ p.out.T + p.offset - part.targets
        return wrong.ravel()

    at, turned = np.empty(0), np.empty((0, 0))

    def squares(values: Floats) -> Floats:
        nonlocal at, turned
        normal = _normal(parameters(values), train, activation)
        found, turned = _shortened(normal.behind(first))
        at = values.copy()
        return found

    def jacobian(values: Floats) -> Floats:  # once at every step, of the last residuals
        assert np.array_equal(values, at)
        watch.step(values)
        return turned

    watch = _Watch(lambda values: float(np.mean(residuals(values, validate) ** 2)), progress)
    bounds: tuple[float | Floats, float | Floats] = (-np.inf, np.inf)
    begin = whole[first:]
    if limits is not None:
        size = limits.flat()[first:]
        bounds = (-size, size)
        begin = np.clip(begin, -0.999 * size, 0.999 * size)
    with suppress(_Enough):
        tolerances = {"ftol": 1e-8, "xtol": 1e-10, "gtol": 1e-10}
        least_squares(squares, begin, jacobian, bounds, max_nfev=MOST_STEPS, **tolerances)
    assert watch.best is not None
    return Fit(parameters(watch.best), watch.steps)


def random_parameters(
    rng: np.random.Generator, neurons: int, inputs: int, outputs: int
) -> Parameters:
    """Draw first parameters after Nguyen and Widrow, whose slopes cover the range of the inputs."""
    size = 0.7 * neurons ** (1 / inputs)
    hidden = rng.uniform(-1, 1, (neurons, inputs))
    hidden *= size / np.linalg.norm(hidden, axis=1, keepdims=True)
    bias = np.linspace(-size, size, neurons) * np.sign(hidden[:, 0])
    return Parameters(hidden, bias, rng.uniform(-0.5, 0.5, (outputs, neurons)), np.zeros(outputs))


def train(
    inputs: Floats,
    targets: Floats,
    parts: Split,
    *,
    neurons: int = 15,
    seed: int = 0,
    progress: Callable[[], None] = lambda: None,
) -> tuple[Network, int]:
    """Train a network.

    Args:
        inputs: inputs, shape (N, inputs).
        targets: targets, shape (N, outputs).
        parts: samples to train and validate with.
        neurons: number of neurons in the hidden layer.
        seed: seed of the first weights; the same seed gives the same network.
        progress: called at every step.

    Returns:
        the network, and the number of steps.

    Raises:
        InputError: NP453, `neurons` out of range; NP455, SciPy is not installed.
    """
    if not 1 <= neurons <= MOST_NEURONS:
        raise InputError("NP453", f"a network has 1 to {MOST_NEURONS} neurons, found {neurons}")
    middle, scale = _range(inputs[parts.train])
    target_middle, target_scale = _range(targets[parts.train])
    samples = Samples((inputs - middle) / scale, (targets - target_middle) / target_scale)
    rng = np.random.default_rng((seed, 1))
    start = random_parameters(rng, neurons, inputs.shape[1], targets.shape[1])
    found, steps = fit(start, samples, parts, progress=progress)
    return Network(*found, middle, scale, target_middle, target_scale), steps


def _range(values: Floats) -> tuple[Floats, Floats]:
    """Return middle and half of the range of each column; 1 for a constant one."""
    low, high = values.min(axis=0), values.max(axis=0)
    half = (high - low) / 2
    return (low + high) / 2, np.where(half > 0, half, 1.0)
