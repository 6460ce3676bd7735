"""Conditions of the debugger's language, and quantities, in JSON."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from npchip.debugger.conditions import Changes, Compare, Condition, Sent, Test
from npchip.debugger.language import parse_condition
from npchip.debugger.names import Names
from npchip.debugger.values import Cell, Counter, One, Pixel, Quantity


def condition_tree(text: str, names: Names) -> dict[str, Any]:
    """Return a condition as a ``ConditionTree``.

    Raises:
        CommandError: it cannot be read.
    """
    condition = parse_condition(text, names)
    return {
        "text": condition.text,
        "places": sorted(condition.places) or None,
        "test": condition.test and _test(condition.test),
        "event": condition.event and _event(condition.event),
        "triggers": _triggers(condition, names.writers.all),
    }


def _triggers(condition: Condition, every: Collection[int]) -> list[int] | None:
    if condition.places or len(condition.triggers) == len(every):
        return None
    return sorted(condition.triggers)


def _test(test: Test) -> dict[str, Any]:
    if not isinstance(test, Compare):
        return {"kind": "mask-empty"}
    return {
        "kind": "compare",
        "value": quantity(test.value),
        "op": test.op,
        "number": test.number,
        "quantifier": test.quantifier,
    }


def _event(event: Sent | Changes) -> dict[str, Any]:
    if isinstance(event, Changes):
        return {"kind": "changes", "value": quantity(event.value)}
    number = None if event.op is None else event.number
    return {"kind": "sent", "port": event.port, "op": event.op, "number": number}


def quantity(value: Quantity) -> dict[str, Any]:
    """Return a ``Quantity``."""
    match value:
        case Cell():
            return {"kind": "cell", "cell": _cell(value)}
        case One():
            place = {"row": value.row, "column": value.column}
            return {"kind": "one", "cell": _cell(value.cell), **place}
        case Pixel():
            return {"kind": "pixel", "row": value.row, "column": value.column}
        case Counter():
            return {"kind": "counter", "name": value.name}


def _cell(cell: Cell) -> dict[str, Any]:
    return {"kind": cell.kind, "index": cell.index}


def quantity_of(data: Mapping[str, Any]) -> Quantity:
    """Return what a ``Quantity`` says: the inverse of `quantity`."""
    match data["kind"]:
        case "cell":
            return Cell(**data["cell"])
        case "one":
            return One(Cell(**data["cell"]), data["row"], data["column"])
        case "pixel":
            return Pixel(data["row"], data["column"])
    return Counter(data["name"])
