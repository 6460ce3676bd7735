"""The array in the studio's page: its pictures, names and marks, asked in Node."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from npchip import Chip, assemble_text
from npchip.debugger.conditions import Changes
from npchip.debugger.language import parse_condition
from npchip.debugger.names import Names
from npchip.machine.layout import to_frames, to_planes
from tests.studio.array.asking import ISA, after, ask, info_of, view_of
from tests.support.page_code import Answers
from tests.support.programs import assembled

pytestmark = pytest.mark.long

ROWS, COLS = 8, 10


def contrast(one: Sequence[int], other: Sequence[int]) -> float:
    """The contrast of two colours, as WCAG defines it."""
    shares = np.array([one, other]) / 255
    linear = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    dark, light = sorted(linear @ [0.2126, 0.7152, 0.0722] + 0.05)
    return float(light / dark)


# ---- pictures and planes


def test_pictures_of_banks_and_pixels_lie_as_npchip_lays_them(harness: Answers) -> None:
    chip = after(assembled("edges"), 560)
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


def test_a_smaller_memory_has_a_part_of_a_bank(harness: Answers) -> None:
    memory = np.arange(100 * 6, dtype=np.uint8)
    view = {"memory": memory, "zero": np.zeros(6, np.uint8), "exposed": np.zeros(6 * 64, np.uint8)}
    found = ask(harness, "planes", view=view, rows=2, cols=3, cells=[])
    assert found["bytes"] == [memory.reshape(100, 6)[64:, at].tolist() for at in range(6)]


@pytest.mark.parametrize("shape", [(8, 10), (3, 5), (1, 1)])
def test_changed_pixels_mark_their_np(harness: Answers, shape: tuple[int, int]) -> None:
    random = np.random.default_rng(2)
    before = random.integers(0, 256, (shape[0] * 8, shape[1] * 8), np.uint8)
    now = before.copy()
    now[random.random(before.shape) < 0.01] ^= 1
    found = ask(harness, "changes", now=now, before=before, rows=shape[0], cols=shape[1])
    assert found["each"] == (now != before).ravel().tolist()
    assert found["nps"] == (to_planes(now) != to_planes(before)).any(axis=0).ravel().tolist()


@pytest.mark.parametrize("before", [None, [1, 2]])
def test_nothing_has_changed_if_there_is_nothing_to_compare(
    harness: Answers, before: list[int] | None
) -> None:
    found = ask(harness, "changes", now=[0] * 64, before=before, rows=1, cols=1)
    assert not any(found["each"] + found["nps"])


def test_marks_of_a_large_array_show_on_every_shade(harness: Answers) -> None:
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


def test_bytes_are_written_as_people_write_them_and_can_be_read(harness: Answers) -> None:
    for byte, found in enumerate(ask(harness, "bytes")):
        wrapped = byte - 256 if byte > 127 else byte
        assert found["decimal"] == str(byte)
        assert found["hex"] == f"{byte:02X}"
        assert found["signed"] == str(wrapped)
        assert found["binary"] == f"{byte >> 4:04b} {byte & 15:04b}"
        assert found["shade"] == wrapped + 128
        ink = {"black": 0, "white": 255}[found["ink"]]
        assert contrast([byte] * 3, [ink] * 3) >= 4.5  # WCAG AA


def test_numbers_are_read_as_the_language_writes_them(harness: Answers) -> None:
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


def test_calls_addresses_and_registers_have_the_names_of_the_program(harness: Answers) -> None:
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


def test_a_routine_without_a_label_is_called_by_its_address(harness: Answers) -> None:
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


def test_quantities_are_written_in_the_debuggers_language(harness: Answers) -> None:
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
