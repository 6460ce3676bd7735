"""The static view of a program: cycles of set-up, frames and routines, loops, reset values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from npchip.isa import Isa, load_isa
from npchip.program.graph import HALTED, Edge, Place, Ways
from npchip.program.loops import Followed
from npchip.program.reads import unwritten
from npchip.program.spans import Loop, Span, Spans

if TYPE_CHECKING:
    from npchip.machine import Machine
    from npchip.program.model import Program


class Routine(NamedTuple):
    """Cycles from the first instruction of a routine to its return, both included.

    Attributes:
        address: where it begins.
        span: over all its callers; None where it never returns.
    """

    address: int
    span: Span | None


class StaticView(NamedTuple):
    """What holds of every run from reset, whatever frames and memory it is given.

    Attributes:
        exposes: whether any way leads to an expose.
        setup: cycles before the first expose, or up to a HALT; None where neither is reached.
        frame: cycles of every complete frame; None where none is ever complete.
        routines: those that are called, in the order of their addresses.
        loops: those that were met, in the order of their headers.
        runs: for each address cycles since the flow last came together or parted, this word
            included: the length of straight-line code.
        assumes: addresses that read a register or flag which some way has not written since
            reset, with the names of what they read.
    """

    exposes: bool
    setup: Span | None
    frame: Span | None
    routines: tuple[Routine, ...]
    loops: tuple[Loop, ...]
    runs: tuple[int, ...]
    assumes: dict[int, tuple[str, ...]]


def static_view(program: Program, machine: Machine, isa: Isa | None = None) -> StaticView:
    """Look at a program without running it.

    Args:
        program: the program, with its ``.loop`` lines.
        machine: whose cycles are counted.
        isa: the program's instruction set.

    Raises:
        TooManyWaysError: it is too large to be looked at.
    """
    ways = Ways(program, machine, isa or load_isa())
    followed = Followed(ways)
    spans = Spans(followed, program.loops)
    exposes = {place for place in followed.after if ways.takes_frame(place)}
    rest = followed.after.keys() - exposes
    start: Place = (0, ())
    setup = Span(0, 0) if start in exposes else _ends(spans.leaving(start, rest).items(), exposes)
    frame: Span | None = None
    for place in exposes:
        found = _ends(spans.leaving(place, rest | {place}, once=True).items(), exposes)
        frame = found.or_(frame) if found else frame
    return StaticView(
        exposes=bool(exposes),
        setup=setup,
        frame=frame,
        routines=tuple(_routines(followed, spans)),
        loops=tuple(spans.loops[address] for address in sorted(spans.loops)),
        runs=tuple(_runs(ways)),
        assumes=unwritten(ways, followed.after),
    )


def _ends(leaving: Iterable[tuple[Edge, Span]], exposes: set[Place]) -> Span | None:
    """Ways to an expose or a HALT, together."""
    found: Span | None = None
    for (_, after), span in leaving:
        if after == HALTED or after in exposes:
            found = span.or_(found)
    return found


def _routines(followed: Followed, spans: Spans) -> Iterator[Routine]:
    found: dict[int, Span | None] = {}
    for place, following in followed.after.items():
        address, stack = place
        decoded = followed.ways.nodes[place].decoded
        if decoded is None or "call" not in decoded.form.effects:
            continue
        for start in following:
            if len(start[1]) <= len(stack):
                continue  # a condition held it back
            known = found.setdefault(start[0], None)
            depth = len(start[1])
            inside = {item for item in followed.after if item[1][:depth] == start[1]}
            for (_, after), span in spans.leaving(start, inside).items():
                if after == (address + 1, stack):
                    known = found[start[0]] = span.or_(known)
    for address in sorted(found):
        yield Routine(address, found[address])


def _runs(ways: Ways) -> Iterator[int]:
    """See `StaticView.runs`; 0 for words that no way leads to."""
    targets: set[int] = set()
    parting: set[int] = set()
    cycles: dict[int, int] = {}
    for (address, _), node in ways.nodes.items():
        cycles[address] = node.cycles
        away = {way[0] for way in (node.taken, node.other) if way is not None}
        if away != {address + 1}:
            parting.add(address)
            targets |= away - ({address + 1} if node.other is None else set())
    total = 0
    for address in range(len(ways.program.words)):
        if address in targets or address - 1 in parting or address not in cycles:
            total = 0
        total += cycles.get(address, 0)
        yield total
