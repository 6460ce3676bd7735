"""The modules that the page's compiler needs: its imports, and theirs."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Final

START: Final = "npchip.studio.toolchain.page"
BROUGHT: Final = ("npchip", "yaml")
"""Packages to bring along; the rest is Python's own, or not wanted."""
_UNWANTED: Final = ("yaml.cyaml",)  # needs a compiled module; PyYAML does without


def needed() -> dict[str, Path]:
    """Return the file of each module by its dotted name.

    Modules that are imported late count, those for annotations only do not.
    """
    found: dict[str, Path] = {}
    work = [START]
    while work:
        name = work.pop()
        if name in found or name in _UNWANTED or name.split(".")[0] not in BROUGHT:
            continue
        path = _file(name)
        if path is None:
            continue  # a name in a module
        found[name] = path
        work += [name.rpartition(".")[0]] * ("." in name)
        work += _imports(name, path)
    return dict(sorted(found.items()))


def _file(name: str) -> Path | None:
    try:
        spec = find_spec(name)
    except ModuleNotFoundError:  # its parent is no package
        return None
    return Path(spec.origin) if spec and spec.origin and spec.origin.endswith(".py") else None


def _imports(name: str, path: Path) -> Iterator[str]:
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    nodes: list[ast.AST] = [ast.parse(path.read_text(encoding="utf-8"))]
    while nodes:
        node = nodes.pop()
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            nodes += node.orelse
        elif isinstance(node, ast.Import):
            yield from (item.name for item in node.names)
        elif isinstance(node, ast.ImportFrom):
            parts = package.split(".")[: 1 - node.level or None] if node.level else []
            base = ".".join([*parts, *filter(None, [node.module])])
            yield base
            yield from (f"{base}.{item.name}" for item in node.names)
        else:
            nodes += ast.iter_child_nodes(node)
