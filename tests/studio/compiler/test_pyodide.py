"""The compiler in Pyodide, in Node: the archive, the snapshot, the page's loader."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import pytest

from npchip import load_machine
from npchip.formats.module import to_module
from npchip.isa import load_isa
from npchip.studio.python_files import make_snapshot, write_python_zip
from npchip.studio.toolchain.facade import Toolchain
from tests.studio.compiler.calls import bundled, request
from tests.support.page_code import PAGE, Bundles, here, node, packages, said_by
from tests.support.programs import assembled

pytestmark = pytest.mark.long

NAMES = ("frame_difference", "trajectory", "edges")


def asked() -> list[dict[str, Any]]:
    """Calls of every method, on three programs."""
    calls: list[tuple[str, list[Any]]] = [
        ("compile", [request(bundled(name), machine)])
        for name in NAMES
        for machine in ("default", "conservative")
    ]
    deep = "MOV r0, #" + "(" * 3000 + "1" + ")" * 3000
    calls += [
        ("compile", [request("JMP nowhere")]),
        ("compile", [request(".macro m\nm\n.endm\nm\n")]),
        ("compile", [request(deep)]),
        ("compile", [request(bundled("sighting"), module=False)]),
        ("compile", [request(bundled("trajectory"), module="run")]),
        ("whole", [request(bundled("trajectory"), module="run")]),
        ("bounds", []),
        ("condition", ["any r1 > 3"]),
        ("condition", ["any r1 >"]),
        ("writers", [{"kind": "pixel", "row": 1, "column": 1}]),
        ("tests", [request(bundled("sighting"))]),
        ("language", []),
        ("scene", ["", {"name": "default"}]),
    ]
    return [{"method": method, "args": args} for method, args in calls]


def test_in_pyodide(tmp_path: Path, bundles: Bundles) -> None:
    """It gives the same answers and the same modules, from its files and from a snapshot."""
    (tmp_path / "python").mkdir()
    (tmp_path / "pyodide").symlink_to(here(packages) / "pyodide")
    write_python_zip(tmp_path / "python" / "npchip.zip")
    make_snapshot(here(node), tmp_path)
    loader = bundles.for_node(PAGE / "compiler" / "python.ts")
    toolchain = Toolchain(tmp_path / "project")
    for snapshot in (False, True):
        calls = asked()
        answers = answered(loader, tmp_path, calls, snapshot=snapshot)
        assert len(answers) == len(calls)
        for each, answer in zip(calls, answers, strict=True):
            text, module = toolchain.call(each["method"], json.dumps(each["args"]))
            assert without_times(answer["text"]) == without_times(text)
            assert answer["module"] == (module and base64.b64encode(module).decode())
        isa, modules = load_isa(), [answer["module"] for answer in answers]
        for number, name in enumerate(NAMES):
            made = to_module(assembled(name), load_machine("default"), isa)
            assert base64.b64decode(modules[2 * number]) == made


def answered(
    loader: Path, site: Path, calls: list[dict[str, Any]], *, snapshot: bool
) -> list[dict[str, Any]]:
    text = json.dumps({"calls": calls, "snapshot": snapshot})
    script = Path(__file__).with_name("pyodide.mjs")
    printed, errors = said_by(script, loader.as_uri(), site, text=text)
    assert ("left out by the test" in errors) != snapshot
    return [json.loads(line) for line in printed.splitlines()]


def without_times(text: str) -> Any:
    answer = json.loads(text)
    if isinstance(answer.get("value"), dict):
        answer["value"].pop("milliseconds", None)
    return answer
