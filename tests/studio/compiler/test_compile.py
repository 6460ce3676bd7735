"""The page's compiler says and makes what npchip does."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from npchip import AssemblyError, assemble, load_machine
from npchip.assembler.blocks import DIRECTIVES
from npchip.formats.module import to_module
from npchip.frames.memory import initial_memory
from npchip.isa import load_isa
from npchip.language.entries import OUTPUTS
from npchip.program.bounds import static_view
from npchip.program.model import OUTPUT_KINDS
from npchip.studio.precompiled import bundled_tables
from npchip.studio.toolchain import page
from npchip.studio.toolchain.facade import Toolchain
from tests.studio.compiler.calls import bundled, call, call_with_module, request
from tests.support.programs import ASM, assembled

if TYPE_CHECKING:
    from npchip import Program
    from npchip.assembler import Diagnostic

PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
QUICK = {"frame_difference", "imaging"}
ISA = load_isa()


@pytest.fixture
def toolchain(tmp_path: Path) -> Toolchain:
    return Toolchain(tmp_path / "project", bundled_tables())


@pytest.mark.parametrize("machine", ["default", "conservative"])
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=() if n in QUICK else pytest.mark.long) for n in PROGRAMS]
)
def test_programs(toolchain: Toolchain, name: str, machine: str) -> None:
    compiled, module = call_with_module(toolchain, "compile", request(bundled(name), machine))
    program, chip = assembled(name, machine), load_machine(machine)
    assert compiled["diagnostics"] == []
    assert module == to_module(program, chip, ISA, initial_memory(program, chip))
    check_info(compiled["program"], program, machine)
    frame = static_view(program, chip, ISA).frame
    assert frame is not None
    most = None if frame.most == float("inf") else frame.most
    assert call(toolchain, "bounds") == {"least": frame.least, "most": most}


def check_info(info: Any, program: Program, machine: str) -> None:
    chip = load_machine(machine)
    assert [word["cycles"] for word in info["words"]] == [*program.cycles(chip, ISA)]
    for word, line in zip(info["words"], program.source, strict=True):
        lines = [(origin["file"], origin["line"]) for origin in word["origins"]]
        assert [(ASM / file, at) for file, at in lines] == [
            (Path(origin.file), origin.line) for origin in line.origins
        ]
    assert info["labels"] == program.labels
    assert info["symbols"] == program.symbols
    assert info["registers"] == program.registers
    assert [tuple(output.values()) for output in info["outputs"]] == [*program.outputs]
    assert info["budgets"] == program.budget._asdict()
    assert info["exposes"]
    defined = {(item["kind"], item["name"]) for item in info["definitions"]}
    for kind, names in (
        ("label", program.labels),
        ("constant", program.symbols),
        ("register", program.registers),
        ("output", [output.name for output in program.outputs]),
    ):
        assert {name for each, name in defined if each == kind} == {*names}


def test_definitions_have_their_place_and_text(toolchain: Toolchain) -> None:
    source = (
        ".equ LIMIT, 2 + 3\n.reg sum, r4\n.output total, 2, scalar\n"
        ".macro twice a, b\nADD a, b\n.endm\n"
        "  begin: twice sum, r1\nCMP sum, #LIMIT\nOUT 2, sum\nHALT\n"
    )
    info = call(toolchain, "compile", request(source))["program"]
    found = {
        item["name"]: (item["text"], item["place"]["line"], item["place"]["column"])
        for item in info["definitions"]
    }
    assert found == {
        "begin": ("begin: address 0 (0x000)", 7, 3),
        "LIMIT": ("LIMIT = 5", 1, 6),
        "sum": ("sum: register r4", 2, 6),
        "twice": ("macro twice a, b", 4, 8),
        "total": ("total: output on port 2, scalar", 3, 9),
    }
    assert info["words"][0] == {
        "origins": [{"file": "program.s", "line": 5}, {"file": "program.s", "line": 7}],
        "text": "ADD sum, r1",
        "cycles": 1,
    }


BROKEN = {
    "an unknown name": "JMP nowhere\nMOV r0, #300\n",
    "a macro": ".macro m a\n  ADD r0, a\n.endm\nm #999\nHALT\n",
    "an endless macro": ".macro m\nm\n.endm\nm\n",
    "a repetition without an end": ".rept 1_000_000\nNOP\n.endr\n",
    "too long": ".rept 600\nNOP\n.endr\n",
    "nothing": "",
    "a warning": "JMP over\nNOP\nover: HALT\n.equ UNUSED, 1\n",
    "an include that is not there": '.include "lib/maximun.s"\nHALT\n',
    "a mistake in an include": '.include "lib/broken.s"\nHALT\n',
    "an include of itself": '.include "program.s"\nHALT\n',
}
LIBRARY = {"lib/maximum.s": ".equ A, 1\n", "lib/broken.s": '.include "deep.s"\n'}
LIBRARY["lib/deep.s"] = "\tMOV r16, #1\n\tFOO\n"


@pytest.mark.parametrize("source", BROKEN.values(), ids=list(BROKEN))
def test_diagnostics(toolchain: Toolchain, tmp_path: Path, source: str) -> None:
    files = {"program.s": source, **LIBRARY}
    project = {"main": "program.s", "files": files}
    compiled, module = call_with_module(toolchain, "compile", request(project, module=False))
    assert module is None
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    expected: list[Diagnostic] = []
    with contextlib.chdir(tmp_path):
        try:
            assemble("program.s", on_warning=expected.append)
        except AssemblyError as error:
            expected = [*error.diagnostics]
    assert len(compiled["diagnostics"]) == len(expected) > 0
    assert (compiled["program"] is None) == any(item.severity == "error" for item in expected)
    for shown, item in zip(compiled["diagnostics"], expected, strict=True):
        assert (shown["severity"], shown["code"]) == (item.severity, item.code)
        assert (shown["message"], shown["help"]) == (item.message, item.suggestion)
        place = shown["place"]
        assert f"{place['file']}:{place['line']}:{place['column']}" == str(item.span)
        assert len(shown["notes"]) == len(item.notes)
        for note, wanted in zip(shown["notes"], item.notes, strict=True):
            assert note["message"] == wanted.message
            at = wanted.span or item.span
            assert (note["place"]["file"], note["place"]["line"]) == (at.line.file, at.line.number)


def test_columns_count_as_javascript_does(toolchain: Toolchain) -> None:
    """A character beyond 16 bits counts as two."""
    (found,) = call(toolchain, "compile", request('.error "\U0001f600"  JMP'))["diagnostics"]
    assert (found["place"]["column"], found["place"]["length"]) == (14, 3)


@pytest.mark.parametrize(
    ("other", "code", "place"),
    [
        ({"machine": {"name": "defualt"}}, "NP202", None),
        ({"machine": {"name": "m.yaml", "text": "extends: default\nfoo: 1\n"}}, "NP203", 2),
        ({"machine": {"name": "m.yaml", "text": ": :"}}, "NP201", 1),
        ({"defines": {"THRESHOLD": 3}}, "NP026", None),
        ({"memory": [{"address": 255, "planes": 2, "data": 0}]}, "NP243", None),
    ],
)
def test_mistakes_of_the_request(
    toolchain: Toolchain, other: Any, code: str, place: int | None
) -> None:
    compiled, module = call_with_module(
        toolchain, "compile", request("HALT", **other), blobs=[bytes(160)]
    )
    (found,) = compiled["diagnostics"]
    assert (found["code"], found["place"] and found["place"]["line"]) == (code, place)
    assert found["message"]
    assert compiled["program"] is module is None


def test_a_machine_of_the_project(toolchain: Toolchain) -> None:
    text = "extends: default\ngeometry: {np_rows: 2, np_cols: 3}\nsensor: {fixed_pattern: 9}\n"
    files = {"program.s": "frame: EXPOSE\nSAMPLE signal, 0\nJMP frame\n", "small.yaml": text}
    project = {"main": "program.s", "files": files}
    as_file = call_with_module(toolchain, "compile", request(project, "small.yaml"))
    machine = {"name": "small.yaml", "text": text}
    as_text = call_with_module(toolchain, "compile", request(project, machine=machine))
    assert as_file[0]["program"]["machine"]["np_cols"] == 3
    assert as_file[0]["program"] == as_text[0]["program"]
    assert as_file[1] == as_text[1] is not None


def test_memory(toolchain: Toolchain) -> None:
    """Planes of bytes give the module that arrays give."""
    table = np.arange(3 * 80, dtype=np.uint8).reshape(3, 8, 10)
    part = {"address": 7, "planes": 3, "data": 0}
    _, module = call_with_module(
        toolchain, "compile", request(bundled("smooth"), memory=[part]), blobs=[table.tobytes()]
    )
    assert module == to_module(assembled("smooth"), load_machine("default"), ISA, [(7, table)])
    turned = np.asfortranarray(table)
    assert module == to_module(assembled("smooth"), load_machine("default"), ISA, [(7, turned)])


@pytest.mark.parametrize(
    "name", ["../program.s", "/program.s", "a//b.s", ".", "a\n.s", "x" * 300, "a/../b.s", ""]
)
def test_names_that_leave_the_project(toolchain: Toolchain, name: str) -> None:
    project = {"main": "program.s", "files": {"program.s": "HALT", name: ""}}
    (found,) = call(toolchain, "compile", request(project))["diagnostics"]
    assert found["code"] == "NP025"
    assert "no name for a file" in found["message"]


def test_a_project_without_its_main_file(toolchain: Toolchain) -> None:
    project = {"main": "program.s", "files": {}}
    (found,) = call(toolchain, "compile", request(project))["diagnostics"]
    assert found["message"] == "the project has no file program.s"


def test_files_that_are_gone_are_gone(toolchain: Toolchain) -> None:
    files = {"program.s": '.include "lib/maximum.s"\nHALT\n', **LIBRARY}
    assert call(toolchain, "compile", request({"main": "program.s", "files": files}))["program"]
    del files["lib/maximum.s"]
    compiled = call(toolchain, "compile", request({"main": "program.s", "files": files}))
    assert [item["code"] for item in compiled["diagnostics"]] == ["NP027"]


def test_the_language(toolchain: Toolchain) -> None:
    entries = call(toolchain, "language")["entries"]
    named = {kind: [e["name"] for e in entries if e["kind"] == kind] for kind in KINDS}
    assert {*named["instruction"]} == {*ISA.forms}
    assert {*named["directive"]} == {*DIRECTIVES}
    assert {*named["condition"]} == {*ISA.condition_names}
    assert {*OUTPUT_KINDS, "north", "signal"} <= {*named["word"]}
    assert len(entries) == len({(e["kind"], e["name"]) for e in entries})
    for entry in entries:
        assert entry["summary"]
        assert "\n" not in entry["summary"]
        assert "`" not in entry["page"]
    (add,) = [e for e in entries if e["name"] == "ADD"]
    assert add["syntax"] == ["ADD rd, rs", "ADD rd, #imm"]
    assert OUTPUTS.keys() == {*OUTPUT_KINDS}


KINDS = ("instruction", "directive", "condition", "register", "word")


def test_the_stepping_form_comes_later(toolchain: Toolchain) -> None:
    """The run form is the first part of the module; the rest is there whatever came since."""
    first, other = (request(bundled(name), module="run") for name in ("trajectory", "edges"))
    machine = load_machine("default")
    wanted = to_module(assembled("trajectory"), machine, ISA)
    compiled, run = call_with_module(toolchain, "compile", first)
    assert compiled["program"]
    assert run is not None
    assert b"npchip.step" not in run
    assert call_with_module(toolchain, "whole", first) == (None, wanted)
    assert wanted.startswith(run)
    call(toolchain, "compile", other)
    assert call_with_module(toolchain, "whole", first) == (None, wanted)
    # Conditions are those of what was compiled last.
    call(toolchain, "compile", request("here: JMP here", module=False))
    call(toolchain, "whole", first)
    assert call(toolchain, "condition", "line 1")["places"] == [0]


def test_the_stepping_form_has_the_same_memory(toolchain: Toolchain) -> None:
    machine = load_machine("default")
    size = machine.np_rows * machine.np_cols
    part = {"address": 3, "planes": 1, "data": 0}
    asked = request("HALT", module="run", memory=[part])
    blobs = [bytes([5] * size)]
    call(toolchain, "compile", asked, blobs=blobs)
    found = [call_with_module(toolchain, "whole", asked, blobs=blobs)[1]]
    call(toolchain, "compile", asked, blobs=[bytes([6] * size)])
    found.append(call_with_module(toolchain, "whole", asked, blobs=blobs)[1])
    whole = request("HALT", memory=[part])
    assert found == [call_with_module(toolchain, "compile", whole, blobs=blobs)[1]] * 2


def test_warming_up_changes_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The page warms the compiler up when it is idle, perhaps behind the first program."""
    monkeypatch.setattr(page, "_TOOLCHAIN", Toolchain(tmp_path / "project"))
    monkeypatch.setattr(page, "Path", lambda name: tmp_path / name.lstrip("/"))
    page.call("compile", json.dumps([request(".reg mine, r7\nhere: JMP here", module=False)]))
    condition = page.call("condition", json.dumps(["any mine > 3"]))
    assert "value" in json.loads(condition[0])
    page.warm()
    assert page.call("condition", json.dumps(["any mine > 3"])) == condition
