"""Named kernels, random ones, and what SciPy makes of them."""

from __future__ import annotations

import random

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from examples.kernels_page import NAMED
from npchip.kernels import Kernel, read_kernel


def named(name: str) -> Kernel:
    """A kernel by its name."""
    text, options = NAMED[name]
    return read_kernel(text, name, **options)


def random_kernel(source: random.Random, name: str = "k") -> Kernel:
    """A kernel of any kind: full, sparse, or an outer product; its sums may need too many bits."""
    size = source.choice([3, 3, 3, 5])
    most = source.choice([1, 2, 4, 9, 16, 28] if size == 3 else [1, 2, 4, 8])
    kind = source.choice(["full", "sparse", "product"])
    filled = 0.5 if kind == "sparse" else 1.0
    rows = [
        [source.randint(-most, most) * (source.random() < filled) for _ in range(size)]
        for _ in range(size)
    ]
    if kind == "product":
        rows = [[left * right for right in rows[1]] for left in rows[0]]
    if not any(map(any, rows)):
        rows[0][0] = 1
    return Kernel(
        name,
        tuple(map(tuple, rows)),
        shift=source.choice([0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11]),
        add=source.choice([0, 0, 0, 128, -5, 77]),
        wrap=source.random() < 0.3,
        down=source.random() < 0.4,
    )


def frames(seed: int) -> NDArray[np.uint8]:
    """Random levels, black and white at random, and all white, shape (3, 64, 80)."""
    source = np.random.default_rng(seed)
    levels = source.integers(0, 256, (64, 80))
    extremes = source.choice([0, 255], (64, 80))
    return np.stack([levels, extremes, np.full((64, 80), 255)]).astype(np.uint8)


def filtered(kernel: Kernel, clip: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Apply a kernel to frames by SciPy; the result has their shape and dtype."""
    weights = np.array(kernel.weights, np.int64)
    sums = np.stack(
        [ndimage.correlate(frame.astype(np.int64), weights, mode="constant") for frame in clip]
    )
    divisor = 2**kernel.shift
    values = (sums if kernel.down else sums + divisor // 2) // divisor + kernel.add
    limited: NDArray[np.int64] = values % 256 if kernel.wrap else values.clip(0, 255)
    return limited.astype(np.uint8)
