"""Conditions and quantities of the debugger's language in the page's form."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from npchip import load_machine
from npchip.debugger.language import parse_condition
from npchip.debugger.names import Names
from npchip.debugger.values import Cell, Counter, One, Pixel, Quantity
from npchip.isa import load_isa
from npchip.studio.toolchain.conditions import quantity, quantity_of
from npchip.studio.toolchain.facade import Toolchain
from tests.studio.compiler.calls import RefusedError, bundled, call, request
from tests.support.programs import assembled

DEFINES = {"THRESHOLD": 190}
NAMES = Names(assembled("keypoints", defines=DEFINES), load_machine("default"), load_isa())
R3: Any = {"kind": "register", "index": 3}


@pytest.fixture(scope="module")
def toolchain(tmp_path_factory: pytest.TempPathFactory) -> Toolchain:
    """A compiler that knows `keypoints`; tests only ask it."""
    return knowing_keypoints(tmp_path_factory.mktemp("project"))


def knowing_keypoints(folder: Path) -> Toolchain:
    toolchain = Toolchain(folder)
    asked = request(bundled("keypoints"), defines=DEFINES, module=False)
    assert call(toolchain, "compile", asked)["program"]
    return toolchain


def compared(value: Any, op: str, number: int, quantifier: str | None = None) -> dict[str, Any]:
    test = {"kind": "compare", "value": value, "op": op, "number": number}
    return {"places": None, "event": None, "test": {**test, "quantifier": quantifier}}


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("any r3 > 40", compared({"kind": "cell", "cell": R3}, ">", 40, "any")),
        (
            "np(3,4).C == 1",
            compared(
                {"kind": "one", "cell": {"kind": "flag", "index": "C"}, "row": 3, "column": 4},
                "==",
                1,
            ),
        ),
        ("pixel(20,33) < 10", compared({"kind": "pixel", "row": 20, "column": 33}, "<", 10)),
        ("frame == 3", compared({"kind": "counter", "name": "frame"}, "==", 3)),
        ("mask empty", {"places": None, "test": {"kind": "mask-empty"}, "event": None}),
        (
            "r3 changes",
            {
                "places": None,
                "test": None,
                "event": {"kind": "changes", "value": {"kind": "cell", "cell": R3}},
            },
        ),
        (
            "output objects > 3",
            {
                "places": None,
                "test": None,
                "event": {"kind": "sent", "port": 0, "op": ">", "number": 3},
            },
        ),
        (
            "output 2",
            {
                "places": None,
                "test": None,
                "event": {"kind": "sent", "port": 2, "op": None, "number": None},
            },
        ),
        (
            "scan if frame == 3",
            {**compared({"kind": "counter", "name": "frame"}, "==", 3), "places": [48]},
        ),
    ],
)
def test_trees(toolchain: Toolchain, text: str, tree: dict[str, Any]) -> None:
    found = call(toolchain, "condition", text)
    triggers = found.pop("triggers")
    assert found == {"text": text, **tree}
    known = parse_condition(text, NAMES)
    assert triggers == (None if known.places else sorted(known.triggers))


def test_what_every_instruction_can_change_has_no_triggers(toolchain: Toolchain) -> None:
    assert call(toolchain, "condition", "cycles > 9")["triggers"] is None


def test_a_line_of_a_file(toolchain: Toolchain) -> None:
    lines = (item.written_at for item in NAMES.program.source)
    line = next(line.line for line in lines if line.file.endswith("keypoints.s"))
    text = f"keypoints.s:{line}"
    places = call(toolchain, "condition", text)["places"]
    assert places == sorted(parse_condition(text, NAMES).places) != []


def test_a_mistake(toolchain: Toolchain) -> None:
    with pytest.raises(RefusedError, match=r"no label 'scam'.*\ndid you mean scan"):
        call(toolchain, "condition", "scam")


def test_the_last_program_without_mistakes_counts(tmp_path: Path) -> None:
    toolchain = knowing_keypoints(tmp_path)
    call(toolchain, "compile", request("FOO"))
    assert call(toolchain, "condition", "scan")["places"] == [48]
    call(toolchain, "compile", request("scan: HALT", module=False))
    assert call(toolchain, "condition", "scan")["places"] == [0]


@pytest.mark.parametrize("method", ["condition", "bounds", "writers"])
def test_nothing_was_compiled(tmp_path: Path, method: str) -> None:
    pixel = {"kind": "pixel", "row": 0, "column": 0}
    arguments: dict[str, list[Any]] = {"condition": ["scan"], "bounds": [], "writers": [pixel]}
    with pytest.raises(RefusedError, match="no program was compiled yet"):
        call(Toolchain(tmp_path), method, *arguments[method])


QUANTITIES: list[Quantity] = [
    Cell("register", 3),
    Cell("flag", "Z"),
    Cell("active"),
    Cell("memory", 200),
    One(Cell("memory", 133), 2, 9),
    Pixel(63, 79),
    *map(Counter, ("frame", "calls", "cycles")),
]


@pytest.mark.parametrize("value", QUANTITIES, ids=str)
def test_writers(toolchain: Toolchain, value: Quantity) -> None:
    data = quantity(value)
    assert quantity_of(data) == value
    assert call(toolchain, "writers", data) == sorted(NAMES.writers.of(value)) != []
