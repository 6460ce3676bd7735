"""The one checker of keys and values in YAML files, and in options that stand for them."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, Self, TypeVar

from npchip.base.errors import InputError, NpchipError
from npchip.base.suggest import shown, suggestion
from npchip.base.yaml import Located

_T = TypeVar("_T")

QUOTES = "YAML takes NO, YES, ON and OFF for true or false: write them in quotes"


class Codes(NamedTuple):
    """Codes of what can be wrong with the keys of a mapping."""

    unknown: str
    missing: str
    type: str


@dataclass(eq=False)
class Section:
    """A mapping of a file, or of options, whose keys are taken one by one.

    Attributes:
        data: the mapping.
        file: the file, as messages call it; None for options of the command line.
        name: the mapping, as messages call it, such as ``a scene``.
        prefix: what messages on a value put before its key, such as ``camera1.``.
    """

    codes: ClassVar[Codes]
    error_type: ClassVar[type[NpchipError]] = InputError

    data: Mapping[str, Any]
    file: str | None
    name: str
    prefix: str = ""

    def line(self, key: str | None = None) -> int:
        """Return the line of a key, or of the mapping; 0 where no file holds it."""
        if not isinstance(self.data, Located):
            return 0
        return self.data.lines.get(key, self.data.line) if key else self.data.line

    def error(
        self,
        message: str,
        *,
        code: str | None = None,
        key: str | None = None,
        hint: str | None = None,
    ) -> NpchipError:
        """Make an error that names file and line.

        Args:
            message: what is wrong.
            code: its code; that of a wrong type by default.
            key: whose line to name; by default that of the mapping.
            hint: what the user can do about it.
        """
        line = self.line(key)
        place = f"{self.file}:{line}: " if line else ""
        text = f"{place}{self.worded(message)}"
        return self.error_type(code or self.codes.type, text, hint=hint)

    def worded(self, message: str) -> str:
        """Return what an error says after the place; by default the message."""
        return message

    def called(self, key: str) -> str:
        """Return a key as messages call it."""
        return key if self.line() else f"--{key}"

    def check_keys(self, required: Collection[str], optional: Collection[str] = ()) -> None:
        """Refuse unknown keys and missing ones."""
        known = [*required, *optional]
        for key in self.data:
            if key not in known:
                raise self.error(
                    f"{self.name} has no {self.called(key)}: it takes {', '.join(known)}",
                    code=self.codes.unknown,
                    key=key,
                    hint=suggestion(key, known),
                )
        for key in required:
            self.need(key)

    def need(self, key: str) -> Any:
        """Return the value of a key that must be there."""
        if key not in self.data:
            message = f"{self.name} needs {self.called(key)}"
            raise self.error(message, code=self.codes.missing)
        return self.data[key]

    def get(self, key: str, kind: type, default: Any = None, what: str = "") -> Any:
        """Return the value of a key, of one type; messages call that `what`."""
        value = self.data.get(key, default)
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            quotes = QUOTES if kind is str and isinstance(value, bool) else None
            raise self.wrong(key, what or _TYPES[kind], value, quotes)
        return value

    def wrong(self, key: str, expected: str, found: Any, hint: str | None = None) -> NpchipError:
        """Make the error of a value of another type than expected."""
        message = f"{self.prefix}{self.called(key)}: expected {expected}, found {shown(found)}"
        return self.error(message, key=key, hint=hint)

    def make(self, kind: Callable[..., _T], values: Mapping[str, Any]) -> _T:
        """Make an object; an error gets the place of the key that it begins with, or of all."""
        try:
            return kind(**values)
        except InputError as error:
            key, message = re.match(r"\w*", error.message), f"{self.prefix}{error.message}"
            raise self.error(
                message, code=error.code, key=key and key[0], hint=error.hint
            ) from None

    def section(self, key: str, name: str | None = None, prefix: str = "") -> Self:
        """Return the mapping of a key that must be there."""
        self.need(key)
        return type(self)(self.get(key, Located), self.file, name or key, prefix)


_TYPES: dict[type, str] = {
    str: "a text",
    int: "a whole number",
    bool: "true or false",
    list: "a list",
    dict: "a mapping",
    Located: "a mapping (key: value)",
}
