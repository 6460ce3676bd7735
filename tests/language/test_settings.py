"""``npchip.toml``: what it says, who reads it, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from npchip.base.errors import InputError
from npchip.language.analysis import Analyst
from npchip.language.settings import Settings, find, parse_settings, settings_for
from tests.support.commands import invoke

PROGRAM = """\
.equ LIMIT, 3
        MOV     r1, #LIMIT
        OUT     0, r1
        HALT
"""
ISA = """\
extends: npchip
name: more
instructions:
  - group: control
    name: REST
    title: Halt too
    timing: branch
    forms:
      - {syntax: "REST", encoding: "1111 1111 1111 1110"}
    semantics: halt()
    text: Halts.
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    folder = tmp_path / "project" / "deep"
    folder.mkdir(parents=True)
    (folder / "a.s").write_text(PROGRAM)
    return folder / "a.s"


def test_the_nearest_file_upward_counts_alone(program: Path) -> None:
    project = program.parents[1]
    assert settings_for(program) == Settings()
    (project / "npchip.toml").write_text('machine = "conservative"\n[defines]\nLIMIT = 9\n')
    found = settings_for(program)
    assert (found.file, found.machine) == (project / "npchip.toml", "conservative")
    assert found.defines == {"LIMIT": 9}
    (program.parent / "npchip.toml").write_text("")
    assert settings_for(program) == Settings(program.parent / "npchip.toml")
    assert find(program.parent) == program.parent / "npchip.toml"


def test_the_command_line_reads_it_and_options_win(program: Path) -> None:
    project = program.parents[1]
    without = invoke("asm", program, "--listing")
    (project / "npchip.toml").write_text(
        'machine = "conservative"\ninclude = ["common"]\n[defines]\nLIMIT = 9\n'
    )
    (project / "common").mkdir()
    (project / "common" / "nothing.s").write_text("; nothing\n")
    assert "LIMIT = 9" in invoke("asm", program).output
    assert "machine conservative" in invoke("asm", program, "--cycles").output
    options = ("--machine", "default", "--define", "LIMIT=3")
    assert invoke("asm", program, "--listing", *options).output == without.output
    assert "conservative" in invoke("compare", program, "--json").output
    program.write_text(f'.include "nothing.s"\n{PROGRAM}')
    assert invoke("asm", program).exit_code == 0
    (project / "npchip.toml").unlink()
    assert "NP027" in invoke("asm", program).output


def test_files_are_relative_to_it(program: Path) -> None:
    project = program.parents[1]
    (project / "slow.yaml").write_text("extends: default\nsummary: slow\ntiming: {move: 7}\n")
    (project / "more.yaml").write_text(ISA)
    (project / "npchip.toml").write_text('machine = "slow.yaml"\nisa = "more.yaml"\n')
    program.write_text(PROGRAM.replace("HALT", "REST"))
    assert "machine slow" in invoke("asm", program, "--cycles").output
    analysis = Analyst().analyse(program)
    assert analysis.faults == []
    assert analysis.machine.cycles("move") == 7


def test_an_assembled_file_keeps_its_constants(program: Path) -> None:
    written = program.with_suffix(".npo")
    assert invoke("asm", program, "-o", written).exit_code == 0
    (program.parent / "npchip.toml").write_text("[defines]\nLIMIT = 9\n")
    assert "LIMIT = 3" in invoke("asm", written).output


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "machin = 'default'",
            ":1: a project has no machin: it takes machine, isa, include, defines",
        ),
        ("\nmachine = 3", ":2: machine: expected a text, found 3"),
        ("isa = ''", ":1: isa: expected a text, found ''"),
        ("include = 'lib'", ":1: include: expected a list of folders, found 'lib'"),
        ("defines = 3", ":1: defines: expected a table, found 3"),
        ("[defines]\nA = 1.5", ":2: defines.A: expected a whole number, found 1.5"),
        ("[defines]\nA = true", ":2: defines.A: expected a whole number, found true"),
        ("machine = ", ":1: not TOML: "),
    ],
)
def test_what_makes_no_sense_is_refused(text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_settings(text, Path("/p/npchip.toml"))
    assert caught.value.code == "NP670"
    assert caught.value.message.startswith(f"/p/npchip.toml{message}")


def test_mistakes_of_the_project_are_mistakes_of_the_program(program: Path) -> None:
    file = program.parent / "npchip.toml"
    for text, code in (
        ("machine = 'fast'", "NP202"),
        ("machine = 'none.yaml'", "NP201"),
        ("isa = 'none.yaml'", "NP401"),
        ("[defines]\nOTHER = 1", "NP026"),
        ("nonsense", "NP670"),
    ):
        file.write_text(text)
        result = invoke("asm", program)
        assert (result.exit_code, f"[{code}]" in result.output) == (2, True), result.output
        assert [fault["code"] for fault in Analyst().analyse(program).faults] == [code]
