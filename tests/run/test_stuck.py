"""A run that reaches its limit says where the program was, and in which loop."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip import Chip, assemble, assemble_text
from npchip.cli.main import cli
from npchip.run.stuck import Stuck, stuck

ENDLESS = """; a comment
frame:  EXPOSE
        SAMPLE signal, 0
wait:   MOV r1, #2
.turn:  ADD r0, #1
        JMP .turn
"""
CLIP = np.zeros((2, 64, 80), np.uint8)


def reached(source: str, limit: int = 500, engine: str = "auto") -> Stuck:
    chip = Chip(assemble_text(source, "p.s"), engine=engine)  # type: ignore[arg-type]
    assert chip.run(CLIP, max_cycles=limit).status == "cycle-limit"
    return stuck(chip)


@pytest.mark.parametrize("engine", ["reference", "wasm"])
def test_the_place_is_that_of_the_next_instruction(engine: str) -> None:
    found = reached(ENDLESS, 500, engine)
    assert found.place in {"p.s:5: ", "p.s:6: "}
    assert found.loops == "in the loop of lines 5 to 6"


@pytest.mark.parametrize(
    ("source", "loops"),
    [
        ("HERE: JMP HERE\n", "in the loop of line 1 from HERE"),
        (" JMP b\na: ADD r0, #1\nb: JMP a\n", "in the loop of lines 2 to 3 from b"),
        ("loop: CALL sub\n JMP loop\nsub: NOP\n NOP\n NOP\n RET\n", "lines 1 to 2 from loop"),
        (".macro stay\n.x: ADD r0, #1\n JMP .x\n.endm\n stay\n", "in the loop of lines 2 to 3"),
        ("a: EXPOSE\n.rept 400\n NOP\n.endr\n JMP a\n", "in no loop"),
        (
            """frame: EXPOSE
outer: MOV r1, #200
inner: ADD r1, #1
 CMP r1, #250
 JANY LO, inner
 JMP outer
""",
            "in the loop of lines 3 to 5 from inner, in that of lines 2 to 6 from outer",
        ),
    ],
)
def test_loops_are_named_by_lines_and_label(source: str, loops: str) -> None:
    assert loops in reached(source, 300).loops


def test_a_program_without_lines_has_addresses() -> None:
    program = assemble_text("NOP\nx: NOP\nJMP x\n")
    from npchip.program.model import Program

    chip = Chip(Program("raw", program.words))
    chip.run(max_cycles=50)
    found = stuck(chip)
    assert found.place == ""
    assert found.loops.startswith("at address ")
    assert found.loops.endswith("in the loop of addresses 1 to 2")


@pytest.fixture
def _files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.s").write_text(ENDLESS)
    Path("t.s").write_text(f"; run: a levels=1 max-cycles=1000\n; expect: frames == 1\n{ENDLESS}")
    np.save("c.npy", CLIP)
    Path("x.dbg").write_text("run\nrun\n")


def npchip(*arguments: str) -> Result:
    return CliRunner().invoke(cli, [*arguments])


@pytest.mark.usefixtures("_files")
@pytest.mark.parametrize(
    ("arguments", "code", "shown"),
    [
        (("run", "p.s", "--frames", "c.npy", "--max-cycles", "500"), 3, "loop of lines 5 to 6"),
        (("compare", "p.s", "--frames", "c.npy", "--max-cycles", "500"), 3, "loop of lines 5 to 6"),
        (("profile", "p.s", "--frames", "c.npy", "--max-cycles", "500"), 3, "loop of lines 5 to 6"),
        (("test", "t.s"), 1, "loop of lines 7 to 8"),
        (
            ("debug", "p.s", "--frames", "c.npy", "--max-cycles", "500", "--script", "x.dbg"),
            0,
            "loop of lines 5 to 6",
        ),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else None,
)
def test_every_command_names_the_loop(arguments: tuple[str, ...], code: int, shown: str) -> None:
    done = npchip(*arguments)
    assert (done.exit_code, shown in done.output) == (code, True), done.output
    if arguments[0] != "debug":
        assert "p.s:5: " in done.output or "p.s:6: " in done.output or "t.s:" in done.output


@pytest.mark.usefixtures("_files")
def test_a_trace_that_cannot_begin_names_the_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("npchip.run.chip.MAX_CYCLES", 1000)
    done = npchip("trace", "p.s", "--frames", "c.npy", "--from", "f1")
    assert done.exit_code == 2
    assert "in the loop of lines 5 to 6" in done.output


def test_a_loop_in_another_file_is_named_with_it(tmp_path: Path) -> None:
    (tmp_path / "wait.inc").write_text("wait:\n.rept 20\n NOP\n.endr\n RET\n")
    source = tmp_path / "p.s"
    source.write_text('again: CALL wait\n JMP again\n.include "wait.inc"\n')
    chip = Chip(assemble(source))
    chip.run(max_cycles=110)
    found = stuck(chip)
    assert "wait.inc:" in found.place
    assert found.loops == f"in the loop of lines 1 to 2 of {source} from again"
