"""YAML with line numbers: safe, duplicate keys refused, every mapping knows where it stands."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, Self, TypeVar

import yaml

from npchip.base.errors import InputError, NpchipError
from npchip.base.suggest import shown, suggestion

_MAX_BYTES = 1 << 20
_MAX_DEPTH = 32
_T = TypeVar("_T")

QUOTES = "YAML takes NO, YES, ON and OFF for true or false: write them in quotes"
_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # libyaml is ten times faster


class Located(dict[str, Any]):
    """A mapping that remembers its own 1-based line and that of each key."""

    line: int = 0
    lines: dict[str, int]


class _LocatingLoader(_Loader):  # type: ignore[misc]
    """Safe loader that makes `Located` mappings and refuses duplicate keys."""


def _mark(event: yaml.Event) -> Any:
    return event.start_mark  # libyaml's marks have a class of their own


def _refuse_bombs(text: str) -> None:
    """Refuse aliases, which grow a kilobyte into gigabytes, and nesting that overflows a stack."""
    depth = 0
    for event in yaml.parse(text, Loader=_Loader):
        if isinstance(event, yaml.AliasEvent):
            raise yaml.MarkedYAMLError(
                problem="aliases (*name) are not used here", problem_mark=_mark(event)
            )
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > _MAX_DEPTH:
                raise yaml.MarkedYAMLError(
                    problem=f"nested deeper than {_MAX_DEPTH}", problem_mark=_mark(event)
                )
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1


def _construct_mapping(loader: Any, node: yaml.MappingNode) -> Located:
    result = Located()
    result.line = node.start_mark.line + 1
    result.lines = {}
    for key_node, value_node in node.value:
        if not isinstance(key_node, yaml.ScalarNode):
            raise yaml.MarkedYAMLError(
                problem="a key must be a word", problem_mark=key_node.start_mark
            )
        key = key_node.value  # as it is written: NO is a word here, not false
        if key in result:
            raise yaml.MarkedYAMLError(
                problem=f"'{key}' is given twice", problem_mark=key_node.start_mark
            )
        result[key] = loader.construct_object(value_node, deep=True)
        result.lines[key] = key_node.start_mark.line + 1
    return result


_LocatingLoader.add_constructor("tag:yaml.org,2002:map", _construct_mapping)


def load_mapping(text: str, name: str, code: str) -> Located:
    """Parse YAML whose top level is a mapping.

    Args:
        text: the YAML text.
        name: how messages call it, usually the file's path.
        code: error code to use.

    Raises:
        InputError: not YAML, not a mapping, a duplicate key, an alias, nested deeper than
            32 levels, or larger than 1 MiB.
    """
    if len(text) > _MAX_BYTES:
        raise InputError(code, f"{name}: larger than {_MAX_BYTES} bytes")
    try:
        _refuse_bombs(text)
        data = yaml.load(text, Loader=_LocatingLoader)  # noqa: S506 - derives from the safe loader
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        raise InputError(code, f"{name}:{line}: {error.problem or 'not valid YAML'}") from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        first = (str(error).splitlines() or ["cannot be read"])[0]
        raise InputError(code, f"{name}: not valid YAML: {first}") from None
    if not isinstance(data, Located):
        raise InputError(code, f"{name}: expected a mapping (key: value), found {shown(data)}")
    return data


def read_mapping(path: Path, code: str) -> Located:
    """Read a YAML file whose top level is a mapping; errors as `load_mapping`."""
    try:
        with path.open(encoding="utf-8") as file:
            text = file.read(_MAX_BYTES + 1)  # enough to see that it is too large
    except OSError as error:
        raise InputError(code, f"cannot read {path}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise InputError(code, f"{path}: not UTF-8 text at byte {error.start}") from None
    return load_mapping(text, str(path), code)


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
        """Make an error that names file and line (that of `key`, if given); a wrong type's code."""
        line = self.line(key)
        place = f"{self.file}:{line}: " if line else ""
        return InputError(code or self.codes.type, f"{place}{message}", hint=hint)

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
