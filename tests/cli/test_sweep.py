"""``npchip sweep``: what the command prints, draws and refuses."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from npchip.cli.main import cli
from tests.support.sweeps import folder_for, rows

pytest.importorskip("pyarrow")

COUNT = "programs: [count.s]\nclips: [dark.npy, ball.npy]\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder_for(tmp_path, f"{COUNT}define: {{STEP: 1..2}}\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def sweep(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["sweep", "s.yaml", *arguments])


def test_it_says_how_much_it_did(folder: Path) -> None:
    done = sweep("--jobs", "0")
    assert (done.exit_code, done.stdout) == (0, "s: 4 rows, 4 computed, 0 failed\n")
    assert len(rows(folder / "s")) == 4
    done = sweep("--jobs", "0", "-o", "s")
    assert (done.exit_code, done.stdout) == (0, "s: 4 rows, 0 computed, 0 failed\n")


def test_a_dry_run_shows_axes_and_time_and_writes_nothing(folder: Path) -> None:
    before = sorted(folder.iterdir())
    shown = sweep("--dry-run").stdout.splitlines()
    assert [line.split() for line in shown[1:5]] == [
        ["program", "1", "count"],
        ["clip", "2", "dark,", "ball"],
        ["machine", "1", "default"],
        ["STEP", "2", "1,", "2"],
    ]
    assert shown[5] == "4 runs, 0 of them done"
    assert shown[6].startswith("about ")
    assert sorted(folder.iterdir()) == before
    sweep("--jobs", "0")
    assert sweep("--dry-run").stdout.splitlines()[5:] == ["4 runs, 4 of them done"]


@pytest.mark.long
def test_a_picture_of_lines_and_one_of_heat_maps_are_the_same_each_time(folder: Path) -> None:
    pytest.importorskip("matplotlib")
    assert sweep("--jobs", "0", "--plot", "lines.svg").exit_code == 0
    assert "STEP" in (folder / "lines.svg").read_text()
    first = (folder / "lines.svg").read_bytes()
    assert sweep("--jobs", "0", "--plot", "lines.svg").exit_code == 0
    assert (folder / "lines.svg").read_bytes() == first
    (folder / "s.yaml").write_text(f"{COUNT}define: {{STEP: 1..2, LIMIT: [90, 95, 99]}}\n")
    assert sweep("--jobs", "0", "--plot", "maps.svg").exit_code == 0
    text = (folder / "maps.svg").read_text()
    assert "LIMIT" in text
    assert "cycles of a frame" in text


def test_what_makes_no_sense_is_refused_before_anything_runs(folder: Path) -> None:
    for arguments, code in (
        (["--plot", "x.pdf"], "NP652"),
        (["-o", "s.yaml"], "NP250"),
    ):
        done = sweep("--jobs", "0", *arguments)
        assert done.exit_code == 2
        assert code in done.stderr
    (folder / "s.yaml").write_text("programs: [counts.s]\n")
    done = sweep("--jobs", "0")
    assert done.exit_code == 2
    assert done.stderr.startswith("s.yaml:1: error: programs: no such file: counts.s [NP644]")
    assert not (folder / "s").exists()


def test_all_failed_leaves_nothing_to_draw(folder: Path) -> None:
    pytest.importorskip("matplotlib")
    (folder / "s.yaml").write_text(f"{COUNT}define: {{STEP: [300]}}\n")
    done = sweep("--jobs", "0", "--plot", "x.svg")
    assert done.exit_code == 2
    assert "NP652" in done.stderr
    assert len(rows(folder / "s")) == 2
