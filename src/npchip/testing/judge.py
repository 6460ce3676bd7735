"""Verdicts: a run against the expectations of a case."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from npchip.assembler.diagnostics import Span, did_you_mean
from npchip.machine import Machine
from npchip.program.model import Program
from npchip.run.result import Measured, over_budget
from npchip.run.stuck import Stuck
from npchip.testing.cases import Case
from npchip.testing.claims import Claim, GoldenClaim
from npchip.testing.compare import Difference, compare, table
from npchip.testing.evaluate import WORDS, fault, misfit
from npchip.testing.golden import Entry, record

_UPDATE = "npchip test --update records it"


class Finished(NamedTuple):
    """A run that has ended.

    Attributes:
        result: its outputs and cycles.
        program: the program.
        machine: the machine.
        stuck: returns where it stands; called if it reached the cycle limit.
    """

    result: Measured
    program: Program
    machine: Machine
    stuck: Callable[[], Stuck]


@dataclass(frozen=True)
class Verdict:
    """One thing that was asked of a run.

    Attributes:
        text: what was asked.
        span: where it was asked.
        found: what was found instead; empty if it holds, or if `differences` tell.
        differences: the differences from the golden.
        claim: the expectation; None for what every run is asked.
    """

    text: str
    span: Span
    found: str = ""
    differences: tuple[Difference, ...] = ()
    claim: Claim | GoldenClaim | None = None

    @property
    def holds(self) -> bool:
        """True if nothing else was found."""
        return not (self.found or self.differences)

    @property
    def line(self) -> str:
        """The text for a report; empty if it holds, or if `differences` tell."""
        if not self.found or self.claim is None:
            return self.found
        return f"{self.span.line.file}:{self.span.line.number}: expected {self.text}; {self.found}"

    @property
    def shown(self) -> str:
        """The finding, with the table of differences; empty if it holds."""
        return "\n".join([self.found] * bool(self.found) + table(self.differences))


class Judgement(NamedTuple):
    """All that is said of a run.

    Attributes:
        verdicts: expectations in their order, then the budget, then the golden.
        entry: the record for a golden; None if the run did not end well.
        mistake: the text of the first known mistake that the run shows; empty if all holds.
    """

    verdicts: list[Verdict]
    entry: Entry | None
    mistake: str = ""


def judge(case: Case, run: Finished, golden: Mapping[str, Entry] | None) -> Judgement:
    """Judge a run.

    Args:
        case: its case.
        run: the run.
        golden: the recorded runs of the suite, by name; None not to compare with them.
    """
    result, program = run.result, run.program
    ending = _bad_ending(case, run)
    if ending:
        ended = Verdict("a run that ends", case.run.span, ending)
        return Judgement([ended], None, _shown_mistake(case, run, WORDS))
    verdicts = [
        Verdict(claim.text, claim.span, _said(case, claim, result, program) or "", claim=claim)
        for claim in case.run.claims
        if isinstance(claim, Claim)
    ]
    over = over_budget(result, program) if run.machine.is_default else None
    if over:
        text = f".budget cycles {program.budget.cycles}"
        verdicts.append(Verdict(text, case.run.span, str(over)))
    words = len(program.words)
    entry = record(result, words, outputs=case.run.golden_outputs, cycles=case.pins_cycles)
    if golden is not None:
        verdicts += _compared(case, entry, golden)
    all_holds = all(verdict.holds for verdict in verdicts)
    return Judgement(verdicts, entry, "" if all_holds else _shown_mistake(case, run))


def _shown_mistake(case: Case, run: Finished, among: Collection[str] | None = None) -> str:
    """Return the text of the first known mistake that a run shows; empty if it shows none.

    Others may hold as well, but as a consequence: where nothing is sent, nothing is right.

    Args:
        case: its case.
        run: the run.
        among: what may be claimed of it; None for everything. Of a run that was cut short, outputs
            prove nothing.
    """
    shown = (
        mistake.text
        for mistake in case.run.mistakes
        if (among is None or mistake.claim.name in among)
        and _said(case, mistake.claim, run.result, run.program) is None
    )
    return next(shown, "")


def _said(case: Case, claim: Claim, result: Measured, program: Program) -> str | None:
    """Return what is wrong, as text, if a claim does not hold."""
    if case.submitted:
        said = misfit(claim, program, case.suite.kinds.get(claim.name))
        if said is not None:
            return said
    return fault(claim, result, program)


def _bad_ending(case: Case, run: Finished) -> str | None:
    """Return a message if a run did not end well, unless an expectation is about that."""
    expected = any(
        isinstance(claim, Claim) and claim.name in {"status", "error"} for claim in case.run.claims
    )
    result = run.result
    if expected or result.status in {"halted", "frames-exhausted"}:
        return None
    if result.error:
        return str(result.error)
    where = f"frame {result.frames - 1}" if result.frames else "the setup"
    at = run.stuck()
    return (
        f"{at.place}{where} reached the limit of {case.run.max_cycles:,} cycles [NP321], "
        f"{at.loops}: is it endless? (max-cycles=N raises the limit)"
    )


def _compared(case: Case, found: Entry, golden: Mapping[str, Entry]) -> Sequence[Verdict]:
    """Return the verdicts on the golden: what differs stands at the first that asks for it."""
    parts = [claim for claim in case.run.claims if isinstance(claim, GoldenClaim)]
    if not parts:
        return []
    said = ""
    differences: tuple[Difference, ...] = ()
    expected = golden.get(case.name)
    lack = None
    if expected is None:
        lack = "nothing"
    elif case.pins_cycles and expected.words is None:
        lack = "no cycles"
    elif case.run.golden_outputs and found.names and not expected.names:
        lack = "no outputs"
    if lack:
        hint = did_you_mean(case.name, golden) if expected is None else None
        verb = "are" if lack.endswith("s") else "is"
        said = f"{lack} {verb} recorded ({hint or _UPDATE})"
    elif expected is not None:
        differences = tuple(compare(expected, found, extra=not case.submitted))
    first, *others = parts
    verdicts = [Verdict(first.text, first.span, said, differences, first)]
    if verdicts[0].holds:
        verdicts += [Verdict(claim.text, claim.span, claim=claim) for claim in others]
    return verdicts
