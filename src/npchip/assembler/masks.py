"""Every address has one mask depth, whichever way it is reached (decision).

That is what lets a mask be a counter in hardware, and lets the compiled engine know where no
NP can be inactive. The assembler checks it, and so does the loader of a raw image.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from npchip.isa import Decoded, Isa


@dataclass(frozen=True)
class MaskFault:
    """A violation found in a program.

    Attributes:
        code: NP020 two depths, NP021 no open region, NP022 too deep, NP023 unbalanced routine.
        message: what is wrong, in words.
        address: where.
        other: the address that disagrees, if there is one.
        remark: what to say of `other`.
    """

    code: str
    message: str
    address: int
    other: int | None = None
    remark: str = ""


@dataclass(frozen=True)
class _State:
    """On arrival at an address: regions open, and regions open where the routine was entered."""

    depth: int
    entry: int
    origin: int  # address of the instruction that leads here


def mask_depths(
    words: Sequence[int], isa: Isa, limit: int
) -> tuple[dict[int, int], list[MaskFault]]:
    """Follow every path of a program.

    Args:
        words: the program's words.
        isa: the instruction set.
        limit: most regions that may be open at a time.

    Returns:
        The mask depth on arrival at each reachable address, and the faults, at most one for
        each address.
    """
    decoded = [isa.decode(word) for word in words]
    seen: dict[int, _State] = {}
    known: set[tuple[int, int]] = set()
    faults: dict[int, MaskFault] = {}
    work = [(0, _State(0, 0, 0))]
    while work:
        address, state = work.pop()
        if address >= len(words) or (address, state.entry) in known:
            continue
        first = seen.setdefault(address, state)
        if first.depth != state.depth:
            fault = MaskFault(
                "NP020",
                f"reached with {_regions(first.depth)} open and with {_regions(state.depth)}",
                address,
                state.origin,
                f"here the way with {_regions(state.depth)} open comes from",
            )
            faults.setdefault(address, fault)
            continue
        known.add((address, state.entry))
        item = decoded[address]
        if item is None:
            continue  # an undefined word is a trap when it is reached
        fault_here = _check(item, address, state, limit)
        if fault_here:
            faults.setdefault(address, fault_here)
            continue
        work.extend(_successors(item, address, state))
    depths = {address: state.depth for address, state in seen.items()}
    return depths, sorted(faults.values(), key=lambda fault: fault.address)


def _check(item: Decoded, address: int, state: _State, limit: int) -> MaskFault | None:
    effects = item.form.effects
    name = item.form.mnemonic
    if "mask_push" in effects and state.depth >= limit:
        return MaskFault("NP022", f"more than {limit} masked regions are open", address)
    if ("mask_invert" in effects or "mask_pop" in effects) and state.depth == 0:
        return MaskFault("NP021", f"{name} without an open masked region", address)
    if "mask_pop" in effects and state.depth <= state.entry:
        return MaskFault(
            "NP023", f"{name} closes a masked region that the caller has opened", address
        )
    if "ret" in effects and state.depth != state.entry:
        return MaskFault(
            "NP023",
            f"{name} with {_regions(state.depth - state.entry)} still open in this routine",
            address,
        )
    return None


def _successors(item: Decoded, address: int, state: _State) -> Iterator[tuple[int, _State]]:
    effects = item.form.effects
    depth = state.depth + ("mask_push" in effects) - ("mask_pop" in effects)
    if item.form.falls_through:
        yield address + 1, _State(depth, state.entry, address)
    target = item.form.target
    if target is not None:
        to = int(item.values[target])
        entry = depth if "call" in effects else state.entry
        yield to, _State(depth, entry, address)


def _regions(number: int) -> str:
    return {0: "no masked region", 1: "1 masked region"}.get(number, f"{number} masked regions")
