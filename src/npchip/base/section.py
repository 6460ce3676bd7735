"""Checks of keys and values in YAML files and in the options that replace them."""

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
    """Codes of the errors in a mapping: unknown key, missing key, wrong type."""

    unknown: str
    missing: str
    type: str


@dataclass(eq=False)
class Section:
    """A mapping from a file or from options, with checks of its keys and values.

    Attributes:
        data: the mapping.
        file: the file's name in messages; None for options of the command line.
        name: the mapping's name in messages, such as ``a scene``.
        prefix: the text before a key in messages about its value, such as ``camera1.``.
    """

    codes: ClassVar[Codes]
    error_type: ClassVar[type[NpchipError]] = InputError

    data: Mapping[str, Any]
    file: str | None
    name: str
    prefix: str = ""

    def line(self, key: str | None = None) -> int:
        """Return the line of a key, or of the mapping; 0 for options."""
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
            message: the message without the place.
            code: the error's code; by default that of a wrong type.
            key: the key whose line to name; by default the line is that of the mapping.
            hint: advice to the user.
        """
        line = self.line(key)
        place = f"{self.file}:{line}: " if line else ""
        text = f"{place}{self.worded(message)}"
        return self.error_type(code or self.codes.type, text, hint=hint)

    def worded(self, message: str) -> str:
        """Return an error's text after the place; subclasses may add to the message."""
        return message

    def called(self, key: str) -> str:
        """Return a key as messages name it: options with ``--``."""
        return key if self.line() else f"--{key}"

    def check_keys(self, required: Collection[str], optional: Collection[str] = ()) -> None:
        """Raise an error for an unknown or a missing key."""
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
        """Return the value of a required key."""
        if key not in self.data:
            message = f"{self.name} needs {self.called(key)}"
            raise self.error(message, code=self.codes.missing)
        return self.data[key]

    def get(self, key: str, kind: type, default: Any = None, what: str = "") -> Any:
        """Return the value of a key, which must be of a type; messages call the type `what`."""
        value = self.data.get(key, default)
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            quotes = QUOTES if kind is str and isinstance(value, bool) else None
            raise self.wrong(key, what or _TYPES[kind], value, quotes)
        return value

    def wrong(self, key: str, expected: str, found: Any, hint: str | None = None) -> NpchipError:
        """Make the error for a value of another type than expected."""
        message = f"{self.prefix}{self.called(key)}: expected {expected}, found {shown(found)}"
        return self.error(message, key=key, hint=hint)

    def make(self, kind: Callable[..., _T], values: Mapping[str, Any]) -> _T:
        """Make an object; an error names the line of the key that its message begins with."""
        try:
            return kind(**values)
        except InputError as error:
            key, message = re.match(r"\w*", error.message), f"{self.prefix}{error.message}"
            raise self.error(
                message, code=error.code, key=key and key[0], hint=error.hint
            ) from None

    def section(self, key: str, name: str | None = None, prefix: str = "") -> Self:
        """Return the mapping that is the value of a required key."""
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
