"""``.npo``: an assembled program as JSON, with all that a run and its messages need.

The layout is versioned; `words` are hexadecimal texts, one a line, so that a difference between
two versions of a program can be read.
"""

from __future__ import annotations

import json
from types import MappingProxyType
from typing import Any, cast

from npchip.base.errors import InputError
from npchip.base.json import indented
from npchip.isa import Isa
from npchip.program.model import (
    OUTPUT_KINDS,
    PORTS,
    Budget,
    Output,
    OutputKind,
    Program,
    SourceLine,
)

VERSION = 1
_FORMAT = "npchip object"
_MAX_DEPTH = 100  # more than the assembler nests


def to_text(program: Program, isa: Isa) -> str:
    """The text of an object file."""
    lines: dict[SourceLine, int] = {}
    for line in program.source:
        _collect(line, lines)
    document = {
        "format": _FORMAT,
        "version": VERSION,
        "name": program.name,
        "isa": isa.name,
        "geometry": program.geometry,
        "outputs": [{"name": o.name, "port": o.port, "kind": o.kind} for o in program.outputs],
        "budget": {"words": program.budget.words, "cycles": program.budget.cycles},
        "loops": [[address, *passes] for address, passes in program.loops.items()],
        "labels": dict(program.labels),
        "symbols": dict(program.symbols),
        "registers": dict(program.registers),
        "words": [f"{word:04X}" for word in program.words],
        "source": [lines[line] for line in program.source],
        "lines": [
            {
                "file": line.file,
                "line": line.line,
                "text": line.text,
                "from": None if line.expanded_from is None else lines[line.expanded_from],
            }
            for line in lines
        ],
    }
    return indented(document, ascii_only=False)


def _collect(line: SourceLine, lines: dict[SourceLine, int]) -> None:
    """Number a line after those that it was expanded from, so that a reader knows them first."""
    if line not in lines:
        if line.expanded_from is not None:
            _collect(line.expanded_from, lines)
        lines[line] = len(lines)


def from_text(text: str, file: str, isa: Isa) -> Program:
    """Read an object file; `file` is how messages call it.

    Raises:
        InputError: NP111 not an object file, damaged, of another version or instruction set.
    """
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError("NP111", f"{file}: not an object file: {error}") from None
    return _Reader(file, isa).program(data)


