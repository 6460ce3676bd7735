"""Conditions and commands as text: what they mean, and what is said about mistakes."""

from __future__ import annotations

import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from npchip import InputError, assemble
from npchip.cli.main import cli
from npchip.debugger import store
from npchip.debugger.commands import COMMANDS, Commands
from npchip.debugger.conditions import Changes, Compare, MaskEmpty, Sent
from npchip.debugger.language import CommandError, parse_condition
from npchip.debugger.session import Debugger
from npchip.debugger.values import Cell, Counter, One, Pixel
from npchip.program.model import Program

ROOT = Path(__file__).parents[2]
PROGRAM = assemble(ROOT / "asm" / "keypoints.s", defines={"THRESHOLD": 190})
DEBUGGER = Debugger(PROGRAM)
NAMES = DEBUGGER.names


@pytest.mark.parametrize(
    ("text", "test"),
    [
        ("any r3 > 40", Compare(Cell("register", 3), ">", 40, "any")),
        ("all seed == 0x10", Compare(Cell("register", 4), "==", 16, "all")),
        ("any Z == 1", Compare(Cell("flag", "Z"), "==", 1, "any")),
        ("all active != 0", Compare(Cell("active"), "!=", 0, "all")),
        ("np(3,4).r3 == 7", Compare(One(Cell("register", 3), 3, 4), "==", 7)),
        ("np( 7 , 9 ) . C <= 0", Compare(One(Cell("flag", "C"), 7, 9), "<=", 0)),
        ("np(0,0).mem[FOUND] >= 2", Compare(One(Cell("memory", 240), 0, 0), ">=", 2)),
        ("np(0,0).mem[BITS+3*2-1] < -1", Compare(One(Cell("memory", 133), 0, 0), "<", -1)),
        ("pixel(20,33) < 10", Compare(Pixel(20, 33), "<", 10)),
        ("pixel(20,33,64) > 5", Compare(One(Cell("memory", 64 + 33), 2, 4), ">", 5)),
        ("mask empty", MaskEmpty()),
        ("frame == 3", Compare(Counter("frame"), "==", 3)),
        ("pc == scan", Compare(Counter("pc"), "==", 48)),
    ],
)
def test_tests(text: str, test: object) -> None:
    condition = parse_condition(f"  {text}  ; a remark", NAMES)
    assert (condition.text, condition.test) == (text, test)
    assert not condition.places
    assert condition.event is None
    assert condition.triggers


@pytest.mark.parametrize(
    ("text", "event"),
    [
        ("np(3,4).mem[0x12] changes", Changes(One(Cell("memory", 0x12), 3, 4))),
        ("run changes", Changes(Cell("register", 8))),
        ("output 2", Sent(2)),
        ("output points", Sent(2)),
        ("output objects > 3", Sent(0, ">", 3)),
    ],
)
def test_events(text: str, event: object) -> None:
    condition = parse_condition(text, NAMES)
    assert condition.event == event
    assert condition.triggers


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("scan", {48}),
        ("scan + 3", {51}),
        ("48", {48}),
        ("0x1F", {31}),
        ("edge_tracer.s:158", {49}),
        ("lib/edge_tracer.s:158", {49}),
        ('"keypoints.s":48', {277}),
        ("line 48", {277}),
        ("line 47", {277}),  # a remark: the next instruction
    ],
)
def test_places(text: str, places: set[int]) -> None:
    assert parse_condition(text, NAMES).places == places


def line_of(start: str) -> int:
    lines = (ROOT / "asm" / "lib" / "edge_tracer.s").read_text(encoding="utf-8").splitlines()
    return next(number for number, line in enumerate(lines, 1) if line.startswith(start))


def test_a_line_of_a_macro_stands_for_all_its_uses() -> None:
    number = line_of(".macro mark") + 1
    assert len(parse_condition(f"edge_tracer.s:{number}", NAMES).places) == 2


