"""Sweeps on a Dask cluster of real processes: workers that die, come late, differ."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from npchip.base.errors import InputError
from npchip.sweep import load
from tests.support.sweeps import folder_for, journal, start, tables
from tests.sweep.test_processes import RUNS, long_folder, wait_until

pytest.importorskip("pyarrow")
pytest.importorskip("distributed")

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(sys.platform == "win32", reason="signals are a Unix matter"),
]


class Processes:
    """A scheduler and workers, which know nothing of the sweep's folder."""

    def __init__(self, folder: Path, opened: ExitStack) -> None:
        self._folder = folder
        self._opened = opened
        self.file = folder / "scheduler.json"
        self.scheduler = self._start(
            "dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"
        )
        wait_until(lambda: self.file.exists() and self.file.read_text().rstrip().endswith("}"))

    def _start(self, module: str, *arguments: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.{module}", "--scheduler-file"]
        process = subprocess.Popen(
            [*command, str(self.file), *arguments],
            cwd=self._folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._opened.callback(process.wait)
        self._opened.callback(process.kill)
        return process

    def worker(self) -> subprocess.Popen[bytes]:
        """Start a worker."""
        return self._start("dask_worker", "--nthreads", "1", "--no-nanny", "--no-dashboard")

    @property
    def address(self) -> str:
        """Address of the scheduler."""
        return str(json.loads(self.file.read_text())["address"])


@contextmanager
def _cluster(
    folder: Path, workers: int
) -> Iterator[tuple[Processes, list[subprocess.Popen[bytes]]]]:
    folder.mkdir()
    with ExitStack() as opened:
        processes = Processes(folder, opened)
        yield processes, [processes.worker() for _ in range(workers)]


def test_a_worker_that_is_killed_and_one_that_comes_late_change_nothing(tmp_path: Path) -> None:
    file = long_folder(tmp_path)
    file.write_text(file.read_text().replace("clips: [", "clips: [ball.npy, coin_slide, "))
    out = tmp_path / "s"
    with _cluster(tmp_path / "cluster", 3) as (processes, workers):
        command = start(file.name, "--scheduler", processes.address, where=tmp_path)
        wait_until(lambda: len(journal(out)) >= 6 or command.poll() is not None)
        assert command.poll() is None, command.communicate()[1]
        workers[0].send_signal(signal.SIGKILL)
        processes.worker()
        _, err = command.communicate(timeout=300)
    assert command.returncode == 0, err
    assert "Traceback" not in err
    keys = [line[:30] for line in journal(out)]
    assert len(keys) == len(set(keys)) == 2 * 8 * 8
    load(file).complete(0, folder=tmp_path / "local")
    assert tables(out) == tables(tmp_path / "local")


def test_a_scheduler_that_is_gone_is_told_and_what_is_done_is_kept(tmp_path: Path) -> None:
    file = long_folder(tmp_path)
    out = tmp_path / "s"
    with _cluster(tmp_path / "cluster", 1) as (processes, _):
        command = start(file.name, "--scheduler", processes.address, where=tmp_path)
        wait_until(lambda: len(journal(out)) >= 6 or command.poll() is not None)
        assert command.poll() is None, command.communicate()[1]
        processes.scheduler.kill()
        begin = time.monotonic()
        _, err = command.communicate(timeout=120)
        assert time.monotonic() - begin < 60
    assert command.returncode == 2, err
    assert "the scheduler is gone [NP648]" in err
    assert "Traceback" not in err
    kept = len(journal(out))
    assert 6 <= kept < RUNS
    assert load(file).complete(0, folder=out).computed == RUNS - kept


def test_the_only_worker_dies_and_another_one_takes_over(tmp_path: Path) -> None:
    file = folder_for(
        tmp_path,
        "programs: [trajectory]\nclips: [ball.npy, coin_slide]\ndefine: {THRESHOLD: 20..60}\n",
    )
    out = tmp_path / "s"
    with _cluster(tmp_path / "cluster", 1) as (processes, workers):
        command = start(file.name, "--scheduler", processes.address, where=tmp_path)
        wait_until(lambda: len(journal(out)) >= 2 or command.poll() is not None)
        workers[0].kill()
        processes.worker()
        _, err = command.communicate(timeout=300)
    assert command.returncode == 0, err
    assert len(journal(out)) == 2 * 41


def test_without_a_scheduler_the_error_says_what_to_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from npchip.sweep import cluster

    monkeypatch.setattr(cluster, "_PATIENCE", 1)
    with pytest.raises(InputError, match=r"no scheduler.*\[NP648\]\n.*dask scheduler"):
        load(folder_for(tmp_path)).complete(folder=tmp_path / "out", scheduler="tcp://127.0.0.1:9")


def test_workers_of_another_version_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from npchip.sweep import batches, cluster, content, plan

    file = folder_for(tmp_path)
    with _cluster(tmp_path / "cluster", 1) as (processes, _):
        for module in (batches, cluster, content, plan):
            if hasattr(module, "version"):
                monkeypatch.setattr(module, "version", lambda: "9.9")
        with pytest.raises(InputError, match=r"another npchip than 9\.9: tcp://.*\[NP649\]"):
            load(file).complete(folder=tmp_path / "out", scheduler=processes.address)
