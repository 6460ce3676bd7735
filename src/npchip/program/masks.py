"""Every address has one mask depth, whichever way it is reached (decision).

That is what lets a mask be a counter in hardware, and lets the compiled engine know where no
NP can be inactive. The assembler checks it, and so does the loader of a raw image.
"""

from __future__ import annotations

from typing import NamedTuple

from npchip.isa import Form
from npchip.program.graph import Place, Words
from npchip.program.routines import Finder, Routine


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


def mask_depths(words: Words, limit: int) -> tuple[dict[int, int], list[MaskFault]]:
    """Follow every path of a program.

    Args:
        words: the program.
        limit: most regions that may be open at a time.

    Returns:
        The mask depth on arrival at each reachable address, and the faults, the first of each
        routine: others may only follow from it.
    """
    seen: dict[int, tuple[int, int]] = {}  # depth on the first arrival, and where it comes from
    faults: dict[int, MaskFault] = {}  # by routine

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
            fault = _fault(word.form, address, depth, routine.entry.depth, limit)
        if fault is None:
            return True
        known = faults.get(routine.entry.address)
        if known is None or fault.blamed < known.blamed:
            faults[routine.entry.address] = fault
        return False

    Finder(words, limit, arrive=arrive).follow_all_calls()
    depths = {address: depth for address, (depth, _) in seen.items()}
    return depths, sorted(faults.values(), key=lambda fault: fault.address)


def _two_depths(
    address: int, first: tuple[int, int], again: tuple[int, int], words: Words
) -> MaskFault:
    """The fault of an address that is reached with two depths; the way that jumps is to blame."""
    jump, other = (again, first) if again[1] != address - 1 else (first, again)
    (depth, origin), least = jump, other[0]
    word = words[origin] if origin >= 0 else None
    hint = "an instruction must have the same masked regions open on every way to it"
    if word and "call" in word.form.effects:
        hint = "every CALL of a routine must stand inside equally many masked regions"
    elif depth > least:
        hint = "is an END missing before the jump?"
    return MaskFault(
        "NP020",
        f"reached with {_regions(least)} open, but from elsewhere with {depth}",
        address,
        origin,
        f"with {_regions(depth)} open it is reached from here",
        hint,
    )


def _fault(form: Form, address: int, depth: int, entry: int, limit: int) -> MaskFault | None:
    """What is wrong with an instruction where so many regions are open, and were at the entry."""
    effects = form.effects
    if not effects:
        return None
    name = form.mnemonic
    if "mask_push" in effects and depth >= limit:
        return MaskFault("NP022", f"more than {limit} masked regions are open", address)
    if ("mask_invert" in effects or "mask_pop" in effects) and depth == 0:
        hint = f"{name} belongs to a WHERE above it"
        return MaskFault("NP021", f"{name} without an open masked region", address, hint=hint)
    if "mask_pop" in effects and depth <= entry:
        return MaskFault(
            "NP023",
            f"{name} closes a masked region that the caller has opened",
            address,
            hint="a routine closes the regions that it has opened itself, and no others",
        )
    if "ret" in effects and depth != entry:
        return MaskFault(
            "NP023",
            f"{name} with {_regions(depth - entry)} of this routine still open",
            address,
            hint="flow ignores the mask: close the region with END, then return",
        )
    return None


def _regions(number: int) -> str:
    return {0: "no masked region", 1: "1 masked region"}.get(number, f"{number} masked regions")
