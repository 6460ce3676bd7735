"""Random loops: each a counter's way from a first value to the one that ends the loop.

Counters count down, up to a number, or shift a bit until it falls out, so that a compiler that
follows values meets every way in which the number of passes may be known.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random


@dataclass(frozen=True)
class Loop:
    """Lines around the body of a loop; ``{l}`` stands for its label and ``{c}`` for its counter.

    Attributes:
        kind: for the comment beside the label.
        passes: how often the body is executed at most.
        before: in front of the label.
        first: behind the label; may leave to ``{l}_end``.
        step: behind the body: changes the counter and the flags.
        back: leads to the label.
    """

    kind: str
    passes: int
    before: Sequence[str]
    first: Sequence[str]
    step: Sequence[str]
    back: str


def draw_loop(random: Random, most: int, *, masked: bool) -> Loop:
    """A loop that ends whatever its body does, if that leaves the counter alone.

    Args:
        random: draws it.
        most: passes.
        masked: inside a masked region, where maybe no NP is active: then JNONE always leads back.
    """
    passes = min(most, random.choice([1, 2, 2, 3, 3, 4, 5, 8, 8, 16, 255]))
    makers: Sequence[Callable[[Random, int, bool], Loop]] = (
        _down,
        _down,
        _up,
        _up,
        _lower,
        _left,
        _left,
        _right,
        _right,
        _until_zero,
        _borrow,
        _test_first,
    )
    return random.choice(makers)(random, passes, masked)


def plain_loop(random: Random, most: int) -> Loop:
    """A loop as most programs have it: its counter is counted down to 0."""
    passes = min(most, random.randrange(1, 4))
    return Loop(
        "counts down", passes, [f"MOV {{c}}, #{passes}"], [], ["SUB {c}, #1"], "JANY NE, {l}"
    )


def _back(random: Random, again: str, done: str, masked: bool) -> str:
    """A branch that leads back where `again` holds in all NPs, and `done` is its opposite."""
    if masked or random.randrange(2):
        return f"JANY {again}, {{l}}"
    return f"JNONE {done}, {{l}}"


def _down(random: Random, passes: int, masked: bool) -> Loop:
    step = random.choice([["SUB {c}, #1"], ["ADD {c}, #255"]])
    back = _back(random, "NE", "EQ", masked)
    return Loop("counts down", passes, [f"MOV {{c}}, #{passes}"], [], step, back)


def _up(random: Random, passes: int, masked: bool) -> Loop:
    step, first = (
        random.choice([1, 1, 2, 3, 8, 16]),
        random.choice([0, 0, 64, random.randrange(256)]),
    )
    end = (first + step * passes) % 256
    if step * passes >= 256:
        passes, step, end = min(passes, 255), 1, (first + min(passes, 255)) % 256
    steps = [f"ADD {{c}}, #{step}", f"CMP {{c}}, #{end}"]
    back = _back(random, "NE", "EQ", masked)
    return Loop("counts up", passes, [f"MOV {{c}}, #{first}"], [], steps, back)


def _lower(random: Random, passes: int, masked: bool) -> Loop:
    step = random.choice([1, 1, 2, 5])
    passes = min(passes, 200 // step)
    first = random.randrange(256 - step * passes)
    end = first + step * passes - random.randrange(step)
    steps = [f"ADD {{c}}, #{step}", f"CMP {{c}}, #{end}"]
    back = _back(random, "LO", "HS", masked)
    return Loop("counts while lower", passes, [f"MOV {{c}}, #{first}"], [], steps, back)


def _left(random: Random, passes: int, masked: bool) -> Loop:
    """A bit that is shifted out at the left ends it; what follows it may be anything."""
    passes = min(passes, 8)
    first = 1 << 8 - passes
    if random.randrange(4) == 0:
        first += random.randrange(first)
    step = random.choice(["ADD {c}, {c}", "ADC {c}, {c}", "ADC {c}, {c}", "SHL {c}, #1"])
    back = _back(random, "HS", "LO", masked)
    return Loop("bit to the left", passes, [f"MOV {{c}}, #{first}"], [], [step], back)


def _right(random: Random, passes: int, masked: bool) -> Loop:
    passes = min(passes, 8)
    first = 1 << passes - 1
    step = random.choice(["RCR {c}", "RCR {c}", "SHR {c}, #1"])
    if random.randrange(4) == 0:  # bits in front of the one that ends it
        first += (random.randrange(256) << passes) & 255
    back = _back(random, "HS", "LO", masked)
    return Loop("bit to the right", passes, [f"MOV {{c}}, #{first}"], [], [step], back)


def _until_zero(random: Random, passes: int, masked: bool) -> Loop:
    passes = min(passes, 8)
    lines = [(1 << passes - 1, "SHR {c}, #1"), (1 << 8 - passes, "SHL {c}, #1")]
    first, step = random.choice(lines)
    if passes == 8 and random.randrange(2):
        first, step, passes = random.choice([(255, "SHR {c}, #3", 3), (85, "SHL {c}, #2", 4)])
    back = _back(random, "NE", "EQ", masked)
    return Loop("until nothing is left", passes, [f"MOV {{c}}, #{first}"], [], [step], back)


def _borrow(random: Random, passes: int, masked: bool) -> Loop:
    step = random.choice([1, 3, 10])
    passes = min(passes, 256 // step)
    first = step * (passes - 1) + random.randrange(step)
    back = _back(random, "HS", "LO", masked)
    line = f"SUB {{c}}, #{step}"
    return Loop("until it borrows", passes, [f"MOV {{c}}, #{first}"], [], [line], back)


def _test_first(random: Random, passes: int, masked: bool) -> Loop:
    """The test stands before the body, which an empty region does not enter."""
    first = random.randrange(256 - passes)
    leave = "JNONE NE" if masked or random.randrange(2) else "JANY EQ"
    return Loop(
        "tests first",
        passes,
        [f"MOV {{c}}, #{first}"],
        [f"CMP {{c}}, #{first + passes}", f"{leave}, {{l}}_end"],
        ["ADD {c}, #1"],
        "JMP {l}",
    )
