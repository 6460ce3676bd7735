"""The invariants of docs/architecture.md."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from npchip.isa import load_isa

PACKAGE = Path(__file__).parents[1] / "src" / "npchip"
QUIET = ("isa", "assembler", "machine", "frames", "engines")


def sources(*rooms: str) -> list[Path]:
    found = [path for room in rooms for path in sorted((PACKAGE / room).rglob("*.py"))]
    assert len(found) >= len(rooms)
    return found


def imports(path: Path) -> set[str]:
    """Modules that a file imports, wherever in it."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {item.name for item in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{item.name}" for item in node.names)}
    return found


def calls(path: Path) -> set[str]:
    """Names of the functions that a file calls."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    functions = [node.func for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return {item.id for item in functions if isinstance(item, ast.Name)}


@pytest.mark.parametrize("path", sources(*QUIET), ids=lambda p: p.name)
def test_only_the_command_line_and_reports_print(path: Path) -> None:
    assert not calls(path) & {"print", "input"}
    assert not {m for m in imports(path) if m.split(".")[0] in {"rich", "click"}}
    assert not {m for m in imports(path) if m.startswith(("npchip.cli", "npchip.report"))}


@pytest.mark.parametrize("path", sources("engines"), ids=lambda p: p.name)
def test_engines_know_nothing_of_the_world_outside(path: Path) -> None:
    """They neither print, open files nor read clocks, and import nothing that shows results."""
    names = {n.id for n in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(n, ast.Name)}
    assert not names & {"print", "open", "input", "exec", "eval", "breakpoint", "__import__"}
    world = ["time", "datetime", "os", "sys", "io", "pathlib", "random", "logging", "subprocess"]
    assert not {m for m in imports(path) if m.split(".")[0] in world}
    above = tuple(f"npchip.{room}" for room in ("cli", "report", "assembler", "chip", "frames"))
    assert not {m for m in imports(path) if m.startswith(above)}


@pytest.mark.parametrize("path", sources("assembler"), ids=lambda p: p.name)
def test_the_assembler_knows_nothing_of_engines(path: Path) -> None:
    assert not {m for m in imports(path) if m.startswith(("npchip.engines", "npchip.chip"))}


@pytest.mark.parametrize("path", sources("engines"), ids=lambda p: p.name)
def test_engines_name_no_instruction(path: Path) -> None:
    names = set(load_isa().instructions)
    tree = ast.parse(path.read_text(encoding="utf-8"))
    strings = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    assert not names & {value for value in strings if isinstance(value, str)}


def test_help_does_not_wait_for_numpy() -> None:
    code = (
        "import sys\n"
        "from click.testing import CliRunner\n"
        "from npchip.cli.main import cli\n"
        "assert CliRunner().invoke(cli, ['--help']).exit_code == 0\n"
        "print(*{name.split('.')[0] for name in sys.modules})\n"
    )
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.split()
    assert "npchip" in loaded
    assert not {"numpy", "yaml", "rich", "PIL"} & set(loaded)


@pytest.mark.parametrize("path", sources("debugger"), ids=lambda p: p.name)
def test_the_debugger_uses_the_public_chip(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    private = {
        node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute)
        and node.attr.startswith("_")
        and not (isinstance(node.value, ast.Name) and node.value.id in {"self", "cls"})
    }
    assert not private - {"__args__", "__init__"}
    assert not {m for m in imports(path) if m.startswith(("npchip.engines.", "npchip.cli"))} - {
        "npchip.engines.TrapError",
        "npchip.engines.Write",
    }
