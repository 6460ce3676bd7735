"""First down the columns, then along the rows: the plan for kernels whose columns are few.

The first pass goes down each column of pixels and stores its sums in place of the samples that
have been read by then. The second goes along the rows of these sums. Corners need no pixel from a
diagonal neighbour, as they come with the sums of columns.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from npchip.kernels.code import Code, NoRoomError, line
from npchip.kernels.columns import Passes
from npchip.kernels.finish import Finish
from npchip.kernels.numbers import Arithmetic, Number
from npchip.kernels.parts import (
    PIXELS,
    PLACE,
    Plan,
    Section,
    corrected,
    loop,
    reach,
    registers_for,
    send,
)
from npchip.kernels.strip import Instance, Strip

SIGNAL, RESET = 0, 128


class Manner(NamedTuple):
    """A way for the second pass to get numbers from beyond the border of an NP.

    Attributes:
        keep: a number that a neighbour reads at the start of a row stays in its register.
        early: the first numbers of a row are read from the neighbour with the own ones.
    """

    keep: bool
    early: bool


MANNERS = tuple(Manner(keep, early) for keep in (True, False) for early in (True, False))


def columns_first(finishes: Sequence[Finish], passes: Passes, manner: Manner) -> Plan | None:
    """Write the program.

    Args:
        finishes: the kernels.
        passes: the same as sums of columns.
        manner: how the second pass crosses borders.

    Returns:
        The plan; None if it needs more memory than there is.
    """
    down, _ = reach(finishes)
    named, registers = registers_for([PLACE])
    spare = _spare(passes.banks, down)
    width = max(how.width for how in finishes)
    first, second = (Arithmetic(Code(PLACE), width) for _ in range(2))
    _down(first, passes, down)
    _along(second, finishes, passes, manner)
    try:
        column = first.code.lines(registers, [at for at in spare if at % 128 >= 64])
        row = second.code.lines(registers, spare)
    except NoRoomError:
        return None
    begin = (line(f"MOV {PLACE}, #0"),)
    sections = [Section(begin, 1), loop(".column", column, PLACE, PIXELS, PIXELS)]
    if down != 1:
        sections.append(Section((line(f"MOV {PLACE}, #{PIXELS * down}"),), 1))
    end = PIXELS * (PIXELS + down)
    sections.append(loop(".row", row, PLACE, end, PIXELS))
    additions = (first.additions + second.additions) / PIXELS
    return Plan(
        "columns, then rows",
        SIGNAL,
        RESET,
        named,
        tuple(sections),
        passes.down.named,
        passes.along.named,
        additions,
    )


def _spare(banks: Mapping[str, Sequence[int]], down: int) -> list[int]:
    """Memory that holds no sums, and in the upper half of each bank no samples either."""
    used = {bank for some in banks.values() for bank in some}
    start = PIXELS * down
    return [bank + at for bank in (64, 192, 128) if bank not in used for at in range(start, 64)]


def _down(do: Arithmetic, passes: Passes, down: int) -> None:
    """Write the first pass: one column of all NPs, from north to south."""
    code = do.code

    def load(_signal: str, y: int) -> Number:
        if 0 <= y < PIXELS:
            code.move(PIXELS * y)
            code.note(f"p({y})")
            number = Number(corrected(code))
            south = ("p", y + PIXELS)
            if strip.uses[south]:  # the neighbour's first pixels are read together with one's own
                strip.values[south] = neighbour(number, y + PIXELS, "south")
            return number
        assert y < 0
        return neighbour(strip.fetch(("p", y + PIXELS)), y, "north")

    def neighbour(number: Number, y: int, side: str) -> Number:
        register = code.new()
        code.note(f"p({y})")
        code.add(f"NBR {{0}}, {{1}}, {side}", register, number.low, made=[register])
        return Number(register)

    strip = Strip(do, passes.down, range(PIXELS), load)
    for y in range(PIXELS):
        # A sample is read before a sum takes its place, whether or not this sum needs it.
        wanted = set(strip.needed(y))
        wanted |= {("p", row) for row in range(y, y + down + 1) if strip.uses["p", row]}
        if not y:  # those that the neighbour to the north asks for
            wanted |= {("p", row) for row in range(down) if strip.uses["p", row + PIXELS]}
        for instance in sorted(instance for instance in wanted if instance[1] < PIXELS):
            strip.fetch(instance)
        for name, banks in passes.banks.items():
            number, _ = strip.result(name, y)
            if len(banks) > len(number.bytes):
                number = Number(number.low, do.byte(0))
            for bank, register in zip(banks, number.bytes, strict=False):
                operand = code.address(bank + PIXELS * (y + down), bank)
                code.add(f"ST {operand}, {{0}}", register)
    code.move(1)


def _along(
    do: Arithmetic,
    finishes: Sequence[Finish],
    passes: Passes,
    manner: Manner,
) -> None:
    """Write the second pass: one row of all NPs, from west to east."""
    code = do.code

    def read(signal: str, x: int) -> Number:
        registers = []
        for bank in passes.banks[signal]:
            registers.append(code.new())
            operand = code.address(bank + x, bank)
            code.note(f"{signal}({x})")
            code.add(f"LD {{0}}, {operand}", registers[-1], made=registers[-1:])
        return Number(*registers)

    def neighbour(number: Number, name: str, side: str, *, own: bool) -> Number:
        registers = []
        for register in number.bytes:
            target = register if own else code.new()
            code.note(name)
            code.add(
                f"NBR {{0}}, {{1}}, {side}",
                target,
                register,
                made=[] if own else [target],
                changed=[target],
            )
            registers.append(target)
        return Number(*registers)

    def load(signal: str, x: int) -> Number:
        if 0 <= x < PIXELS:
            number = read(signal, x)
            east = (signal, x + PIXELS)
            if manner.early and strip.uses[east] and east not in strip.values:
                strip.values[east] = neighbour(number, f"{signal}({x + PIXELS})", "east", own=False)
            return number
        side, there = ("west", x + PIXELS) if x < 0 else ("east", x - PIXELS)
        if x < 0 and manner.keep and strip.uses[signal, there]:
            return neighbour(strip.fetch((signal, there)), f"{signal}({x})", side, own=False)
        return neighbour(read(signal, there), f"{signal}({x})", side, own=True)

    def order(instance: Instance) -> tuple[int, str]:
        return instance[1], instance[0]

    strip = Strip(do, passes.along, range(PIXELS), load)
    for x in range(PIXELS):
        for instance in sorted(strip.needed(x), key=order):
            strip.fetch(instance)
        send(do, strip, finishes, x)
    code.move(PIXELS)
