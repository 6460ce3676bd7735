"""A vector of integers that grows."""

from __future__ import annotations

from mmap import mmap
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_FIRST = 64
_LARGE = 1 << 20


class DynamicArray:
    """A vector of integers that grows at its end.

    A full vector doubles its memory. Large memory comes from the system in pages, as growing
    vectors would fragment the heap. Unwritten pages take no memory.

    Args:
        dtype: type of the integers.
    """

    def __init__(self, dtype: type[np.signedinteger[Any]]) -> None:
        self._memory = _memory(_FIRST, np.dtype(dtype))
        self._count = 0

    def __len__(self) -> int:
        """Return the number of integers."""
        return self._count

    def extend(self, integers: ArrayLike) -> None:
        """Add an integer or a vector of integers at the end."""
        start, self._count = self._count, self._count + np.size(integers)
        if self._count > len(self._memory):
            larger = _memory(max(self._count, 2 * len(self._memory)), self._memory.dtype)
            larger[:start] = self._memory[:start]
            self._memory = larger
        self._memory[start : self._count] = integers

    @property
    def array(self) -> NDArray[Any]:
        """The present integers, not a copy; later ones are not included."""
        return self._memory[: self._count]


def _memory(count: int, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return memory for integers; a large one is a mapping of its own, which is slower to get."""
    if count * dtype.itemsize < _LARGE:
        return np.empty(count, dtype)
    return np.frombuffer(mmap(-1, count * dtype.itemsize), dtype)
