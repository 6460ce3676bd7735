"""The help of commands where Python runs without docstrings (``-OO``)."""

from __future__ import annotations

import ast
import inspect
import sys

import click


def restore_help(command: click.Command) -> None:
    """Give a command and those below it the docstrings of their functions as help."""
    for each in (command, *getattr(command, "commands", {}).values()):
        if each.callback is not None and not each.help:
            each.help = _docstring(each.callback.__module__, each.callback.__name__)


def _docstring(module: str, function: str) -> str | None:
    try:
        body = ast.parse(inspect.getsource(sys.modules[module])).body
    except OSError:  # installed without sources
        return None
    found = (node for node in body if isinstance(node, ast.FunctionDef) and node.name == function)
    return next(map(ast.get_docstring, found), None)
