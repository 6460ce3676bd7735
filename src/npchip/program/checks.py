"""Checks of a program's flow: masks, calls and unreachable code.

Every address has one mask depth on all paths (decision). This lets hardware keep a mask as a
counter, and tells the compiled engine where all NPs are active. The assembler and the loader of
raw images check it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from itertools import groupby
from typing import NamedTuple

from npchip.isa import Form
from npchip.program.graph import Place, Words
from npchip.program.routines import Finder, Routine, Routines


class FlowFault(NamedTuple):
    """An error or a probable mistake in a program.

    Attributes:
        code: NP020 two depths, NP021 no open region, NP022 too deep, NP023 unbalanced routine;
            NPW04 never reached, NPW05 past the end, NPW07 RET without CALL, NPW08 calls nested
            too deeply.
        message: description.
        address: address of the instruction.
        other: address that contradicts it, if there is one.
        remark: description of `other`.
        hint: probable cause.
    """

    code: str
    message: str
    address: int
    other: int | None = None
    remark: str = ""
    hint: str | None = None

    @property
    def blamed(self) -> int:
        """Address of the instruction that causes the fault."""
        return self.address if self.other is None else self.other


def mask_depths(words: Words, limit: int) -> tuple[dict[int, int], list[FlowFault]]:
    """Follow all paths of a program.

    Args:
        words: the program.
        limit: number of regions that can be open at a time.

    Returns:
        The mask depth before each reachable address, and the first fault of each routine, as
        others may result from it.
    """
    seen: dict[int, tuple[int, int]] = {}  # depth on the first arrival, and its origin
    faults: dict[int, FlowFault] = {}  # by routine

    def arrive(routine: Routine, place: Place, origin: int) -> bool:
        address, _, depth = place
        if address >= len(words):
            return False
        word, arrival = words[address], (depth, origin)
        first = seen.setdefault(address, arrival)
        fault = None
        if first[0] != depth:
            fault = _two_depths(address, first, arrival, words)
        elif word is not None:
            fault = _misuse(word.form, address, depth, routine.entry.depth, limit)
        if fault is None:
            return True
        known = faults.get(routine.entry.address)
        if known is None or fault.blamed < known.blamed:
            faults[routine.entry.address] = fault
        return False

    Finder(words, limit, arrive=arrive).follow_all_calls()
    depths = {address: depth for address, (depth, _) in seen.items()}
    found = _led_out(faults.values(), words, seen)
    return depths, sorted(found, key=lambda fault: fault.address)


_NO_END = "is an END missing before the jump?"


def _two_depths(
    address: int, first: tuple[int, int], again: tuple[int, int], words: Words
) -> FlowFault:
    """Return the fault of an address that is reached with two depths; a jump there causes it."""
    jump, other = (again, first) if again[1] != address - 1 else (first, again)
    (depth, origin), least = jump, other[0]
    word = words[origin] if origin >= 0 else None
    hint = "an instruction must have the same masked regions open on every way to it"
    if word and "call" in word.form.effects:
        hint = "every CALL of a routine must stand inside equally many masked regions"
    elif depth > least:
        hint = _NO_END
    return FlowFault(
        "NP020",
        f"reached with {_regions(least)} open, but from elsewhere with {depth}",
        address,
        origin,
        f"with {_regions(depth)} open it is reached from here",
        hint,
    )


def _led_out(
    faults: Iterable[FlowFault], words: Words, seen: Mapping[int, tuple[int, int]]
) -> Iterator[FlowFault]:
    """Yield faults; one of a region that is left by a jump, and has its END, names that jump."""
    ends = _ends(words)
    for fault in faults:
        leaving = None
        if fault.hint == _NO_END and fault.other is not None:
            leaving = _leaving(fault.address, fault.other, ends, seen)
        if leaving is None:
            yield fault
        else:
            yield fault._replace(
                other=leaving,
                remark="this jump leads out of a masked region, past its END",
                hint="a jump takes all NPs along: put JANY or JNONE in place of WHERE,"
                " or END before the jump",
            )


def _leaving(
    address: int,
    origin: int,
    ends: Mapping[int, int],
    seen: Mapping[int, tuple[int, int]],
) -> int | None:
    """Return the last jump on the way to an address that leads out of a region with an END."""
    depth, visited = seen[origin][0], set[int]()
    while origin >= 0 and origin not in visited and seen[origin][0] >= depth:
        visited.add(origin)
        if address != origin + 1 and origin in ends and not origin < address <= ends[origin]:
            return origin
        address, origin = origin, seen[origin][1]
    return None


def _ends(words: Words) -> dict[int, int]:
    """Return for each address in a region that ends further down where the innermost does."""
    ends: dict[int, int] = {}
    below: list[int] = []
    for address in reversed(range(len(words))):
        if below:
            ends[address] = below[-1]
        word = words[address]
        effects = word.form.effects if word else ()
        if "mask_pop" in effects:
            below.append(address)
        elif "mask_push" in effects and below:
            below.pop()
    return ends


def _misuse(form: Form, address: int, depth: int, entry: int, limit: int) -> FlowFault | None:
    """Return the fault of an instruction at a mask depth, in a routine entered at depth `entry`."""
    effects = form.effects
    if not effects:
        return None
    name = form.mnemonic
    if "mask_push" in effects and depth >= limit:
        return FlowFault("NP022", f"more than {limit} masked regions are open", address)
    if ("mask_invert" in effects or "mask_pop" in effects) and depth == 0:
        hint = f"{name} belongs to a WHERE above it"
        return FlowFault("NP021", f"{name} without an open masked region", address, hint=hint)
    if "mask_pop" in effects and depth <= entry:
        return FlowFault(
            "NP023",
            f"{name} closes a masked region that the caller has opened",
            address,
            hint="a routine closes the regions that it has opened itself, and no others",
        )
    if "ret" in effects and depth != entry:
        return FlowFault(
            "NP023",
            f"{name} with {_regions(depth - entry)} of this routine still open",
            address,
            hint="flow ignores the mask: close the region with END, then return",
        )
    return None


def _regions(number: int) -> str:
    return {0: "no masked region", 1: "1 masked region"}.get(number, f"{number} masked regions")


def check_flow(words: Words, routines: Routines, stack: int) -> Iterator[FlowFault]:
    """Yield the probable mistakes in a program's flow.

    Args:
        words: the program.
        routines: routines of the program.
        stack: size of the return stack.
    """
    reached = frozenset().union(*routines.values())
    yield from _unreachable(len(words), reached)
    yield from _past_end(words, reached)
    yield from _stray_returns(words, routines[0])
    yield from _deep_calls(words, routines, stack)


def _unreachable(size: int, reached: AbstractSet[int]) -> Iterator[FlowFault]:
    for is_reached, addresses in groupby(range(size), reached.__contains__):
        if not is_reached:
            start, *others = addresses
            what = f"{len(others) + 1} words are" if others else "this word is"
            yield FlowFault("NPW04", f"{what} never reached", start)


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
                hint="put an instruction after the label there, such as HALT",
            )
        elif address == end - 1 and (flow is None or flow.guard is not None or flow.name == "call"):
            yield FlowFault(
                "NPW05",
                f"the program goes on after its last word, {name}, which is a trap",
                address,
                hint="end it with HALT, or with a JMP back to its loop",
            )


def _stray_returns(words: Words, own: AbstractSet[int]) -> Iterator[FlowFault]:
    for address in sorted(own):
        word = words[address]
        if word is not None and "ret" in word.form.effects:
            yield FlowFault(
                "NPW07",
                "the program can come here without a CALL, and an empty return stack is a trap",
                address,
                hint="is a JMP or HALT missing above the routine, or a CALL written as a JMP?",
            )


def _deep_calls(words: Words, routines: Routines, stack: int) -> Iterator[FlowFault]:
    """Compute the call depth of each routine, until it is stable or exceeds the stack."""
    calls: dict[int, dict[int, int]] = {}  # by routine the first call of each other routine
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
                if _calls(calls, target, entry):
                    hint = "a routine may not call itself, nor one that calls it"
                yield FlowFault("NPW08", message, address, hint=hint)
                return
            if deeper > depth[target]:
                depth[target] = deeper
                work.append(target)


def _calls(calls: Mapping[int, Mapping[int, int]], start: int, goal: int) -> bool:
    """Return whether calls lead from one routine to another, or both are the same."""
    found = [start]
    for entry in found:
        found += calls[entry].keys() - found
    return goal in found
