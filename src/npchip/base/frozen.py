"""Mappings that do not change, and errors: both travel between processes."""

from __future__ import annotations

import copyreg
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, TypeVar

_K = TypeVar("_K")
_V = TypeVar("_V")


class FrozenMap(Mapping[_K, _V]):
    """A mapping that cannot be changed; unlike a `MappingProxyType` it can be pickled and hashed.

    Args:
        items: another mapping, or pairs of key and value; they are copied.
    """

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[_K, _V] | Iterable[tuple[_K, _V]] = ()) -> None:
        self._items = dict(items)

    def __getitem__(self, key: _K) -> _V:
        return self._items[key]

    def __iter__(self) -> Iterator[_K]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._items,)  # the oldest protocols know no slots

    def __hash__(self) -> int:
        return hash(frozenset(self._items.items()))

    def __repr__(self) -> str:
        return f"FrozenMap({self._items!r})"


class PortableError(Exception):
    """An error that can be pickled, whatever arguments its class takes.

    Pickle would call the class with the message alone; a process pool then waits for ever.
    """

    def __reduce__(self) -> tuple[Any, ...]:
        return copyreg.__newobj__, (type(self), *self.args), self.__dict__  # type: ignore[attr-defined]
