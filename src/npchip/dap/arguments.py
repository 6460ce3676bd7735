"""The arguments of a request, each checked when it is taken."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from npchip.base.errors import InputError
from npchip.base.suggest import shown

_CODE: Final = "NP358"


class Arguments:
    """The arguments of a request, or an object inside them.

    Args:
        what: how messages call it.
        data: as JSON has it.

    Raises:
        InputError: NP358, by every method: a value is missing or of another kind.
    """

    def __init__(self, what: str, data: Any) -> None:
        if data is not None and not isinstance(data, dict):
            raise wrong(what, "an object", data)
        self.what = what
        self.data: Mapping[str, Any] = data or {}

    def _take(self, key: str, kind: type, name: str, default: Any) -> Any:
        value = self.data.get(key)
        if value is None and default is not ...:
            return default
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            raise wrong(f"{self.what}: {key}", name, value)
        return value

    def text(self, key: str, default: Any = ...) -> Any:
        """Return a text; without it the default, or an error if there is none."""
        return self._take(key, str, "a text", default)

    def flag(self, key: str) -> bool:
        """Return true or false; false if it is missing."""
        return bool(self._take(key, bool, "true or false", False))

    def number(
        self, key: str, default: Any = ..., least: int | None = None, most: int | None = None
    ) -> Any:
        """Return a whole number."""
        value = self._take(key, int, "a whole number", default)
        if value is not None and (
            (least is not None and value < least) or (most is not None and value > most)
        ):
            bounds = f"from {least} on" if most is None else f"from {least} to {most}"
            raise wrong(f"{self.what}: {key}", f"a whole number {bounds}", value)
        return value

    def texts(self, key: str) -> list[str]:
        """Return a list of texts; an empty one if it is missing."""
        items: list[Any] = self._take(key, list, "a list", [])
        for item in items:
            if not isinstance(item, str):
                raise wrong(f"{self.what}: {key}", "a list of texts", item)
        return items

    def inner(self, key: str) -> Arguments:
        """Return an object; an empty one if it is missing."""
        return Arguments(f"{self.what}: {key}", self.data.get(key))

    def items(self, key: str) -> list[Arguments]:
        """Return a list of objects; an empty one if it is missing."""
        items = self._take(key, list, "a list", [])
        return [Arguments(f"{self.what}: {key}", item) for item in items]


def wrong(what: str, expected: str, found: Any, hint: str | None = None) -> InputError:
    """Return the error for a value of another kind."""
    return InputError(_CODE, f"{what}: expected {expected}, found {shown(found)}", hint=hint)
