"""The cells of the notebook run, in order, as Jupyter runs them."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest

NOTEBOOK = Path(__file__).parents[2] / "examples" / "first_steps.ipynb"


def cells() -> list[dict[str, Any]]:
    document = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert (document["nbformat"], document["nbformat_minor"]) == (4, 5)
    found: list[dict[str, Any]] = document["cells"]
    return found


def shown(source: str, names: dict[str, Any]) -> object:
    """Execute a cell and return the value of its last line, if that is an expression."""
    tree = ast.parse(source)
    last = tree.body[-1]
    if not isinstance(last, ast.Expr):
        exec(compile(tree, NOTEBOOK.name, "exec"), names)  # noqa: S102 - our own cells
        return None
    tree.body.pop()
    exec(compile(tree, NOTEBOOK.name, "exec"), names)  # noqa: S102
    return eval(compile(ast.Expression(last.value), NOTEBOOK.name, "eval"), names)  # noqa: S307


def test_every_cell_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    values = [
        shown("".join(cell["source"]), names) for cell in cells() if cell["cell_type"] == "code"
    ]
    assert len(values) >= 10
    numbers = [value for value in values if isinstance(value, int)]
    assert numbers == [12, 128]  # words; cycles that the mask costs, 2 for each pixel
    assert values[-1] is not None


def test_nothing_that_was_shown_is_kept() -> None:
    for cell in cells():
        assert cell["id"]
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            assert cell["execution_count"] is None
