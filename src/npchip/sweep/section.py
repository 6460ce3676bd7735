"""A mapping of a sweep file, and the axes in it."""

from __future__ import annotations

from typing import Any

from npchip.base.section import Codes, Section
from npchip.sweep.axes import AxisError, values


class SweepSection(Section):
    """A mapping of a sweep file."""

    codes = Codes(unknown="NP642", missing="NP643", type="NP644")

    def axis(self, key: str) -> tuple[Any, ...]:
        """Return the values that a key stands for."""
        try:
            return values(self.data[key])
        except AxisError as error:
            raise self.error(f"{self.prefix}{key}: {error}", code="NP645", key=key) from None

    def entries(self, key: str, what: str) -> list[Any]:
        """Return the list in a key, which must hold something."""
        found: list[Any] = self.get(key, list, what=what)
        if not found:
            raise self.wrong(key, what, found)
        return found
