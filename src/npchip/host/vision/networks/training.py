"""Training of a network with the numbers that the chip will use (decision).

Weights are trained as real numbers, but in every step the network is computed with what the chip
has: signs of the first layer, whole activations, 8 bits for the second. Gradients pass through the
rounding as if it were not there. Adam, with a step that falls to 0 along a cosine; the loss is the
cross-entropy with labels smoothed by `SMOOTHED`. In every round all pictures come in new variants.

NumPy adds in another order with another number of threads: the same seed gives the same bytes on
the same machine, with the same versions and threads.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.networks.features import COUNTS, NPS, counts
from npchip.host.vision.networks.network import (
    BIAS_STEP,
    BIAS_STEPS,
    CLASSES,
    UNIT,
    Network,
    bias_weights,
)
from npchip.host.vision.networks.pictures import (
    Labels,
    PictureSet,
    enlarge,
    expose,
    vary,
)

Floats = NDArray[np.float32]

SMOOTHED: Final = 0.05
SCALE: Final = 128
"""A score of the chip for 1 in the logarithm of a class's odds."""
SEEN: Final = (NPS[0], NPS[1] - 1)
"""Rows and columns of NPs whose counts are inputs: those of column 0 give the bias."""
_BLOCK: Final = 2000  # pictures at a time


@dataclass(frozen=True)
class Settings:
    """Settings of a training.

    Attributes:
        neurons: a multiple of 8.
        rounds: how often new variants of all pictures are made.
        variants: how many of each picture, in each round.
        passes: over them, in each round.
        step: first step of Adam.
        batch: pictures of a step.
        seed: of the split, the first weights, the variants and their order.
    """

    neurons: int = 80
    rounds: int = 24
    variants: int = 8
    passes: int = 2
    step: float = 2e-3
    batch: int = 128
    seed: int = 1


class _Adam:
    """Parameters that follow their gradients."""

    def __init__(self, parameters: list[Floats]) -> None:
        self._parameters = parameters
        self._mean = [np.zeros_like(each) for each in parameters]
        self._square = [np.zeros_like(each) for each in parameters]
        self._steps = 0

    def follow(self, gradients: list[Floats], step: float) -> None:
        """Take a step against the gradients."""
        self._steps += 1
        unbias = np.float32(step / (1 - 0.9**self._steps))
        unbias_square = np.float32(1 / (1 - 0.999**self._steps))
        for parameter, gradient, mean, square in zip(
            self._parameters, gradients, self._mean, self._square, strict=True
        ):
            np.add(mean, np.float32(0.1) * (gradient - mean), out=mean)
            np.add(square, np.float32(0.001) * (gradient * gradient - square), out=square)
            change = unbias * mean / (np.sqrt(square * unbias_square) + np.float32(1e-8))
            np.subtract(parameter, change, out=parameter)


class _Trained:
    """The weights as real numbers, and what the chip makes of them."""

    def __init__(self, neurons: int, rng: np.random.Generator) -> None:
        inputs = COUNTS * SEEN[0] * SEEN[1]
        self.hidden: Floats = rng.uniform(-0.3, 0.3, (inputs, neurons)).astype(np.float32)
        self.hidden_bias: Floats = np.zeros(neurons, np.float32)
        self.classes: Floats = rng.normal(0, 0.1, (neurons, CLASSES)).astype(np.float32)
        self.bias: Floats = np.zeros(CLASSES, np.float32)
        self._adam = _Adam([self.hidden, self.hidden_bias, self.classes, self.bias])

    def _steps(self) -> Floats:
        """Return the biases of the neurons in steps of the chip."""
        return np.asarray(np.rint(self.hidden_bias * np.float32(UNIT / BIAS_STEP)))

    def _class_weights(self) -> Floats:
        return np.asarray(np.rint(self.classes * SCALE).clip(-128, 127))

    def learn(self, inputs: Floats, labels: Labels, step: float) -> None:
        """Take a step for a batch: counts, shape (n, inputs), and classes."""
        signs = np.where(self.hidden >= 0, np.float32(1), np.float32(-1))
        weights = self._class_weights() / np.float32(SCALE)
        sums = inputs @ signs / np.float32(UNIT) + self._steps() * np.float32(BIAS_STEP / UNIT)
        active = np.maximum(np.floor(sums), 0)
        scores = active @ weights + self.bias
        odds = np.exp(scores - scores.max(axis=1, keepdims=True))
        error = odds / odds.sum(axis=1, keepdims=True) - np.float32(SMOOTHED / CLASSES)
        error[np.arange(len(labels)), labels] -= np.float32(1 - SMOOTHED)
        error /= np.float32(len(labels))
        back = error @ weights.T * (sums > 0)
        self._adam.follow(
            [
                inputs.T @ back / np.float32(UNIT),
                back.sum(axis=0),
                active.T @ error,
                error.sum(axis=0),
            ],
            step,
        )
        self.hidden.clip(-1, 1, out=self.hidden)
        most = BIAS_STEP * BIAS_STEPS / 2 / UNIT
        self.hidden_bias.clip(-most, most, out=self.hidden_bias)

    def network(self) -> Network:
        """Return the network of the chip."""
        neurons = len(self.hidden_bias)
        hidden = np.zeros((neurons, COUNTS, *NPS), np.bool_)
        hidden[..., 1:] = (self.hidden >= 0).T.reshape(neurons, COUNTS, *SEEN)
        hidden[..., 0] = bias_weights(self._steps().astype(np.int64) + BIAS_STEPS // 2)
        return Network(
            hidden=hidden,
            classes=self._class_weights().astype(np.int8),
            bias=np.rint(self.bias * SCALE).clip(-0x8000, 0x7FFF).astype(np.int16),
        )


def _variants(data: PictureSet, number: int, rng: np.random.Generator) -> NDArray[np.uint8]:
    """Return the counts of variants of all pictures, one after the other."""
    seen = []
    for _ in range(number):
        for begin in range(0, len(data), _BLOCK):
            frames = enlarge(vary(data.pictures[begin : begin + _BLOCK], rng))
            seen.append(counts(expose(frames, rng))[..., 1:])
    return np.concatenate(seen).reshape(number * len(data), -1)


def train(
    data: PictureSet,
    settings: Settings,
    progress: Callable[[str, int], None] = lambda _name, _done: None,
) -> Network:
    """Train a network; the same arguments give the same one (see above).

    Args:
        data: the pictures to learn from.
        settings: the settings.
        progress: called with the name of a step and the number of rounds done.
    """
    rng = np.random.default_rng((settings.seed, 2))
    trained = _Trained(settings.neurons, rng)
    per_pass = len(data) * settings.variants // settings.batch
    steps, done = settings.rounds * settings.passes * per_pass, 0
    labels = np.tile(data.labels, settings.variants)
    for number in range(settings.rounds):
        progress("training", number)
        inputs = _variants(data, settings.variants, rng)
        for _ in range(settings.passes):
            order = rng.permutation(len(labels))[: per_pass * settings.batch]
            for batch in order.reshape(per_pass, settings.batch):
                step = settings.step * 0.5 * (1 + np.cos(np.pi * done / steps))
                trained.learn(inputs[batch].astype(np.float32), labels[batch], float(step))
                done += 1
    progress("training", settings.rounds)
    return trained.network()
