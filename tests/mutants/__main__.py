"""Plant mutants one at a time in a copy of the project, and say which ones no test notices."""

from __future__ import annotations

import json
import os
import queue
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor, as_completed
from itertools import count
from pathlib import Path
from typing import NamedTuple

import click
from rich.console import Console
from rich.table import Table

from npchip.base.files import write_bytes
from tests.mutants.draw import Mutant, draw
from tests.mutants.touched import CHOOSE, RECORD

ROOT = Path(__file__).parents[2]
ROOMS = ("isa", "program", "assembler", "engines", "run", "frames")
MAP = ROOT / ".pytest_cache" / "touched.json"
MEMORY = 3 << 30
"""Bytes that the tests of a mutant may take: it may have no end."""
SLOWER, LEAST = 4, 40
"""A mutant's tests may take so many times their time, and so many seconds more."""
_LEFT_OUT = (".git", ".venv", ".*_cache", "__pycache__", "dist", "build")


class Test(NamedTuple):
    """A test: its time, whether it passes, and the functions that it calls."""

    seconds: float
    passes: bool
    functions: frozenset[str]


class Verdict(NamedTuple):
    """The fate of a mutant: the test that noticed it, if one did, and after how long."""

    number: int
    mutant: Mutant
    noticed: str
    seconds: float