def test_a_place_may_have_a_test() -> None:
    condition = parse_condition("scan if any y > 3", NAMES)
    assert condition.places == {48}
    assert condition.test == Compare(Cell("register", 0), ">", 3, "any")


@pytest.mark.parametrize(
    ("text", "column", "said", "helped"),
    [
        ("scna", 1, "no label 'scna' [NP351]", "scan"),
        ("any r16 > 3", 5, "no register 'r16' [NP351]", "r0 to r15"),
        ("r3 > 40", 4, "expected 'changes', found '>' [NP350]", "any r3 > ..., all r3 > ..."),
        ("any np(0,0).r3 > 4", 5, "one number [NP351]", "leave it out"),
        ("any r3 = 4", 8, "expected one of ==", "did you mean ==?"),
        ("any r3 >", 9, "expected a number, found the end of the line [NP350]", ""),
        ("np(8,0).r3 == 1", 4, "expected the NP's row from 0 to 7, found 8 [NP351]", ""),
        ("np(0,10).r3 == 1", 6, "expected the NP's column from 0 to 9, found 10", ""),
        ("np(0,0).sed == 1", 9, "no register or label 'sed' [NP351]", "did you mean seed?"),
        ("np(0,0).mem[256] == 1", 13, "expected an address from 0 to 255, found 256", ""),
        ("pixel(64,0) < 1", 7, "expected the pixel's row from 0 to 63, found 64", ""),
        ("pixel(0,0,5) < 1", 11, "5 is not the first byte of a bank", "0, 64, 128 or 192"),
        ("mask full", 6, "expected 'empty', found 'full' [NP350]", ""),
        ("output 16", 8, "expected a port or the name of an output from 0 to 15", ""),
        ("output pionts", 8, "no output 'pionts' [NP351]", "did you mean points?"),
        ("edge_tracr.s:3", 1, "no source file 'edge_tracr.s'", "did you mean edge_tracer.s?"),
        ("line 999", 6, "has no instruction below line", ""),
        ("999", 1, "address 999: the program ends at 297 [NP351]", ""),
        ("scan iff any r3 > 4", 6, "expected 'if' or the end of the line, found 'iff'", "mean if?"),
        ("scan 3", 6, "expected 'if' or the end of the line, found '3' [NP350]", ""),
        ("any r3 > 4 5", 12, "expected the end of the line, found '5' [NP350]", ""),
        ("any r3 > 0xZZ", 10, "'0xZZ' is not a number [NP350]", "hexadecimal"),
        ("any r3 > 9*9*", 14, "expected a number, found the end of the line [NP350]", ""),
        ("any r3 > NOWHERE +", 10, "no constant or label 'NOWHERE' [NP351]", ""),
        (
            f"any r3 > {'99999*' * 5}1",
            27,
            "the result is larger than 62 bits [NP350]",
            "",
        ),
        ("any r3 § 4", 8, "unexpected character U+00A7 (SECTION SIGN) [NP350]", ""),
        ("", 1, "expected a place or a condition, found the end of the line [NP350]", ""),
    ],
)
def test_mistakes_show_their_place(text: str, column: int, said: str, helped: str) -> None:
    with pytest.raises(CommandError) as caught:
        parse_condition(text, NAMES, "x.dbg", 7)
    message = str(caught.value)
    assert message.startswith(f"x.dbg:7:{column}: error: "), message
    assert said in message
    assert helped in message


def test_a_program_without_source_has_addresses_only() -> None:
    names = Debugger(Program("raw", PROGRAM.words)).names
    assert parse_condition("48", names).places == {48}
    with pytest.raises(CommandError, match="no source"):
        parse_condition("line 3", names)


@given(text=st.text(st.sampled_from('np(0,1).r3[]mem if any <>=!+-*/:;"0x12 pixelou'), max_size=40))
def test_nothing_else_is_ever_raised(text: str) -> None:
    debugger = Debugger(Program("raw", (0x001A, 0x002A)))
    for line in (text, f"break {text}", f"print {text}", f"edit {text}", f"expect {text}"):
        with suppress(CommandError):
            Commands(debugger).execute(line)


