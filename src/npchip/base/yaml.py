"""YAML with line numbers: safe, duplicate keys refused, every mapping knows where it stands."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from npchip.base.errors import InputError
from npchip.base.suggest import shown

_MAX_BYTES = 1 << 20
_MAX_DEPTH = 32
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