class _Reader:
    """Takes a document apart; whatever is not as `to_text` writes it is refused with its name."""

    def __init__(self, file: str, isa: Isa) -> None:
        self._file = file
        self._isa = isa

    def program(self, data: Any) -> Program:
        if not isinstance(data, dict) or data.get("format") != _FORMAT:
            raise self._error("not an object file")
        if data.get("version") != VERSION:
            raise InputError(
                "NP111",
                f"{self._file}: object version {data.get('version')!r}, expected {VERSION}",
                hint="assemble the source again",
            )
        if data.get("isa") != self._isa.name:
            raise self._error(
                f"assembled for the instruction set {data.get('isa')!r}, not {self._isa.name!r}"
            )
        words = self._list(data, "words")
        source = self._source(data)
        if source and len(source) != len(words):
            raise self._error(f"{len(words)} words, but {len(source)} source lines")
        geometry = data.get("geometry")
        if geometry is not None:
            sides = self._list(data, "geometry")
            if len(sides) != 2:
                raise self._error("'geometry' must be two numbers")
            geometry = (self._number(sides[0], "geometry"), self._number(sides[1], "geometry"))
        budget = data.get("budget")
        if not isinstance(budget, dict):
            raise self._error("'budget' must be a mapping")
        return Program(
            name=self._text(data.get("name"), "name"),
            words=tuple(self._word(word) for word in words),
            source=source,
            labels=self._numbers(data, "labels"),
            symbols=self._numbers(data, "symbols"),
            registers=self._registers(data),
            outputs=tuple(self._output(item) for item in self._list(data, "outputs")),
            budget=Budget(self._limit(budget, "words"), self._limit(budget, "cycles")),
            loops=self._loops(data),
            geometry=geometry,
        )

    def _source(self, data: dict[str, Any]) -> tuple[SourceLine, ...]:
        lines: list[SourceLine] = []
        depths: list[int] = []
        for item in self._list(data, "lines"):
            if not isinstance(item, dict):
                raise self._error("'lines' must be mappings")
            origin = item.get("from")
            outer = None if origin is None else self._line(lines, origin)
            depths.append(0 if origin is None else depths[origin] + 1)
            if depths[-1] > _MAX_DEPTH:
                raise self._error(f"lines are expanded more than {_MAX_DEPTH} deep")
            lines.append(
                SourceLine(
                    self._text(item.get("file"), "lines: file"),
                    self._number(item.get("line"), "lines: line"),
                    self._text(item.get("text"), "lines: text"),
                    outer,
                )
            )
        return tuple(self._line(lines, number) for number in self._list(data, "source"))

    def _loops(self, data: dict[str, Any]) -> MappingProxyType[int, tuple[int, int]]:
        loops: dict[int, tuple[int, int]] = {}
        for item in self._list(data, "loops") if "loops" in data else ():
            if not isinstance(item, list) or len(item) != 3:
                raise self._error("'loops' must hold three numbers each")
            address, least, most = (self._number(value, "loops") for value in item)
            if not 1 <= least <= most:
                raise self._error(f"'loops': passes {least} to {most}")
            loops[address] = least, most
        return MappingProxyType(loops)

    def _line(self, lines: list[SourceLine], number: Any) -> SourceLine:
        index = self._number(number, "source")
        if not 0 <= index < len(lines):
            raise self._error(f"source line {index} is not among the lines")
        return lines[index]

    def _output(self, item: Any) -> Output:
        if not isinstance(item, dict):
            raise self._error("'outputs' must be mappings")
        kind, port = item.get("kind"), self._number(item.get("port"), "outputs: port")
        if kind not in OUTPUT_KINDS or not 0 <= port < PORTS:
            raise self._error(f"no such output: port {port}, kind {kind!r}")
        return Output(self._text(item.get("name"), "outputs: name"), port, cast("OutputKind", kind))

    def _word(self, value: Any) -> int:
        digits = self._text(value, "words")
        if len(digits) != 4 or not all(c in "0123456789abcdefABCDEF" for c in digits):
            raise self._error(f"'{digits[:20]}' is not a word of four hexadecimal digits")
        return int(digits, 16)

    def _registers(self, data: dict[str, Any]) -> MappingProxyType[str, int]:
        registers = self._numbers({"registers": {}} | data, "registers")  # files may lack them
        for name, number in registers.items():
            if not 0 <= number < 16:
                raise self._error(f"'registers': {name} is {number}, and no register")
        return registers

    def _numbers(self, data: dict[str, Any], key: str) -> MappingProxyType[str, int]:
        value = data.get(key)
        if not isinstance(value, dict):
            raise self._error(f"'{key}' must be a mapping")
        return MappingProxyType({name: self._number(item, key) for name, item in value.items()})

    def _limit(self, budget: dict[str, Any], key: str) -> int | None:
        value = budget.get(key)
        return None if value is None else self._number(value, f"budget: {key}")

    def _list(self, data: dict[str, Any], key: str) -> list[Any]:
        value = data.get(key)
        if not isinstance(value, list):
            raise self._error(f"'{key}' must be a list")
        return value

    def _number(self, value: Any, key: str) -> int:
        if not isinstance(value, int) or isinstance(value, bool):
            raise self._error(f"'{key}' must hold whole numbers, found {str(value)[:40]!r}")
        return value

    def _text(self, value: Any, key: str) -> str:
        if not isinstance(value, str):
            raise self._error(f"'{key}' must hold texts, found {str(value)[:40]!r}")
        return value

    def _error(self, message: str) -> InputError:
        return InputError("NP111", f"{self._file}: {message}")
