"""Programs as files: every format back to the same words, damaged files refused."""

from __future__ import annotations

import contextlib
import copy
import json
import random
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from npchip import Chip, InputError, NpchipError, Program, assemble_text
from npchip.assembler import disassemble
from npchip.assembler.listing import listing
from npchip.formats import load_program, write_program
from npchip.formats.npo import from_text, to_text
from npchip.formats.rom import from_readmemh
from npchip.frames.memory import with_bytes
from npchip.isa import load_isa
from npchip.machine import load_machine
from tests.support.clips import bundled_clips
from tests.support.programs import assembled

ASM = Path(__file__).parents[2] / "asm"
PROGRAMS = sorted(ASM.glob("*.s"))


@pytest.fixture(params=PROGRAMS, ids=lambda path: path.stem)
def program(request: pytest.FixtureRequest) -> Program:
    return assembled(request.param.stem)


@pytest.mark.parametrize("suffix", [".npo", ".hex", ".mem", ".bin", ".HEX"])
def test_words_come_back_from_every_format(program: Program, suffix: str, tmp_path: Path) -> None:
    file = tmp_path / f"rom{suffix}"
    write_program(program, file)
    assert load_program(file).words == program.words


def test_an_object_file_keeps_everything(program: Program, tmp_path: Path) -> None:
    file = tmp_path / "program.npo"
    write_program(program, file)
    assert load_program(file) == with_bytes(program, load_machine("default"))


def test_the_keys_of_an_object_file_are_those_of_its_table_in_the_documents() -> None:
    page = Path(__file__).parents[2] / "docs" / "assembly.md"
    table = page.read_text(encoding="utf-8").split("An `.npo` has these keys:")[1]
    rows = [line.split(" | ")[0] for line in table.splitlines() if line.startswith("| `")]
    named = [name for row in rows for name in re.findall(r"`(\w+)`", row)]
    isa = load_isa()
    assert named == [*json.loads(to_text(assemble_text("HALT"), isa))]
    source = """.output n, 3, plane
    .require NP_ROWS >= 1, "reason"
    .macro stop
    HALT
    .endm
    .loop 2, 5
    a: JANY NE, a
    stop
    """
    data = json.loads(to_text(assemble_text(source, "p.s"), isa))
    assert data["outputs"] == [{"name": "n", "port": 3, "kind": "plane"}]
    assert data["requirements"] == [["NP_ROWS >= 1", "reason"]]
    assert data["loops"] == [[0, 2, 5]]
    assert (data["geometry"], data["labels"]) == ([8, 10], {"a": 0})
    assert data["words"] == ["C200", "002A"]
    inner = data["lines"][data["source"][1]]
    assert (inner["text"].strip(), data["lines"][inner["from"]]["line"]) == ("HALT", 8)


def test_an_object_file_runs_as_its_source_does(tmp_path: Path) -> None:
    source = assembled("trajectory")
    write_program(source, tmp_path / "t.npo")
    frames = bundled_clips()["coin_slide"]
    first, second = (Chip(p).run(frames) for p in (source, load_program(tmp_path / "t.npo")))
    assert first.frame_cycles.tolist() == second.frame_cycles.tolist()
    for name, values in first.outputs.items():
        np.testing.assert_array_equal(values, second.outputs[name])


def test_a_raw_image_is_little_endian(tmp_path: Path) -> None:
    write_program(Program("two", (0x1234, 0xABCD)), tmp_path / "two.bin")
    assert (tmp_path / "two.bin").read_bytes() == bytes([0x34, 0x12, 0xCD, 0xAB])


def test_readmemh_is_what_verilog_reads() -> None:
    text = "// head\n001A 00_1a /* two\nlines */ @4 FFFF\n"
    assert from_readmemh(text, "x.hex") == [0x1A, 0x1A, 0, 0, 0xFFFF]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("12345", "x.hex:1"),
        ("00\n\nxyz", "x.hex:3"),
        ("/* \n */ @@1", "x.hex:2"),
        ("-1", "x.hex:1"),
    ],
)
def test_malformed_readmemh_names_the_line(text: str, place: str) -> None:
    with pytest.raises(InputError, match=place) as caught:
        from_readmemh(text, "x.hex")
    assert caught.value.code == "NP112"


@pytest.mark.parametrize(
    ("name", "data", "code"),
    [
        ("odd.bin", b"\x1a\x00\x1a", "NP112"),
        ("empty.bin", b"", "NP110"),
        ("end.bin", b"\x5a\x00", "NP110"),  # END with no region open
        ("text.hex", b"\xff\xfe", "NP112"),
        ("not.npo", b"{}", "NP111"),
        ("cut.npo", b'{"format": "npchip obj', "NP111"),
        ("deep.npo", b"[" * 100_000, "NP111"),
        ("missing.bin", None, "NP115"),
    ],
)
def test_files_that_hold_no_program_are_refused(
    name: str, data: bytes | None, code: str, tmp_path: Path
) -> None:
    if data is not None:
        (tmp_path / name).write_bytes(data)
    with pytest.raises(InputError, match=name) as caught:
        load_program(tmp_path / name)
    assert caught.value.code == code


