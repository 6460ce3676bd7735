"""Sweeps in one process: rows, errors against the truth, what is kept, what fails."""

from __future__ import annotations

import json
import subprocess
import sys
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip import Chip, assemble
from npchip.base.errors import InputError
from npchip.sweep import load
from npchip.sweep.work import Done
from tests.support.sweeps import ROWS, folder_for, journal, rows, start, sweep_file, tables

pytest.importorskip("pyarrow")

COUNT = "programs: [count.s]\nclips: [dark.npy, ball.npy]\n"


def complete(file: Path, **extra: Any) -> Any:
    return load(file).complete(0, folder=file.parent / "out", **extra)


def test_a_row_is_what_a_run_gives(tmp_path: Path) -> None:
    outcome = complete(folder_for(tmp_path))
    assert (outcome.rows, outcome.computed, outcome.failed) == (ROWS, ROWS, 0)
    found = rows(outcome.folder)
    assert len(found) == ROWS
    row = found[5]
    assert (row["program"], row["clip"], row["THRESHOLD"]) == ("trajectory", "ball", "40")
    clip = np.load(tmp_path / "ball.npy")[:10]
    result = Chip(assemble("trajectory", defines={"THRESHOLD": 40})).run(clip)
    assert int(row["frames"]) == 10
    assert float(row["cycles_mean"]) == pytest.approx(result.frame_cycles.mean())
    assert int(row["cycles_max"]) == result.frame_cycles.max()
    assert int(row["instructions"]) == result.instructions
    assert int(row["words"]) == len(assemble("trajectory").words)
    for name, values in result.outputs.items():
        assert float(row[f"{name}_mean"]) == pytest.approx(values.mean())
        assert int(row[f"{name}_last"]) == values[-1]


def test_workers_need_no_file_of_a_memory_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = '.output a, 0, scalar\n.memory 3, "a.npy"\nf: EXPOSE\n LD r0, [3]\n OUT 0, r0\n JMP f\n'
    (tmp_path / "own.s").write_text(text)
    np.save(tmp_path / "a.npy", np.full((1, 8, 10), 42, np.uint8))
    file = folder_for(tmp_path, "programs: [own.s]\nclips: [dark.npy]\n")

    def without_the_file(*arguments: Any) -> Chip:
        (tmp_path / "a.npy").unlink()
        return Chip(*arguments)

    monkeypatch.setattr("npchip.sweep.work.Chip", without_the_file)
    (row,) = rows(complete(file).folder)
    assert (row["status"], row["a_last"]) == ("frames-exhausted", "42")


def test_a_memory_file_that_is_missing_is_the_error_of_its_runs(tmp_path: Path) -> None:
    (tmp_path / "own.s").write_text('.memory 3, "a.npy"\nf: EXPOSE\n JMP f\n')
    file = folder_for(tmp_path, "programs: [own.s, count.s]\nclips: [dark.npy]\n")
    own, count = rows(complete(file).folder)
    assert "a.npy" in own["error"]
    assert "NP243" in own["error"]
    assert count["error"] == ""
    np.save(tmp_path / "a.npy", np.zeros((1, 8, 10), np.uint8))
    assert complete(file).failed == 0


def test_errors_are_distances_from_the_truth(tmp_path: Path) -> None:
    outcome = complete(folder_for(tmp_path))
    row = rows(outcome.folder)[5]
    truth = json.loads((tmp_path / "ball.truth.json").read_text())["frames"]
    clip = np.load(tmp_path / "ball.npy")[:10]
    result = Chip(assemble("trajectory", defines={"THRESHOLD": 40})).run(clip)
    for names, ahead, column in (
        (("center_row", "center_col"), 0, ""),
        (("predicted_row", "predicted_col"), 1, "_ahead_1"),
    ):
        found = []
        for k in range(10 - ahead):
            y, x = truth[k + ahead]["objects"][0]["center"]
            if result.outputs["valid"][k]:
                sent = [int(result.outputs[name][k]) for name in names]
                found.append(hypot(sent[0] - y, sent[1] - x))
        assert len(found) == 9 - ahead
        assert float(row[f"error_rms{column}"]) == pytest.approx(np.sqrt(np.mean(np.square(found))))
        assert float(row[f"error_median{column}"]) == pytest.approx(np.median(found))
        assert int(row[f"error_frames{column}"]) == len(found)
    assert rows(outcome.folder)[0]["error_rms"] == ""  # nobody knows where the coin was


def test_the_table_of_python(tmp_path: Path) -> None:
    pytest.importorskip("pandas")
    file = folder_for(tmp_path, COUNT)
    table = load(file).run(0, folder=tmp_path / "out")
    assert table["clip"].tolist() == ["dark", "ball"]
    assert table["total_last"].tolist() == [6, 14]
    assert [*table.columns] == [
        *("run", "program", "clip", "machine", "status", "error", "frames", "cycles_mean"),
        *("cycles_max", "words", "instructions", "total_mean", "total_last"),
    ]


