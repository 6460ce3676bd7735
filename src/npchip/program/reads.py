"""Registers and flags that are read before they are written."""

from __future__ import annotations

import operator
from collections import deque
from collections.abc import Collection, Mapping
from typing import Final

from npchip.isa import Decoded, Isa, ir
from npchip.isa.ir import FLAGS, REGISTERS
from npchip.program.graph import RESET, Place, Words, word_at
from npchip.program.known import VARIABLES

_ALL: Final = (1 << VARIABLES) - 1
_NAMES: Final = (*(f"r{number}" for number in range(REGISTERS)), "Z", "C")


def reads_and_writes(decoded: Decoded, isa: Isa) -> tuple[int, int]:
    """Return the bits of the variables that a word depends on, and of those that it writes.

    ``SBC r2, r2`` does not depend on r2. A new Z does not count as dependent on the old Z, as in
    comparisons of longer numbers.
    """
    reads = writes = 0
    for statement in decoded.form.statements:
        match statement:
            case ir.SetRegister(name=name, value=value):
                reads |= _reads(value, decoded, isa) & ~writes
                writes |= 1 << int(decoded.values[name])
            case ir.SetFlag(name=name, value=value):
                own = 1 << FLAGS[name]
                found = _reads(value, decoded, isa)
                reads |= (found & ~own if name == "Z" else found) & ~writes
                writes |= own
            case _:
                reads |= _reads(statement, decoded, isa)
    return reads, writes


def _reads(node: ir.Node, decoded: Decoded, isa: Isa) -> int:
    match node:
        case ir.Register(name=name):
            return 1 << int(decoded.values[name])
        case ir.Flag(name=name):
            return 1 << FLAGS[name]
        case ir.Condition(name=name):
            return _reads(isa.meanings[str(decoded.values[name])], decoded, isa)
        case ir.Operation(op="-" | "==" | "^" | "borrow") if ir.same_register(node, decoded.values):
            return _reads(node.args[2], decoded, isa) if len(node.args) > 2 else 0
    found = 0
    for child in ir.children(node):
        found |= _reads(child, decoded, isa)
    return found


def unwritten(
    words: Words,
    isa: Isa,
    after: Mapping[Place, Collection[Place]],
    *,
    on_every_way: bool = False,
) -> dict[int, tuple[str, ...]]:
    """Return the addresses that read unwritten variables, with the names of these.

    Args:
        words: the program.
        isa: the program's instruction set.
        after: for each place its possible successors.
        on_every_way: whether no path from reset may have written a variable; else it is enough
            that one path has not.
    """
    combine = operator.and_ if on_every_way else operator.or_
    reached = {place.address for place in after}
    found_words = ((address, word_at(words, address)) for address in reached)
    table = {address: reads_and_writes(word, isa) for address, word in found_words if word}
    missing: dict[Place, int] = {RESET: _ALL}
    work = deque(missing)
    while work:
        place = work.popleft()
        left = missing[place] & ~table[place.address][1] if place.address in table else 0
        for way in after.get(place, ()):
            new = combine(missing.get(way, left), left)
            if way in after and new != missing.get(way):
                missing[way] = new
                work.append(way)
    found: dict[int, int] = {}
    for (address, _, _), bits in missing.items():
        if address in table:
            left = bits & table[address][0]
            found[address] = combine(found.get(address, left), left)
    return {
        address: tuple(name for number, name in enumerate(_NAMES) if left >> number & 1)
        for address, left in sorted(found.items())
        if left
    }
