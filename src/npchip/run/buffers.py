"""Numbers that become more, one by one or many at a time."""

from __future__ import annotations

from mmap import mmap
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

_FIRST = 64
_LARGE = 1 << 20


class Growing:
    """A vector of numbers at whose end others are added.

    Its memory doubles when it is full, and where it is large, is taken from the system and given
    back page by page: on the heap, the columns of a long run would leave holes in each other's
    wake, a third of what the numbers themselves take. Pages not yet written take no memory.

    Args:
        kind: the type of the numbers.
    """

    def __init__(self, kind: type[np.signedinteger[Any]]) -> None:
        self._memory = _memory(_FIRST, np.dtype(kind))
        self._count = 0

    def __len__(self) -> int:
        """How many numbers there are."""
        return self._count

    def add(self, numbers: ArrayLike) -> None:
        """Add a number, or a vector of them, at the end."""
        start, self._count = self._count, self._count + np.size(numbers)
        if self._count > len(self._memory):
            larger = _memory(max(self._count, 2 * len(self._memory)), self._memory.dtype)
            larger[:start] = self._memory[:start]
            self._memory = larger
        self._memory[start : self._count] = numbers

    @property
    def numbers(self) -> NDArray[Any]:
        """The numbers, without a copy: what is added later is not among them."""
        return self._memory[: self._count]


def _memory(count: int, kind: np.dtype[Any]) -> NDArray[Any]:
    """Room for numbers: pages of its own for many, as the system takes its time to give some."""
    if count * kind.itemsize < _LARGE:
        return np.empty(count, kind)
    return np.frombuffer(mmap(-1, count * kind.itemsize), kind)