class Copy:
    """A copy of the project to plant mutants in.

    Args:
        folder: where to; must not exist.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*_LEFT_OUT))
        self._clock = count(int(time.time()) - 1_000_000, 10)

    def write(self, path: str, content: bytes) -> None:
        """Write a file of the package, with a time of its own: bytecode must not outlive it."""
        file = self.folder / "src" / "npchip" / path
        file.write_bytes(content)
        at = next(self._clock)
        os.utime(file, (at, at))

    def pytest(self, arguments: list[str], timeout: float, **settings: str) -> tuple[int, str]:
        """Run tests; return the exit code and the output. A run without end has code -1."""
        path = os.pathsep.join((str(self.folder / "src"), str(self.folder)))
        command = [sys.executable, "-m", "pytest", "-q", "-rfE", "-p", "tests.mutants.touched"]
        process = subprocess.Popen(
            [*command, "-p", "no:cacheprovider", *arguments],
            cwd=self.folder,
            env=os.environ | {"PYTHONPATH": path} | settings,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            start_new_session=True,
            preexec_fn=_limit_memory,  # noqa: PLW1509 - nothing else is done there
        )
        try:
            output, _ = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            output = ""
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            else:
                process.wait()
        return (process.returncode if output else -1), output


def _limit_memory() -> None:
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))


def record(copy: Copy, jobs: int) -> dict[str, Test]:
    """Run the quick profile once and note which functions each test calls."""
    folder = copy.folder / "touched"
    folder.mkdir()
    _, output = copy.pytest(["-n", str(jobs)], 3600, **{RECORD: str(folder)})
    click.echo(f"recorded: {output.strip().splitlines()[-1]}", err=True)
    lines = [line for file in folder.iterdir() for line in file.read_text("utf-8").splitlines()]
    told = [json.loads(line) for line in lines]
    names = sorted({name for _, _, functions in told for name in functions})
    index = {name: number for number, name in enumerate(names)}
    tests = [[test, took, [index[name] for name in found]] for test, took, found in told]
    MAP.parent.mkdir(exist_ok=True)
    write_bytes(MAP, json.dumps({"functions": names, "tests": tests}).encode())
    return load()


def load() -> dict[str, Test]:
    """Read the record."""
    told = json.loads(MAP.read_text("utf-8"))
    names = told["functions"]
    return {
        test: Test(took or 0, took is not None, frozenset(names[number] for number in found))
        for test, took, found in told["tests"]
    }


def waves(mutant: Mutant, tests: dict[str, Test]) -> list[list[str]]:
    """Return the tests in the order in which they run: those most likely to notice first.

    They are the tests of the mutant's room that call the function around it, the others that do,
    and the rest. Outside functions, those that call any function of the file stand for them.
    """
    room = f"tests/{mutant.path.split('/')[0]}/"
    of_file = f"{mutant.path}:"
    function = of_file + mutant.function
    found: list[list[str]] = [[], [], []]
    passing = [item for item in tests.items() if item[1].passes]
    for name, test in sorted(passing, key=lambda item: item[1].seconds):
        if mutant.path.endswith(".yaml"):
            near = name.startswith(room)
        elif mutant.function:
            near = function in test.functions
        else:
            near = any(item.startswith(of_file) for item in test.functions)
        found[0 if near and name.startswith(room) else 1 if near else 2].append(name)
    return found


def judge(mutant: Mutant, copy: Copy, tests: dict[str, Test], most: float) -> str:
    """Return what notices a mutant: a test, the time limit, or nothing after `most` seconds."""
    file = copy.folder / "src" / "npchip" / mutant.path
    before = file.read_bytes()
    copy.write(mutant.path, mutant.applied(before))
    try:
        for number, found in enumerate(waves(mutant, tests)):
            wave = []
            for name in found:
                most -= tests[name].seconds
                wave += [name] if most > 0 else []
            if not wave:
                continue
            chosen = copy.folder / "chosen.json"
            chosen.write_text(json.dumps([wave, list(tests)]), "utf-8")
            files = {name.split("::")[0] for name in wave}
            if number == 0:  # its new tests too
                room = copy.folder / "tests" / mutant.path.split("/")[0]
                files |= {str(p.relative_to(copy.folder)) for p in room.rglob("test_*.py")}
            limit = LEAST + SLOWER * sum(tests[name].seconds for name in wave)
            arguments = ["-x", "-n0", *sorted(files)]
            code, output = copy.pytest(arguments, limit, **{CHOOSE: str(chosen)})
            if code == -1:
                return "takes too long"
            if code not in {0, 5}:  # 5: no tests
                lines = output.splitlines()
                said = [line for line in lines if line.startswith(("FAILED ", "ERROR "))]
                return (said or lines[-1:] or [f"exit code {code}"])[-1]
    finally:
        copy.write(mutant.path, before)
    return ""


@click.command()
@click.option("--count", "number", default=100, show_default=True, help="How many mutants.")
@click.option("--seed", default=1, show_default=True, help="The same seed draws the same mutants.")
@click.option("--room", "rooms", multiple=True, default=ROOMS, help="Draw from this package.")
@click.option("--jobs", default=2, show_default=True, help="How many at a time.")
@click.option("--only", type=int, multiple=True, help="Judge only the mutant of this number.")
@click.option("--start", default=1, help="Judge the mutants from this number on.")
@click.option("--record", "again", is_flag=True, help="Record anew which test calls what.")
@click.option("--seconds", default=3600.0, help="Stop after tests of so many seconds.")
@click.option("--list", "only_list", is_flag=True, help="List the mutants, judge none.")
def main(
    *,
    number: int,
    seed: int,
    rooms: tuple[str, ...],
    jobs: int,
    only: tuple[int, ...],
    start: int,
    seconds: float,
    again: bool,
    only_list: bool,
) -> None:
    """Plant mutants, run the tests that most likely notice each, and list those that survive."""
    drawn = draw(ROOT / "src" / "npchip", rooms, number, seed)
    todo = [item for item in enumerate(drawn, 1) if item[0] >= start]
    todo = [item for item in todo if not only or item[0] in only]
    if only_list:
        for at, mutant in todo:
            click.echo(f"{at:4} {mutant}")
        return
    with tempfile.TemporaryDirectory() as folder:
        copies: queue.Queue[Copy] = queue.Queue()
        for at in range(jobs):
            copies.put(Copy(Path(folder) / str(at)))
        first = copies.queue[0]
        tests = record(first, jobs) if again or not MAP.is_file() else load()

        def verdict(job: tuple[int, Mutant]) -> Verdict:
            copy = copies.get()
            begun = time.monotonic()
            try:
                noticed = judge(job[1], copy, tests, seconds)
            finally:
                copies.put(copy)
            return Verdict(*job, noticed, time.monotonic() - begun)

        verdicts = []
        with ThreadPoolExecutor(jobs) as pool:
            for done in as_completed([pool.submit(verdict, job) for job in todo]):
                found = done.result()
                verdicts.append(found)
                word = f"noticed by {found.noticed}" if found.noticed else "SURVIVES"
                click.echo(f"{found.number:4} {found.seconds:5.1f} s  {found.mutant}  {word[:150]}")
    report(verdicts)


def report(verdicts: list[Verdict]) -> None:
    """Print a table of the survivors, and how many were noticed in each package."""
    survivors = sorted(item for item in verdicts if not item.noticed)
    table = Table("number", "place", "was", "becomes", title="Survivors")
    for item in survivors:
        mutant = item.mutant
        place = f"{mutant.path}:{mutant.line}"
        table.add_row(str(item.number), place, mutant.was[:200], mutant.becomes[:200])
    Console(width=160).print(table, markup=False)
    drawn = Counter(item.mutant.path.split("/")[0] for item in verdicts)
    lost = Counter(item.mutant.path.split("/")[0] for item in survivors)
    for room in sorted(drawn):
        click.echo(f"{room:12} {drawn[room] - lost[room]} of {drawn[room]} noticed")
    click.echo(f"{'all':12} {len(verdicts) - len(survivors)} of {len(verdicts)} noticed")


if __name__ == "__main__":
    main()