def test_what_is_done_is_not_computed_again(tmp_path: Path) -> None:
    file = folder_for(tmp_path, COUNT)
    complete(file)
    before = tables(tmp_path / "out")
    assert complete(file).computed == 0
    assert tables(tmp_path / "out") == before
    more = sweep_file(tmp_path, f"{COUNT}define: {{STEP: [1, 2]}}\n")
    assert complete(more).computed == 4  # STEP is now a definition of the run
    sweep_file(tmp_path, COUNT.replace("dark.npy, ", ""))
    outcome = complete(file)
    assert (outcome.rows, outcome.computed) == (1, 0)
    assert [row["clip"] for row in rows(outcome.folder)] == ["ball"]


def test_a_journal_that_was_cut_loses_its_last_run_only(tmp_path: Path) -> None:
    file = folder_for(tmp_path, COUNT)
    complete(file)
    before = tables(tmp_path / "out")
    path = tmp_path / "out" / "journal.jsonl"
    path.write_bytes(path.read_bytes()[:-9])
    assert complete(file).computed == 1
    assert tables(tmp_path / "out") == before


def test_frames_are_rows_of_their_own(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    file = folder_for(tmp_path, COUNT)
    complete(file)
    sweep_file(tmp_path, f"{COUNT}frames: true\n")
    assert complete(file).computed == 2  # their frames were not kept
    table = pandas.read_parquet(tmp_path / "out" / "frames.parquet")
    assert [*table.columns] == ["run", "frame", "cycles", "total"]
    assert table["total"].tolist() == [*range(1, 7), *range(1, 15)]
    assert table["frame"].tolist() == [*range(6), *range(14)]
    assert complete(file).computed == 0


def test_a_program_that_traps_is_a_row_and_stays_one(tmp_path: Path) -> None:
    file = folder_for(tmp_path, f"{COUNT}define: {{LIMIT: [4, 9]}}\n")
    outcome = complete(file)
    assert (outcome.rows, outcome.failed) == (4, 3)
    found = rows(outcome.folder)
    assert [row["status"] for row in found] == ["failed", "frames-exhausted", "failed", "failed"]
    assert "count.s:11: error: at address" in found[0]["error"]
    assert found[0]["error"].endswith("[NP302]")
    assert complete(file).computed == 0


def test_a_program_that_does_not_assemble_for_a_value_is_a_row(tmp_path: Path) -> None:
    file = folder_for(tmp_path, f"{COUNT}define: {{STEP: [300, 1]}}\n")
    outcome = complete(file)
    assert [row["status"] for row in rows(outcome.folder)] == ["failed", "frames-exhausted"] * 2
    assert "NP006" in rows(outcome.folder)[0]["error"]


def test_a_constant_that_no_program_has_is_refused_before_anything_runs(tmp_path: Path) -> None:
    file = folder_for(tmp_path, f"{COUNT}define: {{STEPS: [1, 2]}}\n")
    with pytest.raises(InputError, match=r"'STEPS'.*NP026"):
        complete(file)
    assert journal(tmp_path / "out") == []


def test_a_clip_that_disappears_is_a_row_until_it_is_back(tmp_path: Path) -> None:
    file = folder_for(tmp_path, COUNT)
    kept = (tmp_path / "ball.npy").read_bytes()
    sweep = load(file)
    assert len(sweep.runs) == 2  # the clips have been read
    (tmp_path / "ball.npy").unlink()
    outcome = sweep.complete(0, folder=tmp_path / "out")
    assert (outcome.rows, outcome.failed) == (2, 1)
    assert "NP210" in rows(outcome.folder)[1]["error"]
    (tmp_path / "ball.npy").write_bytes(kept)
    assert complete(file).computed == 1
    assert [row["status"] for row in rows(tmp_path / "out")] == ["frames-exhausted"] * 2


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="limits of files are a Unix matter")
def test_a_full_disk_keeps_what_is_done(tmp_path: Path) -> None:
    file = folder_for(tmp_path, f"{COUNT}define: {{STEP: 1..30}}\n")
    code = (
        "import resource\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))\n"
        "from npchip.__main__ import main\n"
        "main()\n"
    )
    command = [sys.executable, "-B", "-c", code, "sweep", file.name, "--jobs", "0", "-o", "out"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2, done.stderr
    assert "NP250" in done.stderr
    assert "what is done is kept" in done.stderr
    assert "Traceback" not in done.stderr
    kept = len(journal(tmp_path / "out"))
    assert 5 < kept < 60
    assert complete(file).computed == 60 - kept


def test_the_folder_says_what_it_was_made_with(tmp_path: Path) -> None:
    file = folder_for(tmp_path)
    complete(file)
    about = json.loads((tmp_path / "out" / "sweep.json").read_text())
    assert about["command"] == "npchip sweep s.yaml"
    assert about["file"] == file.read_text()
    assert {"npchip", "python", "numpy", "wasmtime"} <= about["versions"].keys()
    assert about["programs"].keys() == {"trajectory", "tracking"}
    assert [clip["name"] for clip in about["clips"]] == ["coin_slide", "ball", *["scene"] * 3]
    assert about["runs"]["planned"] == about["runs"]["in the table"] == ROWS


def test_an_experiment_is_a_function(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "def area(side, kind, machine):\n"
        "    if side == 3:\n"
        "        raise ValueError('too large')\n"
        "    return {'area': side * side, 'rows': machine.rows}\n"
    )
    file = sweep_file(
        tmp_path,
        "experiment: mine:area\nmachines: [conservative]\ndefine: {side: 1..3, kind: [a, b]}\n",
    )
    outcome = complete(file)
    assert (outcome.rows, outcome.failed) == (6, 2)
    found = rows(outcome.folder)
    assert [row["area"] for row in found] == ["1", "1", "4", "4", "", ""]
    assert found[4]["error"] == "ValueError: too large"
    assert found[0]["rows"] == "64"


def test_what_is_no_number_is_missing_and_names_of_columns_are_taken(tmp_path: Path) -> None:
    (tmp_path / "odd.py").write_text(
        "def odd(kind):\n"
        "    if kind == 'own':\n"
        "        return {'error': 1}\n"
        "    return {'y': float(kind)}\n"
    )
    outcome = complete(
        sweep_file(tmp_path, "experiment: odd:odd\ndefine: {kind: [nan, inf, own]}\n")
    )
    assert (outcome.rows, outcome.failed) == (3, 2)
    found = rows(outcome.folder)
    assert [row["y"] for row in found] == ["", "", ""]
    assert [row["error"] for row in found] == [
        "",
        "ValueError: expected finite numbers, found an infinite one",
        "ValueError: a result is named 'error', which is a column of every sweep",
    ]


def test_every_run_is_reported(tmp_path: Path) -> None:
    seen: list[Done] = []
    complete(folder_for(tmp_path, COUNT), on_run=seen.append)
    assert [done.row["status"] for done in seen] == ["frames-exhausted"] * 2


@pytest.mark.long
def test_as_a_process_it_exits_with_1_where_a_run_failed(tmp_path: Path) -> None:
    folder_for(tmp_path, f"{COUNT}define: {{LIMIT: [4]}}\n")
    process = start("s.yaml", "--jobs", "0", where=tmp_path)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (1, "")
    assert out == "s: 2 rows, 2 computed, 2 failed\n"


@pytest.mark.parametrize("first", ["", "first: 5\n"])
def test_a_clip_too_long_to_be_kept_gives_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, first: str
) -> None:
    file = folder_for(tmp_path, f"{COUNT}define: {{STEP: 1..2}}\n{first}")
    complete(file)
    before = tables(tmp_path / "out")
    monkeypatch.setattr("npchip.sweep.work._MOST_PIXELS", 64 * 80 * 2)
    sweep = load(file)
    sweep.complete(0, folder=tmp_path / "again")
    assert tables(tmp_path / "again") == before


