"""`python -m benchmarks --against`: what it asks, counts and prints; no figure is judged."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import against
from benchmarks.__main__ import main
from benchmarks.against import RequestError, Rounds, checked_out, shown, tabulated, working
from benchmarks.programs import ROOT

MEASURED = {
    "slow": Rounds([(50.0, 100.0)], [(0.020, 0.010)]),
    "fast": Rounds(
        [(800.0, 100.0), (100.0, 25.0), (600.0, 50.0)],
        [(0.010, 0.020), (0.030, 0.060), (0.020, 0.040)],
    ),
}


def fails(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Return the last line of a command that ends with 2."""
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2
    return capsys.readouterr().err.splitlines()[-1]


def test_an_unknown_commit_is_told_in_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--against", "no-such-commit"])
    assert end.value.code == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err == (
        "python -m benchmarks: error: no commit 'no-such-commit' in this repository\n"
    )


def test_an_option_is_no_commit() -> None:
    with pytest.raises(RequestError, match="no commit '--all'"), checked_out("--all"):
        pass


def test_an_unknown_program_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    told = fails(capsys, "--against", "HEAD", "--only", "imaging,nothing")
    assert told.endswith("error: no program 'nothing' in asm/ of the working tree")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--against", "HEAD", "ready"], "--against takes parts only with --page"),
        (["--page", "x"], "--page needs --against COMMIT, with all programs"),
        (
            ["--against", "HEAD", "--page", "x", "--only", "dct"],
            "--page needs --against COMMIT, with all programs",
        ),
        (["--only", "dct"], "--only and --rounds belong to --against and ablation"),
        (["--rounds", "3", "ready"], "--only and --rounds belong to --against and ablation"),
        (["--against", "HEAD", "--rounds", "0"], "argument --rounds: expected a number above 0"),
    ],
)
def test_options_that_do_not_go_together(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert fails(capsys, *arguments).endswith(told)


def test_a_ratio_is_the_median_of_the_rounds() -> None:
    """The medians of the two trees are of rounds that need not be the same."""
    assert tabulated(MEASURED)["fast"] == pytest.approx(
        {
            "frames/s": 600,
            "frames/s, then": 50,
            "frames/s, ratio": 8,
            "ready ms": 20,
            "ready ms, then": 40,
            "ready, ratio": 2,
        }
    )


def test_last_are_the_geometric_mean_and_the_lowest() -> None:
    table = tabulated(MEASURED)
    assert list(table)[-2:] == ["geometric mean", "lowest"]
    assert list(table["geometric mean"].values()) == pytest.approx([2, 1])
    assert list(table["lowest"].values()) == pytest.approx([0.5, 0.5])
    lines = shown(table, "main~3").splitlines()
    assert "main~3" in lines[0]
    assert [line.split() for line in lines[3:]] == [
        ["slow", "50", "100", "0.500", "20.0", "10.0", "0.500"],
        ["fast", "600", "50", "8.000", "20.0", "40.0", "2.000"],
        ["geometric", "mean", "2.000", "1.000"],
        ["lowest", "0.500", "0.500"],
    ]


def test_a_worker_measures_the_package_of_its_tree() -> None:
    with working(ROOT) as worker:
        assert worker.package == ROOT / "src" / "npchip" / "__init__.py"
        assert worker.ask("pace", "imaging") > 0
        assert worker.ask("steady", "imaging", 4, 2) > 0
        assert worker.ask("ready", "imaging") > 0


def test_a_tree_without_the_package_is_told(tmp_path: Path) -> None:
    """One that is installed must not be measured in its place."""
    with pytest.raises(against.WorkerError), working(tmp_path):
        pass


@pytest.mark.long
def test_a_commit_is_measured_and_its_folder_removed(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(against, "SECONDS", 0.01)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    main(["--against", "HEAD", "--only", "imaging", "--rounds", "1"])
    told = capsys.readouterr()
    assert [line.split()[0] for line in told.out.splitlines()[3:]] == [
        "imaging",
        "geometric",
        "lowest",
    ]
    assert told.err == ""  # which is no terminal here
    assert not list(tmp_path.iterdir())
