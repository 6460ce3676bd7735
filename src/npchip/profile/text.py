"""A profile as text: a report, or the source with its counts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from npchip.assembler.listing import source_beside
from npchip.base.columns import aligned
from npchip.report.bounds import where as where_is
from npchip.report.table import ending

if TYPE_CHECKING:
    from npchip.isa import Isa
    from npchip.profile.model import Branch, Profile

_HOTTEST = 10


def report(profile: Profile) -> str:
    """Return the summary, the calls, the labels, the hottest lines and the coverage."""
    parts = [_head(profile)]
    if profile.calls.children:
        parts.append(_calls(profile))
    parts += [_labels(profile), _hottest(profile), _coverage(profile)]
    return "\n\n".join("\n".join(part) for part in parts) + "\n"


def annotated(profile: Profile, texts: Mapping[str, Sequence[str]], isa: Isa) -> str:
    """Return the listing with executions, cycles, share and active NPs instead of the words.

    Args:
        profile: the profile of a program.
        texts: lines of its source files, from `npchip.assembler.listing.read_texts`.
        isa: the program's instruction set.
    """
    wide = max(len("cycles"), *(len(f"{word.cycles:,}") for word in profile.words))
    head = f"addr  {'times':>{wide}}  {'cycles':>{wide}}  share  active"

    def columns(address: int) -> str:
        word = profile.words[address]
        if not word.executions:
            return f"{address:03X}   {'-':>{wide}}  {'-':>{wide}}      -       -"
        share, active = percent(profile.share(word.cycles)), percent(word.active or 0)
        return (
            f"{address:03X}   {word.executions:>{wide},}  {word.cycles:>{wide},}"
            f"  {share:>5}  {active:>6}"
        )

    beside = source_beside(profile.program, texts, isa, columns, len(head))
    lines = [f"{head}   line  source", *beside]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def percent(part: float) -> str:
    """Return a share as text; only 0 reads 0.0% and only 1 reads 100.0%."""
    shown = f"{100 * part:.1f}"
    if (shown == "0.0" and part > 0) or (shown == "100.0" and part < 1):
        shown = "<0.1" if part < 0.5 else ">99.9"
    return f"{shown}%"


def where(profile: Profile, address: int) -> str:
    """Return file, line and text of a word; its address if it has no source."""
    place = profile.program.place(address)
    return where_is(profile.program, address) + (f": {code(place.text)}" if place else "")


def code(text: str) -> str:
    """Return a source line without its comment, with single blanks."""
    return " ".join(text.split(";", maxsplit=1)[0].split())


def _head(profile: Profile) -> list[str]:
    result, frames = profile.result, profile.frames
    lines = [
        f"{result.program} on machine {result.machine}, engine {result.engine}: {ending(result)}",
        f"{profile.cycles:,} cycles"
        + (f", {result.setup.cycles:,} of them before the first frame" if result.frames else ""),
    ]
    if frames:
        lines.append(
            f"cycles per frame: minimum {frames.least:,} (frame {frames.least_at}), median "
            f"{frames.median:,.1f}, maximum {frames.most:,} (frame {frames.most_at})"
        )
    return lines


def _calls(profile: Profile) -> list[str]:
    rows: list[tuple[str, ...]] = [("routine", "calls", "own cycles", "with calls", "share")]
    for depth, call in profile.calls.walk():
        counts = (f"{count:,}" for count in (call.calls, call.own, call.total))
        rows.append(("  " * depth + call.name, *counts, percent(profile.share(call.total))))
    return aligned(rows)


def _labels(profile: Profile) -> list[str]:
    rows: list[tuple[str, ...]] = [("label", "words", "times", "cycles", "share")]
    for label in profile.labels:
        counts = (f"{count:,}" for count in (label.words, label.executions, label.cycles))
        rows.append((label.name, *counts, percent(profile.share(label.cycles))))
    return aligned(rows)


def _hottest(profile: Profile) -> list[str]:
    words = sorted(profile.words, key=lambda word: (-word.cycles, word.address))
    lines = ["most cycles in:"]
    for word in words[:_HOTTEST]:
        if word.cycles:
            share = percent(profile.share(word.cycles))
            lines.append(f"  {share:>5}  {word.cycles:>9,}  {where(profile, word.address)}")
    return lines


def _coverage(profile: Profile) -> list[str]:
    executed = sum(word.executions > 0 for word in profile.words)
    covered, outcomes = profile.outcomes("branch")
    masked, parts = profile.outcomes("mask")
    words = f"{executed} of {len(profile.words)} words"
    both = f"{covered} of {outcomes} outcomes of branches, {masked} of {parts} of masks"
    lines = [f"covered: {words}, {both}"]
    lines += [f"  {where(profile, at)}: never executed{more}" for at, more in _gaps(profile)]
    for branch in profile.branches:
        if branch.covered == 1:
            lines.append(f"  {where(profile, branch.address)}: {_missing(branch)}")
    return lines


def _missing(branch: Branch) -> str:
    if branch.kind == "branch":
        return "always taken" if branch.yes else "never taken"
    return "met by all active NPs" if branch.yes else "met by no active NP"


def _gaps(profile: Profile) -> Iterator[tuple[int, str]]:
    """Yield the first address of each run of unexecuted words, and the words that follow it."""
    for executed, run in groupby(profile.words, lambda word: word.executions > 0):
        if not executed:
            first, *more = run
            rest = "word" if len(more) == 1 else f"{len(more)} words"
            yield first.address, f", nor the {rest} after it" if more else ""
