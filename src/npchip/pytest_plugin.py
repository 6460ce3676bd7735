"""pytest plugin for programs: each run of a ``test_*.s`` file is a test item."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from npchip.testing.cases import Case
    from npchip.testing.harness import Golden
    from npchip.testing.runner import Outcome

_TEST_LINE = re.compile(rb";\s*(?:run|expect)\s*:")
_MAX_BYTES = 1 << 18

# npchip is imported only when there is a program, to keep pytest's start fast elsewhere.


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add ``--npchip-update``, ``--npchip-engine`` and the setting ``npchip_files``."""
    group = parser.getgroup("npchip", "programs for the vision chip")
    group.addoption(
        "--npchip-update",
        action="store_true",
        help="record the goldens of .s files that differ; refused where CI is set",
    )
    group.addoption("--npchip-engine", default="auto", help="what executes the programs")
    parser.addini(
        "npchip_files", "names of programs that are tests", type="args", default=["test_*.s"]
    )


def pytest_configure(config: pytest.Config) -> None:
    """Refuse ``--npchip-update`` in CI and in several processes."""
    if not config.getoption("npchip_update"):
        return
    from npchip.base.errors import InputError
    from npchip.testing.harness import refuse_update_in_ci

    try:
        refuse_update_in_ci()
    except InputError as error:
        raise pytest.UsageError(f"--npchip-update: {error.message} [{error.code}]") from None
    if config.getoption("numprocesses", None):
        raise pytest.UsageError("--npchip-update works in one process: add -n 0")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> ProgramFile | None:
    """Collect ``test_*.s`` with test lines, and any source that is named on the command line."""
    if file_path.suffix != ".s":
        return None
    wanted = any(fnmatch(file_path.name, name) for name in parent.config.getini("npchip_files"))
    if parent.session.isinitpath(file_path) or (wanted and _has_test_lines(file_path)):
        file: ProgramFile = ProgramFile.from_parent(parent, path=file_path)
        return file
    return None


def _has_test_lines(path: Path) -> bool:
    """Tell a program for the chip from a source for another assembler."""
    try:
        with path.open("rb") as file:
            return _TEST_LINE.search(file.read(_MAX_BYTES)) is not None
    except OSError:
        return False


class ProgramFile(pytest.File):
    """A source file with an item for each of its runs."""

    def collect(self) -> Iterator[pytest.Item]:
        """Read the test lines and yield an item for each run.

        Raises:
            CollectError: the source has errors or no test lines, or its golden is stale.
        """
        from npchip.base.errors import NpchipError
        from npchip.testing.cases import cases_of, checked_suite
        from npchip.testing.harness import nothing_to_check, read_golden, stale

        path = _shortest(self.path)
        try:
            cases = cases_of(checked_suite(path))
            if not cases:
                raise self.CollectError(nothing_to_check(path))
            update = self.config.getoption("npchip_update")
            self.golden = read_golden(path, fresh=update)
            old = [] if update else stale(path, cases, self.golden)
            if old:
                raise self.CollectError("\n".join(old))
        except NpchipError as error:
            raise self.CollectError(str(error)) from None
        self.cases = cases
        for case in cases:
            item: ProgramItem = ProgramItem.from_parent(self, name=case.name, case=case)
            yield item


class ProgramItem(pytest.Item):
    """One run of a program on one machine."""

    parent: ProgramFile

    def __init__(self, *, case: Case, **other: Any) -> None:
        super().__init__(**other)
        self.case = case

    def runtest(self) -> None:
        """Run the program and compare its results, or update its golden."""
        from npchip.testing.harness import read_golden, update_golden
        from npchip.testing.runner import Settings, run_case

        golden: Golden = self.parent.golden
        update = self.config.getoption("npchip_update")
        settings = Settings(engine=self.config.getoption("npchip_engine"), update=update)
        outcome = run_case(self.case, golden, settings)
        if update:
            path = self.case.program
            changed = update_golden(path, self.parent.cases, [outcome], anew=True)
            if changed:
                self.parent.golden = read_golden(path, fresh=True)
                self.add_report_section("call", "npchip", f"golden updated: {', '.join(changed)}")
        if outcome.state != "passed":
            raise ProgramFailure(outcome)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the difference from the expected results, without a traceback."""
        from npchip.testing.report import outcome_text

        if isinstance(excinfo.value, ProgramFailure):
            return outcome_text(excinfo.value.outcome)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return the path, the line of the run, and the name."""
        return self.path, self.case.run.span.line.number - 1, self.name


class ProgramFailure(Exception):  # noqa: N818 - of a program, not of npchip
    """A run whose results differ from the expected ones."""

    def __init__(self, outcome: Outcome) -> None:
        super().__init__(outcome.case.name)
        self.outcome = outcome


def _shortest(path: Path) -> Path:
    """Return a path relative to the current directory, if it lies below."""
    here = Path.cwd()
    return path.relative_to(here) if path.is_relative_to(here) else path
