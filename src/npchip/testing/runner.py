"""Runs a test case and checks its results."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, Literal

import numpy as np

from npchip import Chip, bundle, load_machine
from npchip.assembler import AssemblyError, Diagnostic
from npchip.assembler.diagnostics import SourceError, Span
from npchip.base.errors import InputError, NpchipError
from npchip.engines.base import Partner
from npchip.formats import load_program
from npchip.frames import FrameSource, open_frames
from npchip.frames.memory import read_memory
from npchip.isa import Isa, load_isa
from npchip.machine import Machine
from npchip.program.model import Program
from npchip.run.partner import sent_by
from npchip.run.result import RunResult
from npchip.run.stuck import stuck
from npchip.testing.cases import MACHINE_FILES, Case
from npchip.testing.claims import Claim
from npchip.testing.compare import Difference, frame_name
from npchip.testing.evaluate import PER_FRAME, check_claim, misfit
from npchip.testing.golden import Entry
from npchip.testing.judge import Finished, judge
from npchip.testing.suite import Run

_UNFIT = {"NP026", "NP113", "NP279"}
"""Codes of errors that a program which does what the exercise asks does not have."""


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
        advice: text of the first known mistake that the run shows; empty if it shows none.
        over: whether it takes more cycles or instructions than it may.
        stopped: where a run that did not end well has stopped: ``frame 3``, ``the setup``.
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
    advice: str = ""
    over: bool = False
    stopped: str = ""


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
        outcome.advice = _advice(case, error)
        outcome.entry = None
        outcome.held.clear()
    outcome.seconds = time.perf_counter() - started
    return outcome


def mistakes(error: NpchipError) -> list[str]:
    """Return the message of each mistake of a file, with its excerpt."""
    if isinstance(error, AssemblyError):
        return [str(diagnostic) for diagnostic in error.diagnostics]
    return [str(error)]


def _advice(case: Case, error: NpchipError) -> str:
    """Return the text of the first known mistake that an error which prevents the run shows."""
    found = error.diagnostics if isinstance(error, AssemblyError) else [error]
    codes = {each.code for each in found}
    shown = (
        each.text
        for each in case.run.mistakes
        if each.claim.name == "error" and each.claim.op == "==" and each.claim.values[0] in codes
    )
    return next(shown, "")


# ---- running


def execute(case: Case, settings: Settings) -> tuple[Chip, RunResult]:
    """Run a case without checking its results.

    Raises:
        NpchipError: a file of the run cannot be used, or the program has mistakes or does not fit
            the run.
    """
    run, folder, isa = case.run, case.suite.path.parent, settings.isa or load_isa()
    with _at(run.span):
        file = case.machine.endswith(MACHINE_FILES)
        machine = load_machine(folder / case.machine if file else case.machine, isa.timing_classes)
    program = _load(case, machine, isa, settings)
    _check_claims(case, program)
    with _at(run.span):
        memory = [(at, read_memory(at, folder / name, machine)) for at, name in run.memory]
        chip = Chip(program, machine, settings.engine, isa, memory=memory)
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
    for claim in (*case.run.claims, *(mistake.claim for mistake in case.run.mistakes)):
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
    outcome.words = len(chip.program.words)
    worst = result.frame_cycles.max() if result.frames else result.setup.cycles
    outcome.cycles = int(worst)
    run = Finished(result, chip.program, chip.machine, partial(stuck, chip))
    verdicts, outcome.entry, outcome.advice = judge(outcome.case, run, golden)
    if outcome.entry is None:
        outcome.stopped = frame_name(result.frames - 1 if result.frames else "setup")
    for verdict in verdicts:
        if verdict.claim and verdict.holds:
            outcome.held.add(verdict.claim.span.line.number)
        if verdict.line:
            outcome.lines.append(verdict.line)
            named = verdict.claim.name if isinstance(verdict.claim, Claim) else verdict.text
            outcome.over |= named in PER_FRAME or named.startswith(".budget cycles")
        outcome.differences += verdict.differences
    if outcome.lines or outcome.differences:
        outcome.state = "failed"