# ---- commands


class Done(NamedTuple):
    """What a command has left behind."""

    returncode: int
    stdout: str
    stderr: str


def script(text: str, *arguments: str) -> Done:
    clip = str(ROOT / "examples" / "clips" / "shapes_photo.npy")
    command = ["debug", str(ROOT / "asm" / "keypoints.s"), "--frames", clip]
    result = CliRunner().invoke(
        cli, [*command, "--define", "THRESHOLD=190", "--script", "-", *arguments], input=text
    )
    return Done(result.exit_code, result.stdout, result.stderr)


def test_every_command_in_a_script() -> None:
    lines = """
        # remarks, and shorter forms
        b scan
        run
        expect stop == breakpoint
        expect pc == scan             ; another remark
        print np(3,4)
        print r1
        print np(3,4).pixel
        print pixel(3,4)
        print frame_cycles
        print outputs
        print stack
        print where
        step 1
        expect pc == look
        expect calls == 1
        out
        expect pc == scan + 1
        back 1
        run back
        expect pc == scan
        over
        expect pc == scan + 1
        disable 1
        watch np(0,0).mem[FOUND] changes if
    """
    done = script(lines)
    assert done.returncode == 2
    assert "standard input:26:42: error: expected the end of the line, found 'if'" in done.stderr
    rest = """
        enable 1
        list
        delete 1
        until object
        expect any points == 19
        who np(0,0).points
        goto 5
        expect instructions == 5
        frame
        expect frame == 0
        frame 1
        expect frame == 1
        frame back
        expect frame == 0
        edit np(0,0).r3 = 7
        edit Z = 1
        expect all Z == 1
        expect np(0,0).r3 == 7
        run
        expect output objects == 1
        expect stop == frames-exhausted
        restart
        expect cycles == 0
        delete all
        list
    """
    done = script("break scan\n" + rest)
    assert (done.returncode, done.stderr) == (0, "")
    used = {line.split()[0] for line in (lines + rest).splitlines() if line.strip()}
    assert {item.name for item in COMMANDS} <= used | {"break"}
    assert "-> 19 in frame 0" in done.stdout


def test_expectations_that_fail() -> None:
    done = script("expect cycles == 1\nexpect any r3 > 4\nexpect mask empty\nexpect stop == trap\n")
    assert done.returncode == 1
    expected = [
        "cycles == 1; found 0",
        "any r3 > 4; found 0 to 0, such as np(0,0).r3 = 0",
        "mask empty; found 80 NPs are active",
        "stop == trap; found start: at the beginning",
    ]
    assert done.stderr.splitlines() == [
        f"standard input:{number}: error: expected {text} [NP354]"
        for number, text in enumerate(expected, 1)
    ]
    done = script("run\nexpect output objects == 2\nexpect output points == 2\n")
    assert done.returncode == 1
    assert "expected output objects == 2; found 1 [NP354]" in done.stderr


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("brake scan", "no command 'brake'"),
        ("step 0", "expected a number from 1 on, found 0"),
        ("delete 3", "no breakpoint 3"),
        ("expect stop == finished", "no reason to stop 'finished'"),
        ("expect output x == 3", "no output 'x'"),
        ("edit np(0,0).r3 = 256", "expected 0 to 255, found 256 [NP352]"),
        ("edit pixel(0,0) = 1", "no frame has been exposed yet"),
        ("who r3", "is not a register, flag, byte or pixel of one NP"),
        ("who np(0,0).active", "is not a register, flag, byte or pixel of one NP"),
        ("print nothing", "no register or label 'nothing'"),
        ("run fast", "expected the end of the line, found 'fast'"),
    ],
)
def test_a_bad_line(line: str, said: str) -> None:
    commands = Commands(Debugger(PROGRAM))
    with pytest.raises(CommandError) as caught:
        commands.execute(line, "x.dbg", 3)
    assert str(caught.value).startswith("x.dbg:3:")
    assert said in str(caught.value)


