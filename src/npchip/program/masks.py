"""Every address has one mask depth, whichever way it is reached (decision).

That is what lets a mask be a counter in hardware, and lets the compiled engine know where no
NP can be inactive. The assembler checks it, and so does the loader of a raw image.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from npchip.isa import Form, Isa


class Step(NamedTuple):
    """What an instruction does to the flow: its form, and where it leads if that is known."""

    form: Form
    target: int | None


class MaskFault(NamedTuple):
    """A violation found in a program.

    Attributes:
        code: NP020 two depths, NP021 no open region, NP022 too deep, NP023 unbalanced routine.
        message: what is wrong, in words.
        address: where.
        other: the address that disagrees, if there is one.
        remark: what to say of `other`.
        hint: what is likely to be the mistake.
    """

    code: str
    message: str
    address: int
    other: int | None = None
    remark: str = ""
    hint: str | None = None

    @property
    def blamed(self) -> int:
        """Address of the instruction that does the wrong thing."""
        return self.address if self.other is None else self.other


class _State(NamedTuple):
    """On arrival at an address: regions open, and those open where the routine was entered."""

    depth: int
    entry: int
    routine: int  # address that a CALL led to, or 0
    origin: int  # address of the instruction that leads here; -1 at the start


def mask_depths(
    words: Sequence[int], isa: Isa, limit: int
) -> tuple[dict[int, int], list[MaskFault]]:
    """Follow every path of a program.

    Args:
        words: the program's words.
        isa: the instruction set.
        limit: most regions that may be open at a time.

    Returns:
        The mask depth on arrival at each reachable address, and the faults, the first of each
        routine: others may only follow from it.
    """
    steps: list[Step | None] = []
    for word in words:
        decoded = isa.decode(word)
        if decoded is None:
            steps.append(None)
        else:
            slot = decoded.form.target
            steps.append(Step(decoded.form, None if slot is None else int(decoded.values[slot])))
    return follow(steps, limit)


def follow(steps: Sequence[Step | None], limit: int) -> tuple[dict[int, int], list[MaskFault]]:
    """`mask_depths` of decoded instructions; None stands for an undefined word, a trap."""
    seen: dict[int, _State] = {}
    known: set[tuple[int, int]] = set()
    faults: dict[int, MaskFault] = {}  # by routine: others follow from the first
    work = [(0, _State(0, 0, 0, -1))]
    while work:
        address, state = work.pop()
        if address >= len(steps):
            continue
        first = seen.setdefault(address, state)
        if first.depth != state.depth:
            _keep_first(faults, state.routine, _two_depths(address, first, state, steps))
            continue
        if (address, state.entry) in known:
            continue
        known.add((address, state.entry))
        step = steps[address]
        if step is None:
            continue
        fault_here = _check(step.form, address, state, limit)
        if fault_here:
            _keep_first(faults, state.routine, fault_here)
            continue
        work.extend(_successors(step, address, state))
    depths = {address: state.depth for address, state in seen.items()}
    return depths, sorted(faults.values(), key=lambda fault: fault.address)


def _keep_first(faults: dict[int, MaskFault], routine: int, fault: MaskFault) -> None:
    known = faults.get(routine)
    if known is None or fault.blamed < known.blamed:
        faults[routine] = fault


def _two_depths(
    address: int, first: _State, state: _State, steps: Sequence[Step | None]
) -> MaskFault:
    """The fault of an address that is reached with two depths; the way that jumps is to blame."""
    jump, other = (state, first) if state.origin != address - 1 else (first, state)
    origin = steps[jump.origin] if jump.origin >= 0 else None
    hint = "an instruction must have the same masked regions open on every way to it"
    if origin and "call" in origin.form.effects:
        hint = "every CALL of a routine must stand inside equally many masked regions"
    elif jump.depth > other.depth:
        hint = "is an END missing before the jump?"
    return MaskFault(
        "NP020",
        f"reached with {_regions(other.depth)} open, but from elsewhere with {jump.depth}",
        address,
        jump.origin,
        f"with {_regions(jump.depth)} open it is reached from here",
        hint,
    )


def _check(form: Form, address: int, state: _State, limit: int) -> MaskFault | None:
    effects = form.effects
    if not effects:
        return None
    name = form.mnemonic
    if "mask_push" in effects and state.depth >= limit:
        return MaskFault("NP022", f"more than {limit} masked regions are open", address)
    if ("mask_invert" in effects or "mask_pop" in effects) and state.depth == 0:
        hint = f"{name} belongs to a WHERE above it"
        return MaskFault("NP021", f"{name} without an open masked region", address, hint=hint)
    if "mask_pop" in effects and state.depth <= state.entry:
        return MaskFault(
            "NP023",
            f"{name} closes a masked region that the caller has opened",
            address,
            hint="a routine closes the regions that it has opened itself, and no others",
        )
    if "ret" in effects and state.depth != state.entry:
        return MaskFault(
            "NP023",
            f"{name} with {_regions(state.depth - state.entry)} of this routine still open",
            address,
            hint="flow ignores the mask: close the region with END, then return",
        )
    return None


def _successors(step: Step, address: int, state: _State) -> Iterator[tuple[int, _State]]:
    """Where flow goes on. The last is followed first: what runs first is the measure."""
    form, target = step
    effects = form.effects
    depth = state.depth + ("mask_push" in effects) - ("mask_pop" in effects)
    if target is not None and "call" not in effects:
        yield target, _State(depth, state.entry, state.routine, address)
    if form.falls_through:
        yield address + 1, _State(depth, state.entry, state.routine, address)
    if target is not None and "call" in effects:
        yield target, _State(depth, depth, target, address)


def _regions(number: int) -> str:
    return {0: "no masked region", 1: "1 masked region"}.get(number, f"{number} masked regions")
