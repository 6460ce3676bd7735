"""An entry of the instruction-set file: its values checked, its place known to messages."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from npchip.base.errors import IsaError
from npchip.base.suggest import near_miss
from npchip.base.yaml import Located

QUOTES = "; YAML takes NO, YES, ON and OFF for true or false: write them in quotes"


@dataclass(eq=False)
class Entry:
    """A mapping of the file.

    Attributes:
        file: the file as messages call it.
        label: the entry as messages call it.
        data: the mapping.
    """

    file: str
    label: str
    data: Located

    def error(self, message: str, *, code: str = "NP401", key: str | None = None) -> IsaError:
        """An error that names file, line (that of `key`, if given) and entry."""
        line = self.data.lines.get(key, self.data.line) if key else self.data.line
        return IsaError(code, f"{self.file}:{line}: {self.label}: {message}")

    def check_keys(self, required: Collection[str], optional: Collection[str] = ()) -> None:
        """Refuse unknown keys and missing ones."""
        for key in self.data:
            if key not in required and key not in optional:
                near = near_miss(key, [*required, *optional])
                hint = f"; did you mean '{near}'?" if near else ""
                raise self.error(f"unknown key '{key}'{hint}", key=key)
        for key in required:
            if key not in self.data:
                raise self.error(f"'{key}' is missing")

    def get(self, key: str, kind: type, default: Any = None) -> Any:
        """The value of a key, of one type."""
        value = self.data.get(key, default)
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            quotes = QUOTES if kind is str and isinstance(value, bool) else ""
            raise self.error(
                f"'{key}' must be {_called(kind)}, found {_called(type(value))}{quotes}", key=key
            )
        return value

    def text(self, key: str) -> str:
        """The text of a key, without space around it."""
        return str(self.get(key, str)).strip()

    def child(self, key: str, label: str | None = None) -> Entry:
        """The mapping of a key."""
        return Entry(self.file, label or key, self.get(key, Located))


def _called(kind: type) -> str:
    """A type as users of YAML call it."""
    names = {
        str: "a text",
        int: "a whole number",
        float: "a fraction",
        bool: "true or false",
        list: "a list",
        dict: "a mapping",
        Located: "a mapping",
        type(None): "nothing",
    }
    return names.get(kind, f"a {kind.__name__}")
