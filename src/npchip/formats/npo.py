"""``.npo``: an assembled program as JSON, with everything that a run and its messages need.

The layout is versioned. `words` are hexadecimal texts, one a line, so that two versions of a
program can be compared as text.
"""

from __future__ import annotations

import json
import re
from typing import Any, Final, TypeVar

from npchip.assembler.diagnostics import Line, SourceError
from npchip.assembler.expressions import evaluate
from npchip.assembler.lexer import SOURCE, Token, read_tokens
from npchip.assembler.requirements import HINT, geometry, unmet
from npchip.base.errors import InputError
from npchip.base.frozen import FrozenMap
from npchip.base.json import indented
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.model import (
    MAX_AHEAD,
    MAX_WORDS,
    OUTPUT_FORMS,
    OUTPUT_KINDS,
    PORTS,
    Budget,
    Initial,
    Output,
    Position,
    Program,
    Requirement,
    SourceLine,
)

_T = TypeVar("_T")

VERSION = 1
_FORMAT = "npchip object"
_MAX_DEPTH = 100  # more than the assembler nests
_WANTED: Final[dict[type, str]] = {
    str: "hold texts, found {!r}",
    int: "hold whole numbers, found {!r}",
    list: "be a list",
    dict: "be a mapping",
}


def to_text(program: Program, isa: Isa) -> str:
    """Return the text of an object file."""
    lines: dict[SourceLine, int] = {}
    for line in program.source:
        for origin in reversed(line.origins):  # a line follows those that it was expanded from
            lines.setdefault(origin, len(lines))
    document = {
        "format": _FORMAT,
        "version": VERSION,
        "name": program.name,
        "isa": isa.name,
        "geometry": program.geometry,
        "outputs": [{"name": o.name, "port": o.port, "kind": o.kind} for o in program.outputs],
        "positions": [list(item) for item in program.positions],
        "budget": {"words": program.budget.words, "cycles": program.budget.cycles},
        "requirements": [list(item) for item in program.requirements],
        "loops": [[address, *passes] for address, passes in program.loops.items()],
        "memory": [
            [item.address, item.place, [plane.hex() for plane in item.planes or ()]]
            for item in program.memory
        ],
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
            | ({"copy": line.copy} if line.copy else {})
            for line in lines
        ],
    }
    return indented(document, ascii_only=False)


class _DamagedError(Exception):
    """A document that `to_text` would not have written."""


def from_text(text: str, file: str, isa: Isa) -> Program:
    """Return the program in an object file, which messages call `file`.

    Raises:
        InputError: NP111 not an object file, damaged, of another version or instruction set.
    """
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError("NP111", f"{file}: not an object file: {error}") from None
    if not isinstance(data, dict) or data.get("format") != _FORMAT:
        raise InputError("NP111", f"{file}: not an object file")
    if data.get("version") != VERSION:
        raise InputError(
            "NP111",
            f"{file}: object version {data.get('version')!r}, expected {VERSION}",
            hint="assemble the source again",
        )
    if data.get("isa") != isa.name:
        message = f"assembled for the instruction set {data.get('isa')!r}, not {isa.name!r}"
        raise InputError("NP111", f"{file}: {message}")
    try:
        return _program(data)
    except _DamagedError as error:
        raise InputError("NP111", f"{file}: {error}") from None


def check_requirements(program: Program, machine: Machine, file: str) -> None:
    """Check the conditions of an object, called `file` in messages, for a machine.

    Raises:
        InputError: NP032 one does not hold, NP111 one cannot be read.
    """
    known = geometry(machine)

    def value(token: Token) -> int:
        if token.text not in known:
            raise SourceError("NP007", f"unknown name '{token.text}'", token.span)
        return known[token.text]

    for condition, reason in program.requirements:
        try:
            tokens: list[Token] = []
            read_tokens(Line(file, 1, condition), SOURCE, 0, tokens)
            holds = evaluate(tokens[:-1], tokens[-1], value)
        except SourceError as error:
            message = f"{file}: the condition '{condition[:60]}': {error.diagnostic.message}"
            raise InputError("NP111", message) from None
        if not holds:
            message = unmet(tokens[:-1], reason, value)
            raise InputError("NP032", f"{file}: {message} on machine {machine.name}", hint=HINT)


