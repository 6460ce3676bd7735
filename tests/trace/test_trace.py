"""``npchip trace``: events against the chip's own state; dumps read by another library."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip import Chip, InputError, assemble_text
from npchip.assembler.listing import source_beside
from npchip.cli.main import cli
from npchip.frames import frames_from_array
from npchip.isa import load_isa
from npchip.trace import Position, record, seek, text
from tests.support.clips import CLIPS, bundled_clips
from tests.support.programs import assembled

ASM = Path(__file__).parents[2] / "asm"
TRAJECTORY, COIN = ASM / "trajectory.s", CLIPS / "coin_slide.npy"
NPS = [(0, 0), (3, 4), (7, 9)]


def invoke(*args: str | Path) -> Result:
    return CliRunner().invoke(cli, ["trace", *map(str, args)])


def lines(*args: str | Path) -> list[dict[str, Any]]:
    done = invoke(*args, "--json")
    assert done.exit_code == 0, done.output
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_changes_add_up_to_the_state() -> None:
    clip = bundled_clips()["coin_slide"][3:6]
    chip = Chip(assembled("trajectory"), engine="reference")
    chip.feed(clip)
    state: list[dict[str, int]] = [{} for _ in NPS]
    count = cycles = 0
    for event in record(chip, NPS):
        assert event.cycle == cycles
        count, cycles = count + 1, cycles + event.cycles
        for known, seen in zip(state, event.seen, strict=True):
            for change in seen.changes:
                assert seen.active
                assert known.get(change.name, 0) == change.before != change.after
                known[change.name] = change.after
    assert (count, cycles) == (chip.instructions, chip.cycles)
    for known, np_ in zip(state, NPS, strict=True):
        found = {f"r{n}": int(chip.registers[(n, *np_)]) for n in range(16)}
        found |= {f"mem[{n}]": int(chip.memory[(n, *np_)]) for n in range(256)}
        found |= {name: int(plane[np_]) for name, plane in chip.flags.items()}
        assert found == {name: known.get(name, 0) for name in found}


@pytest.mark.parametrize("start", ["f0", "f1", "f7", "0", "8466", "9001"])
def test_a_trace_may_begin_anywhere(start: str) -> None:
    program, clip = assembled("trajectory"), bundled_clips()["coin_slide"]
    slow = Chip(program, engine="reference")
    slow.feed(clip)
    position = Position.parse(start)
    expected = []
    for event in record(slow, NPS):
        if position.reached(event.cycle, event.frame):
            expected.append(event)
            if len(expected) == 30:
                break
    fast = Chip(program)
    seek(fast, frames_from_array(clip, 64, 80), position, 50_000)
    found = [event for event, _ in zip(record(fast, NPS), range(30), strict=False)]
    assert found == expected


def test_a_program_that_ends_before_the_trace_leaves_it_empty() -> None:
    chip = Chip(assemble_text("EXPOSE\nEXPOSE\nHALT\n"))
    seek(chip, frames_from_array(np.zeros((9, 64, 80), np.uint8), 64, 80), Position(5, True), 99)
    assert [e.text for e in record(chip, [(0, 0)])] == ["EXPOSE", "HALT"]
    assert chip.frames_taken == 2


def test_a_trace_may_begin_in_a_frame_that_never_ends_but_not_behind_it() -> None:
    program = assemble_text("EXPOSE\na: JMP a\n")
    for cycle in (0, 10, 98):
        inside = Chip(program)
        seek(
            inside,
            frames_from_array(np.zeros((9, 64, 80), np.uint8), 64, 80),
            Position(cycle, False),
            99,
        )
        assert inside.cycles == cycle
    endless = Chip(program)
    with pytest.raises(InputError, match="NP611"):
        seek(
            endless,
            frames_from_array(np.zeros((9, 64, 80), np.uint8), 64, 80),
            Position(5, True),
            99,
        )


def test_one_frame_is_from_its_expose_to_the_next() -> None:
    found = lines(TRAJECTORY, "--frames", COIN, "--from", "f5", "--to", "f6", "--limit", "9999")
    result = Chip(assembled("trajectory")).run(bundled_clips()["coin_slide"])
    assert sum(item["cycles"] for item in found) == result.frame_cycles[5]
    assert len(found) == result.frame_instructions[5]
    assert found[0]["instruction"] == "EXPOSE"
    assert found[0]["file"] == str(ASM / "lib" / "moving_box.s")
    assert {item["frame"] for item in found} == {5}


def test_cycles_bound_a_trace() -> None:
    found = lines(TRAJECTORY, "--frames", COIN, "--from", "9000", "--to", "9010", "--np", "3,4")
    assert [item["cycle"] for item in found] == list(range(9000, 9010))


def test_text_names_what_changes_and_stops_at_its_limit() -> None:
    done = invoke(TRAJECTORY, "--frames", COIN, "--from", "f5", "--limit", "12", "--np", "3,4")
    assert done.exit_code == 0
    assert "note: 12 instructions are shown" in done.stderr
    rows = done.stdout.splitlines()
    assert len(rows) == 13
    assert re.search(r"8722 +5 +02D +12 +SAMPLE signal, 0 +mem\[0\]=168 .*60 bytes", rows[3])
    assert re.search(r"8986 +5 +036 +21 +MOV f, #0 +\(masked\)", rows[12])
    default = invoke(TRAJECTORY, "--frames", COIN)
    assert len(default.stdout.splitlines()) == 201


NAMED = """
.reg in, r4
.reg out, r5
.macro next x
 ADD x, #1
.endm
 MOV in, #3
 next out
 next r4
 MOV r5, in
 HALT
