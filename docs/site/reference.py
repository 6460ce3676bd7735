"""The reference of the Python API: the public names of each module, from their docstrings."""

from __future__ import annotations

import ast
import inspect
import re
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from docs.site.order import listed
from docs.site.sources import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from docs.site.sources import Sources

MODULES = (
    "npchip",
    "npchip.frames",
    "npchip.assembler",
    "npchip.machine",
    "npchip.isa",
    "npchip.program",
    "npchip.formats",
    "npchip.trace",
    "npchip.profile",
    "npchip.debugger.session",
    "npchip.sweep",
    "npchip.host.scenes",
    "npchip.host.rig",
    "npchip.host.vision.fusion",
)
"""Modules whose public names are the interface of npchip, in the order of the reference."""
_INTRODUCTION = """\
# The Python API

What npchip's modules offer to programs in Python. [First steps](docs/first-steps.md#from-python)
shows them at work, and so does a [notebook](examples/first_steps.ipynb). Arrays are NumPy's; each
docstring states shapes, types, units, and the errors that it raises.
"""
_CODE = re.compile(r"^(from|import) ", re.MULTILINE)


def write(sources: Sources) -> None:
    """Write the page of the reference, and one for each module."""
    sources.add("api.md", _INTRODUCTION + listed("", [f"api/{x}" for x in MODULES]), ROOT)
    seen: set[int] = set()
    for name in MODULES:
        sources.add(f"api/{name}.md", _page(import_module(name), seen), ROOT)


def _page(module: ModuleType, seen: set[int]) -> str:
    name = module.__name__
    body = ["```{eval-rst}", f".. py:module:: {name}", *_directives(module, seen), "```"]
    return "\n".join([f"# `{name}`", "", *_summary(module), *body, ""])


def _summary(module: ModuleType) -> Iterator[str]:
    """Yield the docstring of a module as Markdown: its code in a fence."""
    text = inspect.getdoc(module) or ""
    first, _, rest = text.partition("\n\n")
    yield from (first, "")
    if rest:
        yield from ("```python", rest, "```", "") if _CODE.search(rest) else (rest, "")


def _directives(module: ModuleType, seen: set[int]) -> Iterator[str]:
    """Yield a directive for each public name that no earlier page has."""
    for name in _public(module):
        value = getattr(module, name)
        if id(value) in seen:
            continue
        seen.add(id(value))
        full = f"{module.__name__}.{name}"
        if inspect.isclass(value):
            kind = "exception" if issubclass(value, BaseException) else "class"
            yield from ("", f".. auto{kind}:: {full}", "   :members:")
        elif inspect.isroutine(value):
            yield from ("", f".. autofunction:: {full}")
        else:
            yield from ("", f".. py:data:: {full}", "", *_described(module.__name__, name))


def _described(module: str, name: str) -> list[str]:
    """Return what a constant's home says below it; a constant has no docstring of its own."""
    from sphinx.pycode import ModuleAnalyzer  # noqa: PLC0415 - the command looks for it first

    analyzer = ModuleAnalyzer.for_module(module)
    for node in ast.walk(ast.parse(analyzer.code)):
        if isinstance(node, ast.ImportFrom) and node.module:
            names = {item.name for item in node.names}
            if name in names:
                return _described(node.module, name)
    return [f"   {line}" for line in analyzer.find_attr_docs().get(("", name), ())]


def _public(module: ModuleType) -> list[str]:
    """Return the names that a module lists, or else those that it defines."""
    own = (
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", "") == module.__name__
    )
    return [*getattr(module, "__all__", own)]
