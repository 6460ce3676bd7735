"""The layout of a source: labels, instructions, operands and comments in their columns.

Only blanks change, never a word, so a source means after it what it meant before. Comments of
their own and directives stay where they are, as people set them out in tables.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from npchip.assembler.blocks import CLOSERS
from npchip.isa import Isa
from npchip.language.lines import BRANCHES, ENDS, View, opened, view

STOPS: Final = (8, 16, 32)
"""Columns of instructions, operands and comments."""
STEP: Final = 2
"""Columns by which a masked region is indented."""
_DEEPEST: Final = 8
_COLUMNS: Final = range(STOPS[0], STOPS[0] + STEP * _DEEPEST + 1, STEP)


def laid_out(lines: Sequence[str], isa: Isa) -> list[str]:
    """Return lines in their layout; it is the same for lines that have it.

    An instruction that stands in the column of some depth stays there: people set long regions out
    as they like. Any other goes to the column of its masked region.
    """
    views = [view(line) for line in lines]
    columns = [STOPS[0] + STEP * depth for depth in _depths(views, isa)]
    return [
        _line(line, shown, column)
        for line, shown, column in zip(lines, views, columns, strict=True)
    ]


def _depths(views: Iterable[View], isa: Isa) -> Iterator[int]:
    """Yield how many masked regions are open at each line, as far as the text tells."""
    effects = opened(isa)
    depth, outer = 0, [0]
    for shown in views:
        word = shown.word
        change = effects.get(word.upper()) if word and word[0] != "." else None
        if word in CLOSERS:
            outer.append(depth)
        elif word in BRANCHES:
            depth = outer[-1]
        elif word == ".endm" and len(outer) > 1:
            depth = outer.pop()
        elif word in ENDS and len(outer) > 1:
            outer.pop()
        if change is not None and change <= 0:
            depth = max(depth - 1, 0)
        yield min(depth, _DEEPEST)
        if change is not None and change >= 0:
            depth += 1


def _line(line: str, shown: View, column: int) -> str:
    """Return a line in its layout; an instruction in no column of the layout goes to `column`."""
    tokens, at = shown.tokens, shown.at
    bare = at == len(tokens) - 1  # labels and a comment, or nothing
    if shown.broken or (bare and not at) or shown.word.startswith("."):
        return line.rstrip()
    first = tokens[at]
    code = "".join(f"{token.text}: " for token in shown.labels).rstrip()
    if not bare:
        place = first.column if first.column in _COLUMNS and "\t" not in line else column
        code = f"{code} ".ljust(place) if code else " " * place
        code += first.text
        operands = _operands(line, shown)
        if operands:
            code = f"{code} ".ljust(STOPS[1]) + operands
    comment = shown.comment
    return f"{code} ".ljust(STOPS[2]) + comment if comment else code


def _operands(line: str, shown: View) -> str:
    """Return the operands with no blank before a comma, and at least one after it."""
    text = ""
    end = None
    for token in shown.tokens[shown.at + 1 : -1]:
        if end is not None and token.text != ",":
            gap = line[end : token.column]
            text += gap.replace("\t", " ") or " " * text.endswith(",")
        text += token.text
        end = token.column + len(token.text)
    return text
