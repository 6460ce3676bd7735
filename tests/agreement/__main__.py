"""Both engines on many random programs; see docs/engine.md."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from itertools import islice
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from npchip.base.files import write_bytes
from tests.agreement.share import Share, run_share

SHARE = 100
"""Programs that a process runs before it reports."""
EVERY = 120
"""Seconds between two summaries."""


class Summary:
    """The results so far, and their file.

    Args:
        path: the file.
        first: first seed.
        resume: go on with what the file says instead.
        large: whether all arrays are large.
    """

    def __init__(self, path: Path, first: int, *, resume: bool, large: bool) -> None:
        self.path, self.large = path, large
        self.total = Share()
        self.first = self.next = first
        self.seconds = 0.0
        self.memory: list[tuple[int, int]] = []
        if resume:
            told: dict[str, Any] = json.loads(path.read_text("utf-8"))
            self.first, self.next = told["first"], told["next"]
            self.large, self.seconds = told["large"], told["seconds"]
            self.memory = [(at, size) for at, size in told["memory"]]
            self.total.programs, self.total.runs = told["programs"], told["runs"]
            self.total.features.update(told["features"])
            self.total.failures += told["failures"]
        self._begun = time.monotonic() - self.seconds
        self._written = time.monotonic()

    def add(self, share: Share) -> None:
        """Take the next share; they come in the order of their seeds."""
        total = self.total
        self.next += share.programs
        total.programs += share.programs
        total.runs += share.runs
        total.features += share.features
        total.failures += share.failures
        total.memory = max(total.memory, share.memory)
        if time.monotonic() - self._written > EVERY or share.failures:
            self.write()

    def write(self) -> None:
        """Write the file, whole or not at all."""
        now = time.monotonic()
        self._written, self.seconds = now, now - self._begun
        self.memory.append((self.total.programs, self.total.memory))
        told = {
            "first": self.first,
            "next": self.next,
            "large": self.large,
            "programs": self.total.programs,
            "runs": self.total.runs,
            "seconds": round(self.seconds, 1),
            "per_second": round(self.total.programs / max(self.seconds, 0.001), 1),
            "divergences": len(self.total.failures),
            "failures": self.total.failures,
            "features": dict(sorted(self.total.features.items())),
            "memory": self.memory,
        }
        self.path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(self.path, (json.dumps(told, indent=1) + "\n").encode())


def shares(first: int, end: int, jobs: int, *, profile: bool, large: bool) -> Iterator[Share]:
    """Shares in the order of their seeds, from several processes."""
    run = partial(run_share, profile=profile, large=large)
    parts = (range(at, min(at + SHARE, end)) for at in range(first, end, SHARE))
    if jobs == 1:
        yield from map(run, parts)
        return
    with ProcessPoolExecutor(jobs, get_context("spawn")) as pool:
        waiting: list[Future[Share]] = [pool.submit(run, p) for p in islice(parts, 4 * jobs)]
        try:
            while waiting:
                yield waiting.pop(0).result()
                waiting += [pool.submit(run, part) for part in islice(parts, 1)]
        finally:
            pool.shutdown(cancel_futures=True)


@contextmanager
def _shown(total: int, done: int) -> Iterator[Any]:
    columns = (
        TextColumn("{task.completed:,.0f} of {task.total:,.0f} programs"),
        BarColumn(),
        TextColumn("{task.fields[rate]:.0f} per second, {task.fields[bad]} divergences"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), speed_estimate_period=300) as progress:
        task = progress.add_task("", total=total, completed=done, rate=0.0, bad=0)
        begun = time.monotonic()

        def show(summary: Summary) -> None:
            programs = summary.total.programs
            rate = (programs - done) / max(time.monotonic() - begun, 0.001)
            progress.update(task, completed=programs, rate=rate, bad=len(summary.total.failures))

        yield show


@click.command()
@click.option("--programs", default=10_000, help="How many, counted from --seed.")
@click.option("--seed", default=0, help="Seed of the first program; the others follow.")
@click.option("--jobs", default=1, help="Processes.")
@click.option("--most", default=20, help="Divergences after which to stop.")
@click.option("--profile", is_flag=True, help="Compare what a profile counts as well.")
@click.option("--large", is_flag=True, help="Draw large arrays only, of up to 5,000 NPs.")
@click.option("--resume", is_flag=True, help="Go on where the summary ends.")
@click.option(
    "--summary",
    "path",
    default=Path("build/agreement.json"),
    type=click.Path(path_type=Path),
    help="What was covered and found; written every two minutes.",
)
def main(
    programs: int,
    seed: int,
    jobs: int,
    most: int,
    path: Path,
    *,
    profile: bool,
    large: bool,
    resume: bool,
) -> None:
    """Run random programs on both engines and compare all results and states."""
    summary = Summary(path, seed, resume=resume, large=large)
    end = summary.first + programs
    try:
        with _shown(programs, summary.total.programs) as show:
            for share in shares(summary.next, end, jobs, profile=profile, large=summary.large):
                for failure in share.failures:
                    click.echo(_report(failure))
                summary.add(share)
                show(summary)
                if len(summary.total.failures) >= most:
                    break
    finally:
        summary.write()
    total = summary.total
    click.echo(f"{total.programs:,} programs, {len(total.failures)} divergences: {path}")
    sys.exit(1 if total.failures else 0)


def _report(failure: dict[str, Any]) -> str:
    lines = [f"seed {failure['seed']}: {failure['failure'][0]}", *failure["failure"][1:]]
    return "\n".join([*lines, str(failure["case"]), *failure["program"], ""])


if __name__ == "__main__":
    main()