def _program(data: dict[str, Any]) -> Program:
    words = _list(data, "words")
    if len(words) > MAX_WORDS:
        raise _DamagedError(f"{len(words)} words, more than any ROM's {MAX_WORDS}")
    source = _source(data)
    if source and len(source) != len(words):
        raise _DamagedError(f"{len(words)} words, but {len(source)} source lines")
    geometry = None
    if data.get("geometry") is not None:
        sides = _list(data, "geometry")
        if len(sides) != 2:
            raise _DamagedError("'geometry' must be two numbers")
        geometry = (_checked(int, sides[0], "geometry"), _checked(int, sides[1], "geometry"))
    budget = _checked(dict, data.get("budget"), "budget")
    outputs = _outputs(data)
    return Program(
        name=_checked(str, data.get("name"), "name"),
        words=tuple(map(_word, words)),
        source=source,
        labels=_numbers(data, "labels"),
        symbols=_numbers(data, "symbols"),
        registers=_registers(data),
        outputs=outputs,
        budget=Budget(_limit(budget, "words"), _limit(budget, "cycles")),
        loops=_loops(data),
        requirements=_requirements(data),
        positions=_positions(data, outputs),
        geometry=geometry,
        memory=_memory(data, geometry),
    )


def _source(data: dict[str, Any]) -> tuple[SourceLine, ...]:
    lines: list[SourceLine] = []
    for item in _list(data, "lines"):
        _checked(dict, item, "lines", "be mappings")
        origin = item.get("from")
        outer = None if origin is None else _line(lines, origin)
        if outer is not None and len(outer.origins) > _MAX_DEPTH:
            raise _DamagedError(f"lines are expanded more than {_MAX_DEPTH} deep")
        file = _checked(str, item.get("file"), "lines: file")
        number = _checked(int, item.get("line"), "lines: line")
        text = _checked(str, item.get("text"), "lines: text")
        copy = _checked(int, item.get("copy", 0), "lines: copy")  # files may lack it
        lines.append(SourceLine(file, number, text, outer, copy))
    return tuple(_line(lines, number) for number in _list(data, "source"))


def _line(lines: list[SourceLine], number: Any) -> SourceLine:
    index = _checked(int, number, "source")
    if not 0 <= index < len(lines):
        raise _DamagedError(f"source line {index} is not among the lines")
    return lines[index]


def _loops(data: dict[str, Any]) -> FrozenMap[int, tuple[int, int]]:
    loops: dict[int, tuple[int, int]] = {}
    for item in _list(data, "loops") if "loops" in data else ():
        if not isinstance(item, list) or len(item) != 3:
            raise _DamagedError("'loops' must hold three numbers each")
        address, least, most = (_checked(int, value, "loops") for value in item)
        if not 1 <= least <= most:
            raise _DamagedError(f"'loops': passes {least} to {most}")
        loops[address] = least, most
    return FrozenMap(loops)


def _requirements(data: dict[str, Any]) -> tuple[Requirement, ...]:
    requirements: list[Requirement] = []
    for item in _list({"requirements": []} | data, "requirements"):  # files may lack them
        if not isinstance(item, list) or len(item) != 2:
            raise _DamagedError("'requirements' must hold a condition and a reason each")
        requirements.append(Requirement(*(_checked(str, text, "requirements") for text in item)))
    return tuple(requirements)


