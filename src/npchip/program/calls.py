"""Where a program's flow can go: code that nothing reaches, ends that it runs past, calls."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import NamedTuple

from npchip.program.masks import Step

Routines = Mapping[int, AbstractSet[int]]
"""For each entry, 0 being the program's own, the addresses that are reached before it returns."""


class FlowFault(NamedTuple):
    """Something in the flow that is hardly meant.

    Attributes:
        code: NPW04 never reached, NPW05 past the end, NPW07 RET without CALL, NPW08 too many
            calls within each other.
        message: what is wrong, in words.
        address: where.
        hint: what is likely to be meant.
    """

    code: str
    message: str
    address: int
    hint: str | None = None


def find_routines(steps: Sequence[Step | None]) -> Routines:
    """Follow all ways; behind a CALL only if the routine can return.

    Args:
        steps: the program's instructions; None for an undefined word, which is a trap.
    """
    routines: dict[int, set[int]] = {0: set()}
    returning: set[int] = set()
    waiting: dict[int, list[tuple[int, int]]] = {}  # ways that go on when a routine returns
    work = [(0, 0)]
    while work:
        entry, address = work.pop()
        if address >= len(steps) or address in routines[entry]:
            continue
        routines[entry].add(address)
        step = steps[address]
        if step is None:
            continue
        target = step.target
        if "ret" in step.form.effects:
            returning.add(entry)
            work += waiting.pop(entry, [])
        if target is not None and "call" in step.form.effects:
            if target not in routines:
                routines[target] = set()
                work.append((target, target))
            if target in returning:
                work.append((entry, address + 1))
            else:
                waiting.setdefault(target, []).append((entry, address + 1))
            continue
        if target is not None:
            work.append((entry, target))
        if step.form.falls_through:
            work.append((entry, address + 1))
    return routines


def check_flow(steps: Sequence[Step | None], routines: Routines, stack: int) -> Iterator[FlowFault]:
    """Look at all ways through a program.

    Args:
        steps: the program's instructions.
        routines: what `find_routines` has found.
        stack: entries of the return stack.
    """
    reached = frozenset().union(*routines.values())
    yield from _unreachable(len(steps), reached)
    yield from _past_end(steps, reached)
    yield from _stray_returns(steps, routines[0])
    yield from _deep_calls(steps, routines, stack)


def _unreachable(size: int, reached: AbstractSet[int]) -> Iterator[FlowFault]:
    start: int | None = None
    for address in range(size + 1):
        if address < size and address not in reached:
            start = address if start is None else start
        elif start is not None:
            count = address - start
            what = f"{count} words are" if count > 1 else "this word is"
            yield FlowFault("NPW04", f"{what} never reached", start)
            start = None


def _past_end(steps: Sequence[Step | None], reached: AbstractSet[int]) -> Iterator[FlowFault]:
    end = len(steps)
    for address in sorted(reached):
        step = steps[address]
        if step is None:
            continue
        name = step.form.mnemonic
        if step.target is not None and step.target >= end:
            yield FlowFault(
                "NPW05",
                f"{name} leads past the last word, which is a trap",
                address,
                "put an instruction after the label there, such as HALT",
            )
        elif address == end - 1 and step.form.falls_through:
            yield FlowFault(
                "NPW05",
                f"the program goes on after its last word, {name}, which is a trap",
                address,
                "end it with HALT, or with a JMP back to its loop",
            )


def _stray_returns(steps: Sequence[Step | None], own: AbstractSet[int]) -> Iterator[FlowFault]:
    for address in sorted(own):
        step = steps[address]
        if step is not None and "ret" in step.form.effects:
            yield FlowFault(
                "NPW07",
                "the program can come here without a CALL, and an empty return stack is a trap",
                address,
                "is a JMP or HALT missing above the routine, or a CALL written as a JMP?",
            )


def _deep_calls(
    steps: Sequence[Step | None], routines: Routines, stack: int
) -> Iterator[FlowFault]:
    """How many returns are on the stack in each routine, raised until no call raises it more."""
    calls: dict[int, dict[int, int]] = {}  # for each routine what it calls, and where first
    for entry, addresses in routines.items():
        calls[entry] = {}
        for address in sorted(addresses):
            step = steps[address]
            if step is not None and step.target is not None and "call" in step.form.effects:
                calls[entry].setdefault(step.target, address)
    depth = dict.fromkeys(calls, 0)
    work = list(calls)
    while work:
        entry = work.pop()
        for target, address in calls[entry].items():
            deeper = depth[entry] + 1
            if deeper > stack:
                message = f"calls can nest {deeper} deep here, and the return stack holds {stack}"
                hint = "write one of the routines where it is called"
                if _leads(calls, target, entry):
                    hint = "a routine may not call itself, nor one that calls it"
                yield FlowFault("NPW08", message, address, hint)
                return
            if deeper > depth[target]:
                depth[target] = deeper
                work.append(target)


def _leads(calls: Mapping[int, Mapping[int, int]], start: int, goal: int) -> bool:
    """Whether calls lead from one routine to another."""
    found: set[int] = set()
    work = [start]
    while work:
        entry = work.pop()
        if entry not in found:
            found.add(entry)
            work += calls[entry]
    return goal in found
