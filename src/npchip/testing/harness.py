"""Finds programs with tests, runs them, and keeps their golden files."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from natsort import natsorted, ns

from npchip.assembler import AssemblyError, Diagnostic
from npchip.assembler.sources import read_source
from npchip.base.errors import InputError, NpchipError
from npchip.testing.golden import Entry, golden_path, load, save
from npchip.testing.runner import Case, Outcome, Settings, cases_of, mistakes, run_case
from npchip.testing.suite import Suite, read_suite

SUFFIX = ".s"
_INCLUDE = re.compile(r'^[^;"\n]*\.include\s+"([^"\n\0]+)"', re.MULTILINE | re.IGNORECASE)


@dataclass
class Report:
    """The results of one program.

    Attributes:
        program: the source that was tested.
        outcomes: of its runs, in order.
        problems: faults of the file as a whole: test lines that cannot be read, a stale golden.
        broken: whether these kept it from being tested.
        untested: it has no test lines, and nobody asked for it by name.
        skipped: number of runs that were not selected.
        updated: names of the runs of which a golden was recorded or removed.
    """

    program: Path
    outcomes: list[Outcome] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    broken: bool = False
    untested: bool = False
    skipped: int = 0
    updated: list[str] = field(default_factory=list)

    def count(self, state: str) -> int:
        """Number of runs that ended so; the file as a whole counts as one where it is at fault."""
        own = ("error" if self.broken else "failed") if self.problems else None
        return sum(outcome.state == state for outcome in self.outcomes) + (own == state)


@dataclass(frozen=True)
class Selection:
    """The runs that are wanted, and what to call while they run.

    Attributes:
        pattern: part of ``file::run``, without regard to case; empty for all.
        stop: end after the first run that fails.
        on_case: called before each run.
    """

    pattern: str = ""
    stop: bool = False
    on_case: Callable[[Case], None] = lambda _case: None

    def wants(self, case: Case) -> bool:
        """Return whether the pattern stands in the name of the case."""
        return self.pattern.lower() in f"{case.program}::{case.name}".lower()


# ---- finding


def find_sources(paths: Iterable[Path]) -> list[tuple[Path, bool]]:
    """Sources to look at, each with whether it must have tests.

    A file must, and so must ``test_*.s`` in a folder; folders are searched with all below them,
    hidden ones left out.

    Raises:
        InputError: NP275, there is no such file, or no source in a folder.
    """
    found: dict[Path, bool] = {}
    for path in paths:
        if path.is_dir():
            sources = list(_sources(path))
            if not sources:
                raise InputError("NP275", f"{path}: no {SUFFIX} files in this folder")
            for source in sources:
                must = source.name.startswith("test_")
                found[source] = found.get(source, False) or must
        elif path.exists():
            found[path] = True
        else:
            raise InputError("NP275", f"{path}: no such file or folder")
    return list(found.items())


def included_files(sources: Iterable[Path]) -> set[Path]:
    """Files that some of the sources include: parts of programs, where they have no tests.

    Returns:
        resolved paths; of includes that name a file from their own folder.
    """
    found: set[Path] = set()
    for source in sources:
        try:
            text = read_source(source)
        except InputError:
            continue  # is told where it is tested
        found |= {(source.parent / name).resolve() for name in _INCLUDE.findall(text)}
    return found


def find_submissions(paths: Iterable[Path]) -> list[Path]:
    """Programs to be judged by another's tests; of a folder all sources.

    Raises:
        InputError: as `find_sources`.
    """
    return [path for path, _ in find_sources(paths)]


def _sources(folder: Path) -> Iterator[Path]:
    files = [
        path
        for path in folder.rglob(f"*{SUFFIX}")
        if path.is_file()
        and not any(part.startswith(".") for part in path.relative_to(folder).parts)
    ]
    yield from natsorted(sorted(files), alg=ns.PATH)


# ---- testing


def test_source(source: Path, settings: Settings, selection: Selection, *, must: bool) -> Report:
    """Run the tests of a source; `must`: it is at fault if it has none."""
    report = Report(source)
    try:
        suite = checked_suite(source)
        cases = cases_of(suite)
    except NpchipError as error:
        return _broken(report, error)
    path = golden_path(source)
    if not cases and not path.exists():
        report.untested = not must
        if must:
            report.problems.append(nothing_to_check(source))
        return report
    try:
        golden = read_golden(path, fresh=settings.update and not selection.pattern)
    except InputError as error:
        return _broken(report, error)
    _run(report, cases, golden, settings, selection)
    complete = len(report.outcomes) + report.skipped == len(cases)
    if settings.update:
        report.updated = update_golden(source, cases, golden, report.outcomes)
    elif complete and not selection.pattern:
        report.problems += stale(source, cases, golden)
    return report


def test_submission(
    suite: Suite, program: Path, settings: Settings, selection: Selection
) -> Report:
    """Run the tests of a suite on another program."""
    report = Report(program)
    try:
        golden = load(golden_path(suite.path))
    except InputError as error:
        return _broken(report, error)
    _run(report, cases_of(suite, program), golden, settings, selection)
    return report


test_source.__test__ = False  # type: ignore[attr-defined]
test_submission.__test__ = False  # type: ignore[attr-defined]


def checked_suite(source: Path) -> Suite:
    """Read the test lines of a source.

    Raises:
        NpchipError: as `read_suite`; NP275, a run of it expects nothing.
    """
    suite = read_suite(source)
    idle = [run for run in suite.runs if not run.claims]
    if idle:
        raise AssemblyError(
            Diagnostic(
                "error",
                "NP275",
                f"run '{run.name}' expects nothing",
                run.span,
                suggestion="say what must come out below it, such as: ; expect: golden",
            )
            for run in idle
        )
    return suite


def nothing_to_check(source: Path) -> str:
    """Return the message about a source that should have tests and has none."""
    return f"{source}: nothing to check: it has no '; expect:' line [NP275]"


def _run(
    report: Report,
    cases: list[Case],
    golden: dict[str, Entry],
    settings: Settings,
    selection: Selection,
) -> None:
    for case in cases:
        if not selection.wants(case):
            report.skipped += 1
            continue
        selection.on_case(case)
        outcome = run_case(case, golden, settings)
        report.outcomes.append(outcome)
        if selection.stop and outcome.state != "passed":
            break


def _broken(report: Report, error: NpchipError) -> Report:
    report.problems = mistakes(error)
    report.broken = True
    return report


# ---- goldens


def refuse_update_in_ci() -> None:
    """Goldens are recorded by people who look at what has changed.

    Raises:
        InputError: NP277, the environment says that this is continuous integration.
    """
    if os.environ.get("CI"):
        raise InputError(
            "NP277",
            "goldens are not updated where the environment variable CI is set",
            hint="update them at your desk, look at the change, and commit it",
        )


def update_golden(
    source: Path, cases: list[Case], golden: dict[str, Entry], outcomes: list[Outcome]
) -> list[str]:
    """Record what came out, where it differs from `golden`; remove runs that are gone.

    Args:
        source: the source beside which the golden lies.
        cases: all cases of the source.
        golden: what is recorded.
        outcomes: of those cases that were run.

    Returns:
        Names of the runs that were changed or removed; nothing is written where there are none.

    Raises:
        InputError: NP250, the file cannot be written.
    """
    fresh = {outcome.case.name: outcome.entry for outcome in outcomes}
    path = golden_path(source)
    entries: dict[str, Entry] = {}
    for name in _recorded(cases):
        entry = fresh.get(name) or golden.get(name)
        if entry is not None:
            entries[name] = entry
    changed = [name for name, entry in entries.items() if golden.get(name) != entry]
    changed += [f"{name} removed" for name in golden if name not in entries]
    if changed and entries:
        save(path, source.name, entries)
    elif changed:
        path.unlink(missing_ok=True)
    return changed


def stale(source: Path, cases: list[Case], golden: dict[str, Entry]) -> list[str]:
    """Return messages about recorded runs that are gone, or ask for no golden any more."""
    names = [name for name in golden if name not in _recorded(cases)]
    path = golden_path(source)
    return [
        f"{path}: '{name}' is recorded, but no run of that name expects it (--update removes it)"
        for name in names
    ]


def _recorded(cases: list[Case]) -> list[str]:
    return [case.name for case in cases if case.wants_golden]


def read_golden(path: Path, *, fresh: bool) -> dict[str, Entry]:
    """Read a golden; a damaged one is as good as none where it is written anew (`fresh`).

    Raises:
        InputError: NP276, it is damaged.
    """
    try:
        return load(path)
    except InputError:
        if fresh:
            return {}
        raise
