"""A copy of the picture with a margin in each NP: the plan for any kernels.

Each NP copies its pixels into a larger picture and fills its margin from the neighbours: first the
rows, then the columns with the corners. After that it needs no neighbour any more, and a loop over
1, 2, 4 or 8 pixels at a time computes all sums.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from npchip.kernels.code import Code, NoRoomError, line
from npchip.kernels.finish import Finish
from npchip.kernels.numbers import Arithmetic, Number
from npchip.kernels.parts import (
    PIXELS,
    PLACE,
    ROW_NAMES,
    Plan,
    Section,
    corrected,
    loop,
    reach,
    registers_for,
    send,
)
from npchip.kernels.strip import Strip
from npchip.kernels.sums import Sums, share

SIGNAL, RESET = 0, 64
AT_ONCE = 12
"""Pixels that are loaded together, in the order of their addresses."""


class Shape(NamedTuple):
    """Words for cycles.

    Attributes:
        copied: pixels copied in one pass of the loop, 8 or 1.
        tile: pixels computed in one pass of the loop: 8, 4, 2 or 1.
    """

    copied: int
    tile: int


SHAPES = tuple(Shape(copied, tile) for tile in (8, 4, 2, 1) for copied in (8, 1))


class _Picture(NamedTuple):
    """The larger picture: the pixels of an NP with a margin from its neighbours.

    Attributes:
        down: rows of the margin above and below.
        across: columns of the margin on each side.
    """

    down: int
    across: int

    @property
    def stride(self) -> int:
        return PIXELS + 2 * self.across

    @property
    def rows(self) -> int:
        return PIXELS + 2 * self.down

    @property
    def begin(self) -> int:
        """Address of its first pixel; only its upper margin may lie where samples are."""
        return 255 - self.stride * self.rows

    def at(self, y: int, x: int) -> int:
        """Address of a pixel, counted from the NP's own first one."""
        return self.begin + self.stride * (y + self.down) + x + self.across


def rows_of(finishes: Sequence[Finish], *, split: bool) -> Sums:
    """Write kernels as sums of the pixels of the rows around; `split` as in `share`."""
    results = {
        how.kernel.name: {
            (ROW_NAMES[y], x): weight for y, x, weight in how.kernel.placed() if weight
        }
        for how in finishes
    }
    return share(results, "b", split=split)


def padded(finishes: Sequence[Finish], sums: Sums, shape: Shape) -> Plan | None:
    """Write the program.

    Args:
        finishes: the kernels.
        sums: the same as `rows_of` gives them.
        shape: pixels at a time.

    Returns:
        The plan; None if it needs more memory than there is.
    """
    picture = _Picture(*reach(finishes))
    sections = _copy(picture, shape.copied)
    if picture.down:
        sections += _margin(picture, rows=True)
    if picture.across:
        sections += _margin(picture, rows=False)
    distances = {name: y for y, name in ROW_NAMES.items()}
    code = Code(PLACE)
    do = Arithmetic(code, max(how.width for how in finishes))

    def load(signal: str, x: int) -> Number:
        register = code.new()
        code.move(picture.at(distances[signal], x) - picture.begin)
        code.note(f"{signal}({x})")
        code.add(f"LD {{0}}, [{PLACE}]", register, made=[register])
        return Number(register)

    strip = Strip(do, sums, range(shape.tile), load)
    for x in range(shape.tile):
        wanted = strip.needed(x)
        if len(wanted) <= AT_ONCE:
            for column in sorted({place for _, place in wanted}):
                rows = sorted((distances[name], name) for name, place in wanted if place == column)
                first = picture.at(rows[0][0], column) - picture.begin
                last = picture.at(rows[-1][0], column) - picture.begin
                if abs(last - code.at) < abs(first - code.at):
                    rows.reverse()
                for _, name in rows:
                    strip.fetch((name, column))
        send(do, strip, finishes, x)
    whole = shape.tile == PIXELS
    code.move(picture.stride if whole else shape.tile)
    named, registers = registers_for([PLACE] if whole else [PLACE, "column"])
    try:
        lines = code.lines(registers, range(picture.begin))
    except NoRoomError:
        return None
    end = picture.at(PIXELS - picture.down, -picture.across)
    sections.append(Section((line(f"MOV {PLACE}, #{picture.begin}"),), 1))
    if whole:
        sections.append(loop(".row", lines, PLACE, end, PIXELS))
    else:
        sections.append(Section((".row:", line("MOV column, #0")), PIXELS))
        lines.append(line(f"ADD column, #{shape.tile}"))
        times = PIXELS * PIXELS // shape.tile
        sections.append(loop(".tile", lines, "column", PIXELS, times))
        turn = [line(f"ADD {PLACE}, #{2 * picture.across}")] if picture.across else []
        closing = loop(".row", turn, PLACE, end, PIXELS)
        sections.append(closing._replace(lines=closing.lines[1:]))
    if shape.copied == 1:
        named = named | {"to": "r13"}
    return Plan(
        f"a picture with a margin, {shape.tile} pixels at a time",
        SIGNAL,
        RESET,
        named,
        tuple(sections),
        (),
        sums.named,
        do.additions / shape.tile,
    )


