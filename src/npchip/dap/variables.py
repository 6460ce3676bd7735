"""Contents of the chip, as scopes and variables; each level is computed when it is opened."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.dap.arguments import Arguments
from npchip.dap.session import Session
from npchip.debugger import answers
from npchip.debugger.language import parse_number
from npchip.debugger.values import COUNTERS, Cell, One

Body = dict[str, Any]

ACTIVE: Final = Cell("active")
FLAGS: Final = (Cell("flag", "Z"), Cell("flag", "C"))
REGISTERS: Final = tuple(Cell("register", number) for number in range(16))


@dataclass(frozen=True)
class Processor:
    """The chosen NP: its place, activity, flags and registers."""


@dataclass(frozen=True)
class Bytes:
    """The memory of the chosen NP."""


@dataclass(frozen=True)
class Array:
    """All NPs: what each register, flag and byte is over the array."""


@dataclass(frozen=True)
class Planes:
    """The memory of all NPs."""


@dataclass(frozen=True)
class Plane:
    """A cell of all NPs, row by row."""

    cell: Cell


@dataclass(frozen=True)
class Row:
    """A cell of the NPs of a row."""

    cell: Cell
    row: int


@dataclass(frozen=True)
class Control:
    """Counters, open calls and masks, and the outputs of this frame."""


Node = Processor | Bytes | Array | Planes | Plane | Row | Control


def scopes(session: Session, _arguments: Arguments) -> Body:
    """Return the scopes; they are the same at each place, as registers know no calls."""
    row, column = session.chosen
    size = session.debugger.chip.machine.memory_bytes
    listed: list[tuple[str, Node, Body]] = [
        (f"NP ({row},{column})", Processor(), {"presentationHint": "registers"}),
        (f"Memory of NP ({row},{column})", Bytes(), {"indexedVariables": size}),
        ("Array", Array(), {"expensive": True}),
        ("Control unit", Control(), {}),
    ]
    return {
        "scopes": [
            {"name": name, "variablesReference": session.handle(node), "expensive": False, **more}
            for name, node, more in listed
        ]
    }


def variables(session: Session, arguments: Arguments) -> Body:
    """Return the variables of a scope or another variable, or some of them."""
    node = session.node(arguments.number("variablesReference"))
    start, count = arguments.number("start", 0, 0), arguments.number("count", 0, 0)
    indexed = isinstance(node, Bytes | Planes | Plane | Row)
    wanted = arguments.text("filter", None)
    if wanted and (wanted == "indexed") != indexed:
        return {"variables": []}
    style = "#04x" if arguments.inner("format").flag("hex") else ""
    end = start + count if count else None
    return {"variables": list(_Children(session, style).of(node, slice(start, end)))}


def place_of(session: Session, reference: int, name: str) -> str | None:
    """Return how the debugger's language calls a variable; None if it cannot.

    Raises:
        InputError: NP358, there is no such variable.
    """
    for item in _Children(session, "").of(session.node(reference), slice(None)):
        if item["name"] == name:
            found = item.get("evaluateName")
            return None if found is None else str(found)
    raise InputError("NP358", f"no variable {name!r} here")


def set_variable(session: Session, arguments: Arguments) -> Body:
    """Edit a variable, or choose another NP by its row or column.

    Raises:
        NpchipError: as the command ``edit``; NP358.
    """
    reference, name = arguments.number("variablesReference"), arguments.text("name")
    value = arguments.text("value")
    if isinstance(session.node(reference), Processor) and name in {"row", "column"}:
        number = parse_number(value, session.debugger.names)
        row, column = session.chosen
        session.choose(*((number, column) if name == "row" else (row, number)))
        return {"value": str(number)}
    place = place_of(session, reference, name)
    if place is None:
        raise InputError("NP358", f"{name} cannot be set")
    return edit(session, place, value, arguments)


def edit(session: Session, place: str, value: str, arguments: Arguments) -> Body:
    """Set a place of the debugger's language, and return its new value.

    Raises:
        NpchipError: as the command ``edit``.
    """
    session.commands.execute(f"edit {place} = {value}")
    number = parse_number(value, session.debugger.names)
    hexadecimal = arguments.inner("format").flag("hex")
    return {"value": format(number, "#04x") if hexadecimal else str(number)}


def statistics(plane: NDArray[Any], active: NDArray[np.bool_], style: str = "") -> str:
    """Return least, most and mean of a plane, and of its active NPs if not all are."""
    if plane.dtype == np.bool_:
        return f"{int(plane.sum())} of {plane.size}"
    least, most = format(int(plane.min()), style), format(int(plane.max()), style)
    text = least if least == most else f"{least} to {most}, mean {plane.mean():.1f}"
    if active.all() or not active.any() or least == most:
        return text
    some = plane[active]
    return f"{text}; active: {int(some.min()):{style}} to {int(some.max()):{style}}"


class _Children:
    """Makes the variables of a node.

    Args:
        session: the session.
        style: format of numbers.
    """

    def __init__(self, session: Session, style: str) -> None:
        self._session = session
        self._style = style
        self._chip = session.debugger.chip
        names: dict[int, list[str]] = {}
        for name, number in session.debugger.program.registers.items():
            names.setdefault(number, []).append(name)
        self._names = names

    def of(self, node: Node, wanted: slice) -> Iterator[Body]:
        rows, columns = self._chip.machine.geometry
        addresses = range(self._chip.machine.memory_bytes)[wanted]
        match node:
            case Processor():
                yield from list(self._processor())[wanted]
            case Bytes():
                for address in addresses:
                    yield self._one(Cell("memory", address), *self._session.chosen)
            case Array():
                yield from list(self._array())[wanted]
            case Planes():
                yield from (self._plane(Cell("memory", at)) for at in addresses)
            case Plane(cell=cell):
                yield from (self._row(cell, row) for row in range(rows)[wanted])
            case Row(cell=cell, row=row):
                for column in range(columns)[wanted]:
                    yield self._one(cell, row, column) | {"name": f"np({row},{column})"}
            case Control():
                yield from list(self._control())[wanted]

    def _processor(self) -> Iterator[Body]:
        row, column = self._session.chosen
        yield _leaf("row", str(row))
        yield _leaf("column", str(column))
        for cell in (ACTIVE, *FLAGS, *REGISTERS):
            yield self._one(cell, row, column)

    def _called(self, cell: Cell) -> str:
        names = self._names.get(int(cell.index), ()) if cell.kind == "register" else ()
        return " ".join([str(cell), *names])

    def _one(self, cell: Cell, row: int, column: int) -> Body:
        one = One(cell, row, column)
        style = self._style if cell.kind in {"register", "memory"} else ""
        body = _leaf(self._called(cell), format(one.value(self._chip), style))
        if cell.kind == "memory":
            body["memoryReference"] = str(one)
        if cell.kind == "active":
            body["presentationHint"] = {"kind": "data", "attributes": ["readOnly"]}
        return body | {"evaluateName": str(one)}

    def _array(self) -> Iterator[Body]:
        for cell in (ACTIVE, *FLAGS, *REGISTERS):
            yield self._plane(cell)
        size = self._chip.machine.memory_bytes
        yield {
            **_leaf("mem", f"{size} bytes in each NP"),
            "variablesReference": self._session.handle(Planes()),
            "indexedVariables": size,
        }

    def _plane(self, cell: Cell) -> Body:
        return {
            **_leaf(self._called(cell), self.over_array(cell)),
            "evaluateName": str(cell),
            "memoryReference": str(cell),
            "variablesReference": self._session.handle(Plane(cell)),
            "indexedVariables": self._chip.machine.np_rows,
        }

    def over_array(self, cell: Cell) -> str:
        return statistics(cell.plane(self._chip), self._chip.active, self._style)

    def _row(self, cell: Cell, row: int) -> Body:
        values = cell.plane(self._chip)[row]
        style = self._style if cell.kind in {"register", "memory"} else ""
        shown = " ".join(format(int(value), style) for value in values[:16])
        return {
            **_leaf(f"row {row}", f"{shown} ..." if len(values) > 16 else shown),
            "variablesReference": self._session.handle(Row(cell, row)),
            "indexedVariables": len(values),
        }

    def _control(self) -> Iterator[Body]:
        chip = self._chip
        for name, number in COUNTERS.items():
            yield _leaf(name, str(number(chip))) | {"evaluateName": name}
        yield _leaf("masks", str(chip.depth))
        near = self._session.debugger.names.near
        calls = " < ".join(near(back - 1) for back in reversed(chip.stack))
        yield _leaf("calls from", calls or "none open")
        for name, value in self._session.debugger.outputs.items():
            yield _leaf(f"output {name}", answers.output(value))


def _leaf(name: str, value: str) -> Body:
    return {"name": name, "value": value, "variablesReference": 0}


def shown_plane(session: Session, cell: Cell, style: str) -> Body:
    """Return a cell as the result of an evaluation: its chosen NP, all NPs, and rows to open."""
    chip = session.debugger.chip
    value = One(cell, *session.chosen).value(chip)
    row, column = session.chosen
    over = statistics(cell.plane(chip), chip.active, style)
    return {
        "result": f"{value:{style}} in np({row},{column}); all: {over}",
        "variablesReference": session.handle(Plane(cell)),
        "indexedVariables": chip.machine.np_rows,
        "memoryReference": str(cell),
    }
