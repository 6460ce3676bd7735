"""The loops in which a program is, as far as they take no new frame."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from npchip.program.graph import Graph, Place
from npchip.program.model import Program, SourceLine

Loop = frozenset[Place]


def loops_around(graph: Graph, place: Place) -> list[tuple[Place, Loop]]:
    """Return the loops without an expose that a place is in, the innermost first.

    Args:
        graph: graph of the program.
        place: one of its places.

    Returns:
        first place and places of each loop.
    """
    before: dict[Place, list[Place]] = {}
    for each in graph.successors:
        for after in graph.following(each):
            before.setdefault(after, []).append(each)
    nodes = frozenset(each for each in graph.successors if not graph.exposes(each))
    found: list[tuple[Place, Loop]] = []
    while place in nodes:
        ahead = _reached(graph.following(place), nodes, graph.following)
        loop = ahead & _reached([place], nodes, lambda each: before.get(each, []))
        if place not in loop:
            break
        entered = [each for each in loop if not loop.issuperset(before.get(each, []))]
        first = min(entered or loop, key=lambda each: (len(each.stack), each.address))
        found.append((first, loop))
        nodes = loop - {first}
    return found[::-1]


def _reached(
    start: Iterable[Place], nodes: Loop, following: Callable[[Place], list[Place]]
) -> Loop:
    found: set[Place] = set()
    work = [place for place in start if place in nodes]
    while work:
        place = work.pop()
        if place not in found:
            found.add(place)
            work += [after for after in following(place) if after in nodes]
    return frozenset(found)


def described(program: Program, first: Place, loop: Loop, near: SourceLine | None) -> str:
    """Return the lines or addresses of a loop, and its label, as text.

    Args:
        program: the program.
        first: first place of the loop.
        loop: its places.
        near: a line whose file need not be named.
    """
    addresses = sorted({each.address for each in loop if each.stack == first.stack})
    lines = [line for line in map(program.place, addresses) if line is not None]
    name = program.label_names.get(first.address)
    label = f" from {name}" if name else ""
    if not lines:
        return f"{_range('address', 'addresses', addresses)}{label}"
    outer = [line.written_at for line in lines]
    same = len({(line.file, line.line) for line in outer}) == 1
    shown: list[SourceLine] = lines if same else outer
    here = program.place(first.address)
    file = here.file if here and same else outer[0].file
    numbers = sorted({line.line for line in shown if line.file == file})
    other = "" if near is not None and near.file == file else f" of {file}"
    return f"{_range('line', 'lines', numbers)}{other}{label}"


def _range(one: str, several: str, numbers: list[int]) -> str:
    first, last = numbers[0], numbers[-1]
    return f"{one} {first}" if first == last else f"{several} {first} to {last}"
