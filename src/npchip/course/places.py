"""Places where a run fails: the clip and the frame, but not what was expected there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from npchip.bundle import bundled
from npchip.testing.claims import Claim
from npchip.testing.evaluate import MEASURES
from npchip.testing.runner import Outcome
from npchip.testing.suite import Run

MAX_LEVELS = 8
"""Most grey levels of a run that are named."""


def first_failing(outcomes: Sequence[Outcome]) -> Outcome | None:
    """Return the first run that fails.

    Before others comes one whose frame can be named, and one whose clip the learner can run.
    """
    failing = [outcome for outcome in outcomes if outcome.state != "passed"]
    return min(
        failing, key=lambda each: (not each.differences, not runnable_clip(each)), default=None
    )


def runnable_clip(outcome: Outcome) -> str | None:
    """Return the clip of a run if it comes with npchip."""
    clip = outcome.case.run.frames
    return clip if clip in bundled("clip") else None


def options(outcome: Outcome) -> tuple[str, ...]:
    """Return the options of `npchip run` that show a run; none if its clip is not npchip's own."""
    clip, machine = runnable_clip(outcome), outcome.case.machine
    if clip is None:
        return ()
    return ("--frames", clip, *(() if machine == "default" else ("--machine", machine)))


def stop(outcome: Outcome) -> str:
    """Return where a run has stopped."""
    return ", ".join(filter(None, (_clip(outcome.case.run), outcome.stopped)))


def place(outcome: Outcome) -> str:
    """Return where a run fails, and what of it."""
    clip = _clip(outcome.case.run) or "without a clip"
    if outcome.entry is None:
        return f"{stop(outcome) or clip}: {outcome.lines[0]}"
    first, *others = [*_wrong(outcome)] or outcome.lines
    return f"{clip}: {first}" + (f" (and {len(others)} more)" if others else "")


def _wrong(outcome: Outcome) -> Iterator[str]:
    for each in outcome.differences:
        if each.where:
            yield f"{each.what} is not right in {each.where} {each.note}".rstrip()
        else:
            yield f"{each.what} is not right: {each.found}"
    for claim in outcome.case.run.claims:
        if isinstance(claim, Claim) and claim.span.line.number not in outcome.held:
            yield f"{claim.name} {'is too high' if claim.name in MEASURES else 'is not right'}"


def _clip(run: Run) -> str:
    """Return what a run sees, as text; empty if it sees nothing."""
    if run.levels is None:
        return run.frames or ""
    more = ", ..." if len(run.levels) > MAX_LEVELS else ""
    return f"frames of grey {', '.join(map(str, run.levels[:MAX_LEVELS]))}{more}"
