"""A profile: the counts of a chip by word, label, routine, branch and frame."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from npchip.engines.counts import Counts, Table
from npchip.engines.rows import ACTIVE, EXECUTED, TAKEN

if TYPE_CHECKING:
    from npchip.program.graph import Words
    from npchip.program.model import Program, SourceLine
    from npchip.run.chip import Chip
    from npchip.run.result import RunResult


@dataclass(frozen=True)
class Word:
    """A word of the program.

    Attributes:
        address: its address.
        place: its source line, if the program carries its source.
        executions: number of executions.
        cycles: cycles spent on it.
        active: mean share of active NPs in its executions, 0 to 1; None without executions.
    """

    address: int
    place: SourceLine | None
    executions: int
    cycles: int
    active: float | None


@dataclass(frozen=True)
class Label:
    """The words from a label to the next one.

    Attributes:
        name: the label; ``(start)`` for words above the first label.
        address: address of the first word.
        words: number of words.
        executions: executions of the first word.
        cycles: cycles of the words, without those of called routines.
    """

    name: str
    address: int
    words: int
    executions: int
    cycles: int


@dataclass
class Call:
    """A routine in one chain of calls; the root is the program itself.

    Attributes:
        name: label of the routine.
        address: address of its first word.
        calls: number of calls in this chain.
        own: cycles without those of called routines.
        children: the routines that it calls, in the order of their addresses.
    """

    name: str
    address: int
    calls: int = 0
    own: int = 0
    children: list[Call] = field(default_factory=list)

    @property
    def total(self) -> int:
        """Cycles with those of called routines."""
        return self.own + sum(child.total for child in self.children)

    def walk(self, depth: int = 0) -> Iterator[tuple[int, Call]]:
        """Yield this call and all below it, each with its depth."""
        yield depth, self
        for child in self.children:
            yield from child.walk(depth + 1)


@dataclass(frozen=True)
class Branch:
    """A conditional branch, or an instruction that opens a masked region, and its two outcomes.

    Attributes:
        kind: ``branch``: outcomes are counted in executions. ``mask``: in NPs.
        address: address of the instruction.
        yes: times the branch was taken; NPs that stayed active.
        no: times the branch was not taken; active NPs that were masked out.
    """

    kind: Literal["branch", "mask"]
    address: int
    yes: int
    no: int

    @property
    def covered(self) -> int:
        """The number of outcomes that occurred, 0 to 2."""
        return (self.yes > 0) + (self.no > 0)


@dataclass(frozen=True)
class FrameCycles:
    """Cycles of the complete frames of a run.

    Attributes:
        count: number of frames.
        least, most: fewest and most cycles of a frame.
        least_at, most_at: the first frames with so many cycles.
        median: median of the cycles.
    """

    count: int
    least: int
    least_at: int
    median: float
    most: int
    most_at: int


@dataclass(frozen=True)
class Profile:
    """The cycles of a run, by word, label, routine, branch and frame.

    Attributes:
        program: the program.
        result: the run.
        decoded: the decoded words; None for an undefined one.
        costs: cycles of one execution of each word.
        stacks: the counts of each call stack (return addresses, the newest last).
        words: all words.
        labels: all labels that name addresses, in the order of the addresses.
        calls: the tree of calls.
        branches: conditional branches and masks, in the order of their addresses.
        frames: cycles of the complete frames; None if no frame is complete.
    """

    program: Program
    result: RunResult
    decoded: Words
    costs: tuple[int, ...]
    stacks: Mapping[tuple[int, ...], Table]
    words: tuple[Word, ...]
    labels: tuple[Label, ...]
    calls: Call
    branches: tuple[Branch, ...]
    frames: FrameCycles | None

    @property
    def cycles(self) -> int:
        """All cycles since reset."""
        return sum(word.cycles for word in self.words)

    def share(self, cycles: int) -> float:
        """Return a number of cycles as a part of all cycles, 0 to 1."""
        return cycles / self.cycles if self.cycles else 0.0

    @cached_property
    def taken(self) -> list[int]:
        """Times that a jump, call or return was taken, by address."""
        none = np.zeros(len(self.words), np.int64)
        return sum((table[TAKEN] for table in self.stacks.values()), start=none).tolist()

    def label_at(self, address: int) -> Label:
        """Return the label to whose words an address belongs."""
        return next(item for item in reversed(self.labels) if item.address <= address)

    def outcomes(self, kind: Literal["branch", "mask"]) -> tuple[int, int]:
        """Return the number of outcomes that occurred, and of all outcomes."""
        found = [item.covered for item in self.branches if item.kind == kind]
        return sum(found), 2 * len(found)


def profile_of(chip: Chip, result: RunResult) -> Profile:
    """Return the profile of a chip since reset.

    Args:
        chip: a chip made with ``profile=True``.
        result: its last run, for the cycles of the frames.

    Raises:
        ValueError: the chip was made without ``profile=True``.
    """
    counts = chip.counts
    if counts is None:
        raise ValueError("the chip does not count: make it with Chip(..., profile=True)")
    program, machine = chip.program, chip.machine
    decoded, costs = program.decoded(chip.isa), program.cycles(machine, chip.isa)
    total, processors = counts.total(), machine.np_rows * machine.np_cols
    words = tuple(_words(program, costs, total, processors))
    return Profile(
        program=program,
        result=result,
        decoded=decoded,
        costs=costs,
        stacks=dict(counts.used()),
        words=words,
        labels=tuple(_labels(program, words)),
        calls=_calls(program, decoded, costs, counts),
        branches=tuple(_branches(decoded, total)),
        frames=_frames(result),
    )


def _words(
    program: Program, costs: tuple[int, ...], total: Table, processors: int
) -> Iterator[Word]:
    for address, (cost, count, active) in enumerate(
        zip(costs, total[EXECUTED].tolist(), total[ACTIVE].tolist(), strict=True)
    ):
        share = active / (count * processors) if count else None
        yield Word(address, program.place(address), count, count * cost, share)


def _labels(program: Program, words: tuple[Word, ...]) -> Iterator[Label]:
    names = {0: "(start)", **program.label_names}
    starts = sorted(address for address in names if address < len(words))
    for start, end in zip(starts, [*starts[1:], len(words)], strict=True):
        cycles = sum(word.cycles for word in words[start:end])
        yield Label(names[start], start, end - start, words[start].executions, cycles)


def _calls(program: Program, decoded: Words, costs: tuple[int, ...], counts: Counts) -> Call:
    names = program.label_names
    root = Call(names.get(0, program.name), 0, calls=1)
    found: dict[tuple[int, ...], Call] = {(): root}
    for stack, table in counts.used():
        path = called(decoded, stack)
        node = found.get(path)
        if node is None:
            node = found[path] = Call(names.get(path[-1], f"0x{path[-1]:03X}"), path[-1])
            found[path[:-1]].children.append(node)
        node.own += int(table[EXECUTED] @ np.array(costs, np.int64))
        if stack:
            node.calls += int(counts.tables[stack[:-1]][TAKEN, stack[-1] - 1])
    for node in found.values():
        node.children.sort(key=lambda child: child.address)
    return root


def called(words: Words, stack: tuple[int, ...]) -> tuple[int, ...]:
    """Return the targets of the calls that return to the addresses of a stack."""
    calls = [words[after - 1] for after in stack]
    return tuple(call.target for call in calls if call is not None and call.target is not None)


def entries(profile: Profile, first: int, end: int) -> int:
    """Return how often control came to the words from `first` to `end` - 1 from other words."""
    words, arrivals = profile.words, defaultdict[int, int](int)
    arrivals[0] += 1  # from reset
    for address, decoded in enumerate(profile.decoded):
        if decoded is None or first <= address < end:
            continue
        flow, executed = decoded.form.flow, words[address].executions
        if flow is None:
            arrivals[address + 1] += executed
            continue
        taken = executed
        if flow.guard is not None:
            taken = profile.taken[address]
        if decoded.target is not None:
            arrivals[decoded.target] += taken
        arrivals[address + 1] += executed if flow.name == "call" else executed - taken
    # The end of the run may have come before the word was executed.
    return sum(min(arrivals[item.address], item.executions) for item in words[first:end])


def _branches(decoded: Words, total: Table) -> Iterator[Branch]:
    for address, item in enumerate(decoded):
        if item is None:
            continue
        flow = item.form.flow
        executed, active, taken, entered = total[:, address].tolist()
        if flow is not None and flow.guard is not None and flow.name != "halt":
            yield Branch("branch", address, taken, executed - taken)
        if "mask_push" in item.form.effects:
            yield Branch("mask", address, entered, active - entered)


def _frames(result: RunResult) -> FrameCycles | None:
    cycles = result.complete_cycles
    if not len(cycles):
        return None
    first = result.first_frame
    return FrameCycles(
        count=len(cycles),
        least=int(cycles.min()),
        least_at=first + int(cycles.argmin()),
        median=float(np.median(cycles)),
        most=int(cycles.max()),
        most_at=first + int(cycles.argmax()),
    )