"""


def test_registers_are_called_as_in_the_source() -> None:
    program = assemble_text(NAMED, "x.s")
    events = list(record(Chip(program, engine="reference"), [(0, 0)]))
    expected = ["MOV in, #3", "ADD out, #1", "ADD r4, #1", "MOV r5, in", "HALT"]
    assert [event.text for event in events] == expected
    shown = [text.line(event).split()[-1] for event in events]
    assert shown == ["in=3", "out=1", "r4=4", "r5=4", "."]
    assert json.loads(text.json_line(events[0]))["nps"][0]["changes"] == {"r4": [0, 3]}
    listed = source_beside(program, {}, load_isa(), str, 3)
    assert any(line.split()[-3:] == ["ADD", "out,", "#1"] for line in listed)


# ---- value change dumps


def vcdvcd() -> Any:
    """Import the reader, which sets SIGPIPE so that a write to a closed pipe ends the process."""
    before = signal.getsignal(signal.SIGPIPE)
    import vcdvcd  # type: ignore[import-untyped] # it has no types

    signal.signal(signal.SIGPIPE, before)
    return vcdvcd


def test_another_reader_finds_the_values_in_a_dump(tmp_path: Path) -> None:
    reader = vcdvcd().VCDVCD

    file = tmp_path / "x.vcd"
    names = ("pc", "frame", "depth", "r1", "Z", "active", "mem[0x80]", "instruction")
    chosen = [part for name in names for part in ("--signal", name)]
    where = ("--frames", COIN, "--from", "f5", "--to", "f6", "--np", "3,4", "--np", "0,0")
    done = invoke(TRAJECTORY, *where, *chosen, "--vcd", file)
    assert (done.exit_code, done.stdout) == (0, "")
    dump = reader(str(file))
    assert float(dump.timescale["timescale"]) == pytest.approx(1e-9)
    chip = Chip(assembled("trajectory"))
    clip = bundled_clips()["coin_slide"]
    chip.run(clip[:5])
    chip.feed(clip[5:6])
    checked, words = 0, []
    for event in record(chip, [(3, 4)]):
        after = event.cycle + event.cycles
        if checked % 7 == 0:
            assert int(dump["gcu.pc"][after], 2) == chip.pc
            assert int(dump["gcu.frame"][after], 2) == 5
            assert int(dump["gcu.depth"][after], 2) == chip.depth
            assert int(dump["np_3_4.r1"][after], 2) == chip.registers[1, 3, 4]
            assert int(dump["np_3_4.Z"][after], 2) == chip.flags["Z"][3, 4]
            assert int(dump["np_3_4.active"][after], 2) == chip.active[3, 4]
            assert int(dump["np_0_0.mem_128"][after], 2) == chip.memory[128, 0, 0]
        words.append(f"s{event.text}".replace(" ", "\\x20"))
        checked += 1
    assert checked > 1000
    shown = [line.split()[0] for line in file.read_text().splitlines() if line.startswith("s")]
    assert shown == words  # that reader leaves texts out


def test_a_dump_is_the_same_every_day_and_begins_with_the_state(tmp_path: Path) -> None:
    reader = vcdvcd().VCDVCD

    files = [tmp_path / "a.vcd", tmp_path / "b.vcd"]
    for file in files:
        invoke(TRAJECTORY, "--frames", COIN, "--from", "9000", "--limit", "50", "--vcd", file)
    text = files[0].read_text()
    assert text == files[1].read_text()
    assert "$date" not in text
    dump = reader(str(files[0]))
    assert {"gcu.pc", "np_0_0.r15", "np_0_0.C", "np_0_0.active"} <= set(dump.signals)
    assert int(dump["np_0_0.r6"][9000], 2) == 3


# ---- what cannot be done


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (["--from", "frame 3"], "NP610"),
        (["--to", "-1"], "NP610"),
        (["--to", "0"], "NP610"),
        (["--from", "f5", "--to", "f5"], "NP610"),
        (["--np", "8,0"], "NP615"),
        (["--np", "1"], "NP615"),
        (["--vcd", "x.vcd", "--signal", "r16"], "NP612"),
        (["--vcd", "x.vcd", "--signal", "mem[256]"], "NP612"),
        (["--vcd", "x.vcd", "--json"], "NP613"),
        (["--signal", "r1"], "NP613"),
        (["--vcd", "missing/x.vcd"], "NP250"),
    ],
)
def test_what_cannot_be_traced_is_refused(
    options: list[str], code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = invoke(TRAJECTORY, "--frames", COIN, *options)
    assert (done.exit_code, done.stdout) == (2, "")
    assert f"[{code}]" in done.stderr
    assert not list(tmp_path.iterdir())


def test_frames_that_are_missing_are_told() -> None:
    missing = invoke(TRAJECTORY)
    assert missing.exit_code == 2
    assert "[NP246]" in missing.stderr
    late = invoke(TRAJECTORY, "--frames", COIN, "--from", "f30")
    assert late.exit_code == 0
    assert late.stderr == "note: the run has no such part\n"


def test_a_trap_ends_a_trace_with_its_place(tmp_path: Path) -> None:
    source = tmp_path / "x.s"
    source.write_text("NOP\nRET\n")
    done = invoke(source)
    assert done.exit_code == 1
    assert "NOP" in done.stdout
    assert f"{source}:2: error: at address 1: no call is open" in done.stderr


def test_a_reader_that_goes_away_is_no_error() -> None:
    command = [sys.executable, "-m", "npchip", "trace", str(TRAJECTORY), "--frames", str(COIN)]
    with subprocess.Popen(
        [*command, "--limit", "20000"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        process.stdout.close()
        assert process.stderr is not None
        assert "Traceback" not in process.stderr.read()
        assert process.wait() == 0
