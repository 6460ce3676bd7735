"""An array of integers that grows along its first axis."""

from __future__ import annotations

from math import prod
from mmap import mmap
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_FIRST = 64
_LARGE = 1 << 20
_RESERVED = 1 << 30


class DynamicArray:
    """An array of integers that grows at its end.

    A full array doubles its memory. Large memory of a vector comes from the system in pages, as
    growing vectors would fragment the heap. Unwritten pages take no memory.

    Args:
        dtype: type of the integers.
        shape: shape of an item; () for a vector.
        expected: number of items for which memory is reserved, up to 1 GiB.
    """

    def __init__(
        self, dtype: type[np.integer[Any]], shape: tuple[int, ...] = (), expected: int = 0
    ) -> None:
        most = _RESERVED // (np.dtype(dtype).itemsize * max(1, prod(shape)))
        try:
            self._memory = _memory((max(_FIRST, min(expected, most)), *shape), np.dtype(dtype))
        except MemoryError:  # that much cannot be reserved, but maybe the run ends before
            self._memory = _memory((_FIRST, *shape), np.dtype(dtype))
        self._count = 0

    def __len__(self) -> int:
        """Return the number of items."""
        return self._count

    def extend(self, items: ArrayLike) -> None:
        """Add items at the end: an array of them, or a single integer."""
        added = len(items) if isinstance(items, np.ndarray) and items.ndim else np.size(items)
        start, self._count = self._count, self._count + added
        if self._count > len(self._memory):
            count = max(self._count, 2 * len(self._memory))
            larger = _memory((count, *self._memory.shape[1:]), self._memory.dtype)
            larger[:start] = self._memory[:start]
            self._memory = larger
        self._memory[start : self._count] = items

    @property
    def array(self) -> NDArray[Any]:
        """The present items, not a copy; later ones are not included."""
        return self._memory[: self._count]


def _memory(shape: tuple[int, ...], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return memory for integers.

    NumPy asks for huge pages, which take pictures several times as fast; see docs/speed.md. A
    mapping of its own cannot have them.
    """
    size = prod(shape) * dtype.itemsize
    if len(shape) > 1 or size < _LARGE:
        return np.empty(shape, dtype)
    return np.frombuffer(mmap(-1, size), dtype)