def test_a_truth_that_is_none_is_told(tmp_path: Path) -> None:
    text = COUNT.replace("count.s", "tracking")
    (folder_for(tmp_path, text).parent / "ball.truth.json").write_text('{"frames": [{}]}')
    outcome = complete(tmp_path / "s.yaml")
    assert outcome.failed == 1
    assert "ball.truth.json: not the truth about a clip" in rows(outcome.folder)[1]["error"]


def test_a_source_that_changes_gives_its_own_results_in_the_same_process(tmp_path: Path) -> None:
    file = folder_for(tmp_path, COUNT)
    complete(file)
    source = tmp_path / "count.s"
    source.write_text(source.read_text().replace("MOV     r0, #0", "MOV     r0, #50"))
    assert complete(file).computed == 2
    assert [row["total_last"] for row in rows(tmp_path / "out")] == ["56", "64"]


def test_an_experiment_that_changes_does_too(tmp_path: Path) -> None:
    module = tmp_path / "changing.py"
    file = sweep_file(tmp_path, "experiment: changing:double\ndefine: {x: 1..2}\n")
    for factor in (2, 30):
        module.write_text(f"def double(x):\n    return {{'y': {factor} * x}}\n")
        assert complete(file).computed == 2
        assert [row["y"] for row in rows(tmp_path / "out")] == [str(factor), str(2 * factor)]
