"""``.memory`` lines: what lies in the NPs' memories before a run, wherever a program runs."""

from __future__ import annotations

import copy
import json
import pickle
from pathlib import Path

import numpy as np
import pytest

from npchip import AssemblyError, Chip, InputError, Program, assemble, assemble_text, load_machine
from npchip.debugger.session import Debugger
from npchip.formats import load_program, write_program
from tests.support.commands import invoke

SOURCE = """
.output value, 0, plane
.equ TABLE, 64
.memory TABLE + 1, "data/table.npy"
        LD      r0, [TABLE + 1]
        LD      r1, [TABLE + 2]
        ADD     r0, r1
        OUT     0, r0
        ST      [TABLE + 1], r0
        HALT
; run: all
; expect: value[setup] == 50
"""


@pytest.fixture
def source(tmp_path: Path) -> Path:
    (tmp_path / "data").mkdir()
    np.save(tmp_path / "data" / "table.npy", planes(20, 30))
    file = tmp_path / "bound.s"
    file.write_text(SOURCE, encoding="utf-8")
    return file


def planes(*values: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    return np.stack([np.full((8, 10), value, np.uint8) for value in values])


def sent(chip: Chip) -> set[int]:
    result = chip.run()
    assert result.setup is not None
    value = result.setup.outputs["value"]
    assert isinstance(value, np.ndarray)
    return set(np.unique(value).tolist())


def test_the_file_is_found_beside_the_source_and_read_by_a_chip(source: Path) -> None:
    program = assemble(source)
    (item,) = program.memory
    assert (item.address, item.file) == (65, str(source.parent / "data" / "table.npy"))
    for engine in ("wasm", "reference"):
        chip = Chip(program, engine=engine)
        assert sent(chip) == {50}
        chip.reset()  # the program has written over it
        assert sent(chip) == {50}


def test_other_memory_takes_its_place_and_then_the_file_is_not_read(source: Path) -> None:
    program = assemble(source)
    (source.parent / "data" / "table.npy").unlink()
    chip = Chip(program, memory=[(65, planes(1, 2))])
    assert sent(chip) == {3}
    chip.reset()
    assert sent(chip) == {3}


def test_other_memory_at_another_address_is_written_after_it(source: Path) -> None:
    assert sent(Chip(assemble(source), memory=[(66, planes(7))])) == {27}


def test_a_chip_that_is_pickled_or_copied_needs_no_file(source: Path) -> None:
    chip = Chip(assemble(source))
    (source.parent / "data" / "table.npy").unlink()
    for other in (pickle.loads(pickle.dumps(chip)), copy.deepcopy(chip)):  # noqa: S301 - our own
        assert sent(other) == {50}
        other.reset()
        assert sent(other) == {50}


def test_the_debugger_honours_it(source: Path) -> None:
    debugger = Debugger(assemble(source))
    assert (debugger.chip.memory[65] == 20).all()
    assert (Debugger(assemble(source), memory=[(65, planes(9))]).chip.memory[65] == 9).all()


@pytest.mark.parametrize("command", ["run", "profile", "trace", "compare", "test", "asm"])
def test_commands_honour_it(source: Path, command: str) -> None:
    done = invoke(command, str(source))
    assert done.exit_code == 0, done.output
    (source.parent / "data" / "table.npy").unlink()
    done = invoke(command, str(source))
    assert done.exit_code == 2
    assert "table.npy: No such file" in done.output
    assert "[NP243]" in done.output


@pytest.mark.parametrize("command", ["run", "profile", "trace"])
def test_the_option_overrides_it(source: Path, tmp_path: Path, command: str) -> None:
    (source.parent / "data" / "table.npy").unlink()
    np.save(tmp_path / "other.npy", planes(1, 2))
    done = invoke(command, str(source), "--memory", f"65={tmp_path / 'other.npy'}")
    assert done.exit_code == 0, done.output


def test_run_shows_the_sum(source: Path) -> None:
    document = json.loads(invoke("run", str(source), "--json").stdout)
    assert document["setup"]["outputs"]["value"] == [[50] * 10] * 8


def test_an_object_holds_the_bytes(source: Path, tmp_path: Path) -> None:
    write_program(assemble(source), tmp_path / "bound.npo")
    (source.parent / "data" / "table.npy").unlink()
    program = load_program(str(tmp_path / "bound.npo"), load_machine("default"))
    assert sent(Chip(program)) == {50}


def test_a_module_holds_the_bytes(source: Path, tmp_path: Path) -> None:
    """`write_program` left them out, and so did the live pages of the site."""
    file = tmp_path / "bound.wasm"
    write_program(assemble(source), file)
    assert all(bytes([value] * 80) in file.read_bytes() for value in (20, 30))
    write_program(assemble(source), file, memory=[(65, planes(1, 2))])
    assert all(bytes([value] * 80) in file.read_bytes() for value in (1, 2))
    assert bytes([20] * 80) not in file.read_bytes()


@pytest.mark.parametrize(
    "memory",
    [
        [[65]],
        [[65, "x", 7]],
        [[65, "x", ["zz"]]],
        [[65, "x", ["00"]]],
        [["a", "x", []]],
        [[256, "x", []]],
        3,
    ],
)
def test_an_object_whose_bytes_are_damaged_is_refused(
    source: Path, tmp_path: Path, memory: object
) -> None:
    file = tmp_path / "bound.npo"
    write_program(assemble(source), file)
    document = json.loads(file.read_text(encoding="utf-8")) | {"memory": memory}
    file.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_program(str(file), load_machine("default"))
    assert caught.value.code == "NP111"


def test_a_file_that_does_not_fit_is_named_with_its_line(source: Path) -> None:
    np.save(source.parent / "data" / "table.npy", np.zeros((2, 8, 9), np.uint8))
    with pytest.raises(InputError, match=r"bound.s:4: .*table.npy: the array's shape") as caught:
        Chip(assemble(source))
    assert caught.value.code == "NP243"


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ('.memory 256, "a.npy"', "NP006"),
        ('.memory -1, "a.npy"', "NP006"),
        ('.memory 1, "a.npy"\n.memory 1, "b.npy"', "NP008"),
        ('.memory 1, "../a.npy"', "NP028"),
        (".memory 1, a.npy", "NP011"),
        (".memory 1", "NP011"),
        ('.memory 1, "a.npy", 2', "NP011"),
        ('.memory "a.npy", 1', "NP011"),
        ('.memory NOWHERE, "a.npy"', "NP016"),
    ],
)
def test_wrong_lines(tmp_path: Path, line: str, code: str) -> None:
    file = tmp_path / "wrong.s"
    file.write_text(f"{line}\n HALT\n", encoding="utf-8")
    with pytest.raises(AssemblyError) as caught:
        assemble(file)
    assert code in {item.code for item in caught.value.diagnostics}


def test_a_text_without_a_folder_needs_an_include_path(tmp_path: Path) -> None:
    text = '.memory 0, "a.npy"\n HALT'
    with pytest.raises(AssemblyError, match="NP027"):
        assemble_text(text)
    program: Program = assemble_text(text, include_paths=[tmp_path])
    assert program.memory[0].file == str(tmp_path / "a.npy")
