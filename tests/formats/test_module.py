"""Modules for any host: what they describe, what they hold, and programs that cannot be one."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from wasmtime import Func, FuncType, Instance, Module, Store, ValType

import npchip.machine
from examples.hosts.host import custom_sections
from npchip import Chip, InputError, assemble_text
from npchip.cli.main import cli
from npchip.formats import write_program
from npchip.formats.module import to_module
from npchip.isa import Isa, load_isa, parse_isa
from tests.support.chips import clip_of, machine_of
from tests.support.hosts import printed
from tests.support.programs import assembled

MACHINES = Path(npchip.machine.__file__).parent
PAGE = (Path(__file__).parents[2] / "docs" / "module.md").read_text(encoding="utf-8")
SOURCE = """
.equ STEP, 1
.output n, 1, scalar
.output p, 2, picture
        CALL count
frame:  EXPOSE
        IN r1, 3
        OUT 1, r1
        CALL count
        WHERE EQ
        OUT 2, r2
        END
        CMP r2, #9
        JANY EQ, last
        JMP frame
count:  ADD r2, #STEP
        RET
last:   RET
"""


def sections(wasm: bytes) -> list[bytes]:
    """The module of the fast form and that of the stepping form."""
    return [wasm, custom_sections(wasm)["npchip.step"]]


def description(wasm: bytes) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(custom_sections(wasm)["npchip"])
    return found


def run_without_frames(wasm: bytes, folder: Path) -> dict[str, Any]:
    """Return what the host in Python says about a module, with the state at the end."""
    about, module, clip = description(wasm), folder / "module.wasm", folder / "clip.npy"
    module.write_bytes(wasm)
    np.save(clip, np.zeros((0, 8 * about["np_rows"], 8 * about["np_cols"]), np.uint8))
    return printed(str(module), str(clip), "--state")


def names(heading: str, second: str = "") -> set[str]:
    """Names in the first column of the tables below a heading, where the second begins so."""
    section = PAGE.split(f"{heading}\n", 1)[1].split("\n#", 1)[0]
    lines = [line.split(" | ") for line in section.splitlines() if line.startswith("| `")]
    cells = [line[0] for line in lines if line[1].startswith(second)]
    return {name for cell in cells for name in re.findall(r"`([\w.\[\]]+)`", cell)}


def paths(value: Any, place: str = "") -> set[str]:
    """Keys of an object and of the objects in it, such as ``frames.ring`` and ``blocks[].port``."""
    if isinstance(value, list):
        return set().union(*(paths(item, f"{place}[]") for item in value))
    if not isinstance(value, dict):
        return set()
    prefix = f"{place}." if place else ""
    own = {f"{prefix}{key}" for key in value}
    return own.union(*(paths(item, f"{prefix}{key}") for key, item in value.items()))


@pytest.mark.parametrize("form", ["run", "step"])
def test_the_description_has_the_keys_of_the_page(form: str) -> None:
    wasm = to_module(assemble_text(SOURCE), machine_of(), load_isa())
    about = description(sections(wasm)[form == "step"])
    assert (about["version"], about["form"]) == (1, form)
    found = paths(about)
    assert {*about["words"]} == names("### Control words", "4")
    assert {*about["longs"]} == names("### Control words", "8")
    assert {*about["planes"]} == names("### The state")
    assert {*about["requests"]} == names("### Requests")
    exits = {key for key in found if key.startswith("blocks[].exit.")}
    assert {key.split(".")[-1] for key in exits} == {"status", "code", "message"}
    tables = ("words.", "longs.", "planes.", "requests.", "blocks[].exit.")
    found = {key for key in found if not key.startswith(tables)}
    missing = names("## The description") - found
    assert found <= names("## The description")
    assert missing <= ({"blocks[].stack", "blocks[].depth"} if form == "run" else set())


def test_numbers_of_words_lie_in_the_memory_and_apart() -> None:
    about = description(to_module(assemble_text(SOURCE), machine_of(), load_isa()))
    taken = sorted(
        [(place, place + 4) for place in about["words"].values()]
        + [(place, place + 8) for place in about["longs"].values()]
    )
    assert all(end <= begin for (_, end), (begin, _) in pairwise(taken))
    assert taken[-1][1] <= min(about["planes"].values())
    assert about["stride"] >= about["np_rows"] * about["np_cols"]


def test_places_are_unique_in_the_stepping_form_and_common_to_both() -> None:
    fast, stepping = (
        [
            (block["address"], tuple(block.get("stack", ())), block.get("depth", 0))
            for block in description(wasm)["blocks"]
        ]
        for wasm in sections(to_module(assemble_text(SOURCE), machine_of(), load_isa()))
    )
    assert len(set(stepping)) == len(stepping)
    assert {*fast} <= {*stepping}


def test_equal_programs_give_equal_bytes_and_others_do_not(tmp_path: Path) -> None:
    machine, isa = machine_of(), load_isa()
    wasm = to_module(assemble_text(SOURCE), machine, isa)
    assert wasm == to_module(assemble_text(SOURCE), machine, isa)
    assert wasm != to_module(assemble_text(SOURCE, defines={"STEP": 2}), machine, isa)
    assert wasm != to_module(assemble_text(SOURCE), replace(machine, name="other"), isa)
    for name in ("program.wasm", "program.WASM"):
        write_program(assemble_text(SOURCE), tmp_path / name, isa, machine)
        assert (tmp_path / name).read_bytes() == wasm


def test_both_forms_hold_the_bytes_of_the_memory(tmp_path: Path) -> None:
    machine = machine_of()
    planes = np.arange(2 * 3 * 4, dtype=np.uint8).reshape(2, 3, 4) + 1
    wasm = to_module(assemble_text("EXPOSE\nHALT"), machine, load_isa(), [(200, planes)])
    for form in sections(wasm):
        state = run_without_frames(form, tmp_path)["state"]
        memory = np.array(state["memory"], np.uint8)
        assert (memory[200:202] == planes).all()
        assert not memory[:200].any()
        assert not memory[202:].any()


def asm(*arguments: object, exit_code: int = 0) -> str:
    done = CliRunner().invoke(cli, ["asm", *map(str, arguments)])
    assert done.exit_code == exit_code, done.output
    return done.output


def test_the_command_takes_constants_and_memory(tmp_path: Path) -> None:
    source, file, table = (tmp_path / name for name in ("a.s", "a.wasm", "table.npy"))
    source.write_text(".equ VALUE, 1\n.output n, 1, scalar\nMOV r0, #VALUE\nOUT 1, r0\nHALT\n")
    np.save(table, np.full((1, 8, 10), 7, np.uint8))
    asm(source, "-o", file, "--define", "VALUE=42", "--memory", f"9={table}")
    document = run_without_frames(file.read_bytes(), tmp_path)
    assert document["setup"]["outputs"] == {"n": 42}
    assert document["state"]["memory"][9] == [[7] * 10] * 8


@pytest.mark.parametrize("output", [[], ["-o", "a.npo"], ["--listing"]])
def test_memory_needs_a_module(output: list[str], tmp_path: Path) -> None:
    source, table = tmp_path / "a.s", tmp_path / "table.npy"
    source.write_text("HALT\n")
    np.save(table, np.zeros((1, 8, 10), np.uint8))
    arguments = [tmp_path / word if word.endswith(".npo") else word for word in output]
    shown = asm(source, *arguments, "--memory", f"9={table}", exit_code=2)
    assert "[NP244]" in shown


def test_a_program_with_too_many_calls_in_calls_cannot_be_a_module(tmp_path: Path) -> None:
    lines = ["CALL first", "HALT"]
    for name, called in pairwise(["first", "second", "third", "fourth"]):
        lines += [f"{name}: NOP", *[f"CALL {called}"] * 20, "RET"]
    source, file = tmp_path / "a.s", tmp_path / "a.wasm"
    source.write_text("\n".join([*lines, "fourth: NOP", *["LD r1, [0]"] * 40, "RET\n"]))
    shown = asm(source, "-o", file, exit_code=2)
    assert "[NP116]" in shown
    assert not file.exists()


def test_a_program_that_does_not_fit_the_machine_is_refused(tmp_path: Path) -> None:
    source, machine, wide = (tmp_path / name for name in ("a.npo", "small.yaml", "wide.npy"))
    write_program(assembled("trajectory"), source)
    machine.write_text((MACHINES / "default.yaml").read_text().replace("np_rows: 8", "np_rows: 4"))
    file = tmp_path / "a.wasm"
    shown = asm(source, "-o", file, "--machine", machine, exit_code=2)
    assert "[NP102]" in shown
    np.save(wide, np.zeros((2, 8, 10), np.uint8))
    assert "[NP243]" in asm(source, "-o", file, "--memory", f"255={wide}", exit_code=2)
    assert not file.exists()


def with_instruction(semantics: str) -> Isa:
    """The built-in instruction set and an instruction ``STOP``."""
    form = {"syntax": "STOP", "encoding": "1111 0000 0000 0000"}
    about = {"group": "control", "name": "STOP", "title": "Stop", "timing": "control"}
    entry = about | {"forms": [form], "semantics": semantics, "text": "Stops."}
    return parse_isa(
        json.dumps({"extends": "npchip", "name": "custom", "instructions": [entry]}), "custom.yaml"
    )


@pytest.mark.parametrize("semantics", ["if any(Z):\n    halt()", "if any(Z):\n    output(1, 3)"])
def test_a_custom_instruction_that_may_end_the_run_or_not_cannot_be_in_a_module(
    semantics: str,
) -> None:
    isa = with_instruction(semantics)
    program = assemble_text("NOP\nSTOP\nHALT", isa=isa)
    with pytest.raises(InputError, match="the instruction at address 1 may end") as caught:
        to_module(program, machine_of(), isa)
    assert caught.value.code == "NP116"
    unreached = assemble_text("HALT\nSTOP", isa=isa)
    assert to_module(unreached, machine_of(), isa)


def test_a_custom_instruction_that_ends_every_run(tmp_path: Path) -> None:
    isa = with_instruction("halt()")
    wasm = to_module(assemble_text("NOP\nSTOP", isa=isa), machine_of(), isa)
    document = run_without_frames(wasm, tmp_path)
    assert (document["status"], document["cycles"], document["instructions"]) == ("halted", 2, 2)


def test_pictures_of_several_frames_take_one_call() -> None:
    machine = machine_of()
    program, clip = assembled("imaging", machine), clip_of(3, machine)
    wasm = to_module(program, machine, load_isa())
    about = description(wasm)
    store, asked = Store(), []

    def ask(request: int, _block: int) -> int:
        asked.append(request)
        if request != about["requests"]["refill"] or asked.count(request) > 1:
            return 0
        memory.write(store, clip.tobytes(), about["frames"]["ring"])
        memory.write(store, len(clip).to_bytes(4, "little"), about["words"]["available"])
        return 1

    function = Func(store, FuncType([ValType.i32()] * 2, [ValType.i32()]), ask)
    exports: Any = Instance(store, Module(store.engine, wasm), [function]).exports(store)
    memory = exports["memory"]
    for long in ("check", "first_check"):
        memory.write(store, (10**6).to_bytes(8, "little"), about["longs"][long])
    for word in ("log", "data"):
        memory.write(store, about[word].to_bytes(4, "little"), about["words"][f"{word}_end"])
    exports["run"](store, 0)
    exports["assemble"](store, about["data"], about["stride"], 64 * about["stride"], 3)
    begin = about["pictures"]
    shown = bytes(memory.read(store, begin, begin + clip.size))
    assert shown == bytes(Chip(program, machine).run(clip).outputs["picture"])
    assert begin + clip.size <= about["frames"]["ring"]
