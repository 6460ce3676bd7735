"""The floors of the house, and the invariants of docs/architecture.md."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from npchip.isa import load_isa

PACKAGE = Path(__file__).parents[1] / "src" / "npchip"
QUIET = (
    *("base", "isa", "machine", "program", "frames", "assembler", "engines", "run"),
    "kernels",
)
FACES = {"__init__", "__main__", "pytest_plugin"}
FLOORS = (
    ("base",),
    ("isa", "machine", "bundle"),
    ("program", "frames"),
    ("assembler", "engines"),
    ("formats", "editors", "kernels", "run"),
    ("trace", "testing", "host", "debugger", "language"),
    ("report", "lsp", "dap"),
    ("profile", "course"),
    ("studio", "sweep"),
    ("cli", "pytest_plugin"),
    ("__main__",),
)
"""Rooms by floor, the lowest first. A room imports from lower floors only."""
INNER_FLOORS = {
    "engines": (
        ("rows",),
        ("counts",),
        ("batch",),
        ("state",),
        ("base",),
        ("traps",),
        ("reference", "wasm.translate"),
        ("wasm.emit",),
        ("wasm.translation",),
        ("wasm.host",),
    ),
    "host": (("vision",), ("scenes", "rig")),
}
"""The same inside packages that hold packages."""


def sources(*rooms: str) -> list[Path]:
    found = [path for room in rooms for path in sorted((PACKAGE / room).rglob("*.py"))]
    assert len(found) >= len(rooms)
    return found


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imports(path: Path) -> set[str]:
    """Modules that a file imports, wherever in it."""
    found: set[str] = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            found |= {item.name for item in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{item.name}" for item in node.names)}
    return found


def calls(path: Path) -> set[str]:
    """Names of the functions that a file calls."""
    functions = [node.func for node in ast.walk(tree(path)) if isinstance(node, ast.Call)]
    return {item.id for item in functions if isinstance(item, ast.Name)}


def modules() -> dict[str, Path]:
    """Every module below npchip, by its dotted name without ``npchip.``."""
    found: dict[str, Path] = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        found[".".join(parts).removesuffix(".__init__")] = path
    assert len(found) > 100
    return found


MODULES = modules()


@cache
def graph() -> dict[str, set[str]]:
    """The modules that each module imports, wherever in it, but for annotations only."""
    found: dict[str, set[str]] = {}
    for name, path in MODULES.items():
        found[name] = {
            item.removeprefix("npchip.")
            for item in imported(tree(path))
            if item.removeprefix("npchip.") in MODULES
        } - {name}
    return found


def imported(file: ast.Module) -> Iterator[str]:
    """The dotted name of whatever a file imports: of a name in a module, the module's."""
    nodes: list[ast.AST] = [file]
    while nodes:
        node = nodes.pop()
        if isinstance(node, ast.Import):
            yield from (item.name for item in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            for item in node.names:
                inner = f"{node.module}.{item.name}"
                yield inner if inner.removeprefix("npchip.") in MODULES else node.module
        elif isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            nodes += node.orelse
        else:
            nodes += ast.iter_child_nodes(node)


def faults(rooms: Mapping[str, str], floors: Sequence[Sequence[str]]) -> list[str]:
    """Imports between rooms that do not lead to a lower floor.

    Args:
        rooms: the room of each module looked at.
        floors: rooms by floor, the lowest first.
    """
    floor = {room: number for number, names in enumerate(floors) for room in names}
    return [
        f"{name} (floor {floor[room]}) imports {below} (floor {floor[rooms[below]]})"
        for name, room in rooms.items()
        for below in sorted(graph()[name])
        if below in rooms and rooms[below] != room and floor[rooms[below]] >= floor[room]
    ]


def test_every_module_stands_in_a_room_of_some_floor() -> None:
    loose = {path.stem for path in PACKAGE.glob("*.py")}
    assert loose == FACES
    known = {room for floor in FLOORS for room in floor}
    assert {name.split(".")[0] for name in MODULES} - {"__init__"} <= known


def test_imports_lead_to_lower_floors_only() -> None:
    rooms = {name: name.split(".")[0] for name in MODULES if name != "__init__"}
    assert not faults(rooms, FLOORS)


@pytest.mark.parametrize("package", INNER_FLOORS)
def test_imports_inside_a_package_lead_to_lower_floors_only(package: str) -> None:
    floors = INNER_FLOORS[package]
    rooms: dict[str, str] = {}
    for name in MODULES:
        inner = name.removeprefix(f"{package}.")
        names = [room for floor in floors for room in floor]
        found = [room for room in names if inner == room or inner.startswith(f"{room}.")]
        if inner != name and found:
            rooms[name] = max(found, key=len)
    assert len(rooms) > len(floors)
    assert not faults(rooms, floors)


def test_no_circle_of_files() -> None:
    TopologicalSorter(graph()).prepare()  # raises CycleError with the circle


def test_an_import_that_leads_up_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(graph(), "base.errors", {"run.chip"})
    rooms = {name: name.split(".")[0] for name in MODULES if name != "__init__"}
    assert faults(rooms, FLOORS) == ["base.errors (floor 0) imports run.chip (floor 4)"]
    with pytest.raises(CycleError):
        TopologicalSorter(graph()).prepare()


@pytest.mark.parametrize("path", sources(*QUIET), ids=lambda p: p.name)
def test_only_the_command_line_and_reports_print(path: Path) -> None:
    assert not calls(path) & {"print", "input"}
    assert not {m for m in imports(path) if m.split(".")[0] in {"rich", "click"}}
    assert not {m for m in imports(path) if m.startswith(("npchip.cli", "npchip.report"))}


@pytest.mark.parametrize("path", sources("engines"), ids=lambda p: p.name)
def test_engines_know_nothing_of_the_world_outside(path: Path) -> None:
    """They neither print, open files nor read clocks, and import nothing that shows results."""
    names = {node.id for node in ast.walk(tree(path)) if isinstance(node, ast.Name)}
    assert not names & {"print", "open", "input", "exec", "eval", "breakpoint", "__import__"}
    world = ["time", "datetime", "os", "sys", "io", "pathlib", "random", "logging", "subprocess"]
    assert not {m for m in imports(path) if m.split(".")[0] in world}
    above = tuple(f"npchip.{room}" for room in ("cli", "report", "assembler", "run", "frames"))
    assert not {m for m in imports(path) if m.startswith(above)}


@pytest.mark.parametrize("path", sources("assembler"), ids=lambda p: p.name)
def test_the_assembler_knows_nothing_of_engines(path: Path) -> None:
    assert not {m for m in imports(path) if m.startswith(("npchip.engines", "npchip.run.chip"))}


@pytest.mark.parametrize("path", sources("engines"), ids=lambda p: p.name)
def test_engines_name_no_instruction(path: Path) -> None:
    names = set(load_isa().instructions)
    strings = {node.value for node in ast.walk(tree(path)) if isinstance(node, ast.Constant)}
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
    private = {
        node.attr
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Attribute)
        and node.attr.startswith("_")
        and not (isinstance(node.value, ast.Name) and node.value.id in {"self", "cls"})
    }
    assert not private - {"__args__", "__init__"}
    assert not {m for m in imports(path) if m.startswith(("npchip.engines.", "npchip.cli"))} - {
        "npchip.engines.base",
        "npchip.engines.base.TrapError",
        "npchip.engines.state",
        "npchip.engines.state.Write",
    }


