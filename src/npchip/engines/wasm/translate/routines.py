"""Routines that are not copied: one place for each address and mask depth, whoever has called.

Copies of routines are best, as every return has one known successor then; but a routine that
calls another twice, which calls another twice, soon has a thousand of them. Here a return leads
to where any caller of its routine goes on. Which it is, the stack tells at run time.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import chain

from npchip.engines.wasm.translate.steps import Decoder, Place, Step, TooLargeError


@dataclass(eq=False)
class _Routine:
    """What is reached from the entry of a routine without returning from it.

    Attributes:
        places: where it can be.
        callers: return addresses, with the routines that they belong to.
        behind: where its callers go on, by the open masked regions where it returns.
    """

    places: set[Place] = field(default_factory=set)
    callers: list[tuple[int, _Routine]] = field(default_factory=list)
    behind: dict[int, dict[Place, None]] = field(default_factory=dict)


def share(decoder: Decoder, entry: Place, most: int) -> dict[Place, Step]:
    """The steps that `entry` reaches, at places without a stack.

    Args:
        decoder: makes steps.
        entry: where execution begins. What its stack holds are callers of its routine.
        most: places up to which it is done, counted once for each routine that they belong to.

    Raises:
        TooLargeError: there are more, or a call or return is conditional or receives a byte,
            which must not happen where it traps.
    """
    steps: dict[Place, Step] = {}
    routines: dict[Place, _Routine] = {}
    returns: dict[Place, list[dict[Place, None]]] = {}
    first = inner = _Routine()
    for address in reversed(entry.stack):
        outer = _Routine()
        inner.callers.append((address, outer))
        inner = outer
    work = [(first, entry._replace(stack=()))]
    count = 0
    while work:
        routine, place = work.pop()
        if place in routine.places:
            continue
        routine.places.add(place)
        count += 1
        if count > most:
            raise TooLargeError("its routines are too entangled")
        step = steps.get(place)
        if step is None:
            step = steps[place] = decoder.step(place)
        way = decoder.way(step)
        if way is None:
            step.decoded = None
            continue
        target = Place(way.target, (), way.depth)
        if way.flow in {"call", "ret"} and (way.guarded or step.port is not None):
            raise TooLargeError("its calls depend on conditions or inputs")
        if way.flow == "ret":
            if way.depth not in routine.behind:
                routine.behind[way.depth] = {}
                work += [_back(routine, way.depth, caller) for caller in routine.callers]
            returns.setdefault(place, []).append(routine.behind[way.depth])
        elif way.flow == "call":
            step.pushes, step.following = place.address + 1, (target,)
            called = routines.setdefault(target, _Routine())
            caller = step.pushes, routine
            called.callers.append(caller)
            work.append((called, target))
            work += [_back(called, depth, caller) for depth in called.behind]
        else:
            step.following = (target,)
            if way.guarded:
                step.following += (Place(place.address + 1, (), way.depth),)
            work += [(routine, following) for following in step.following]
    for place, behind in returns.items():
        step = steps[place]
        step.following = tuple(dict.fromkeys(chain(*behind)))
        step.returns = bool(step.following)
        if not step.returns:  # nobody has called
            step.decoded = None
    return steps


def _back(routine: _Routine, depth: int, caller: tuple[int, _Routine]) -> tuple[_Routine, Place]:
    """Let a routine return to a caller; what is reached by that."""
    address, outer = caller
    place = Place(address, (), depth)
    routine.behind[depth][place] = None
    return outer, place
