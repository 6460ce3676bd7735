"""The manifest of the VS Code extension, its snippets and first program, against npchip itself."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from npchip import assemble_text
from npchip.cli.main import COMMANDS, cli
from npchip.dap.launch import KNOWN

ROOT = Path(__file__).parents[2]
EXTENSION = ROOT / "docs" / "editors" / "vscode"
SOURCES = EXTENSION / "src"
PAGE = ROOT / "src" / "npchip" / "studio" / "page"
MANIFEST: dict[str, Any] = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
OWN = MANIFEST["contributes"]
SNIPPETS = json.loads((EXTENSION / "snippets.json").read_text(encoding="utf-8"))


def written(body: list[str]) -> str:
    """Return the text that a snippet writes if the user takes what it offers."""
    text = "\n".join(body)
    text = re.sub(r"\$\{\d+\|([^,|]*)[^}]*\}", r"\1", text)
    return re.sub(r"\$\{\d+:([^}]*)\}", r"\1", text)


@pytest.mark.parametrize("name", sorted({*SNIPPETS} - {"Test"}))
def test_snippets_assemble(name: str) -> None:
    body = written(SNIPPETS[name]["body"])
    body = re.sub(r"^ *\$\d+$", "        NOP", body, flags=re.MULTILINE)
    assert "$" not in body
    program = assemble_text(f"{body}\n        HALT\n")
    assert len(program.words) > body.count("NOP") or name == "Macro"


def test_the_snippet_of_a_test_is_one(tmp_path: Path) -> None:
    test = written(SNIPPETS["Test"]["body"]).replace("0, 0, 0", "1, 1, 1")
    path = tmp_path / "one.s"
    path.write_text(
        f"{test}\n.output result, 0, scalar\nframe: EXPOSE\n MOV r0, #1\n OUT 0, r0\n JMP frame\n"
    )
    result = CliRunner().invoke(cli, ["test", str(path)])
    assert result.exit_code == 0, result.output


def test_the_first_program_passes_its_test(tmp_path: Path) -> None:
    text = (SOURCES / "new-program.ts").read_text(encoding="utf-8")
    program = re.search(r"PROGRAM = `(.*?)`", text, re.DOTALL)
    assert program
    path = tmp_path / "darker.s"
    path.write_text(program[1])
    result = CliRunner().invoke(cli, ["test", str(path)])
    assert result.exit_code == 0, result.output
    assert "1 passed" in result.output


def test_a_launch_takes_what_the_adapter_takes() -> None:
    (debugger,) = OWN["debuggers"]
    launch = debugger["configurationAttributes"]["launch"]
    assert {*launch["properties"], "noDebug"} == {*KNOWN}  # the editor sets noDebug itself
    configurations = [
        *debugger["initialConfigurations"],
        *(item["body"] for item in debugger["configurationSnippets"]),
        *shown_launches(),
    ]
    assert len(configurations) == 3
    for item in configurations:
        assert item["type"] == debugger["type"]
        assert item.keys() - {"type", "request", "name"} <= {*launch["properties"]}


def shown_launches() -> list[dict[str, Any]]:
    page = (ROOT / "docs" / "editors.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```json\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    found = [json.loads(block) for block in blocks]
    return [item for block in found for item in block.get("configurations", ())]


def test_commands_are_there_and_used() -> None:
    text = "\n".join(path.read_text(encoding="utf-8") for path in SOURCES.rglob("*.ts"))
    registered = {*re.findall(r'registerCommand\(\s*"([\w.]+)"', text)}
    declared = {item["command"] for item in OWN["commands"]}
    asked = {*OWN["debuggers"][0]["variables"].values()}
    assert registered == declared | asked
    for menu in OWN["menus"].values():
        assert {item["command"] for item in menu} <= declared
    steps = [step for guide in OWN["walkthroughs"] for step in guide["steps"]]
    linked = re.findall(r"command:(npchip\.\w+)", "\n".join(step["description"] for step in steps))
    assert linked
    assert {*linked} <= declared


def test_what_the_walkthrough_waits_for_is_told() -> None:
    told = (SOURCES / "progress.ts").read_text(encoding="utf-8")
    steps = [step for guide in OWN["walkthroughs"] for step in guide["steps"]]
    events = [event.split(":", 1) for step in steps for event in step["completionEvents"]]
    assert {kind for kind, _ in events} == {"onContext", "onCommand"}
    for kind, name in events:
        assert kind == "onCommand" or f'"{name.removeprefix("npchip.")}"' in told


def test_tasks_run_commands_of_npchip() -> None:
    (task,) = OWN["taskDefinitions"]
    assert {*task["properties"]["command"]["enum"]} <= {*COMMANDS}
    text = (SOURCES / "tasks.ts").read_text(encoding="utf-8")
    used = {*re.findall(r'"(asm|run|test|profile)"', text)}
    assert used == {*task["properties"]["command"]["enum"]}


def test_settings_that_are_read_are_declared() -> None:
    text = "\n".join(path.read_text(encoding="utf-8") for path in SOURCES.rglob("*.ts"))
    read = {f"npchip.{name}" for name in re.findall(r'\.get(?:<[^>]*>+)?\("([\w.]+)"\)', text)}
    declared = {*OWN["configuration"]["properties"]}
    assert read
    assert read <= declared
    assert declared - read == {"npchip.trace.server"}  # the client's library reads it


def test_the_panel_offers_all_that_the_array_asks_for() -> None:
    """Beside the panel only `Breaks` and `Travel` ask for more, and they are not in it."""
    panel = (SOURCES / "array" / "panel.tsx").read_text(encoding="utf-8")
    offered = {*re.findall(r"^  (\w+)\([^)]*\) \{$", panel, re.MULTILINE)}
    seen: set[Path] = set()
    todo = [PAGE / "array" / f"{name}.tsx" for name in ("ArrayView", "Processor")]
    while todo:
        path = todo.pop()
        if path in seen:
            continue
        seen.add(path)
        for name in re.findall(r'from "\./(\w+)"', path.read_text(encoding="utf-8")):
            todo += list(path.parent.glob(f"{name}.ts*"))
    assert len(seen) > 8
    asked = {name for path in seen for name in re.findall(r"\bact\(\)\.(\w+)", path.read_text())}
    assert asked == offered
