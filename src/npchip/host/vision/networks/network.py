"""A network of two layers in whole numbers, as ``asm/digits.s`` computes it.

All of it is a decision. Every NP multiplies its eight counts by eight weights of +1 or -1, for each
neuron others, and the sum over all NPs in units of 64, rounded down, is the neuron's activation; a
negative one counts as 0. Ten classes add the activations, times weights of 8 bits, to a bias, in 16
bits. The class with the largest score is the answer, of equals the first.

A neuron's bias needs no memory of its own. The NPs of column 0, which a digit in the middle of the
frame does not reach, start counting at `START` instead of 0: with eight weights in each of eight
NPs, the bias is -512 to 512 in steps of 16.

The sums flow through the array as a wave: in step s the NP in row r and column c adds its part of
neuron s - r - c. The NPs' memories hold, from `ADDRESS` on, for each step a byte of eight weights,
bit k set for a +1 with count k; then the weights of the classes, where the NP in row r and column c
has those of class c for neurons r, r + 8, ...; then the count to start with; then the biases of the
classes, low byte and high byte, in row 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from npchip.host.vision.networks.features import COUNTS, NPS, Counts, Frames, counts

ADDRESS: Final = 128
"""Address of the weights in the NPs' memories."""

CLASSES: Final = NPS[1]
"""Each column of NPs is a class."""

START: Final = 8
"""First count of the NPs in column 0."""

UNIT: Final = 64
"""Divisor of a neuron's sum."""

STEPS: Final = NPS[0] + NPS[1] - 2
"""Steps that the wave takes from the first NP to the last one."""

MOST_NEURONS: Final = 96
"""Neurons whose weights an NP's memory holds beside the samples."""

NONE: Final = 255
"""The answer that is none."""

BIAS_STEP: Final = 2 * START
BIAS_STEPS: Final = COUNTS * NPS[0]

_BLOCK = 1000  # pictures at a time


@dataclass(frozen=True)
class Network:
    """The weights of a network.

    Attributes:
        hidden: bool, shape (neurons, `COUNTS`, 8, 10): True for a weight of +1, False for -1.
            The number of neurons is a multiple of 8.
        classes: int8, shape (neurons, 10): weights of each class.
        bias: int16, shape (10,): of each class.
    """

    hidden: NDArray[np.bool_]
    classes: NDArray[np.int8]
    bias: NDArray[np.int16]

    @property
    def neurons(self) -> int:
        """The number of neurons."""
        return len(self.hidden)

    def activations(self, seen: Counts) -> NDArray[np.int64]:
        """Return what the neurons say to counts.

        Returns:
            shape (n, neurons), 0 or more.
        """
        begun = seen.astype(np.int64)
        begun[..., 0] += START
        signs = np.where(self.hidden, 1, -1)
        in_nps = np.zeros((len(seen), self.neurons), np.int64)
        for row, col in np.ndindex(NPS):
            local = begun[:, :, row, col] @ signs[:, :, row, col].T
            in_nps += ((local + 128) & 255) - 128  # the sum in an NP has 8 bits
        return np.maximum(in_nps // UNIT, 0)

    def scores(self, frames: Frames, *, dark: bool = False) -> NDArray[np.int64]:
        """Return the scores of all classes.

        Args:
            frames: uint8, shape (n, 64, 80).
            dark: True for dark on bright.

        Returns:
            shape (n, 10), -32768 to 32767.
        """
        found = []
        for begin in range(0, len(frames), _BLOCK):
            active = self.activations(counts(frames[begin : begin + _BLOCK], dark=dark))
            found.append(active @ self.classes.astype(np.int64) + self.bias)
        total = np.concatenate(found) if found else np.zeros((0, CLASSES), np.int64)
        return ((total + 0x8000) & 0xFFFF) - 0x8000

    def answers(self, frames: Frames, *, sure: int = 0, dark: bool = False) -> NDArray[np.int64]:
        """Return the class with the largest score for each frame.

        Args:
            frames: uint8, shape (n, 64, 80).
            sure: `NONE` is the answer where another score is not more than this below it.
            dark: True for dark on bright.

        Returns:
            shape (n,).
        """
        scores = self.scores(frames, dark=dark) + 0x8000
        first = scores.argmax(axis=1)
        every = np.arange(len(scores))
        scores[every, first] = (scores[every, first] - sure) & 0xFFFF
        return np.where(scores.argmax(axis=1) == first, first, NONE)

    def planes(self) -> NDArray[np.uint8]:
        """Return the bytes of the NPs' memories from `ADDRESS` on.

        Returns:
            uint8, shape (neurons + `STEPS` + neurons / 8 + 3, 8, 10).
        """
        bits = (1 << np.arange(COUNTS))[:, None, None]
        parts = (self.hidden * bits).sum(axis=1).astype(np.uint8)
        hidden = np.zeros((self.neurons + STEPS, *NPS), np.uint8)
        for row, col in np.ndindex(NPS):
            hidden[row + col : row + col + self.neurons, row, col] = parts[:, row, col]
        classes = self.classes.reshape(-1, NPS[0], CLASSES).view(np.uint8)
        start = np.zeros((1, *NPS), np.uint8)
        start[0, :, 0] = START
        bias = np.zeros((2, *NPS), np.uint8)
        bias[:, 0] = self.bias.astype("<i2").view(np.uint8).reshape(CLASSES, 2).T
        return np.concatenate([hidden, classes, start, bias])


def from_planes(planes: NDArray[np.uint8]) -> Network:
    """Read a network from the bytes of the NPs' memories; see `Network.planes`.

    Raises:
        ValueError: the number of bytes is that of no network, or the counts start elsewhere.
    """
    neurons = max(0, len(planes) - STEPS - 3) // 9 * 8
    steps = neurons + STEPS
    if not neurons or planes.shape != (steps + neurons // 8 + 3, *NPS):
        raise ValueError(f"an array of shape {planes.shape} holds no network")
    expected = np.zeros(NPS, np.uint8)
    expected[:, 0] = START
    if (planes[-3] != expected).any():
        raise ValueError(f"the NPs start counting at {START} in column 0 and at 0 elsewhere")
    parts = np.empty((neurons, 1, *NPS), np.uint8)
    for row, col in np.ndindex(NPS):
        parts[:, 0, row, col] = planes[row + col : row + col + neurons, row, col]
    return Network(
        hidden=(parts >> np.arange(COUNTS)[:, None, None] & 1).astype(np.bool_),
        classes=planes[steps:-3].reshape(neurons, CLASSES).view(np.int8),
        bias=np.ascontiguousarray(planes[-2:, 0].T).view("<i2").reshape(CLASSES).astype(np.int16),
    )


def bias_weights(steps: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return the weights of column 0 that give neurons their biases.

    Args:
        steps: for each neuron how many of the 64 weights are +1; its bias is
            `BIAS_STEP` * steps - 512. They are spread evenly over the NPs and counts.

    Returns:
        bool, shape (neurons, `COUNTS`, 8).
    """
    order = np.arange(BIAS_STEPS)
    spread = (order + 1) * steps[:, None] // BIAS_STEPS - order * steps[:, None] // BIAS_STEPS
    return spread.reshape(-1, NPS[0], COUNTS).transpose(0, 2, 1).astype(np.bool_)
