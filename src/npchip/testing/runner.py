"""Runs a test case and checks its results."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any, Literal

import numpy as np

from npchip import Chip, bundle, load_machine
from npchip.assembler import AssemblyError, Diagnostic
from npchip.assembler.diagnostics import SourceError, Span, did_you_mean
from npchip.base.errors import InputError, NpchipError
from npchip.engines.base import Partner
from npchip.formats import load_program
from npchip.frames import FrameSource, open_frames
from npchip.frames.memory import read_memory
from npchip.isa import Isa, load_isa
from npchip.machine import Machine
from npchip.program.model import Program
from npchip.run.partner import sent_by
from npchip.run.result import RunResult, over_budget
from npchip.run.stuck import stuck
from npchip.testing.claims import Claim, GoldenClaim
from npchip.testing.compare import Difference, compare
from npchip.testing.evaluate import check_claim, fault, misfit
from npchip.testing.golden import Entry, record
from npchip.testing.suite import Run, Suite

_SUFFIXES = (".yaml", ".yml")
_UNFIT = {"NP026", "NP113", "NP279"}
"""Codes of errors that a program which does what the exercise asks does not have."""
_UPDATE = "npchip test --update records it"


@dataclass(frozen=True)
class Settings:
    """Settings that all runs share.

    Attributes:
        engine: the engine, as for `npchip.Chip`.
        isa: instruction set of the programs; None for the built-in one.
        include_paths: folders to include from, besides the program's own.
        update: record goldens instead of comparing with them.
    """

    engine: Any = "auto"
    isa: Isa | None = None
    include_paths: tuple[Path, ...] = ()
    update: bool = False


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
        file = self.machine.endswith(_SUFFIXES)
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


@dataclass
class Outcome:
    """The result of a case.

    Attributes:
        case: the case.
        state: ``error`` if the case could not be run.
        lines: messages on the faults, some of several lines.
        differences: the differences from the golden.
        entry: the record for a golden; None if the run did not end well.
        seconds: duration.
        held: lines of the suite whose expectations hold.
        words: length of the program; None if it was not run.
        cycles: its worst frame, or its setup where it takes no frame.
    """

    case: Case
    state: Literal["passed", "failed", "error"] = "passed"
    lines: list[str] = field(default_factory=list)
    differences: list[Difference] = field(default_factory=list)
    entry: Entry | None = None
    seconds: float = 0.0
    held: set[int] = field(default_factory=set)
    words: int | None = None
    cycles: int | None = None


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


def run_case(case: Case, golden: dict[str, Entry], settings: Settings) -> Outcome:
    """Run a case and check its results.

    Args:
        case: the case to run.
        golden: the recorded runs of the suite, by name.
        settings: with `update`, the golden is not compared; the caller records `Outcome.entry`.
    """
    outcome = Outcome(case)
    started = time.perf_counter()
    try:
        chip, result = execute(case, settings)
        _check(outcome, chip, result, None if settings.update else golden)
    except NpchipError as error:
        outcome.state = "failed" if case.submitted and error.code in _UNFIT else "error"
        outcome.lines = mistakes(error)
        outcome.entry = None
        outcome.held.clear()
    outcome.seconds = time.perf_counter() - started
    return outcome


def mistakes(error: NpchipError) -> list[str]:
    """Return the message of each mistake of a file, with its excerpt."""
    if isinstance(error, AssemblyError):
        return [str(diagnostic) for diagnostic in error.diagnostics]
    return [str(error)]


# ---- running


def execute(case: Case, settings: Settings) -> tuple[Chip, RunResult]:
    """Run a case without checking its results.

    Raises:
        NpchipError: a file of the run cannot be used, or the program has mistakes or does not fit
            the run.
    """
    run, folder, isa = case.run, case.suite.path.parent, settings.isa or load_isa()
    with _at(run.span):
        file = case.machine.endswith(_SUFFIXES)
        machine = load_machine(folder / case.machine if file else case.machine, isa.timing_classes)
    program = _load(case, machine, isa, settings)
    _check_claims(case, program)
    with _at(run.span):
        chip = Chip(program, machine, settings.engine, isa)
        for address, name in run.memory:
            chip.load_memory(address, read_memory(address, folder / name, machine))
        chip.connect(_partner(run, folder, machine, settings))
        frames = _frames(run, folder, machine)
        result = chip.run(frames, max_cycles=run.max_cycles)
        if frames is None and result.status == "frames-exhausted":
            raise InputError(
                "NP279",
                f"{program.name} takes frames, but this run has none",
                hint=f"; run: {run.name} frames=clip.npy, or levels=0,128,255",
            )
    return chip, result


def _load(case: Case, machine: Machine, isa: Isa, settings: Settings) -> Program:
    try:
        return load_program(
            case.program, machine, case.run.defines, isa, include_paths=settings.include_paths
        )
    except InputError as error:
        if case.submitted or error.code not in {"NP026", "NP113"}:
            raise  # not the run's mistake
        raise _located(error, case.run.span) from None


def _partner(run: Run, folder: Path, machine: Machine, settings: Settings) -> Partner | None:
    if run.partner is None or run.partner_frames is None:
        return None
    program = load_program(
        bundle.find("program", run.partner, folder),
        machine,
        None,
        settings.isa,
        include_paths=settings.include_paths,
    )
    file = bundle.find("clip", run.partner_frames, folder)
    clip = open_frames(file, machine.rows, machine.cols)
    other = Chip(program, machine, settings.engine, settings.isa)
    return sent_by(program, other.run(clip, max_cycles=run.max_cycles), machine.geometry)


def _check_claims(case: Case, program: Program) -> None:
    mistakes = []
    for claim in case.run.claims:
        if isinstance(claim, Claim):
            try:
                if case.submitted:  # what it lacks itself only fails the claim
                    misfit(claim, program)
                else:
                    check_claim(claim, program)
            except SourceError as error:
                mistakes.append(error.diagnostic)
    if mistakes:
        raise AssemblyError(mistakes)


def _frames(run: Run, folder: Path, machine: Machine) -> FrameSource | Any:
    if run.levels is not None:
        levels = run.levels[: run.first]
        shape = (len(levels), machine.rows, machine.cols)
        return np.broadcast_to(np.array(levels, np.uint8)[:, None, None], shape)
    if run.frames is None:
        return None
    fit: Any = run.fit
    file = bundle.find("clip", run.frames, folder)
    source = open_frames(file, machine.rows, machine.cols, fit)
    return source if run.first is None else np.stack(list(islice(source, run.first)))


@contextmanager
def _at(span: Span) -> Iterator[None]:
    """Give errors of the input the place of the run."""
    try:
        yield
    except InputError as error:
        raise _located(error, span) from None


def _located(error: InputError, span: Span) -> AssemblyError:
    return AssemblyError(
        [Diagnostic("error", error.code, error.message, span, suggestion=error.hint)]
    )


# ---- checking the results


def _check(
    outcome: Outcome, chip: Chip, result: RunResult, golden: dict[str, Entry] | None
) -> None:
    run, machine, program = outcome.case.run, chip.machine, chip.program
    outcome.words = len(program.words)
    worst = result.frame_cycles.max() if result.frames else result.setup.cycles
    outcome.cycles = int(worst)
    ending = _bad_ending(run, result, chip)
    if ending:
        outcome.lines.append(ending)
    else:
        for claim in run.claims:
            if isinstance(claim, Claim):
                said = _said(outcome.case, claim, result, program)
                if said is None:
                    outcome.held.add(claim.span.line.number)
                else:
                    outcome.lines.append(f"{_place(claim)}: expected {claim.text}; {said}")
        over = over_budget(result, program) if machine.is_default else None
        if over:
            outcome.lines.append(str(over))
        outcome.entry = record(
            result, len(program.words), outputs=run.golden_outputs, cycles=outcome.case.pins_cycles
        )
        if golden is not None:
            _compare(outcome, golden)
    if outcome.lines or outcome.differences:
        outcome.state = "failed"


def _said(case: Case, claim: Claim, result: RunResult, program: Program) -> str | None:
    """Return what is wrong, as text, if a claim does not hold."""
    if case.submitted:
        said = misfit(claim, program, case.suite.kinds.get(claim.name))
        if said is not None:
            return said
    return fault(claim, result, program)


def _bad_ending(run: Run, result: RunResult, chip: Chip) -> str | None:
    """Return a message if a run did not end well, unless an expectation is about that."""
    expected = any(
        isinstance(claim, Claim) and claim.name in {"status", "error"} for claim in run.claims
    )
    if expected or result.status in {"halted", "frames-exhausted"}:
        return None
    if result.error:
        return str(result.error)
    where = f"frame {result.frames - 1}" if result.frames else "the setup"
    at = stuck(chip)
    return (
        f"{at.place}{where} reached the limit of {run.max_cycles:,} cycles [NP321], {at.loops}: "
        "is it endless? (max-cycles=N raises the limit)"
    )


def _compare(outcome: Outcome, golden: dict[str, Entry]) -> None:
    case = outcome.case
    parts = [claim for claim in case.run.claims if isinstance(claim, GoldenClaim)]
    if not parts:
        return
    place = f"{_place(parts[0])}: expected {parts[0].text}"
    expected, found = golden.get(case.name), outcome.entry
    assert found is not None
    lack = None
    before = len(outcome.lines)
    if expected is None:
        lack = "nothing"
    elif case.pins_cycles and expected.words is None:
        lack = "no cycles"
    elif case.run.golden_outputs and found.names and not expected.names:
        lack = "no outputs"
    if lack:
        hint = did_you_mean(case.name, golden) if expected is None else None
        verb = "are" if lack.endswith("s") else "is"
        outcome.lines.append(f"{place}; {lack} {verb} recorded ({hint or _UPDATE})")
    elif expected is not None:
        outcome.differences = compare(expected, found, extra=not case.submitted)
    if not outcome.differences and len(outcome.lines) == before:
        outcome.held |= {claim.span.line.number for claim in parts}


def _place(claim: Claim | GoldenClaim) -> str:
    return f"{claim.span.line.file}:{claim.span.line.number}"
