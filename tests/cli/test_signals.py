"""Signals end npchip with their exit code and leave no half-written or temporary file."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import npchip

CODES = {"SIGINT": 130, "SIGTERM": 143, "SIGHUP": 129}

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals are a Unix matter")


@pytest.mark.parametrize("name", CODES)
@pytest.mark.parametrize("moment", ["imports", "writing", "the end"])
def test_a_signal_has_its_exit_code_and_leaves_no_file(
    tmp_path: Path, name: str, moment: str
) -> None:
    kill = f"os.kill(os.getpid(), signal.{name})"
    script = f"""
import os, pathlib, signal, sys
import npchip.__main__
sys.argv = "npchip scene --shape dot --start 9,9 --velocity 0,1 -o clip.npy".split()
moment = {moment!r}
if moment == "imports":
    {kill}
write = pathlib.Path.write_bytes
def half(path, data):
    write(path, data[:100])
    {kill}
    write(path, data)
pathlib.Path.write_bytes = half if moment == "writing" else write
try:
    npchip.__main__.main()
finally:
    if moment == "the end":
        {kill}
"""
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == CODES[name], done.stderr
    assert done.stderr.split() == ["interrupted"]
    sizes = {path.name: path.stat().st_size for path in tmp_path.iterdir()}
    assert not any(file.endswith(".tmp") for file in sizes)
    assert sizes.get("clip.npy", 0) in {0, 128 + 30 * 64 * 80}


def test_an_ignored_signal_stays_ignored() -> None:
    script = "import npchip.__main__, signal; print(signal.getsignal(signal.SIGHUP).name)"
    done = subprocess.run(
        [sys.executable, "-c", script],
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN),
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "SIG_IGN"


def test_a_run_is_ended_by_term_within_compiled_code(tmp_path: Path) -> None:
    (tmp_path / "loop.s").write_text("loop: JMP loop\n")
    running = subprocess.Popen(
        [sys.executable, "-m", "npchip", "run", "loop.s", "--max-cycles", "1000G"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
    )
    time.sleep(1)
    running.terminate()
    assert running.communicate(timeout=30)[1].split() == ["interrupted"]
    assert running.returncode == 143


@pytest.mark.long
@pytest.mark.parametrize("closed", ["0<&-", "1>&-", "2>&-", "0<&- 1>&- 2>&-"])
@pytest.mark.parametrize(
    ("command", "code"),
    [("isa", 0), ("asm p.s", 0), ("test p.s", 0), ("run p.s --json-to out", 0), ("isa nix", 2)],
)
def test_closed_streams_change_nothing_else(
    tmp_path: Path, closed: str, command: str, code: int
) -> None:
    (tmp_path / "p.s").write_text("; run: a\n; expect: status == halted\n HALT\n")
    line = f'"{sys.executable}" -m npchip {command} {closed}'
    done = subprocess.run(["sh", "-c", line], cwd=tmp_path, stdout=subprocess.DEVNULL, check=False)
    assert done.returncode == code
    if "out" in command:
        assert (tmp_path / "out").read_bytes().startswith(b"{")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_a_full_disk_behind_standard_error_changes_nothing_else() -> None:
    """A note that could not be said ended in a traceback and exit code 1."""
    line = f'"{sys.executable}" -m npchip isa nix 2>/dev/full'
    assert subprocess.run(["sh", "-c", line], check=False).returncode == 2


SOURCE = """; run: a frames=clip.npy
; expect: golden
.output sum, 0, plane
x: EXPOSE
 SAMPLE signal, 0
 LD r0, [0]
 OUT 0, r0
 JMP x
"""


@pytest.mark.long
@pytest.mark.parametrize("raw", [b"raw\xff", "größe".encode()])
def test_names_that_the_locale_cannot_read(tmp_path: Path, raw: bytes) -> None:
    folder = tmp_path / os.fsdecode(raw)
    folder.mkdir()
    (folder / os.fsdecode(raw + b".s")).write_text(SOURCE)
    locale = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    env = os.environ | (locale if raw.startswith(b"g") else {})

    def call(*arguments: bytes | str) -> None:
        command = [sys.executable, "-m", "npchip", *arguments]
        done = subprocess.run(command, cwd=folder, env=env, capture_output=True, check=False)
        assert (done.returncode, done.stderr) == (0, b""), (arguments, done)

    source, clip, program = raw + b".s", b"clip.npy", raw + b".npo"
    call(
        "scene",
        "--shape",
        "disc",
        "--radius",
        "3",
        "--start",
        "9,9",
        "--velocity",
        "0,1",
        "--frames",
        "2",
        "-o",
        clip,
    )
    call("asm", source, "-o", program, "--listing")
    for file in (source, program):
        call("run", file, "--frames", clip, "--json-to", raw + b".json")
    call("run", source, "--frames", clip, "--save", raw + b".out")
    call("disasm", program, "-o", b"again-" + source)
    call("test", source, "--update", "--junit", raw + b".xml")
    call("test", ".")
    call("profile", program, "--frames", clip, "--lcov", raw, "--speedscope", raw + b".json")
    call("trace", source, "--frames", clip, "--vcd", raw + b".vcd")


def test_nothing_is_imported_before_signals_are_seen_to() -> None:
    """The time in which a signal still ended Python in its own way was three times as long."""
    script = (
        f"import sys\nsys.path.insert(0, {str(Path(npchip.__file__).parents[1])!r})\n"
        "before = set(sys.modules)\nimport npchip.cli.interrupts\n"
        "print(*sorted(set(sys.modules) - before))"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-c", script], capture_output=True, text=True, check=True
    )
    new = set(done.stdout.split())
    assert new <= {"__future__", "atexit", "npchip", "npchip.cli", "npchip.cli.interrupts"}
