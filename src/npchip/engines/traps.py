"""The traps that the flow of a program can run into, and what each says."""

from __future__ import annotations

from collections.abc import Sequence

from npchip.engines.base import TrapError
from npchip.machine import Machine
from npchip.program.graph import Place


def trap_of_word(words: Sequence[int], address: int) -> TrapError:
    """Return the trap of an address that holds no instruction: NP305 past the end, else NP303."""
    if address >= len(words):
        return TrapError("NP305", f"the program ends at address {len(words) - 1}", address)
    return TrapError("NP303", f"the word 0x{words[address]:04X} is undefined", address)


def trap_of_effect(effect: str, place: Place, machine: Machine) -> TrapError | None:
    """Return the trap that an effect on the flow or the masks is at a place; None if it is none.

    Args:
        effect: name of the effect, as in `npchip.isa.ir`.
        place: address of the instruction, open calls and number of open masked regions.
        machine: limits of both.
    """
    calls, regions = machine.stack_depth, machine.mask_depth
    if effect == "call" and len(place.stack) >= calls:
        return TrapError("NP301", f"more than {calls} calls are open", place.address)
    if effect == "ret" and not place.stack:
        return TrapError("NP302", "no call is open to return from", place.address)
    if effect == "mask_push" and place.depth >= regions:
        return TrapError("NP304", f"more than {regions} masked regions are open", place.address)
    if effect in {"mask_invert", "mask_pop"} and not place.depth:
        return TrapError("NP304", "no masked region is open", place.address)
    return None
