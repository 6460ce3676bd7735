"""The static view of a program: bounds of its cycles and loops, and reads of unwritten state."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from npchip.isa import Isa, load_isa
from npchip.program.graph import HALTED, RESET, Graph, Place
from npchip.program.loops import AbstractExecution
from npchip.program.paths import CycleRange, Loop, Paths, union
from npchip.program.reads import unwritten

if TYPE_CHECKING:
    from npchip.machine import Machine
    from npchip.program.model import Program


class RoutineCycles(NamedTuple):
    """Cycles from the first instruction of a routine to its return, both included.

    Attributes:
        address: first address of the routine.
        cycles: range over all calls; None if it never returns.
    """

    address: int
    cycles: CycleRange | None


class StaticView(NamedTuple):
    """Properties of every run from reset, for any frames and memory contents.

    Attributes:
        exposes: whether an expose can be reached.
        setup: cycles before the first expose, or up to a HALT; None if neither is reached.
        frame: cycles of a complete frame; None if no frame is ever complete.
        routines: called routines in the order of their addresses.
        loops: reachable loops in the order of their headers.
        runs: for each address the cycles of straight-line code up to and including this word;
            0 if it cannot be reached.
        assumes: for each address the names of the registers and flags that it reads although
            some path from reset has not written them.
    """

    exposes: bool
    setup: CycleRange | None
    frame: CycleRange | None
    routines: tuple[RoutineCycles, ...]
    loops: tuple[Loop, ...]
    runs: tuple[int, ...]
    assumes: dict[int, tuple[str, ...]]


def static_view(program: Program, machine: Machine, isa: Isa | None = None) -> StaticView:
    """Analyse a program without running it.

    Args:
        program: the program, with its ``.loop`` lines.
        machine: cycles and limits.
        isa: the program's instruction set.

    Raises:
        TooManyPlacesError: the program is too large to be analysed.
    """
    isa = isa or load_isa()
    graph = Graph(program.decoded(isa), machine)
    costs = program.cycles(machine, isa)
    execution = AbstractExecution(graph, isa)
    paths = Paths(execution, costs, program.loops)
    exposes = {place for place in execution.after if graph.exposes(place)}
    rest = execution.after.keys() - exposes

    def ends(start: Place, inside: Collection[Place]) -> Iterator[CycleRange]:
        for (_, after), cycles in paths.leaving(start, inside, once=start in exposes).items():
            if after == HALTED or after in exposes:
                yield cycles

    return StaticView(
        exposes=bool(exposes),
        setup=CycleRange(0, 0) if RESET in exposes else union(ends(RESET, rest)),
        frame=union(cycles for place in exposes for cycles in ends(place, rest | {place})),
        routines=tuple(_routines(execution, paths)),
        loops=tuple(paths.loops[address] for address in sorted(paths.loops)),
        runs=tuple(_runs(graph, costs)),
        assumes=unwritten(graph.words, isa, execution.after),
    )


def _routines(execution: AbstractExecution, paths: Paths) -> Iterator[RoutineCycles]:
    found: dict[int, list[CycleRange]] = {}
    for place, following in execution.after.items():
        for start in following:
            depth = len(start.stack)
            if depth <= len(place.stack):
                continue  # not a call, or a conditional call that is not taken
            inside = {item for item in execution.after if item.stack[:depth] == start.stack}
            found.setdefault(start.address, []).extend(
                cycles
                for (_, after), cycles in paths.leaving(start, inside).items()
                if (after.address, after.stack) == (place.address + 1, place.stack)
            )
    for address in sorted(found):
        yield RoutineCycles(address, union(found[address]))


def _runs(graph: Graph, costs: Sequence[int]) -> Iterator[int]:
    targets: set[int] = set()
    branches: set[int] = set()
    for (address, _, _), following in graph.successors.items():
        found = {place.address for place in following if place is not None}
        if found != {address + 1}:
            branches.add(address)
            targets |= found - ({address + 1} if len(following) == 1 else set())
    reached = {place.address for place in graph.successors}
    total = 0
    for address, cost in enumerate(costs):
        if address in targets or address - 1 in branches or address not in reached:
            total = 0
        total += cost if address in reached else 0
        yield total
