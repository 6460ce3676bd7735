"""The array in the studio's page: its pictures, names, marks and keys, asked in Node."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from npchip import Chip, assemble, assemble_text
from npchip.assembler.disassembler import disassemble_word
from npchip.debugger.conditions import Changes
from npchip.debugger.language import parse_condition
from npchip.debugger.names import Names
from npchip.isa import load_isa
from npchip.machine.layout import to_frames, to_planes
from npchip.program.model import Program
from npchip.studio.toolchain.moves import moves
from tests.support.clips import CLIPS

ROOT = Path(__file__).parents[2]
STUDIO = ROOT / "src" / "npchip" / "studio"
ISA = load_isa()
ROWS, COLS = 8, 10


@pytest.fixture(scope="module")
def harness(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page's code for Node."""
    esbuild = STUDIO / "node_modules" / ".bin" / "esbuild"
    if not esbuild.exists():
        pytest.skip(f"no {esbuild}: run npm ci in {STUDIO}")
    if shutil.which("node") is None:
        pytest.skip("no node here")
    made = tmp_path_factory.mktemp("array") / "harness.mjs"
    source = Path(__file__).parent / "array" / "harness.ts"
    options = ["--bundle", "--platform=node", "--format=esm", f"--outfile={made}"]
    # The harness stands beside the tests, and the packages beside the page.
    surroundings = os.environ | {"NODE_PATH": str(STUDIO / "node_modules")}
    subprocess.run([esbuild, source, *options, "--log-level=warning"], check=True, env=surroundings)
    return made