def _positions(data: dict[str, Any], outputs: tuple[Output, ...]) -> tuple[Position, ...]:
    named = {output.name for output in outputs if OUTPUT_FORMS[output.kind] == "integer"}
    positions: list[Position] = []
    for item in _list({"positions": []} | data, "positions"):  # files may lack them
        if not isinstance(item, list) or len(item) != 3:
            raise _DamagedError("'positions' must hold two outputs and a number each")
        row, col = (_checked(str, name, "positions") for name in item[:2])
        ahead = _checked(int, item[2], "positions")
        if not {row, col} <= named or not 0 <= ahead <= MAX_AHEAD:
            raise _DamagedError(f"no such position: {row[:40]}, {col[:40]}, {ahead}")
        positions.append(Position(row, col, ahead))
    return tuple(positions)


def _memory(data: dict[str, Any], geometry: tuple[int, int] | None) -> tuple[Initial, ...]:
    rows, columns = geometry or (0, 0)
    found: list[Initial] = []
    for item in _list({"memory": []} | data, "memory"):  # files may lack them
        if not isinstance(item, list) or len(item) != 3 or not isinstance(item[2], list):
            raise _DamagedError("'memory' must hold an address, a place and bytes each")
        address = _checked(int, item[0], "memory")
        if not 0 <= address <= 255:
            raise _DamagedError(f"'memory': no such address: {address}")
        try:
            planes = tuple(bytes.fromhex(_checked(str, plane, "memory")) for plane in item[2])
        except ValueError:
            raise _DamagedError("'memory': no hexadecimal bytes") from None
        if any(len(plane) != rows * columns for plane in planes):
            raise _DamagedError(f"'memory': bytes of {rows} x {columns} NPs expected")
        found.append(Initial(address, "", _checked(str, item[1], "memory"), planes))
    return tuple(found)


def _outputs(data: dict[str, Any]) -> tuple[Output, ...]:
    items = _list(data, "outputs")
    if len(items) > PORTS:
        raise _DamagedError(f"{len(items)} outputs, but {PORTS} ports")
    outputs = tuple(map(_output, items))
    for what in ("name", "port"):
        if len({getattr(output, what) for output in outputs}) < len(outputs):
            raise _DamagedError(f"two outputs have the same {what}")
    return outputs


def _output(item: Any) -> Output:
    _checked(dict, item, "outputs", "be mappings")
    kind, port = item.get("kind"), _checked(int, item.get("port"), "outputs: port")
    if kind not in OUTPUT_KINDS or not 0 <= port < PORTS:
        raise _DamagedError(f"no such output: port {port}, kind {kind!r}")
    return Output(_checked(str, item.get("name"), "outputs: name"), port, kind)


def _word(value: Any) -> int:
    digits = _checked(str, value, "words")
    if not re.fullmatch("[0-9a-fA-F]{4}", digits):
        raise _DamagedError(f"'{digits[:20]}' is not a word of four hexadecimal digits")
    return int(digits, 16)


def _registers(data: dict[str, Any]) -> FrozenMap[str, int]:
    registers = _numbers({"registers": {}} | data, "registers")  # files may lack them
    for name, number in registers.items():
        if not 0 <= number < 16:
            raise _DamagedError(f"'registers': {name} is {number}, and no register")
    return registers


def _numbers(data: dict[str, Any], key: str) -> FrozenMap[str, int]:
    items = _checked(dict, data.get(key), key).items()
    return FrozenMap({name: _checked(int, value, key) for name, value in items})


def _limit(budget: dict[str, Any], key: str) -> int | None:
    value = budget.get(key)
    return None if value is None else _checked(int, value, f"budget: {key}")


def _list(data: dict[str, Any], key: str) -> list[Any]:
    return _checked(list, data.get(key), key)


def _checked(kind: type[_T], value: Any, key: str, wanted: str = "") -> _T:
    """Return a value if it is of a type; messages name its key and what it must be or hold."""
    if not isinstance(value, kind) or isinstance(value, bool):
        raise _DamagedError(f"'{key}' must {(wanted or _WANTED[kind]).format(str(value)[:40])}")
    return value
