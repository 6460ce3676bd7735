"""Safe YAML with line numbers; duplicate keys are refused, numbers are read as people mean them.

PyYAML follows YAML 1.1, to which 010 is 8, 1:30 is 90 and 1e1 a text. Numbers here are those of
YAML 1.2, but 010 is refused. Dates are texts.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import yaml

from npchip.base.errors import InputError
from npchip.base.files import read_bytes
from npchip.base.suggest import shown

MAX_BYTES = 1 << 20
"""Most bytes of a YAML file."""
_MAX_DEPTH = 32
_MAX_DIGITS = 1000
_Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # libyaml if it is there


class Located(dict[str, Any]):
    """A mapping that remembers its own 1-based line and that of each key."""

    line: int = 0
    lines: dict[str, int]


class _LocatingLoader(_Loader):  # type: ignore[misc]
    """Safe loader that makes `Located` mappings and refuses duplicate keys."""


_BOOL, _NULL, _INT, _FLOAT = (
    f"tag:yaml.org,2002:{name}" for name in ("bool", "null", "int", "float")
)
_INTEGER = re.compile(r"[-+]?(?:0[xX][0-9a-fA-F_]+|0[oO][0-7_]+|0[bB][01_]+|[0-9][0-9_]*)$")
_DECIMAL = re.compile(
    r"[-+]?(?:(?:[0-9][0-9_]*(?:\.[0-9_]*)?|\.[0-9][0-9_]*)(?:[eE][-+]?[0-9]+)?|\.(?:inf|Inf|INF))$"
    r"|\.(?:nan|NaN|NAN)$"
)
_LEADING_ZERO = re.compile(r"[-+]?0[0-9_]")
_LocatingLoader.yaml_implicit_resolvers = {
    first: kept
    for first, resolvers in _Loader.yaml_implicit_resolvers.items()
    if (kept := [item for item in resolvers if item[0] in {_BOOL, _NULL}])
}
_LocatingLoader.add_implicit_resolver(_INT, _INTEGER, list("-+0123456789"))
_LocatingLoader.add_implicit_resolver(_FLOAT, _DECIMAL, list("-+.0123456789"))


def _error(problem: str, item: Any) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=item.start_mark)


def _refuse_bombs(text: str) -> None:
    """Refuse aliases, which turn a kilobyte into gigabytes, and nesting that overflows a stack."""
    depth = 0
    for event in yaml.parse(text, Loader=_Loader):
        if isinstance(event, yaml.AliasEvent):
            raise _error("aliases (*name) are not used here", event)
        tag = getattr(event, "tag", None)
        if tag:
            raise _error(f"tags ({shown(tag)}) are not used here", event)
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > _MAX_DEPTH:
                raise _error(f"nested deeper than {_MAX_DEPTH}", event)
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1


def _construct_mapping(loader: Any, node: yaml.MappingNode) -> Located:
    result = Located()
    result.line = node.start_mark.line + 1
    result.lines = {}
    for key_node, value_node in node.value:
        if not isinstance(key_node, yaml.ScalarNode):
            raise _error("a key must be a word", key_node)
        key = key_node.value  # as written: NO is a word here, not false
        if key in result:
            raise _error(f"'{key}' is given twice", key_node)
        result[key] = loader.construct_object(value_node, deep=True)
        result.lines[key] = key_node.start_mark.line + 1
    return result


def _construct_integer(_loader: Any, node: yaml.ScalarNode) -> int:
    text = node.value
    if _LEADING_ZERO.match(text):
        plain = text.replace("_", "").lstrip("-+0") or "0"
        hint = f"write {plain}, 0o{plain} if it is octal, or quotes around a text"
        raise _error(f"{shown(text)} begins with 0: {hint}", node)
    if len(text) > _MAX_DIGITS:
        raise _error("a number is too long", node)
    return int(text.replace("_", ""), 0)


def _construct_decimal(_loader: Any, node: yaml.ScalarNode) -> float:
    if len(node.value) > _MAX_DIGITS:
        raise _error("a number is too long", node)
    text = node.value.replace("_", "").lower()
    return float(text.replace(".inf", "inf").replace(".nan", "nan"))


_LocatingLoader.add_constructor("tag:yaml.org,2002:map", _construct_mapping)
_LocatingLoader.add_constructor(_INT, _construct_integer)
_LocatingLoader.add_constructor(_FLOAT, _construct_decimal)


def load_mapping(text: str, name: str, code: str) -> Located:
    """Return the mapping at the top level of a YAML text.

    Args:
        text: the YAML text.
        name: the name of the text in messages, usually the file's path.
        code: the code of every error.

    Raises:
        InputError: not YAML, not a mapping, a duplicate key, an alias, nested deeper than
            32 levels, or larger than 1 MiB.
    """
    if len(text) > MAX_BYTES:
        raise InputError(code, f"{name}: larger than {MAX_BYTES} bytes")
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
    """Return the mapping at the top level of a YAML file; errors as for `load_mapping`."""
    try:
        text = read_bytes(path, MAX_BYTES).decode()
    except OSError as error:
        raise InputError(code, f"cannot read {path}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise InputError(code, f"{path}: not UTF-8 text at byte {error.start}") from None
    return load_mapping(text, str(path), code)
