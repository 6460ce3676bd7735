"""The compiler in Pyodide, in Node: the archive, the snapshot, the page's loader."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest

from npchip import load_machine
from npchip.formats.module import to_module
from npchip.isa import load_isa
from npchip.studio.python_files import make_snapshot, write_python_zip
from npchip.studio.toolchain.facade import Toolchain
from tests.studio.calls import bundled, call, request
from tests.support.programs import assembled

STUDIO = Path(__file__).parents[2] / "src" / "npchip" / "studio"
MODULES = STUDIO / "node_modules"
NODE = shutil.which("node")
NAMES = ("frame_difference", "trajectory", "edges")


def test_the_archive(tmp_path: Path) -> None:
    """What is packed runs by itself, and twice the same is packed."""
    archive, again = tmp_path / "npchip.zip", tmp_path / "again.zip"
    write_python_zip(archive)
    write_python_zip(again)
    assert archive.read_bytes() == again.read_bytes()
    assert archive.stat().st_size < 400_000
    with zipfile.ZipFile(archive) as packed:
        packed.extractall(tmp_path / "unpacked")
    assert not (tmp_path / "unpacked" / "npchip" / "cli").exists()
    code = (
        f"import sys; sys.path[:0] = [{str(tmp_path / 'unpacked')!r}]\n"
        "import json\n"
        "from npchip.studio.toolchain import page\n"
        "print(page.__file__)\n"
        "print(len(json.loads(page.call('language', '[]')[0])['value']['entries']))\n"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True, check=False
    )
    file, count = done.stdout.split()
    assert file.startswith(str(tmp_path))
    assert int(count) == len(call(Toolchain(tmp_path / "project"), "language")["entries"])


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


@pytest.mark.long
@pytest.mark.skipif(not NODE, reason="Node is not installed")
@pytest.mark.skipif(not (MODULES / "pyodide").is_dir(), reason="the page's packages are not there")
def test_in_pyodide(tmp_path: Path) -> None:
    """It gives the same answers and the same modules, from its files and from a snapshot."""
    (tmp_path / "python").mkdir()
    (tmp_path / "pyodide").symlink_to(MODULES / "pyodide")
    write_python_zip(tmp_path / "python" / "npchip.zip")
    make_snapshot(Path(NODE or ""), tmp_path)
    toolchain = Toolchain(tmp_path / "project")
    for snapshot in (False, True):
        calls = asked()
        answers = answered(tmp_path, calls, snapshot=snapshot)
        assert len(answers) == len(calls)
        for each, answer in zip(calls, answers, strict=True):
            text, module = toolchain.call(each["method"], json.dumps(each["args"]))
            assert without_times(answer["text"]) == without_times(text)
            assert answer["module"] == (module and base64.b64encode(module).decode())
        isa, modules = load_isa(), [answer["module"] for answer in answers]
        for number, name in enumerate(NAMES):
            made = to_module(assembled(name), load_machine("default"), isa)
            assert base64.b64decode(modules[2 * number]) == made


def answered(site: Path, calls: list[dict[str, Any]], *, snapshot: bool) -> list[dict[str, Any]]:
    loader = STUDIO / "page" / "compiler" / "python.ts"
    script = Path(__file__).with_name("pyodide.mjs")
    done = subprocess.run(
        [str(NODE), str(script), str(MODULES), str(loader), str(site)],
        input=json.dumps({"calls": calls, "snapshot": snapshot}),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert ("left out by the test" in done.stderr) != snapshot
    return [json.loads(line) for line in done.stdout.splitlines()]


def without_times(text: str) -> Any:
    answer = json.loads(text)
    if isinstance(answer.get("value"), dict):
        answer["value"].pop("milliseconds", None)
    return answer
