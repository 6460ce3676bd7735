"""Scripts of commands, and breakpoints in a file beside the program."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from click.testing import CliRunner

from npchip import InputError, assemble
from npchip.cli.main import cli
from npchip.debugger import store
from npchip.debugger.commands import COMMANDS, Commands
from npchip.debugger.language import CommandError
from npchip.debugger.session import Debugger

ROOT = Path(__file__).parents[2]
PROGRAM = assemble(ROOT / "asm" / "keypoints.s", defines={"THRESHOLD": 190})


class Done(NamedTuple):
    """A finished command: exit code and output."""

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


HUGE = 10**18
COUNTS = f"""
    step {HUGE}
    expect stop == frames-exhausted
    back {HUGE}
    expect stop == start
    goto {HUGE}
    expect stop == frames-exhausted
    frame back {HUGE}
    expect instructions == 0
    frame {HUGE}
    expect stop == frames-exhausted
    goto {2**62 - 1}
    back 1
    step {2**62 - 1}
    expect frame == 1
"""


@pytest.mark.long
def test_huge_counts_end_where_the_run_or_its_past_ends() -> None:
    done = script(COUNTS)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_script_without_memory_ends_with_a_message(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise MemoryError("Unable to allocate 8.0 GiB")

    monkeypatch.setattr(Debugger, "step", full)
    done = script(f"step {HUGE}\n")
    assert done.returncode == 2
    assert "error: no memory is left: Unable to allocate 8.0 GiB [NP258]" in done.stderr


def test_scripts_that_cannot_be_read(tmp_path: Path) -> None:
    from npchip.debugger.script import read_script

    for name, data in (("a", b"\xff\xfe"), ("b", b"#" * 300_000)):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(InputError, match="NP353"):
            read_script(tmp_path / name)
    with pytest.raises(InputError, match="No such file"):
        read_script(tmp_path / "c")


def test_lines_of_a_script_end_where_an_editor_ends_them() -> None:
    done = script("# a remark\x0b\u2028run\r\n\x85 §\n")
    assert done.returncode == 2
    assert "standard input:2:1: error: unexpected character U+0085" in done.stderr
    assert "> run" not in done.stdout


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