def ask(harness: Path, name: str, **question: Any) -> Any:
    """Return the page's answer to a question."""
    text = json.dumps({"ask": name, **question}, default=plain)
    done = subprocess.run(
        ["node", harness], input=text, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def plain(value: Any) -> Any:
    assert isinstance(value, np.ndarray | np.integer), value
    return value.astype(int).ravel().tolist() if isinstance(value, np.ndarray) else int(value)


def view_of(chip: Chip, **more: Any) -> dict[str, Any]:
    """A chip as the page sees it."""
    return {
        "address": chip.pc,
        "instructions": chip.instructions,
        "registers": chip.registers,
        "zero": chip.flags["Z"] * 255,
        "carry": chip.flags["C"] * 255,
        "active": chip.active,
        "memory": chip.memory,
        "exposed": chip.frame,
        **more,
    }


def info_of(program: Program) -> dict[str, Any]:
    """A program as the page sees it."""
    words = [
        {
            "text": disassemble_word(word, ISA, program.label_names),
            "origins": [{"file": item.file, "line": item.line} for item in line.origins],
            "moves": [move._asdict() for move in moves(decoded)] if decoded else [],
        }
        for word, line, decoded in zip(
            program.words, program.source, program.decoded(ISA), strict=True
        )
    ]
    named = {"labels": dict(program.labels), "registers": dict(program.registers)}
    return {**named, "words": words}


def after(program: Program, steps: int) -> Chip:
    chip = Chip(program, engine="reference")
    chip.feed(np.load(CLIPS / "shapes_photo.npy"))
    for _ in range(steps):
        chip.step()
    return chip


def contrast(one: Sequence[int], other: Sequence[int]) -> float:
    """The contrast of two colours, as WCAG defines it."""
    shares = np.array([one, other]) / 255
    linear = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    dark, light = sorted(linear @ [0.2126, 0.7152, 0.0722] + 0.05)
    return float(light / dark)


# ---- pictures and planes


def test_pictures_of_banks_and_pixels_lie_as_npchip_lays_them(harness: Path) -> None:
    chip = after(assemble(ROOT / "asm" / "edges.s"), 560)
    assert len(np.unique(chip.memory)) > 100
    cells = [
        {"kind": "register", "index": 3},
        {"kind": "flag", "index": "Z"},
        {"kind": "flag", "index": "C"},
        {"kind": "memory", "index": 70},
        {"kind": "active", "index": ""},
    ]
    found = ask(harness, "planes", view=view_of(chip), rows=ROWS, cols=COLS, cells=cells)
    banks = chip.memory.reshape(4, 64, ROWS, COLS)
    for number, bank in enumerate(banks):
        assert found["banks"][number] == to_frames(bank).ravel().tolist()
    assert chip.frame is not None
    by_np = np.moveaxis(to_planes(chip.frame), 0, -1).reshape(-1, 64)
    assert found["pixels"] == by_np.tolist()
    assert found["bytes"] == np.moveaxis(banks[1], 0, -1).reshape(-1, 64).tolist()
    planes = [chip.registers[3], chip.flags["Z"], chip.flags["C"], chip.memory[70], chip.active]
    assert found["cells"] == [plane.astype(int).ravel().tolist() for plane in planes]


def test_a_smaller_memory_has_a_part_of_a_bank(harness: Path) -> None:
    memory = np.arange(100 * 6, dtype=np.uint8)
    view = {"memory": memory, "zero": np.zeros(6, np.uint8), "exposed": np.zeros(6 * 64, np.uint8)}
    found = ask(harness, "planes", view=view, rows=2, cols=3, cells=[])
    assert found["bytes"] == [memory.reshape(100, 6)[64:, at].tolist() for at in range(6)]


@pytest.mark.parametrize("shape", [(8, 10), (3, 5), (1, 1)])
def test_changed_pixels_mark_their_np(harness: Path, shape: tuple[int, int]) -> None:
    random = np.random.default_rng(2)
    before = random.integers(0, 256, (shape[0] * 8, shape[1] * 8), np.uint8)
    now = before.copy()
    now[random.random(before.shape) < 0.01] ^= 1
    found = ask(harness, "changes", now=now, before=before, rows=shape[0], cols=shape[1])
    assert found["each"] == (now != before).ravel().tolist()
    assert found["nps"] == (to_planes(now) != to_planes(before)).any(axis=0).ravel().tolist()


@pytest.mark.parametrize("before", [None, [1, 2]])
def test_nothing_has_changed_if_there_is_nothing_to_compare(
    harness: Path, before: list[int] | None
) -> None:
    found = ask(harness, "changes", now=[0] * 64, before=before, rows=1, cols=1)
    assert not any(found["each"] + found["nps"])


def test_marks_of_a_large_array_show_on_every_shade(harness: Path) -> None:
    shades = [*range(256)]
    nothing, all_of_them = [0] * 256, [1] * 256
    question = {"rows": 1, "cols": 256, "shades": shades}
    hatched = ask(harness, "paint", **question, inactive=all_of_them, changed=nothing)
    cornered = ask(harness, "paint", **question, inactive=nothing, changed=all_of_them)
    hatch, corner = (
        np.array(made).reshape(8, 256, 8, 4).swapaxes(0, 1)[..., :3] for made in (hatched, cornered)
    )
    for grey in shades:
        marked = (hatch[grey] != grey).any(axis=-1)
        assert marked.sum() == 16
        assert min(contrast(colour, [grey] * 3) for colour in hatch[grey][marked]) >= 3
        assert (
            max(contrast(colour, [grey] * 3) for colour in corner[grey][:3, -3:].reshape(-1, 3))
            >= 3
        )
        assert (corner[grey][4:, :4] == grey).all()


# ---- text


def test_bytes_are_written_as_people_write_them_and_can_be_read(harness: Path) -> None:
    for byte, found in enumerate(ask(harness, "bytes")):
        wrapped = byte - 256 if byte > 127 else byte
        assert found["decimal"] == str(byte)
        assert found["hex"] == f"{byte:02X}"
        assert found["signed"] == str(wrapped)
        assert found["binary"] == f"{byte >> 4:04b} {byte & 15:04b}"
        assert found["shade"] == wrapped + 128
        ink = {"black": 0, "white": 255}[found["ink"]]
        assert contrast([byte] * 3, [ink] * 3) >= 4.5  # WCAG AA


def test_numbers_are_read_as_the_language_writes_them(harness: Path) -> None:
    texts = ["18", " 0x1F ", "0b101", "0X10", "", "-1", "1.5", "12z", "0b2", "1e3", "ff"]
    values = [18, 31, 5, 16] + [None] * 7
    assert ask(harness, "numbers", texts=texts) == values


CALLS = """
.reg sum, r3
.reg total, r3
        CALL outer
        HALT
outer:  NOP
        CALL inner
        RET
inner:  NOP
.again: JMP .again
"""


def test_calls_addresses_and_registers_have_the_names_of_the_program(harness: Path) -> None:
    program = assemble_text(CALLS, "calls.s")
    chip = Chip(program)
    for _ in range(3):
        chip.step()
    assert len(chip.stack) == 2
    names = ask(harness, "names", program=info_of(program), stack=chip.stack, quantities=[])
    at = program.source
    assert names["calls"] == [
        {"routine": "inner", "caller": 3, "at": {"file": "calls.s", "line": at[3].line}},
        {"routine": "outer", "caller": 0, "at": {"file": "calls.s", "line": at[0].line}},
    ]
    assert names["addresses"][:6] == [
        "address 0",
        "address 1",
        "outer",
        "outer + 1",
        "outer + 2",
        "inner",
    ]
    assert names["registers"][2:5] == ["r2", "r3 sum total", "r4"]


def test_a_routine_without_a_label_is_called_by_its_address(harness: Path) -> None:
    program = {
        "labels": {"here": 1},
        "registers": {},
        "words": [
            {"text": "CALL 0x002", "origins": []},
            {"text": "OWN r3", "origins": []},
            {"text": "RET", "origins": []},
        ],
    }
    names = ask(harness, "names", program=program, stack=[1, 2], quantities=[])
    assert [call["routine"] for call in names["calls"]] == ["called from here", "address 2"]
    assert [call["at"] for call in names["calls"]] == [None, None]


def test_quantities_are_written_in_the_debuggers_language(harness: Path) -> None:
    cells = [
        {"kind": "register", "index": 4},
        {"kind": "memory", "index": 18},
        {"kind": "flag", "index": "C"},
        {"kind": "active", "index": ""},
    ]
    quantities = [
        *({"kind": "one", "cell": cell, "row": 2, "column": 3} for cell in cells),
        *({"kind": "cell", "cell": cell} for cell in cells),
        {"kind": "pixel", "row": 20, "column": 33},
        {"kind": "counter", "name": "frame"},
    ]
    program = assemble_text(CALLS, "calls.s")
    question = {"program": info_of(program), "stack": [], "quantities": quantities}
    texts = ask(harness, "names", **question)["quantities"]
    names = Names(program, Chip(program).machine, ISA)
    for text in texts:
        event = parse_condition(f"{text} changes", names).event
        assert isinstance(event, Changes)
        assert str(event.value) == text


# ---- moments


def test_a_moment_is_compared_with_the_stop_before_it(harness: Path) -> None:
    program = assemble(ROOT / "asm" / "edges.s")
    views = {count: view_of(after(program, count)) for count in (0, 1, 9, 10, 11)}
    events: list[dict[str, Any]] = [
        {"view": views[0]},
        {"running": True, "view": views[1]},
        {"running": False},
        {"running": True},
        {"view": views[9]},
        {"view": views[10]},
        {"running": False},
        {"view": views[9]},
        {"program": info_of(program)},
        {"view": views[11]},
    ]
    found = ask(harness, "story", events=events)
    assert [each["reference"] for each in found] == [None, 0, 0, 0, 1, 1, 1, 10, None, 9]


def neighbours() -> tuple[Program, int]:
    """A program and how many steps lead to its first read of a neighbour."""
    program = assemble(ROOT / "asm" / "edges.s")
    chip = after(program, 0)
    count = 0
    while not info_of(program)["words"][chip.pc]["moves"]:
        chip.step()
        count += 1
    return program, count


def test_values_pass_after_a_step_over_a_read_of_a_neighbour(harness: Path) -> None:
    program, count = neighbours()
    made = info_of(program)
    views = [view_of(after(program, count + step)) for step in range(-1, 2)]
    moved = made["words"][views[1]["address"]]["moves"]
    slow, fast = {"unit": "steps", "rate": 2}, {"unit": "steps", "rate": 60}
    told = {**views[2], "last": views[1]["address"]}
    events: list[dict[str, Any]] = [
        {"program": made},
        {"view": views[0]},
        {"view": views[1]},
        {"view": views[2]},
        {"running": True, "pace": fast},
        {"pace": slow},
        {"running": False, "view": views[1]},
        {"view": views[0]},
        {"view": told},
        {"view": {**views[1], "last": None}},
    ]
    found = [each["passing"] for each in ask(harness, "story", events=events)]
    seen = {"moves": moved, "from": views[1]["instructions"]}
    unseen = {"moves": moved, "from": None}
    assert found == [None, None, None, seen, None, seen, None, None, unseen, None]


@pytest.mark.parametrize("direction", ["north", "east", "south", "west"])
def test_arrows_carry_what_the_nps_took(harness: Path, direction: str) -> None:
    program = assemble_text(f"CMP r1, #100\nWHERE LO\nNBR r5, r9, {direction}\nHALT", "nbr.s")
    chip = Chip(program, engine="reference")
    values = np.random.default_rng(3).permutation(256)[:80].reshape(8, 10)
    chip.registers[9] = chip.registers[1] = values
    chip.step()
    chip.step()
    before = view_of(chip, registers=chip.registers.copy())
    active = chip.active.copy()
    assert 10 < active.sum() < 70
    (move,) = info_of(program)["words"][2]["moves"]
    question = {"move": move, "from": before, "active": active, "rows": 8, "cols": 10}
    arrows = ask(harness, "arrows", **question)
    chip.step()
    assert {(each["row"], each["column"]) for each in arrows} == {
        (row, column) for row, column in np.argwhere(active).tolist()
    }
    for each in arrows:
        assert each["value"] == chip.registers[5][each["row"], each["column"]]


def test_arrows_of_a_large_array_are_few(harness: Path) -> None:
    active: NDArray[np.uint8] = np.ones(60 * 80, np.uint8)
    registers = np.zeros(16, np.uint8)
    question = {"move": {"row": 0, "column": 1, "register": None}, "from": {"registers": registers}}
    arrows = ask(harness, "arrows", **question, active=active, rows=60, cols=80)
    assert 200 <= len(arrows) <= 400
    assert {each["value"] for each in arrows} == {None}


# ---- keys


def test_every_way_has_keys_of_its_own_that_are_heard(harness: Path) -> None:
    keys = [
        {"key": "F11"},
        {"key": "F11", "ctrlKey": True},
        {"key": "F11", "shiftKey": True},
        {"key": "F11", "altKey": True},
        {"key": "s"},
        {"key": "S", "shiftKey": True},
        {"key": "s", "ctrlKey": True},
        {"key": "R"},
        {"key": "x"},
    ]
    found = ask(harness, "ways", keys=keys)
    letters = ["Step", "Step back", None, "Run back", None]
    assert found["everywhere"] == ["Step", "Step back", "Step out", None] + [None] * 5
    assert found["withLetters"] == [*found["everywhere"][:4], *letters]
    ways = found["shortcuts"]
    for column in ("name", "letter", "key", "does"):
        used = [way[column] for way in ways if way[column] is not None]
        assert len(set(used)) == len(used) >= 10
    assert (
        {"step", "over", "out", "cursor", "frame"}
        == {way["to"] for way in ways if not way["back"]}
        == {way["to"] for way in ways if way["back"]} - {"end"}
    )


def test_arrow_keys_stay_within_the_grid(harness: Path) -> None:
    presses: dict[tuple[Any, ...], tuple[int, int] | None] = {
        ("ArrowUp", False, 0, 3, 8, 10): (0, 3),
        ("ArrowDown", False, 6, 3, 8, 10): (7, 3),
        ("ArrowLeft", False, 6, 0, 8, 10): (6, 0),
        ("ArrowRight", False, 6, 8, 8, 10): (6, 9),
        ("PageDown", False, 2, 8, 8, 10): (6, 8),
        ("PageUp", False, 2, 8, 8, 10): (0, 8),
        ("Home", False, 2, 8, 8, 10): (2, 0),
        ("End", True, 2, 8, 8, 10): (7, 9),
        ("Home", True, 2, 8, 8, 10): (0, 0),
        ("a", False, 2, 8, 8, 10): None,
    }
    found = ask(harness, "keys", presses=list(presses))
    wanted = [to and {"row": to[0], "column": to[1]} for to in presses.values()]
    assert found == wanted
