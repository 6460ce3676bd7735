"""Numbers of checks of each part that hold, and that could not be judged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

from npchip.testing.claims import Claim, GoldenClaim
from npchip.testing.evaluate import compares
from npchip.testing.harness import Report
from npchip.testing.runner import Outcome

Part = Literal["result", "words", "cycles"]
PARTS: Final[tuple[Part, ...]] = ("result", "words", "cycles")
_PARTS: Final[dict[str, Part]] = {
    "words": "words",
    "cycles": "cycles",
    "instructions": "cycles",
}


@dataclass(frozen=True)
class Tally:
    """The checks of one part.

    Attributes:
        held: number of those that hold.
        of: number of all.
        unjudged: number of those that no run could answer, as it stopped or did not begin.
    """

    held: int = 0
    of: int = 0
    unjudged: int = 0


class Counts(NamedTuple):
    """The checks of one part, and the points of those that hold."""

    tally: Tally
    points: int


def counts(report: Report) -> dict[Part, Counts]:
    """Count the lines that hold in every run that they belong to."""
    parts: dict[int, Part] = {}
    points: dict[int, int] = {}
    lost: set[int] = set()
    open_: set[int] = set()
    for outcome in report.outcomes:
        for claim in outcome.case.run.claims:
            line = claim.span.line.number
            parts[line] = _PARTS.get(claim.name, "result") if isinstance(claim, Claim) else "result"
            points[line] = claim.points
            held = _held(claim, outcome)
            if held is None:
                open_.add(line)
            elif not held:
                lost.add(line)
    found: dict[Part, Counts] = {}
    for part in PARTS:
        own = {line for line, each in parts.items() if each == part}
        held_lines = own - lost - open_
        tally = Tally(len(held_lines), len(own), len((own & open_) - lost))
        found[part] = Counts(tally, sum(points[line] for line in held_lines))
    return found


def points_of(found: dict[Part, Counts]) -> int:
    """Return the points: those of words and cycles count only where the result is right."""
    result = found["result"].tally
    right = result.held == result.of
    return sum(each.points for part, each in found.items() if right or part == "result")


def _held(claim: Claim | GoldenClaim, outcome: Outcome) -> bool | None:
    """Return whether a claim holds; None if the run cannot tell.

    The length of a program is known as soon as it assembles.
    """
    if outcome.entry is not None:
        return claim.span.line.number in outcome.held
    if isinstance(claim, Claim) and claim.name == "words" and outcome.words is not None:
        return compares(outcome.words, claim.op, claim.values[0])
    return None
