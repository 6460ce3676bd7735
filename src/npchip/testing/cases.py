"""Test cases: each run of a source on each of its machines."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from npchip.assembler import AssemblyError, Diagnostic
from npchip.testing.suite import Run, Suite, read_suite

MACHINE_FILES: Final = (".yaml", ".yml")
"""Suffixes that tell a machine file from the name of a machine."""


def checked_suite(source: Path) -> Suite:
    """Read the test lines of a source.

    Raises:
        NpchipError: as `read_suite`; NP275, a run without expectations.
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


@dataclass(frozen=True)
class Case:
    """One run on one machine, which passes or fails.

    Attributes:
        suite: the source with the test lines.
        run: one of its runs.
        machine: one of the machines of the run, as written.
        program: the source to assemble: the suite's or a submission.
    """

    suite: Suite
    run: Run
    machine: str
    program: Path

    @property
    def name(self) -> str:
        """Name within the suite: the run's, with the machine's unless it is the default."""
        if self.machine == "default":
            return self.run.name
        file = self.machine.endswith(MACHINE_FILES)
        return f"{self.run.name}@{Path(self.machine).stem if file else self.machine}"

    @property
    def submitted(self) -> bool:
        """True for a submission, whose cycles need not equal the golden."""
        return self.program != self.suite.path

    @property
    def pins_cycles(self) -> bool:
        """True if words, instructions and cycles must equal the golden."""
        return self.run.golden_cycles and not self.submitted

    @property
    def wants_golden(self) -> bool:
        """True if an expectation of the run needs the golden."""
        return self.run.golden_outputs or self.run.golden_cycles


def cases_of(suite: Suite, program: Path | None = None) -> list[Case]:
    """Return a case for every run and machine.

    Raises:
        AssemblyError: NP272, two machine files of one run have the same name.
    """
    cases = [
        Case(suite, run, machine, program or suite.path)
        for run in suite.runs
        for machine in run.machines
    ]
    known: dict[str, Case] = {}
    for case in cases:
        if known.setdefault(case.name, case) is not case:
            message = f"two runs are called '{case.name}'"
            raise AssemblyError([Diagnostic("error", "NP272", message, case.run.span)])
    return cases
