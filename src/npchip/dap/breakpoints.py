"""Requests that set breakpoints: to the debugger's language, and what the client is told."""

from __future__ import annotations

from typing import Any

from npchip.base.errors import InputError, NpchipError
from npchip.dap import memory, stack
from npchip.dap.arguments import Arguments
from npchip.dap.points import Point, Spec, described
from npchip.dap.session import Session
from npchip.dap.variables import place_of
from npchip.debugger.language import parse_value
from npchip.debugger.values import Counter

Body = dict[str, Any]


def _spec(kind: str, text: str, item: Arguments) -> Spec:
    test, hits = item.text("condition", ""), item.text("hitCondition", "")
    return Spec(kind, text, test, hits, item.text("logMessage", ""))


def _all(session: Session, group: str, specs: list[Spec]) -> Body:
    points = session.points.set(group, specs)
    return {"breakpoints": [described(point, _where(session, point)) for point in points]}


def _where(session: Session, point: Point) -> Body:
    places = point.condition.places if point.condition else ()
    if not places:
        return {}
    line = session.debugger.program.place(min(places))
    found = {} if line is None else stack.place(session, line.file, line.line)
    return {"instructionReference": memory.address(min(places)), **found}


def set_lines(session: Session, arguments: Arguments) -> Body:
    """Replace the breakpoints of a file. They move down to the next line with an instruction."""
    first, names = session.client.first, session.debugger.names
    source = arguments.inner("source")
    known = session.file_of(source)
    file = known or source.text("path", "") or source.text("name", "")
    items = arguments.items("breakpoints")
    wanted = [item.number("line", least=first) - first + 1 for item in items]
    starts = names.lines(file)
    lines = [next((line for line in starts if line >= wish), None) for wish in wanted]
    specs = [
        # Where no line is found, the text is one whose error says so.
        _spec("breakpoint", names.line_called(file, line) if line else f'"{file}":{wish}', item)
        for line, wish, item in zip(lines, wanted, items, strict=True)
    ]
    points = session.points.set(f"file {file}", specs)
    return {
        "breakpoints": [
            described(point, stack.place(session, known, line or wish) if known else {})
            for point, line, wish in zip(points, lines, wanted, strict=True)
        ]
    }


def set_functions(session: Session, arguments: Arguments) -> Body:
    """Replace those that are written in the debugger's language: labels, places, conditions."""
    items = arguments.items("breakpoints")
    specs = [_spec("function breakpoint", item.text("name"), item) for item in items]
    return _all(session, "functions", specs)


def set_instructions(session: Session, arguments: Arguments) -> Body:
    """Replace those on addresses."""
    specs = []
    for item in arguments.items("breakpoints"):
        reference, offset = item.text("instructionReference"), item.number("offset", 0)
        address = memory.rom(reference) + offset // 2
        specs.append(_spec("instruction breakpoint", str(address), item))
    return _all(session, "instructions", specs)


def set_data(session: Session, arguments: Arguments) -> Body:
    """Replace those on values."""
    items = arguments.items("breakpoints")
    specs = [_spec("data breakpoint", f"{item.text('dataId')} changes", item) for item in items]
    return _all(session, "data", specs)


def data_info(session: Session, arguments: Arguments) -> Body:
    """Say whether a value can be watched; what it is called then."""
    name, reference = arguments.text("name"), arguments.number("variablesReference", 0)
    text = place_of(session, reference, name) if reference else name
    try:
        value = parse_value(text or name, session.debugger.names)
        if text is None or isinstance(value, Counter):
            raise InputError("NP351", f"{name} is no register, flag, byte, pixel or activity")
    except NpchipError as fault:
        return {"dataId": None, "description": fault.message}
    return {"dataId": text, "description": f"{text} changes", "accessTypes": ["write"]}


def locations(session: Session, arguments: Arguments) -> Body:
    """Return the lines that have instructions between two."""
    file, first = session.file_of(arguments.inner("source")), session.client.first
    begin = arguments.number("line", least=first) - first + 1
    end = arguments.number("endLine", begin - 1 + first) - first + 1
    lines = session.debugger.names.lines(file) if file else []
    return {"breakpoints": [{"line": line - 1 + first} for line in lines if begin <= line <= end]}
