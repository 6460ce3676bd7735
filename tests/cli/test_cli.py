"""The command line: options, errors, exit codes, progress. Whole runs are in ``test_run.py``."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip.base.errors import InputError
from npchip.cli import progress, run
from npchip.frames.memory import read_memory
from npchip.machine import load_machine
from npchip.run.chip import MAX_CYCLES
from npchip.run.result import FrameRecord
from tests.support.commands import invoke
from tests.support.results import tracked

NPCHIP = [sys.executable, "-m", "npchip"]
CLIP = np.random.default_rng(3).integers(256, size=(4, 64, 80)).astype(np.uint8)


Runs = Any


def npchip(*arguments: str, **extra: Any) -> subprocess.CompletedProcess[str]:
    command = [*NPCHIP, *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, check=False, **({"timeout": 60} | extra)
    )


# --- usage errors -------------------------------------------------------------------------


def test_near_misses_are_suggested() -> None:
    for arguments, expected in (
        (["rnu"], "Did you mean 'run'?"),
        (["xyz"], "Commands: run, learn, studio, sweep"),
        (["run", "p.s", "--frame", "x"], "--frames"),
    ):
        result = invoke(*arguments)
        assert result.exit_code == 2
        assert expected in result.output


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["--clock", "fast"], "NP240"),
        (["--clock", "0"], "NP240"),
        (["--clock", "-5"], "NP240"),
        (["--clock", "1e99"], "NP240"),
        (["--clock", "0.5"], "NP240"),
        (["--max-cycles", "1.5"], "NP240"),
        (["--define", "THRESHOLD"], "NP241"),
        (["--define", "=3"], "NP241"),
        (["--define", "A=x"], "NP241"),
        (["--define", "A=1", "--define", "A=2"], "NP245"),
        (["--memory", "3"], "NP242"),
        (["--memory", "x=file.npy"], "NP242"),
        (["--memory", "-1=file.npy"], "NP242"),
        (["--json", "--json-to", "x.json"], "NP244"),
        (["--render", "film.mp4"], "NP247"),
        (["--render", "no/such/folder/film.gif"], "NP250"),
        (["--save", __file__], "NP250"),
    ],
)
def test_bad_options_name_their_code_before_the_run(arguments: list[str], code: str) -> None:
    result = invoke("run", "no-such-program.s", *arguments)
    assert result.exit_code == 2
    assert f"[{code}]" in result.stderr
    assert "Traceback" not in result.output


@pytest.mark.parametrize(
    ("text", "hertz"),
    [
        ("10e6", 10_000_000),
        ("10M", 10_000_000),
        ("10 MHz", 10_000_000),
        ("32_768", 32_768),
        ("0x100", 256),
        ("1.5k", 1500),
    ],
)
def test_clock_takes_many_forms(runs: Runs, text: str, hertz: int) -> None:
    runs(tracked(CLIP))
    result = invoke("run", "p.s", "--json", "--clock", text)
    assert json.loads(result.stdout)["clock_hz"] == hertz


def test_defines_take_hexadecimal_and_binary() -> None:
    context = run.command.make_context(
        "run", ["p.s", "--define", "A=0x10", "--define", "B=0b11", "--memory", "0xC0=w.npy"]
    )
    assert context.params["defines"] == {"A": 16, "B": 3}
    assert context.params["memory"] == [(192, Path("w.npy"))]


# --- memory -------------------------------------------------------------------------------


def test_memory_of_any_integer_type(tmp_path: Path) -> None:
    machine, path = load_machine("default"), tmp_path / "w.npy"
    np.save(path, np.full((4, 8, 10), 255, np.int64))
    array = read_memory(252, path, machine)
    assert array.dtype == np.uint8
    assert array.shape == (4, 8, 10)


@pytest.mark.parametrize(
    "array",
    [
        np.zeros((8, 10), np.uint8),
        np.zeros((5, 8, 10), np.uint8),
        np.zeros((1, 10, 8), np.uint8),
        np.full((1, 8, 10), 256),
        np.full((1, 8, 10), -1),
        np.zeros((1, 8, 10)),
        np.zeros((1, 8, 10), bool),
        np.array([{}], object),
    ],
)
def test_memory_that_does_not_fit(tmp_path: Path, array: Any) -> None:
    path = tmp_path / "w.npy"
    np.save(path, array)
    with pytest.raises(InputError, match=r"w\.npy.*NP243"):
        read_memory(252, path, load_machine("default"))


def test_memory_file_that_is_none(tmp_path: Path) -> None:
    path = tmp_path / "w.npy"
    with pytest.raises(InputError, match=r"cannot read .*w\.npy: No such file.*NP243"):
        read_memory(0, path, load_machine("default"))
    for data in (b"", b"PK", b"\x93NUMPY\x01\x00", b"hello"):
        path.write_bytes(data)
        with pytest.raises(InputError, match="NP243"):
            read_memory(0, path, load_machine("default"))
    np.savez(tmp_path / "w.npz", np.zeros(3))
    with pytest.raises(InputError, match="NP243"):
        read_memory(0, tmp_path / "w.npz", load_machine("default"))


# --- where errors end -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("error", "code", "message"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (InputError("NP299", "bad", hint="do"), 2, "error: bad [NP299]\n  hint: do\n"),
        (PermissionError(13, "Permission denied", "x.s"), 2, "x.s: Permission denied [NP252]"),
        (MemoryError(), 2, "error: no memory is left [NP258]\n  hint: the process needs more"),
        (MemoryError("1 GiB"), 2, "error: no memory is left: 1 GiB [NP258]"),
        (ValueError("oops"), 70, "internal error: ValueError: oops [NP259]"),
        (ImportError("failed\nto map", name="numpy"), 2, "loaded: failed to map [NP258]\n  hint"),
        (ImportError("nix", name="npchip.nix"), 70, "internal error: ImportError: nix [NP259]"),
        (BrokenPipeError(32, "Broken pipe"), 0, ""),
    ],
)
def test_every_error_ends_in_a_message(
    monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int, message: str
) -> None:
    def fail(*_: object) -> None:
        raise error

    monkeypatch.setattr(run, "load", fail)
    result = invoke("run", "p.s")
    assert result.exit_code == code
    assert message in result.stderr
    assert "Traceback" not in result.stderr


def test_unknown_command_in_a_real_process() -> None:
    done = npchip("rnu")
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Did you mean 'run'?" in done.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_full_disk_behind_standard_output() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [*NPCHIP, "--help"], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    assert done.stderr == "error: No space left on device [NP252]\n"


def test_reader_that_has_gone_away_sees_no_traceback() -> None:
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "w") as pipe:
        done = subprocess.run(
            [*NPCHIP, "--help"], stdout=pipe, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.stderr == ""


# --- progress -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("patience", "shown"), [(0.0, True), (60.0, False)])
def test_progress_shows_on_a_terminal_after_a_while(
    monkeypatch: pytest.MonkeyPatch, patience: float, shown: bool
) -> None:
    terminal = io.StringIO()
    monkeypatch.setattr(terminal, "isatty", lambda: True)
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(progress, "_PATIENCE_SECONDS", patience)
    with progress.frame_progress(100) as on_frame:
        assert on_frame
        on_frame(FrameRecord(1, 1, {}))
    assert ("1/100" in terminal.getvalue()) == shown
    assert bool(terminal.getvalue()) == shown


def test_no_progress_without_a_terminal() -> None:
    with progress.frame_progress(100) as on_frame:
        assert on_frame is None


def test_default_limit_is_that_of_the_chip() -> None:
    context = run.command.make_context("run", ["p.s"])
    assert context.params["max_cycles"] == MAX_CYCLES
