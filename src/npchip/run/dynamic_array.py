"""Integers to which others are added, one or many at a time."""

from __future__ import annotations

from mmap import mmap
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_FIRST = 64
_LARGE = 1 << 20


class DynamicArray:
    """A vector of integers at whose end others are added.

    Its memory doubles when it is full. Large memory is taken from the system and given back page
    by page: on the heap, the arrays of a long run would leave holes in each other's wake, a third
    of what the integers themselves take. Pages not yet written take no memory.

    Args:
        dtype: the type of the integers.
    """

    def __init__(self, dtype: type[np.signedinteger[Any]]) -> None:
        self._memory = _memory(_FIRST, np.dtype(dtype))
        self._count = 0

    def __len__(self) -> int:
        """Return how many integers there are."""
        return self._count

    def extend(self, integers: ArrayLike) -> None:
        """Add an integer, or a vector of them, at the end."""
        start, self._count = self._count, self._count + np.size(integers)
        if self._count > len(self._memory):
            larger = _memory(max(self._count, 2 * len(self._memory)), self._memory.dtype)
            larger[:start] = self._memory[:start]
            self._memory = larger
        self._memory[start : self._count] = integers

    @property
    def array(self) -> NDArray[Any]:
        """The integers, without a copy: what is added later is not among them."""
        return self._memory[: self._count]


def _memory(count: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return room for integers; for many, in pages of its own, which the system is slow to give."""
    if count * dtype.itemsize < _LARGE:
        return np.empty(count, dtype)
    return np.frombuffer(mmap(-1, count * dtype.itemsize), dtype)