def _copy(picture: _Picture, copied: int) -> list[Section]:
    """Copy the NP's own pixels, column by column."""
    code = Code(PLACE)
    _, registers = registers_for([PLACE, "column", "to"])
    begin = [line(f"MOV {PLACE}, #0")]
    if copied == PIXELS:
        for y in range(PIXELS):
            code.move(PIXELS * y)
            register = corrected(code)
            code.add(f"ST {code.address(picture.at(y, 0), 128)}, {{0}}", register)
        code.move(1)
        lines = code.lines(registers, ())
        return [Section(tuple(begin), 1), loop(".copy", lines, PLACE, PIXELS, PIXELS)]
    register = corrected(code)
    code.add("ST [to], {0}", register)
    code.move(PIXELS)
    code.add(f"ADD to, #{picture.stride}")
    back, down = PIXELS * PIXELS - 1, PIXELS * picture.stride - 1
    begin = [line(f"MOV {PLACE}, #{back}"), line(f"MOV to, #{(picture.at(0, 0) + down) % 256}")]
    turn = (".copy:", line(f"SUB {PLACE}, #{back}"), line(f"SUB to, #{down}"))
    inner = loop(".pixel", code.lines(registers, ()), PLACE, PIXELS * PIXELS, PIXELS * PIXELS)
    closing = loop(".copy", (), PLACE, back + PIXELS, PIXELS).lines[1:]
    return [Section(tuple(begin), 1), Section(turn, PIXELS), inner, Section(closing, PIXELS)]


def _margin(picture: _Picture, *, rows: bool) -> list[Section]:
    """Fill the margin above and below, or on both sides with the corners."""
    code = Code(PLACE)
    if rows:
        label, start, step = ".above", picture.at(-picture.down, 0), 1
        times, width = PIXELS, picture.down
        sides = ("north", "south")
    else:
        label, start, step = ".beside", picture.begin, picture.stride
        times, width = picture.rows, picture.across
        sides = ("west", "east")
    place = picture.stride if rows else 1

    def at(number: int) -> int:
        return place * (number + width)

    for distance in range(1, width + 1):
        pairs = ((PIXELS - distance, -distance), (distance - 1, PIXELS - 1 + distance))
        for side, (source, target) in zip(sides, pairs, strict=True):
            register = code.new()
            operand = code.address(at(source), 0)
            code.add(f"LD {{0}}, {operand}", register, made=[register])
            code.add(f"NBR {{0}}, {{0}}, {side}", register, changed=[register])
            operand = code.address(at(target), 0)
            code.add(f"ST {operand}, {{0}}", register)
    code.move(step)
    _, registers = registers_for([PLACE])
    lines = code.lines(registers, ())
    begin = Section((line(f"MOV {PLACE}, #{start}"),), 1)
    return [begin, loop(label, lines, PLACE, start + step * times, times)]
