"""Print the lowest versions that pyproject.toml allows, as constraints for pip.

``python -m tests.support.lowest [EXTRA]…``
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

PROJECT = Path(__file__).parents[2] / "pyproject.toml"
_BOUND = re.compile(r"([\w-]+)>=([\d.]+)")
_EXTRAS = re.compile(r"npchip\[([\w,]+)\]")


def lowest(*extras: str) -> dict[str, str]:
    """Return the lower bound of every package that npchip with some extras depends on."""
    project = tomllib.loads(PROJECT.read_text("utf-8"))["project"]
    found: dict[str, str] = {}
    for line in [*project["dependencies"], *_named(project["optional-dependencies"], extras)]:
        bound = _BOUND.fullmatch(line)
        if bound is None:
            raise ValueError(f"{line}: expected NAME>=VERSION")
        name, version = bound.groups()
        found[name] = max(found.get(name, "0"), version, key=_parts)
    return found


def _named(lists: dict[str, list[str]], extras: tuple[str, ...]) -> list[str]:
    lines: list[str] = []
    for line in (line for extra in extras for line in lists[extra]):
        inner = _EXTRAS.fullmatch(line)
        lines += _named(lists, tuple(inner[1].split(","))) if inner else [line]
    return lines


def _parts(version: str) -> list[int]:
    return [int(part) for part in version.split(".")]


if __name__ == "__main__":
    sys.stdout.writelines(f"{name}=={version}\n" for name, version in lowest(*sys.argv[1:]).items())
