"""Commands, programs and Python in the documents are run; what they show is what happens."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from click.testing import CliRunner

from npchip.cli.main import cli
from npchip.isa import load_isa
from npchip.isa.manual import manual

ROOT = Path(__file__).parents[2]
FIRST_STEPS = ROOT / "docs" / "first-steps.md"
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A fenced block: its language and text."""

    language: str
    text: str


def blocks(path: Path) -> list[Block]:
    return [Block(m[1], m[2]) for m in _BLOCK.finditer(path.read_text(encoding="utf-8"))]


SLOW = {"first-steps", "fusion", "profiling", "sweeps"}
"""Documents whose commands take seconds."""


def runnable(path: Path) -> list[Block]:
    return [block for block in blocks(path) if block.language in {"console", "python"}]


@pytest.fixture
def workplace(tmp_path: Path) -> Path:
    """A directory that looks like the repository, where commands may write files."""
    for name in ("asm", "examples", "docs", "tests"):
        (tmp_path / name).symlink_to(ROOT / name)
    return tmp_path


def test_the_manual_is_what_the_instruction_set_gives() -> None:
    assert (ROOT / "docs" / "isa.md").read_text(encoding="utf-8") == manual(load_isa())


def test_the_commands_of_the_readme_are_those_of_ci() -> None:
    commands = [block.text for block in blocks(ROOT / "README.md") if block.language == "sh"]
    assert len(commands) == 3
    served = " --export .venv/page"  # where the README's command serves the page until Ctrl-C
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8").replace(served, "")
    assert all(command in ci.splitlines(keepends=True) for command in commands)


def test_the_first_steps_set_up_as_the_readme_does() -> None:
    run, studio, _ = (block for block in blocks(ROOT / "README.md") if block.language == "sh")
    assert [block for block in blocks(FIRST_STEPS) if block.language == "sh"] == [run, studio]


def test_the_readme_is_one_screen() -> None:
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 55


def test_there_is_something_to_run() -> None:
    assert len(runnable(FIRST_STEPS)) >= 5


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, marks=pytest.mark.long if path.stem in SLOW else (), id=path.name)
        for path in DOCUMENTS
        if runnable(path)
    ],
)
def test_what_a_document_shows_is_what_happens(path: Path, workplace: Path) -> None:
    for block in blocks(path):
        if block.language in {"asm", "yaml"}:
            named = re.match(r"[;#] (\w+\.(?:s|yaml))\n", block.text)
            if named:
                (workplace / named[1]).write_text(block.text, encoding="utf-8")
        elif block.language == "python" and path == FIRST_STEPS:
            subprocess.run([sys.executable, "-c", block.text], cwd=workplace, check=True)
        elif block.language == "console":
            if path == FIRST_STEPS and "broken.s" in block.text:
                good = (workplace / "brightest.s").read_text(encoding="utf-8")
                bad = good.replace("CMP     r0, #64", "CMP     r0, 64")
                (workplace / "broken.s").write_text(bad, encoding="utf-8")
            for command, expected in commands(block.text):
                shown = run(command, workplace)
                assert matches(expected, shown), f"{path.name}: $ {command}\n{shown}"


def commands(text: str) -> list[tuple[str, list[str]]]:
    """Commands after ``$`` with the lines shown below each."""
    found: list[tuple[str, list[str]]] = []
    for line in text.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        else:
            found[-1][1].append(line)
    assert all(command.startswith("npchip ") for command, _ in found)
    return found


def matches(expected: list[str], shown: str) -> bool:
    """Return True if the lines stand there in order; ``...`` stands for any lines."""
    pattern = "".join(
        r"(?:.*\n)*?" if line == "..." else re.escape(line.rstrip()) + r"[ ]*\n"
        for line in expected
    )
    return not expected or re.fullmatch(pattern, shown) is not None


def run(command: str, where: Path) -> str:
    """Return what a command prints; those that fail must do so with a message."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(where)
        arguments = shlex.split(command)[1:]
        environment = {"COLUMNS": "100", "NO_COLOR": "1"}
        done = CliRunner(env=environment).invoke(cli, arguments, prog_name="npchip")
    assert "Traceback" not in done.stderr, done.stderr
    assert done.exit_code == 0 or "broken.s" in command, done.stderr
    return done.stdout + done.stderr


def test_every_code_stands_in_the_documents() -> None:
    files = sorted((ROOT / "src").rglob("*.py"))
    used = {
        code
        for path in files
        for code in re.findall(r'"(NPW?\d{2,3})"', path.read_text(encoding="utf-8"))
    }
    documents = "".join(path.read_text(encoding="utf-8") for path in DOCUMENTS)
    assert len(used) > 100
    assert not {code for code in used if code not in documents}
