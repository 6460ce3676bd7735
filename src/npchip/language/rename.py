"""All places of a name, in every program that has it, and another name in them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from npchip.assembler.symbols import REGISTERS
from npchip.base.errors import InputError
from npchip.language.analysis import Analysis, Analyst
from npchip.language.names import Name, Use

_CODE: Final = "NP671"
_PLAIN: Final = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_LOCAL: Final = re.compile(r"\.[A-Za-z_]\w*", re.ASCII)
_EXPECT: Final = re.compile(r"^\s*;+\s*expect:", re.IGNORECASE)
_DEFINES: Final = re.compile(r"(?<=\s)define=\S+")
_RUN: Final = re.compile(r"^\s*;+\s*run:", re.IGNORECASE)


class Place(NamedTuple):
    """A place of a name; `line` counts from 1, `column` from 0."""

    path: Path
    line: int
    column: int
    length: int
    defines: bool


class Everywhere(NamedTuple):
    """All places of a name, and the name in each program that has it."""

    places: list[Place]
    programs: list[tuple[Analysis, Name]]


def everywhere(
    found: Use, analysis: Analysis, programs_of: Callable[[Path], Iterable[Analysis]]
) -> Everywhere:
    """Return all places of a name, in every program that has one of them.

    What a library uses may be defined in each program anew: these are one name then.

    Args:
        found: one of its places.
        analysis: the program of that place.
        programs_of: gives the programs that a file belongs to.
    """
    result: dict[tuple[Path, int, int], Place] = {}
    work = [(analysis, found.name)]
    programs = {(analysis.root, found.name): analysis}
    while work:
        program, name = work.pop()
        for use in program.names.all(name):
            place = place_of(use, program)
            if result.setdefault(place[:3], place) is not place:
                continue
            for other in programs_of(place.path):
                file = other.file(place.path)
                same = other.names.at(file, place.line, place.column) if file else None
                if same is None or same.span.column != place.column:
                    continue
                if (other.root, same.name) not in programs:
                    programs[other.root, same.name] = other
                    work.append((other, same.name))
    return Everywhere(
        sorted(result.values()), [(item, name) for (_, name), item in programs.items()]
    )


def place_of(use: Use, analysis: Analysis) -> Place:
    """Return the place of a name."""
    path = analysis.paths[use.span.line.file]
    line, column, length = use.span
    return Place(path, line.number, column, length, use.kind is not None)


def check_new(new: str, name: Name, programs: Iterable[Analysis]) -> None:
    """Check that a name can be called otherwise.

    Raises:
        InputError: NP671, the new name is none, or is taken.
    """
    local = name.space == "local"
    if not (_LOCAL if local else _PLAIN).fullmatch(new):
        form = "a dot, then a name" if local else "letters A to Z, digits and _, no digit first"
        raise InputError(_CODE, f"'{new[:40]}' is no name here: it consists of {form}")
    for program in programs:
        if new.lower() in REGISTERS or new.upper() in program.isa.forms:
            raise InputError(_CODE, f"'{new}' is a word of the language")
        if not local and (new in program.values or _taken(new, name, program)):
            raise InputError(_CODE, f"'{new}' is defined already in {program.root.name}")


def _taken(new: str, name: Name, program: Analysis) -> bool:
    spaces = {"output"} if name.space == "output" else {"name", "macro", "parameter"}
    return any(use.name.text == new and use.name.space in spaces for use in program.names.uses)


def in_tests(name: Name, lines: Sequence[str]) -> Iterator[tuple[int, int]]:
    """Yield line, from 1, and column of a name in the test lines of a source."""
    word = rf"(?<![\w.]){re.escape(name.text)}(?![\w-])"
    for number, line in enumerate(lines, 1):
        if name.space == "output" and _EXPECT.match(line):
            head = re.compile(word)
            yield from ((number, item.start()) for item in head.finditer(line, line.index(":")))
        elif name.space == "name" and _RUN.match(line):
            define = re.compile(rf"(?<=[=,]){re.escape(name.text)}(?==)")
            for option in _DEFINES.finditer(line):
                yield from (
                    (number, item.start()) for item in define.finditer(line, *option.span())
                )


def same_words(changed: Mapping[Path, str], programs: Sequence[Analysis], analyst: Analyst) -> None:
    """Check that programs are the same words with changed texts.

    Raises:
        InputError: NP671, a program would change.
    """
    kept = analyst.texts
    try:
        analyst.texts = {**kept, **changed}
        for before in programs:
            after = analyst.analyse(before.root)
            if _words(before) != _words(after):
                raise InputError(_CODE, f"{before.root.name} would no longer be the same program")
    finally:
        analyst.texts = kept


def _words(analysis: Analysis) -> object:
    examined = analysis.examined
    if examined is None or examined.program is None:
        return [fault["code"] for fault in analysis.faults]
    return examined.program.words