@pytest.mark.parametrize("pattern", ["t*.s", pytest.param("[!t]*.s", marks=pytest.mark.long)])
def test_the_tool_chain_needs_neither_numpy_nor_wasmtime(tmp_path: Path, pattern: str) -> None:
    """It assembles, lists, writes, bounds and translates every program where neither is there."""
    programs = sorted((PACKAGE.parents[1] / "asm").glob(pattern))
    assert len(programs) > 3
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_NUMPY, str(tmp_path), *map(str, programs)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.stderr, done.stdout.split()) == ("", [path.stem for path in programs])


def test_the_compiler_of_the_page_needs_python_and_yaml_alone(tmp_path: Path) -> None:
    """It does all that the page asks where only what the page brings can be imported."""
    done = subprocess.run(
        [sys.executable, "-c", IN_THE_PAGE, str(tmp_path)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.stderr, done.stdout.split()) == ("", ["done"])


IN_THE_PAGE = """
import sys

for name in ("numpy", "wasmtime", "click", "rich", "PIL", "natsort", "tifffile", "av"):
    sys.modules[name] = None  # importing it fails
import json
from pathlib import Path

from npchip.studio.toolchain import page
from npchip.studio.toolchain.facade import Toolchain
from npchip.studio.toolchain.modules import needed

toolchain = Toolchain(Path(sys.argv[1]))


def call(method, *arguments):
    text, module = toolchain.call(method, json.dumps(arguments))
    answer = json.loads(text)
    assert "error" not in answer, answer
    return answer["value"], module


noisy = "extends: default\\nsensor: {fixed_pattern: 9, noise_rms: 2}\\n"
request = {
    "project": {"main": "warm.s", "files": {"warm.s": page.PROGRAM}},
    "machine": {"name": "noisy.yaml", "text": noisy},
    "defines": {},
    "memory": [],
    "module": True,
}
compiled, module = call("compile", request)
assert module.startswith(b"\\0asm"), compiled
call("language")
call("bounds")
assert call("condition", "any sum > 3")[0]["triggers"]
assert call("writers", {"kind": "pixel", "row": 1, "column": 2})[0]
(run,) = call("tests", request)[0]["runs"]
picture = {"cycles": 1, "instructions": 1, "outputs": {"total": 0}}
result = {"status": "halted", "setup": picture, "frames": [picture, picture]}
(verdict,) = call("judge", run["name"], run["machine"], result)[0]
assert verdict["holds"]
missing = {name for name in sys.modules if name.split(".")[0] in {"npchip", "yaml"}} - {*needed()}
assert missing <= {"yaml.cyaml", "yaml._yaml", needed.__module__}, missing
print("done")
"""


WITHOUT_NUMPY = """
import sys

sys.modules["numpy"] = sys.modules["wasmtime"] = None  # importing them fails
from pathlib import Path

from npchip import assemble, load_machine
from npchip.assembler import disassemble
from npchip.assembler.listing import listing, read_texts
from npchip.editors.textmate import grammar
from npchip.engines.wasm.translate.summary import MASKS, SAME
from npchip.program.graph import Place
from npchip.engines.wasm.translation import translate
from npchip.formats.files import ASSEMBLED, load_program, write_program
from npchip.isa import load_isa
from npchip.program.bounds import static_view

isa, machine, folder = load_isa(), load_machine("default"), Path(sys.argv[1])
assert grammar(isa)
for path in map(Path, sys.argv[2:]):
    program = assemble(path)
    assert listing(program, read_texts(program), [machine], isa)
    assert disassemble(program, isa)
    for suffix in () if program.memory else ASSEMBLED:  # the bytes of .memory need NumPy
        write_program(program, folder / f"program{suffix}", isa)
        assert load_program(folder / f"program{suffix}").words == program.words
    assert static_view(program, machine, isa).frame is not None
    module = translate(program, machine, isa, Place(0), dict.fromkeys(range(MASKS), SAME))
    assert module.binary.startswith(b"\\0asm")
    print(path.stem)
"""
