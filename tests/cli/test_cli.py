"""The command line: help, options, errors, exit codes. Whole runs are in ``test_run.py``."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip.base.errors import InputError
from npchip.cli import progress, run
from npchip.cli.main import COMMANDS, cli
from npchip.frames.memory import read_memory
from npchip.isa import load_isa
from npchip.machine import load_machine
from npchip.run.chip import MAX_CYCLES
from npchip.run.result import FrameRecord, RunError, RunResult
from tests.support.results import IMAGING, TRAJECTORY, imaged, made, tracked

if TYPE_CHECKING:
    from collections.abc import Callable

    from npchip.program.model import Program

NPCHIP = [sys.executable, "-m", "npchip"]
CLIP = np.random.default_rng(3).integers(256, size=(4, 64, 80)).astype(np.uint8)


def invoke(*arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, [str(each) for each in arguments], prog_name="npchip")


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> Callable[[RunResult, Program], None]:
    """Make ``npchip run`` deliver a given result instead of assembling and executing."""

    def deliver(result: RunResult, program: Program = TRAJECTORY) -> None:
        machine = load_machine("default")
        monkeypatch.setattr(run, "load", lambda *_: (load_isa(), machine, program))
        monkeypatch.setattr(run, "execute", lambda *_: result)

    return deliver


Runs = Any


def npchip(*arguments: str, **extra: Any) -> subprocess.CompletedProcess[str]:
    command = [*NPCHIP, *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, check=False, **({"timeout": 60} | extra)
    )


# --- help ---------------------------------------------------------------------------------


def test_help_fits_one_screen_and_names_every_command() -> None:
    for flag in ("--help", "-h"):
        result = invoke(flag)
        assert result.exit_code == 0
        lines = result.output.splitlines()
        assert len(lines) <= 24
        assert max(map(len, lines)) <= 80
        assert all(
            re.search(rf"^  .{{7}}  {name} ", result.output, re.MULTILINE) for name in COMMANDS
        )


def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; sys.argv = ['npchip', '--help']\n"
        "from npchip.cli.main import main\n"
        "try: main()\n"
        "finally: print(sorted({'numpy', 'rich', 'PIL', 'yaml'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_run_help_teaches_by_examples() -> None:
    result = invoke("run", "-h")
    assert result.exit_code == 0
    assert result.output.count("  npchip run ") >= 3
    assert max(map(len, result.output.splitlines())) <= 80


def every_help() -> dict[str, str]:
    found = {}
    for name in COMMANDS:
        command = cli.get_command(click.Context(cli), name)
        for below in ((), *((each,) for each in getattr(command, "commands", {}))):
            found[" ".join((name, *below))] = invoke(name, *below, "--help").output
    return found


def test_help_names_no_file_of_a_clone() -> None:
    for name, text in every_help().items():
        assert not re.search(r"\b(asm|examples|docs|src)/", text), name


def test_help_does_not_need_docstrings() -> None:
    code = (
        "from click.testing import CliRunner\n"
        "from npchip.cli.main import cli, with_help\n"
        "with_help(cli)\n"
        "for name in ('', 'run', 'orient predict'):\n"
        "    print(CliRunner().invoke(cli, [*name.split(), '--help']).output)"
    )
    done = subprocess.run(
        [sys.executable, "-OO", "-c", code], capture_output=True, text=True, check=True
    )
    for text in (
        "Try: npchip run trajectory",
        "npchip run trajectory --frames coin_slide",
        "With the camera's yaw and pitch",
    ):
        assert text in done.stdout


def test_version() -> None:
    result = invoke("--version")
    assert re.fullmatch(r"npchip \d+\.\d+\.\d+\n", result.output)


@pytest.mark.parametrize("name", COMMANDS)
def test_table_of_commands_leads_to_modules(name: str) -> None:
    assert isinstance(cli.get_command(click.Context(cli), name), click.Command)


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


# --- what a run delivers --------------------------------------------------------------------


def test_table_when_piped(runs: Runs) -> None:
    runs(tracked(CLIP))
    result = invoke("run", "p.s")
    assert result.exit_code == 0
    assert result.stdout.splitlines()[0].split()[0] == "frame"
    assert result.stderr == ""


def test_json_is_all_of_standard_output(runs: Runs, tmp_path: Path) -> None:
    runs(tracked(CLIP))
    printed = invoke("run", "p.s", "--json").stdout
    result = invoke("run", "p.s", "--json-to", tmp_path / "run.json")
    assert json.loads(printed)["schema"] == 1
    assert (tmp_path / "run.json").read_text() == printed
    assert result.stdout.splitlines()[0].split()[0] == "frame"


def test_save_and_json_name_the_same_files(runs: Runs, tmp_path: Path) -> None:
    runs(imaged(CLIP), IMAGING)
    result = invoke("run", "p.s", "--json", "--save", tmp_path / "out")
    assert result.stdout == (tmp_path / "out" / "run.json").read_text()
    assert np.array_equal(np.load(tmp_path / "out" / "picture.npy"), CLIP)


def test_render(runs: Runs, tmp_path: Path) -> None:
    np.save(tmp_path / "clip.npy", CLIP)
    runs(tracked(CLIP))
    path = tmp_path / "path.gif"
    result = invoke("run", "p.s", "--frames", tmp_path / "clip.npy", "--render", path)
    assert result.exit_code == 0, result.output
    assert path.read_bytes().startswith(b"GIF89a")


def test_failed_run_shows_its_frames_and_the_error(runs: Runs) -> None:
    error = RunError("NP301", "NPs disagree", address=3, file="p.s", line=9)
    runs(made({}, [10, 20], status="failed", error=error))
    for option in ([], ["--json"]):
        result = invoke("run", "p.s", *option)
        assert result.exit_code == 1
        assert "20" in result.stdout
        assert result.stderr == "p.s:9: error: NPs disagree [NP301]\n"


def test_cycle_limit_shows_its_frames_and_exits_with_3(runs: Runs) -> None:
    runs(made({}, [10, 50], status="cycle-limit", last_complete=False))
    result = invoke("run", "p.s", "--max-cycles", "50")
    assert result.exit_code == 3
    assert "frame 1 reached the limit of 50 cycles [NP321]" in result.stderr
    assert "CYCLE LIMIT" in result.stdout


def test_cycle_limit_in_the_set_up(runs: Runs) -> None:
    runs(made({}, [], status="cycle-limit"))
    assert "set-up reached the limit" in invoke("run", "p.s").stderr


@pytest.mark.parametrize(("cycles", "code"), [(2000, 0), (2001, 1)])
def test_budget_bounds_the_worst_frame(runs: Runs, cycles: int, code: int) -> None:
    runs(made({}, [1, cycles, 1]))
    result = invoke("run", "p.s", "--json")
    assert result.exit_code == code
    document = json.loads(result.stdout)
    assert document["status"] == ("failed" if code else "frames-exhausted")
    if code:
        assert document["error"]["code"] == "NP320"
        assert "frame 1 took 2,001 cycles" in document["error"]["message"]
        assert "[NP320]" in result.stderr


def test_budget_speaks_of_the_default_machine_only(
    runs: Runs, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs(made({}, [9999]))
    machine = load_machine("conservative")
    monkeypatch.setattr(run, "load", lambda *_: (load_isa(), machine, TRAJECTORY))
    assert invoke("run", "p.s", "--machine", "conservative").exit_code == 0


def test_budget_does_not_hide_another_failure() -> None:
    error = RunError("NP301", "disagree")
    result = made({}, [9999], status="failed", error=error)
    assert run.check_budget(result, TRAJECTORY) is result


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
