"""Results of a run on the command line: table, JSON, files, pictures, failures, budgets."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip.cli import run
from npchip.isa import load_isa
from npchip.machine import load_machine
from npchip.run.result import RunError
from tests.support.commands import invoke
from tests.support.results import IMAGING, TRAJECTORY, imaged, made, tracked

CLIP = np.random.default_rng(3).integers(256, size=(4, 64, 80)).astype(np.uint8)


Runs = Any


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
    assert result.stdout.splitlines()[-1] == f"# {path}: {len(CLIP)} frames"


def test_render_says_which_frames_a_png_shows(runs: Runs, tmp_path: Path) -> None:
    np.save(tmp_path / "clip.npy", np.zeros((20, *CLIP.shape[1:]), np.uint8))
    runs(made({}, [10] * 20))
    path = tmp_path / "path.png"
    arguments = ("run", "p.s", "--frames", tmp_path / "clip.npy", "--render", path)
    numbers = "0, 2, 3, 5, 7, 9, 10, 12, 14, 16, 17, 19"
    said = invoke(*arguments).stdout.splitlines()[-1]
    assert said == f"# {path}: 12 of 20 frames, {numbers}; a .gif shows all"
    assert str(path) not in invoke(*arguments, "--json").stdout


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
