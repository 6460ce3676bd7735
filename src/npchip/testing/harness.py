"""Finds programs with tests, runs them and updates their golden files."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from natsort import natsorted, ns

from npchip import bundle
from npchip.assembler.sources import read_source
from npchip.base.errors import InputError, NpchipError
from npchip.base.files import locked
from npchip.testing.cases import Case, cases_of, checked_suite
from npchip.testing.golden import Entry, golden_path, load, save
from npchip.testing.runner import Outcome, Settings, mistakes, run_case

Golden = dict[str, Entry]
"""The recorded runs of a source, by name."""

SUFFIX = ".s"
_INCLUDE = re.compile(r'^[^;"\n]*\.include\s+"([^"\n\0]+)"', re.MULTILINE | re.IGNORECASE)


@dataclass
class Report:
    """The results of one program.

    Attributes:
        program: the source that was tested.
        outcomes: the outcomes of its runs, in order.
        problems: faults of the whole file: unreadable test lines, a stale golden.
        broken: these faults prevented the tests.
        unrun: the reason why a submission is no program to run; empty if it is one.
        untested: the source has no test lines and need not have any.
        skipped: number of runs that were not selected.
        updated: names of the runs whose golden was recorded or removed.
    """

    program: Path
    outcomes: list[Outcome] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    broken: bool = False
    unrun: str = ""
    untested: bool = False
    skipped: int = 0
    updated: list[str] = field(default_factory=list)

    def count(self, state: str) -> int:
        """Return the number of runs in a state; faults of the whole file count as one run."""
        own = ("error" if self.broken else "failed") if self.problems else None
        return sum(outcome.state == state for outcome in self.outcomes) + (own == state)


@dataclass(frozen=True)
class Selection:
    """The runs to execute.

    Attributes:
        pattern: part of ``file::run``, in either case; empty for all.
        stop: end after the first run that fails.
        on_case: called before each run.
    """

    pattern: str = ""
    stop: bool = False
    on_case: Callable[[Case], None] = lambda _case: None

    def wants(self, case: Case) -> bool:
        """Return whether the pattern occurs in the name of the case."""
        return self.pattern.lower() in f"{case.program}::{case.name}".lower()


# ---- finding


def find_sources(paths: Iterable[Path]) -> list[tuple[Path, bool]]:
    """Return the sources to test, each with True if it must have tests.

    Files must have tests, and so must ``test_*.s`` in folders. Folders are searched with all
    below them but hidden ones.

    Raises:
        InputError: NP275, there is no such file, or no source in a folder.
    """
    found: dict[Path, bool] = {}
    for given in paths:
        path = bundle.find("program", given)
        if path.is_dir():
            sources = _sources(path)
            if not sources:
                raise InputError("NP275", f"{path}: no {SUFFIX} files in this folder")
            for source in sources:
                must = source.name.startswith("test_")
                found[source] = found.get(source, False) or must
        elif path.exists():
            found[path] = True
        else:
            hint = bundle.hint("program", given)
            raise InputError("NP275", f"{path}: no such file or folder", hint=hint)
    return list(found.items())


def included_files(sources: Iterable[Path]) -> set[Path]:
    """Return the files that sources include from their own folder, as resolved paths."""
    found: set[Path] = set()
    for source in sources:
        with suppress(InputError, OSError, RuntimeError):  # its test reports that
            names = _INCLUDE.findall(read_source(source))
            found |= {(source.parent / name).resolve() for name in names}
    return found


def _sources(folder: Path) -> list[Path]:
    files = [
        path
        for path in folder.rglob(f"*{SUFFIX}")
        if path.is_file()
        and not any(part.startswith(".") for part in path.relative_to(folder).parts)
    ]
    return natsorted(sorted(files), alg=ns.PATH)


# ---- testing


def test_source(source: Path, settings: Settings, selection: Selection, *, must: bool) -> Report:
    """Run the tests of a source. With `must`, a source without tests is a fault."""
    report = Report(source)
    try:
        suite = checked_suite(source)
        cases = cases_of(suite)
    except NpchipError as error:
        return broken(report, error)
    if not cases and not os.path.exists(golden_path(source)):  # noqa: PTH110 - false if too long
        report.untested = not must
        if must:
            report.problems.append(nothing_to_check(source))
        return report
    try:
        anew = settings.update and not selection.pattern
        golden = read_golden(source, fresh=anew)
    except InputError as error:
        return broken(report, error)
    run_cases(report, cases, golden, settings, selection)
    complete = len(report.outcomes) + report.skipped == len(cases)
    if settings.update:
        report.updated = update_golden(source, cases, report.outcomes, anew=anew)
    elif complete and not selection.pattern:
        report.problems += stale(source, cases, golden)
    return report


test_source.__test__ = False  # type: ignore[attr-defined]


def nothing_to_check(source: Path) -> str:
    """Return the message on a source that must have tests and has none."""
    return f"{source}: nothing to check: it has no '; expect:' line [NP275]"


def run_cases(
    report: Report, cases: list[Case], golden: Golden, settings: Settings, selection: Selection
) -> None:
    """Run the selected cases and add their outcomes to a report."""
    for case in cases:
        if not selection.wants(case):
            report.skipped += 1
            continue
        selection.on_case(case)
        outcome = run_case(case, golden, settings)
        report.outcomes.append(outcome)
        if selection.stop and outcome.state != "passed":
            break


def broken(report: Report, error: NpchipError) -> Report:
    """Return a report on a file that cannot be tested."""
    report.problems = mistakes(error)
    report.broken = True
    return report


# ---- goldens


def refuse_update_in_ci() -> None:
    """Refuse to record goldens in continuous integration, where nobody looks at the changes.

    Raises:
        InputError: NP277, the environment variable CI is set.
    """
    if os.environ.get("CI"):
        raise InputError(
            "NP277",
            "goldens are not updated where the environment variable CI is set",
            hint="update them at your desk, look at the change, and commit it",
        )


def update_golden(
    source: Path, cases: list[Case], outcomes: list[Outcome], *, anew: bool = False
) -> list[str]:
    """Record the outcomes that differ from the golden, and remove runs that no longer exist.

    The golden is read again, as another process may have recorded other runs meanwhile.

    Args:
        source: the source of the golden.
        cases: all cases of the source.
        outcomes: outcomes of the cases that were run.
        anew: whether a damaged golden counts as empty.

    Returns:
        names of the runs that were changed or removed. Without any, nothing is written.

    Raises:
        InputError: NP250, the file cannot be written; NP276, it is damaged.
    """
    fresh = {outcome.case.name: outcome.entry for outcome in outcomes}
    path = golden_path(source)
    with locked(path.parent):
        golden = read_golden(source, fresh=anew)
        known = {name: fresh.get(name) or golden.get(name) for name in _recorded(cases)}
        entries = {name: entry for name, entry in known.items() if entry is not None}
        changed = [name for name, entry in entries.items() if golden.get(name) != entry]
        changed += [f"{name} removed" for name in golden if name not in entries]
        if changed and entries:
            save(path, source.name, entries)
        elif changed:
            path.unlink(missing_ok=True)
    return changed


def stale(source: Path, cases: list[Case], golden: Golden) -> list[str]:
    """Return messages on recorded runs that no longer exist or no longer expect a golden."""
    path, wanted = golden_path(source), _recorded(cases)
    return [
        f"{path}: '{name}' is recorded, but no run of that name expects it (--update removes it)"
        for name in golden
        if name not in wanted
    ]


def _recorded(cases: list[Case]) -> list[str]:
    return [case.name for case in cases if case.wants_golden]


def read_golden(source: Path, *, fresh: bool = False) -> Golden:
    """Read the golden of a source. With `fresh`, a damaged one counts as empty.

    Raises:
        InputError: NP276, it is damaged.
    """
    try:
        return load(golden_path(source))
    except InputError:
        if fresh:
            return {}
        raise
