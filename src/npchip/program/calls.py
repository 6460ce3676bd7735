"""Flow that is hardly meant: code that nothing reaches, ends that are run past, calls."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from typing import NamedTuple

from npchip.program.graph import Words
from npchip.program.routines import Routines


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


def check_flow(words: Words, routines: Routines, stack: int) -> Iterator[FlowFault]:
    """Look at all ways through a program.

    Args:
        words: the program.
        routines: of the program.
        stack: entries of the return stack.
    """
    reached = frozenset().union(*routines.values())
    yield from _unreachable(len(words), reached)
    yield from _past_end(words, reached)
    yield from _stray_returns(words, routines[0])
    yield from _deep_calls(words, routines, stack)


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


def _past_end(words: Words, reached: AbstractSet[int]) -> Iterator[FlowFault]:
    end = len(words)
    for address in sorted(reached):
        word = words[address]
        if word is None:
            continue
        name, flow = word.form.mnemonic, word.form.flow
        if word.target is not None and word.target >= end:
            yield FlowFault(
                "NPW05",
                f"{name} leads past the last word, which is a trap",
                address,
                "put an instruction after the label there, such as HALT",
            )
        elif address == end - 1 and (flow is None or flow.guard is not None or flow.name == "call"):
            yield FlowFault(
                "NPW05",
                f"the program goes on after its last word, {name}, which is a trap",
                address,
                "end it with HALT, or with a JMP back to its loop",
            )


def _stray_returns(words: Words, own: AbstractSet[int]) -> Iterator[FlowFault]:
    for address in sorted(own):
        word = words[address]
        if word is not None and "ret" in word.form.effects:
            yield FlowFault(
                "NPW07",
                "the program can come here without a CALL, and an empty return stack is a trap",
                address,
                "is a JMP or HALT missing above the routine, or a CALL written as a JMP?",
            )


def _deep_calls(words: Words, routines: Routines, stack: int) -> Iterator[FlowFault]:
    """How many returns are on the stack in each routine, raised until no call raises it more."""
    calls: dict[int, dict[int, int]] = {}  # for each routine what it calls, and where first
    for entry, addresses in routines.items():
        calls[entry] = {}
        for address in sorted(addresses):
            word = words[address]
            if word is not None and word.target is not None and "call" in word.form.effects:
                calls[entry].setdefault(word.target, address)
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
