"""Where a program's flow can go: code that nothing reaches, ends that it runs past, calls."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from npchip.assembler.masks import Step


@dataclass(frozen=True)
class FlowFault:
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


def check_flow(
    steps: Sequence[Step | None], reached: Collection[int], stack: int
) -> Iterator[FlowFault]:
    """Look at all ways through a program.

    Args:
        steps: the program's instructions.
        reached: addresses that some way leads to.
        stack: entries of the return stack.
    """
    yield from _unreachable(len(steps), reached)
    yield from _past_end(steps, reached)
    yield from _stray_returns(steps)
    yield from _deep_calls(steps, reached, stack)


def _unreachable(size: int, reached: Collection[int]) -> Iterator[FlowFault]:
    start: int | None = None
    for address in range(size + 1):
        if address < size and address not in reached:
            start = address if start is None else start
        elif start is not None:
            count = address - start
            what = f"{count} words are" if count > 1 else "this word is"
            yield FlowFault("NPW04", f"{what} never reached", start)
            start = None


def _past_end(steps: Sequence[Step | None], reached: Collection[int]) -> Iterator[FlowFault]:
    end = len(steps)
    for address in sorted(reached):
        step = steps[address] if address < end else None
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


def _routine(steps: Sequence[Step | None], entry: int) -> set[int]:
    """Addresses that flow reaches from an entry until it returns, taking calls as one step."""
    found: set[int] = set()
    work = [entry]
    while work:
        address = work.pop()
        if address in found or address >= len(steps):
            continue
        found.add(address)
        step = steps[address]
        if step is None:
            continue
        if step.form.falls_through:
            work.append(address + 1)
        if step.target is not None and "call" not in step.form.effects:
            work.append(step.target)
    return found


def _stray_returns(steps: Sequence[Step | None]) -> Iterator[FlowFault]:
    for address in sorted(_routine(steps, 0)):
        step = steps[address]
        if step is not None and "ret" in step.form.effects:
            yield FlowFault(
                "NPW07",
                "the program can come here without a CALL, and an empty return stack is a trap",
                address,
                "is a JMP or HALT missing above the routine, or a CALL written as a JMP?",
            )


def _calls(step: Step | None) -> bool:
    return step is not None and step.target is not None and "call" in step.form.effects


def _deep_calls(
    steps: Sequence[Step | None], reached: Collection[int], stack: int
) -> Iterator[FlowFault]:
    """How many returns are on the stack in each routine, raised until no call raises it more."""
    sites = {address: steps[address] for address in reached if address < len(steps)}
    targets = {step.target for step in sites.values() if step and _calls(step) and step.target}
    bodies = {entry: _routine(steps, entry) for entry in (0, *sorted(targets))}
    calls = [
        (entry, address, step.target)
        for entry, body in bodies.items()
        for address in sorted(body)
        if (step := steps[address]) is not None and _calls(step) and step.target in bodies
    ]
    depth = dict.fromkeys(bodies, 0)
    changed = True
    while changed:
        changed = False
        for entry, address, target in calls:
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
                changed = True


def _leads(calls: Sequence[tuple[int, int, int]], start: int, goal: int) -> bool:
    """Whether calls lead from one routine to another."""
    found = {start}
    for _ in calls:
        found |= {target for entry, _, target in calls if entry in found}
    return goal in found