def test_scripts_that_cannot_be_read(tmp_path: Path) -> None:
    from npchip.debugger.script import read_script

    for name, data in (("a", b"\xff\xfe"), ("b", b"#" * 300_000)):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(InputError, match="NP353"):
            read_script(tmp_path / name)
    with pytest.raises(InputError, match="No such file"):
        read_script(tmp_path / "c")


@pytest.mark.parametrize("text", [b"\xff\xfe run\n", b"#" * 300_000])
def test_a_script_on_standard_input_that_cannot_be_read(text: bytes) -> None:
    command = ["debug", str(ROOT / "asm" / "keypoints.s"), "--script", "-"]
    done = CliRunner().invoke(cli, command, input=text)
    assert done.exit_code == 2
    assert "error: standard input: " in done.stderr
    assert "[NP353]" in done.stderr


# ---- breakpoints beside the program


def test_breakpoints_come_back(tmp_path: Path) -> None:
    path = tmp_path / "keypoints.breakpoints.yaml"
    debugger = Debugger(PROGRAM)
    store.save(debugger, path)
    assert not path.exists()
    texts = ["scan if any y > 3", "np(3,4).mem[0x12] changes", '"keypoints.s":48']
    for text in texts:
        debugger.add(text)
    debugger.breakpoints[2].enabled = False
    debugger.add_broken("nowhere", "no label")
    store.save(debugger, path)
    again = Debugger(PROGRAM)
    wrong = store.load(again, path)
    assert [item.text for item in again.breakpoints.values()] == [*texts, "nowhere"]
    assert [item.enabled for item in again.breakpoints.values()] == [True, False, True, False]
    assert len(wrong) == 1
    assert "no label 'nowhere'" in wrong[0]
    store.save(again, path)
    assert store.load(Debugger(PROGRAM), path) == wrong
    again.breakpoints.clear()
    store.save(again, path)
    assert store.load(Debugger(PROGRAM), path) == []


@pytest.mark.parametrize(
    "text",
    [
        "",
        "- scan\n",
        "breakpoints: scan\n",
        "breakpoints: [scan]\n",
        "breakpoints: [{at: scan}]\n",
        "breakpoints: [{stop: 3}]\n",
        "breakpoints: [{stop: scan, enabled: perhaps}]\n",
        "breakpoints: [{stop: scan, colour: red}]\n",
        "breakpoints: []\nother: 1\n",
        "breakpoints: !!python/object/apply:os.system ['true']\n",
    ],
)
def test_files_of_breakpoints_that_are_none(tmp_path: Path, text: str) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="NP355"):
        store.load(Debugger(PROGRAM), path)


def test_breakpoints_of_a_file_in_a_script(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text("breakpoints:\n- stop: object\n- stop: gone\n", encoding="utf-8")
    done = script("run\nexpect pc == object\n", "--breakpoints", str(path))
    assert done.returncode == 0
    assert f"warning: {path}:3: no label 'gone'" in done.stderr


def test_the_screen_needs_a_terminal() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "npchip", "debug", str(ROOT / "asm" / "keypoints.s")],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "needs a terminal [NP357]" in done.stderr


def test_without_textual_the_extra_is_named() -> None:
    code = "import sys; sys.modules['textual'] = None; from npchip.cli.main import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", code, "debug", str(ROOT / "asm" / "imaging.s")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert 'pip install "npchip[debug]"' in done.stderr


def test_memory_is_loaded_first(tmp_path: Path) -> None:
    np.save(tmp_path / "m.npy", np.full((2, 8, 10), 9, np.uint8))
    done = script("expect all mem[101] == 9\n", "--memory", f"100={tmp_path / 'm.npy'}")
    assert done.returncode == 0
