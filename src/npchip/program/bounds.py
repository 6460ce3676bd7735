"""The static view of a program: cycles of set-up, frames and routines, loops, reset values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from npchip.isa import Isa, load_isa
from npchip.program.graph import HALTED, RESET, Edge, Graph, Place
from npchip.program.loops import Followed
from npchip.program.paths import CycleRange, Loop, Paths
from npchip.program.reads import unwritten

if TYPE_CHECKING:
    from npchip.machine import Machine
    from npchip.program.model import Program


class RoutineCycles(NamedTuple):
    """Cycles from the first instruction of a routine to its return, both included.

    Attributes:
        address: where it begins.
        cycles: over all its callers; None where it never returns.
    """

    address: int
    cycles: CycleRange | None


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
    setup: CycleRange | None
    frame: CycleRange | None
    routines: tuple[RoutineCycles, ...]
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
        TooManyPlacesError: it is too large to be looked at.
    """
    isa = isa or load_isa()
    graph = Graph(program.decoded(isa), machine)
    costs = program.cycles(machine, isa)
    followed = Followed(graph, isa)
    paths = Paths(followed, costs, program.loops)
    exposes = {place for place in followed.after if graph.exposes(place)}
    rest = followed.after.keys() - exposes
    setup: CycleRange | None = CycleRange(0, 0)
    if RESET not in exposes:
        setup = _ends(paths.leaving(RESET, rest).items(), exposes)
    frame: CycleRange | None = None
    for place in exposes:
        found = _ends(paths.leaving(place, rest | {place}, once=True).items(), exposes)
        frame = found.or_(frame) if found else frame
    return StaticView(
        exposes=bool(exposes),
        setup=setup,
        frame=frame,
        routines=tuple(_routines(followed, paths)),
        loops=tuple(paths.loops[address] for address in sorted(paths.loops)),
        runs=tuple(_runs(graph, costs)),
        assumes=unwritten(graph.words, isa, followed.after),
    )


def _ends(leaving: Iterable[tuple[Edge, CycleRange]], exposes: set[Place]) -> CycleRange | None:
    """Ways to an expose or a HALT, together."""
    found: CycleRange | None = None
    for (_, after), cycles in leaving:
        if after == HALTED or after in exposes:
            found = cycles.or_(found)
    return found


def _routines(followed: Followed, paths: Paths) -> Iterator[RoutineCycles]:
    found: dict[int, CycleRange | None] = {}
    for place, following in followed.after.items():
        for start in following:
            depth = len(start.stack)
            if depth <= len(place.stack):
                continue  # it is no call, or a condition held it back
            known = found.setdefault(start.address, None)
            inside = {item for item in followed.after if item.stack[:depth] == start.stack}
            for (_, after), cycles in paths.leaving(start, inside).items():
                if (after.address, after.stack) == (place.address + 1, place.stack):
                    known = found[start.address] = cycles.or_(known)
    for address in sorted(found):
        yield RoutineCycles(address, found[address])


def _runs(graph: Graph, costs: Sequence[int]) -> Iterator[int]:
    """See `StaticView.runs`; 0 for words that no way leads to."""
    targets: set[int] = set()
    parting: set[int] = set()
    for (address, _, _), ways in graph.successors.items():
        away = {way.address for way in ways if way is not None}
        if away != {address + 1}:
            parting.add(address)
            targets |= away - ({address + 1} if len(ways) == 1 else set())
    reached = {place.address for place in graph.successors}
    total = 0
    for address, cost in enumerate(costs):
        if address in targets or address - 1 in parting or address not in reached:
            total = 0
        total += cost if address in reached else 0
        yield total
