"""Sweeps in several processes: the same bytes, and what an interrupt or a kill leaves."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from npchip.sweep import load
from tests.support.sweeps import folder_for, journal, start, tables

pytest.importorskip("pyarrow")
pytest.importorskip("joblib")

LONG = """
programs: [trajectory, tracking]
clips: [{scene: long.yaml, seeds: 1..6}]
define: {THRESHOLD: 20..34..2}
"""
RUNS = 2 * 6 * 8


def long_folder(path: Path) -> Path:
    file = folder_for(path, LONG)
    scene = (path / "scene.yaml").read_text()
    (path / "long.yaml").write_text(scene.replace("frames: 12", "frames: 300"))
    return file


def wait_until(holds: Callable[[], bool], seconds: float = 120) -> None:
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)


@pytest.mark.long
def test_the_tables_are_the_same_bytes(tmp_path: Path) -> None:
    sweep = load(folder_for(tmp_path))
    for jobs in (0, 2):
        sweep.complete(jobs, folder=tmp_path / f"jobs{jobs}")
    assert len(tables(tmp_path / "jobs0")) == 3
    assert tables(tmp_path / "jobs2") == tables(tmp_path / "jobs0")


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="signals are a Unix matter")
def test_an_interrupt_keeps_what_is_done(tmp_path: Path) -> None:
    file = long_folder(tmp_path)
    out = tmp_path / "s"
    process = start(file.name, "--jobs", "2", where=tmp_path, start_new_session=True)
    wait_until(lambda: len(journal(out)) >= 6)
    os.killpg(process.pid, signal.SIGINT)  # as Ctrl-C does: to all processes of the terminal
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in err, err
    kept = len(journal(out))
    assert 6 <= kept < RUNS
    outcome = load(file).complete(0, folder=out)
    assert (outcome.rows, outcome.computed) == (RUNS, RUNS - kept)
    load(file).complete(0, folder=tmp_path / "again")
    assert tables(out) == tables(tmp_path / "again")


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="signals are a Unix matter")
def test_a_killed_process_is_told_and_what_is_done_is_kept(tmp_path: Path) -> None:
    psutil = pytest.importorskip("psutil")  # comes with Dask
    file = long_folder(tmp_path)
    process = start(file.name, "--jobs", "2", where=tmp_path)
    wait_until(lambda: len(journal(tmp_path / "s")) >= 6)
    workers = [
        child
        for child in psutil.Process(process.pid).children(recursive=True)
        if "LokyProcess" in " ".join(child.cmdline()) or "loky" in " ".join(child.cmdline())
    ]
    os.kill(workers[-1].pid, signal.SIGKILL)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 2, err
    assert "NP650" in err
    assert "Traceback" not in err
    assert load(file).complete(0, folder=tmp_path / "s").computed < RUNS
