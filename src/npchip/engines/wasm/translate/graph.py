"""Builds the control-flow graph of a program: the words that it can reach, as blocks.

Routines are copied for each caller, so that every return has one known successor.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import chain
from typing import Final

from npchip.engines.wasm.translate.steps import Block, Step, TooLargeError, is_foreign
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.graph import MAX_PLACES, Place, Words, successors, word_at
from npchip.program.model import Program

MOST: Final = 60_000
"""Highest cost of all steps (`Step.cost`): the program is ready within a second."""
_COSTLIEST: Final = 2000
"""Highest cost of a block (`Block.cost`): Cranelift's time grows faster than a block's length."""


def build(program: Program, machine: Machine, isa: Isa, entry: Place, longest: int) -> list[Block]:
    """Return the blocks that `entry` reaches, in reverse postorder.

    Args:
        program: the program.
        machine: its limits and cycles.
        isa: the instruction set.
        entry: place where execution begins.
        longest: most steps of a block.

    Raises:
        TooLargeError: there are more than `MAX_PLACES`, or the steps cost more than `MOST`.
    """
    words = [
        None if word is None or is_foreign(word, machine) else word for word in program.decoded(isa)
    ]
    steps: dict[Place, Step] = {}
    work = [entry]
    cost = 0
    while work:
        place = work.pop()
        if place in steps:
            continue
        step = steps[place] = _step(words, machine, place)
        work.extend(step.following)
        cost += step.cost
        if len(steps) > MAX_PLACES or cost > MOST:
            raise TooLargeError("its routines would have to be copied too often")
    order = _reverse_postorder(entry, {place: step.following for place, step in steps.items()})
    numbers = {place: number for number, place in enumerate(order)}
    blocks = [
        Block(number, [steps[place]], [numbers[after] for after in steps[place].following])
        for number, place in enumerate(order)
    ]
    return joined(blocks, longest)


def _step(words: Words, machine: Machine, place: Place) -> Step:
    """Return the step at a place. A word that may trap leaves the module."""
    word = word_at(words, place.address)
    following = successors(words, machine, place)
    if word is None or not following or following[0] is None:
        return Step(place, None)
    cycles = machine.cycles(word.form.timing)
    return Step(place, word, cycles, tuple(filter(None, following)), port=word.port)


def joined(blocks: Sequence[Block], longest: int, gone: Collection[int] = ()) -> list[Block]:
    """Join blocks of which each has no other successor or predecessor, and number them anew.

    Args:
        blocks: blocks in reverse postorder.
        longest: most steps of a block.
        gone: numbers of blocks that are unreachable.
    """
    edges = Counter(chain([0], *(block.after for block in blocks if block.number not in gone)))
    inside = set(gone)
    found: list[Block] = []
    for block in blocks:
        if block.number in inside:
            continue
        steps, after, cost = block.steps, block.after, block.cost
        while len(after) == 1 and edges[after[0]] == 1:
            following = blocks[after[0]]
            if following.first.alone:
                break
            cost += following.cost
            if len(steps) + len(following.steps) > longest or cost > _COSTLIEST:
                break
            inside.add(following.number)
            steps = steps + following.steps  # a new list
            after = following.after
        found.append(Block(block.number, steps, list(after), bounds=block.bounds))
    numbers = {block.number: index for index, block in enumerate(found)}
    for block in found:
        block.number = numbers[block.number]
        block.after = [numbers[number] for number in block.after]
    for block in found:
        for number in block.after:
            found[number].before.append(block.number)
    return found


def _reverse_postorder(entry: Place, following: Mapping[Place, Sequence[Place]]) -> list[Place]:
    done: list[Place] = []
    seen = {entry}
    path: list[tuple[Place, Iterator[Place]]] = [(entry, iter(following[entry]))]
    while path:
        place, rest = path[-1]
        unseen = next((item for item in rest if item not in seen), None)
        if unseen is None:
            done.append(place)
            path.pop()
        else:
            seen.add(unseen)
            path.append((unseen, iter(following[unseen])))
    return done[::-1]
