"""Compare the working tree with another commit, both measured in turn in one run."""

from __future__ import annotations

import io
import os
import signal
import statistics
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from benchmarks.measure import plan, progress
from benchmarks.programs import FRAMES, ROOT, sources

SECONDS: Final = 0.2
"""About what one measurement of frames per second takes."""

_MEAN: Final = "geometric mean"
_LOWEST: Final = "lowest"
_RATIOS: Final = ("frames/s, ratio", "ready, ratio")

Table = dict[str, dict[str, float]]


class RequestError(Exception):
    """The request cannot be met: no such commit or program, or git is missing."""


class WorkerError(Exception):
    """A process that measures has ended before its time."""


@dataclass
class Rounds:
    """Measurements of a program: a pair for each round, the working tree's first."""

    steady: list[tuple[float, float]] = field(default_factory=list)
    ready: list[tuple[float, float]] = field(default_factory=list)


class Worker:
    """A process that measures the package of a tree."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self.package = Path(self._answer())

    def ask(self, *words: str | int) -> float:
        """Send a request and return the answer."""
        assert self._process.stdin
        try:
            self._process.stdin.write(" ".join(map(str, words)) + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            raise WorkerError("a process that measures has ended; what it said is above") from None
        return float(self._answer())

    def _answer(self) -> str:
        assert self._process.stdout
        line = self._process.stdout.readline()
        if not line:
            raise WorkerError("a process that measures has ended; what it said is above")
        return line.rstrip("\n")


@contextmanager
def working(tree: Path) -> Iterator[Worker]:
    """Give a process that measures the package of a tree, with the code of the working tree."""
    process = subprocess.Popen(
        [sys.executable, "-P", "-m", "benchmarks.worker", str(tree)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tree / "src"), str(ROOT)])},
        start_new_session=True,  # a Ctrl-C is for the process that can tidy up
    )
    try:
        worker = Worker(process)
        # An editable install must not come first: both would measure the same package.
        if not worker.package.is_relative_to(tree / "src"):
            raise WorkerError(f"{worker.package} would be measured, which is not in {tree}")
        yield worker
    finally:
        process.kill()  # it has nothing to lose, and may be in the middle of a measurement
        process.wait()
        for pipe in (process.stdin, process.stdout):
            assert pipe
            with suppress(BrokenPipeError):
                pipe.close()


def compare(commit: str, only: Sequence[str], rounds: int) -> Table:
    """Measure the working tree and a commit.

    Args:
        commit: what git knows it by.
        only: names of programs; all that both have if there are none.
        rounds: how often each program is measured.

    Raises:
        RequestError: there is no such commit, or no such program in both.
        WorkerError: a program cannot be run.
    """
    with ExitStack() as stack:
        stack.enter_context(_tidy_when_terminated())
        tree = stack.enter_context(checked_out(commit))
        names = _chosen(tree, commit, only)
        new, old = (stack.enter_context(working(folder)) for folder in (ROOT, tree))
        return tabulated(_measured(new, old, names, rounds))


@contextmanager
def checked_out(commit: str) -> Iterator[Path]:
    """Give a temporary folder with the package and the programs of a commit."""
    name = _git(
        f"no commit '{commit}' in this repository",
        *("rev-parse", "--verify", "--quiet", "--end-of-options", f"{commit}^{{commit}}"),
    )
    archive = _git(
        f"commit '{commit}' has no src/npchip or no asm/",
        *("archive", name.decode().strip(), "src/npchip", "asm"),
    )
    with tempfile.TemporaryDirectory(prefix="npchip-") as folder:
        with tarfile.open(fileobj=io.BytesIO(archive)) as files:
            files.extractall(folder, filter="data")
        yield Path(folder).resolve()


def tabulated(measured: Mapping[str, Rounds]) -> Table:
    """Return medians and ratios of the programs, then of all of them.

    A ratio is above 1 if the working tree is the faster one. It is the median of the ratios of the
    rounds, as the two measurements of a round are neighbours: a machine that slows down between
    rounds does not change it.
    """
    table: Table = {}
    for name, rounds in measured.items():
        rates, times = rounds.steady, rounds.ready
        table[name] = {
            "frames/s": statistics.median(new for new, _ in rates),
            "frames/s, then": statistics.median(old for _, old in rates),
            _RATIOS[0]: statistics.median(new / old for new, old in rates),
            "ready ms": 1000 * statistics.median(new for new, _ in times),
            "ready ms, then": 1000 * statistics.median(old for _, old in times),
            _RATIOS[1]: statistics.median(old / new for new, old in times),
        }
    columns = {key: [row[key] for row in table.values()] for key in _RATIOS}
    table[_MEAN] = {key: statistics.geometric_mean(ratios) for key, ratios in columns.items()}
    table[_LOWEST] = {key: min(ratios) for key, ratios in columns.items()}
    return table


def shown(table: Table, commit: str) -> str:
    """Return the table as text."""
    lines = [
        f"The working tree (new) and {commit} (old); a ratio above 1: new is faster",
        f"{'':<22}{'steady, frames/s':^31}  {'source to first frame, ms':^25}",
        f"{'program':<22}{'new':>11} {'old':>11} {'ratio':>7}  {'new':>8} {'old':>8} {'ratio':>7}",
    ]
    for name, row in table.items():
        if name in (_MEAN, _LOWEST):
            steady, ready = row.values()
            lines.append(f"{name:<46}{steady:>7.3f}  {ready:>25.3f}")
        else:
            new, old, steady, new_ms, old_ms, ready = row.values()
            lines.append(
                f"{name:<22}{new:>11,.0f} {old:>11,.0f} {steady:>7.3f}  "
                f"{new_ms:>8.1f} {old_ms:>8.1f} {ready:>7.3f}"
            )
    return "\n".join(lines)


def _measured(new: Worker, old: Worker, names: Sequence[str], rounds: int) -> dict[str, Rounds]:
    measured = {name: Rounds() for name in names}
    plans: dict[str, tuple[int, int]] = {}
    with progress(rounds * len(names)) as tick:
        for index in range(rounds):
            for place, name in enumerate(names):
                tick(f"round {index + 1} of {rounds}: {name}")
                if name not in plans:
                    slower = min(new.ask("pace", name), old.ask("pace", name))
                    plans[name] = plan(slower, FRAMES, SECONDS)
                # Who goes first changes, as the second may find a machine that is warmer.
                turned = (index + place) % 2 == 1
                steady = ("steady", name, *plans[name])
                measured[name].steady.append(_pair(new, old, steady, turned=turned))
                measured[name].ready.append(_pair(new, old, ("ready", name), turned=turned))
    return measured


def _pair(
    new: Worker, old: Worker, words: Sequence[str | int], *, turned: bool
) -> tuple[float, float]:
    """Ask both the same, the new one first unless turned."""
    if turned:
        then = old.ask(*words)
        return new.ask(*words), then
    return new.ask(*words), old.ask(*words)


def _chosen(tree: Path, commit: str, only: Sequence[str]) -> list[str]:
    """Return the programs that both trees have, in order of their names."""
    here, there = sources(), sources(tree)
    for name in only:
        for programs, where in ((here, "the working tree"), (there, f"'{commit}'")):
            if name not in programs:
                raise RequestError(f"no program '{name}' in asm/ of {where}")
    names = [name for name in here if name in there and (not only or name in only)]
    if not names:
        raise RequestError(f"the working tree and '{commit}' have no program in common")
    return names


def _git(failure: str, *arguments: str) -> bytes:
    """Return what git prints.

    Raises:
        RequestError: it fails, which means what is given first.
    """
    try:
        return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=True).stdout
    except subprocess.CalledProcessError as error:
        reason = " ".join(error.stderr.decode(errors="replace").split())
        raise RequestError(f"{failure} ({reason})" if reason else failure) from None
    except FileNotFoundError:
        raise RequestError("git is not installed") from None


@contextmanager
def _tidy_when_terminated() -> Iterator[None]:
    """Leave through all that tidies up when the process is asked to end."""

    def leave(number: int, _: object) -> None:
        sys.exit(128 + number)

    before = signal.signal(signal.SIGTERM, leave)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