def test_constants_of_an_assembled_file_cannot_be_defined(tmp_path: Path) -> None:
    write_program(Program("nop", (0x001A,)), tmp_path / "p.bin")
    with pytest.raises(InputError, match="assembled") as caught:
        load_program(tmp_path / "p.bin", defines={"T": 1})
    assert caught.value.code == "NP113"


def test_an_unknown_format_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="unknown format") as caught:
        write_program(Program("nop", (0x001A,)), tmp_path / "p.elf")
    assert caught.value.code == "NP114"
    assert not list(tmp_path.iterdir())


def test_names_of_registers_in_an_object_file() -> None:
    isa = load_isa()
    document = json.loads(to_text(assembled("imaging"), isa))
    named = json.dumps(document | {"registers": {"a": 15}})
    assert dict(from_text(named, "x", isa).registers) == {"a": 15}
    with pytest.raises(InputError, match="a is 16, and no register"):
        from_text(json.dumps(document | {"registers": {"a": 16}}), "x", isa)
    del document["registers"]  # as older files
    assert not from_text(json.dumps(document), "x", isa).registers


@given(st.randoms(use_true_random=False))
def test_a_damaged_object_file_never_gives_a_traceback(chance: random.Random) -> None:
    isa = load_isa()
    document = json.loads(to_text(assembled("imaging"), isa))
    values = [None, True, -1, 10**30, 1.5, "", "x", [], {}, [None], {"a": None}]
    for _ in range(chance.randint(1, 3)):
        place = document
        while True:
            keys = list(place) if isinstance(place, dict) else list(range(len(place)))
            if not keys:
                break
            key = chance.choice(keys)
            if isinstance(place[key], dict | list) and chance.random() < 0.7:
                place = place[key]
                continue
            place[key] = copy.deepcopy(chance.choice(values))
            break
    with contextlib.suppress(NpchipError):
        Chip(from_text(json.dumps(document), "x.npo", isa)).run(max_cycles=100)


# ---- disassembly


def test_a_disassembled_program_assembles_to_the_same_words(program: Program) -> None:
    isa = load_isa()
    again = assemble_text(disassemble(program, isa))
    assert again.words == program.words
    assert again.outputs == program.outputs
    raw = Program("raw", program.words)
    assert assemble_text(disassemble(raw, isa)).words == program.words


@pytest.mark.long
def test_every_word_comes_back_from_its_disassembly() -> None:
    isa = load_isa()
    halt = 0x002A
    size = 511  # words behind a HALT: not reached, so that masks need not nest
    for first in range(0, 0x10000, size):
        words = (halt, *range(first, min(first + size, 0x10000)))
        again = assemble_text(disassemble(Program("all", words), isa))
        assert again.words == words


# ---- listing


def test_a_listing_shows_every_word_and_every_line(program: Program) -> None:
    machines = [load_machine("default"), load_machine("conservative")]
    path = Path(program.source[0].file)
    lines = path.read_text().splitlines()
    text = listing(program, {str(path): lines}, machines, load_isa())
    assert f"{len(program.words)} words, {512 - len(program.words)} left" in text
    for address, word in enumerate(program.words):
        assert f"{address:03X}   {word:04X}  " in text
    for number, line in enumerate(lines, start=1):
        assert f"{number:5d}  {line}".rstrip() + "\n" in text
    without = listing(program, {}, machines, load_isa())
    assert sum(line[:1].isalnum() for line in without.splitlines()) == len(program.words) + 1


def test_a_listing_shows_expansions_with_their_values() -> None:
    source = ".macro TWICE r\n ADD r, r\n.endm\n TWICE r3\n.rept 2, n\n MOV r0, #n\n.endr\n HALT\n"
    program = assemble_text(source, "x.s")
    text = listing(program, {"x.s": source.splitlines()}, [load_machine("default")], load_isa())
    assert [line[18:].split(None, 1)[1] for line in text.splitlines() if line[:1] == "0"] == [
        "2+   ADD r3, r3",
        "6+   MOV r0, #0",
        "6+   MOV r0, #1",
        "8   HALT",
    ]
    body = text.index("6   MOV r0, #n")
    assert text.index("5  .rept 2, n") < body < text.index("MOV r0, #0")


def test_a_listing_counts_the_words_left_of_the_machine() -> None:
    machine = replace(load_machine("default"), name="small", rom_words=20)
    program = assemble_text("HALT", machine=machine)
    assert "1 words, 19 left" in listing(program, {}, [machine], load_isa())
