"""Breakpoints that follow their instructions when the program has changed."""

from __future__ import annotations

import re
import zlib
from collections.abc import Sequence
from difflib import SequenceMatcher
from typing import Final

from npchip.debugger.language import CommandError, parse_condition
from npchip.debugger.names import Names
from npchip.program.model import MAX_WORDS, Program, SourceLine

MARKS: Final = re.compile(rf"[a-p]{{4}}( [a-p]{{4}}){{0,{MAX_WORDS - 1}}}")
"""The text that `marks` returns."""

_LINE: Final = re.compile(r'(line\s+|(?P<file>"[^"]*"|[A-Za-z_.][\w./]*)\s*:\s*)(?P<number>\d+)\b')
_AFTER: Final = re.compile(r"(?P<label>[A-Za-z_]\w*)\s*\+\s*(?P<number>\d+)\b(?!\s*[-+*])")
_ADDRESS: Final = re.compile(r"\d\w*\b(?!\s*[-+*])")


def marks(program: Program) -> str:
    """Return a mark for each word of a program, by which the word is found in another version."""
    return " ".join(_mark(program, address) for address in range(len(program.words)))


def _mark(program: Program, address: int) -> str:
    line = program.place(address)
    texts = [str(program.words[address])] if line is None else [item.code for item in line.origins]
    value = zlib.crc32("\n".join(texts).encode("utf-8", "replace"))
    return "".join("abcdefghijklmnop"[value >> shift & 15] for shift in (0, 4, 8, 12))


def followable(stop: str, names: Names) -> bool:
    """Return whether a condition has a place that does not follow by itself, as a label does."""
    word = stop.split(maxsplit=1)[0]
    alone = stop.strip() == word or stop.split()[1] == "if"
    return bool(_places(stop, names)) and not (alone and word in names.program.labels)


def moves(before: Sequence[str], after: Sequence[str]) -> dict[int, int]:
    """Return the new address of each word that is still there, by its old one.

    A word may have changed in its place.
    """
    found: dict[int, int] = {}
    for what, start, end, new, new_end in SequenceMatcher(None, before, after, False).get_opcodes():
        if what == "equal" or (what == "replace" and end - start == new_end - new):
            found.update(zip(range(start, end), range(new, new_end), strict=True))
    return found


def followed(
    stop: str, at: Sequence[object], line: str, known: dict[int, int], names: Names
) -> str:
    """Return a condition that stops where another did before the program changed.

    Args:
        stop: the condition as it was written.
        at: the addresses at which it stopped.
        line: the source line there, or nothing.
        known: the new addresses of words, from `moves`.
        names: the names of the program as it is now.

    Raises:
        LookupError: the instruction is not there any more, or the condition has no such form.
    """
    new = {known[address] for address in at if isinstance(address, int) and address in known}
    if new and _places(stop, names) != new:
        stop = _moved(stop, min(new), line, names)
    if not new & _places(stop, names):
        raise LookupError(stop)
    return stop


def _places(text: str, names: Names) -> frozenset[int]:
    try:
        return parse_condition(text, names).places
    except CommandError:
        return frozenset()


def line_at(stop: str, address: int, names: Names) -> str:
    """Return the text of the source line at which a condition stops; none for an address."""
    place = _LINE.match(stop)
    lines = _lines(place, address, names) if place else []
    below = [item for item in lines if item.line >= int(place["number"])] if place else []
    return min(below, key=lambda item: item.line).code if below else ""


def _lines(place: re.Match[str], address: int, names: Names) -> list[SourceLine]:
    """Return the lines of an address in the file that a condition names, the innermost first."""
    file = place["file"]
    files = names.files_called(file.strip('"')) if file else [names.main_file]
    line = names.program.place(address)
    return [item for item in line.origins if item.file in files] if line else []


def _moved(stop: str, address: int, line: str, names: Names) -> str:
    if place := _LINE.match(stop):
        lines = _lines(place, address, names)
        best = next((item for item in lines if item.code == line), lines[0] if lines else None)
        return _with(stop, place, best.line) if best else stop
    if (place := _AFTER.match(stop)) and place["label"] in names.program.labels:
        distance = address - names.program.labels[place["label"]]
        return _with(stop, place, distance) if distance > 0 else stop
    if place := _ADDRESS.match(stop):
        return f"{address}{stop[place.end() :]}"
    return stop


def _with(stop: str, place: re.Match[str], number: int) -> str:
    return f"{stop[: place.start('number')]}{number}{stop[place.end('number') :]}"
