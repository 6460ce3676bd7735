"""Outputs of ``asm/dct.s``: exactly, by the rule in its head, and nearly, by SciPy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Frames = NDArray[np.uint8]
    Integers = NDArray[np.int64]
    Numbers = NDArray[np.float64]

ODD = ((89, 75, 50, 18), (75, -18, -89, -50), (50, -89, 18, 75), (18, -50, 75, -89))
"""Constants in units of 1/64 for the differences, by coefficient 1, 3, 5, 7."""


def dct(frames: Frames) -> Frames:
    """Coefficients in the place of pixels, two's complement, of frames of shape (T, rows, cols)."""
    numbers = to_blocks(frames).astype(np.int64) - 128
    numbers = _transform(numbers.swapaxes(-1, -2)).swapaxes(-1, -2)
    numbers = _transform(numbers)
    return from_blocks(((numbers + 31) // 64).astype(np.int8).view(np.uint8))


def quotients(frames: Frames) -> Numbers:
    """The orthonormal DCT of every block of F - 128, divided by 8, of shape (..., 8, 8)."""
    found: Numbers = scipy.fft.dctn(to_blocks(frames) - 128.0, axes=(-2, -1), norm="ortho") / 8
    return found


def error_of_constants() -> Numbers:
    """Return the error due to the constants alone: of coefficient (v, u) / 8, by pixel (y, x)."""
    units = np.eye(8, dtype=np.int64) * 64  # so that nothing is lost by halving
    ours = _transform(units).T / 64
    exact = scipy.fft.dct(np.eye(8), axis=1, norm="ortho").T * np.sqrt(8)
    products = [np.einsum("vy,ux->vuyx", matrix, matrix) for matrix in (ours, exact)]
    error: Numbers = (products[0] - products[1]) / 64
    return error


def picture(coefficients: Integers | Numbers) -> Frames:
    """The frames that coefficients of shape (..., 8, 8) stand for."""
    values = scipy.fft.idctn(coefficients * 8.0, axes=(-2, -1), norm="ortho") + 128
    return from_blocks(np.clip(np.rint(values), 0, 255).astype(np.uint8))


def to_blocks(frames: Frames) -> Frames:
    """(T, rows, cols) as (T, NP rows, NP cols, 8, 8)."""
    count, rows, cols = frames.shape
    return frames.reshape(count, rows // 8, 8, cols // 8, 8).swapaxes(2, 3)


def from_blocks(blocks: Frames) -> Frames:
    """The inverse of `to_blocks`."""
    count, rows, cols, _, _ = blocks.shape
    return blocks.swapaxes(2, 3).reshape(count, rows * 8, cols * 8)


def _transform(x: Integers) -> Integers:
    """Eight numbers along the last axis; sqrt(8) times the orthonormal transform."""
    half, mirrored = x[..., :4], x[..., :3:-1]
    sums, differences = half + mirrored, half - mirrored
    outer, inner = sums[..., :2], sums[..., :1:-1]
    total, rest = outer + inner, outer - inner
    result = np.empty_like(x)
    result[..., 0] = total[..., 0] + total[..., 1]
    result[..., 4] = total[..., 0] - total[..., 1]
    result[..., 2] = _product(rest, (84, 35))
    result[..., 6] = _product(rest, (35, -84))
    for index, constants in enumerate(ODD):
        result[..., 2 * index + 1] = _product(differences, constants)
    return result


def _product(numbers: Integers, constants: tuple[int, ...]) -> Integers:
    """Sum of products / 64: from the lowest bit up, all are halved and rounded down together."""
    total = np.zeros_like(numbers[..., 0])
    for bit in range(7):
        if bit:
            total = total // 2
        for index, constant in enumerate(constants):
            if abs(constant) >> bit & 1:
                total = total + np.sign(constant) * numbers[..., index]
    return total
