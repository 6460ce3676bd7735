"""Stops of a program, forwards and backwards."""

from __future__ import annotations

from typing import Any

import pytest

from tests.dap.client import Client, adapter_here
from tests.dap.sample import (
    CALL,
    DOUBLE,
    FRAME,
    FRAMES,
    INSIDE,
    LAST,
    LOAD,
    MORE,
    SEND,
    START,
    STORE,
    Sample,
)


def frame_of(client: Client) -> int:
    return int(client.value("frame"))


def test_lines(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        found = client.ask("setBreakpoints", **sample.lines(DOUBLE - 1, 18, 99))
        assert [item.verified for item in found.breakpoints] == [True, True, False]
        assert [item.line for item in found.breakpoints] == [CALL, MORE, 99]
        assert f"no instruction below line {LAST}" in found.breakpoints[2].message
        elsewhere = client.ask(
            "setBreakpoints", source={"path": "other.s"}, breakpoints=[{"line": 1}]
        )
        assert "no source file 'other.s'" in elsewhere.breakpoints[0].message
        assert client.start().reason == "entry"
        assert client.line == START
        for line in (CALL, MORE) * FRAMES:
            stop = client.move("continue")
            assert stop.reason == "breakpoint"
            assert len(stop.hitBreakpointIds) == 1
            assert client.line == line
        assert client.move("continue").description == "no frame is left"
        for line in (MORE, CALL) * FRAMES:
            assert client.move("reverseContinue").reason == "breakpoint"
            assert client.line == line
        stop = client.move("reverseContinue")
        assert (stop.reason, stop.description) == ("entry", "at the beginning")
        lines = client.ask(
            "breakpointLocations", source={"path": str(sample.source)}, line=1, endLine=FRAME
        )
        assert [item.line for item in lines.breakpoints] == [INSIDE, START, FRAME]


def test_conditions(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        condition = {"line": LOAD, "condition": "frame == 2"}
        wrong = {"line": MORE, "condition": "any r99 > 1"}
        client.ask("setBreakpoints", **sample.lines(condition, wrong))
        message = client.ask("setBreakpoints", **sample.lines(condition, wrong)).breakpoints[1]
        assert (message.verified, message.message) == (
            False,
            "no register 'r99'; they are r0 to r15 [NP351]",
        )
        client.start()
        client.move("continue")
        assert (client.line, frame_of(client)) == (LOAD, 2)
        assert client.move("continue").reason == "pause"


@pytest.mark.long
@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("3", [2]),
        ("== 3", [2]),
        (">= 5", [4, 5]),
        ("> 5", [5]),
        ("<=2", [0, 1]),
        ("< 2", [0]),
        ("%2", [1, 3, 5]),
    ],
)
def test_hit_counts_go_both_ways(sample: Sample, text: str, expected: list[int]) -> None:
    with adapter_here(**sample.launch()) as client:
        client.ask("setBreakpoints", **sample.lines({"line": LOAD, "hitCondition": text}))
        client.start()
        for _ in range(2):
            for frame in expected:
                assert client.move("continue").reason == "breakpoint"
                assert frame_of(client) == frame
            assert client.move("continue").description == "no frame is left"
            for frame in reversed(expected):
                assert client.move("reverseContinue").reason == "breakpoint"
                assert frame_of(client) == frame
            assert client.move("reverseContinue").reason == "entry"


def test_a_hit_count_that_is_none(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        item = {"line": LOAD, "hitCondition": "often"}
        found = client.ask("setBreakpoints", **sample.lines(item)).breakpoints[0]
        assert not found.verified
        assert "hit count: expected a number" in found.message


def test_log_points(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        log = {"line": LOAD, "logMessage": "frame {frame}: {np(0,0).r0}, rows {r1}, {r0}"}
        some = {"line": STORE, "logMessage": "even", "hitCondition": "% 2"}
        wrong = {"line": SEND, "logMessage": "{r77}"}
        found = client.ask("setBreakpoints", **sample.lines(log, some, wrong)).breakpoints
        assert [item.verified for item in found] == [True, True, False]
        client.start()
        assert client.move("continue").description == "no frame is left"
        lines = client.output("console").splitlines()
        assert lines[:3] == [
            "frame 0: 0, rows 0, 0",
            "frame 1: 1, rows 0 to 7, 1",
            "even",
        ]
        assert lines.count("even") == FRAMES // 2
        assert len(lines) == FRAMES + FRAMES // 2
        assert client.move("reverseContinue").reason == "entry"
        assert client.output("console").splitlines() == lines  # nothing on the way back


def test_a_log_point_does_not_end_a_step(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.ask("setBreakpoints", **sample.lines({"line": MORE, "logMessage": "in"}, CALL))
        client.start()
        client.move("continue")
        assert client.move("next").reason == "step"
        assert client.line == INSIDE
        assert client.output("console") == "in\n"
        client.move("stepBack")
        assert client.line == LAST
        client.move("reverseContinue")
        assert client.move("stepIn").reason == "step"
        assert client.line == MORE
        assert client.output("console") == "in\n" * 2
        client.move("stepOut")
        assert client.line == INSIDE


def test_steps(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.start()
        for line in (FRAME, 10, LOAD, CALL):
            assert client.move("stepIn").reason == "step"
            assert client.line == line
        client.move("next")
        assert client.line == INSIDE
        for line in (LAST, 20, MORE, CALL, LOAD):
            assert client.move("stepBack").reason == "step"
            assert client.line == line
        client.move("stepIn")
        client.move("stepIn")
        assert [item.line for item in client.frames()] == [MORE, CALL]
        client.move("stepOut")
        assert client.line == INSIDE
        assert client.move("stepOut").description == "no call is open"
        assert client.line == INSIDE


def test_data_breakpoints(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.start()
        client.protocol.scopes(1)
        registers = client.answer().scopes[0].variablesReference
        info = client.ask("dataBreakpointInfo", variablesReference=registers, name="r3 value")
        assert (info.dataId, info.accessTypes) == ("np(0,0).r3", ["write"])
        for name in ("row", "cycles"):
            reference = registers if name == "row" else 0
            none = client.ask("dataBreakpointInfo", variablesReference=reference, name=name)
            assert none.dataId is None
        whole = client.ask("dataBreakpointInfo", name="mem[70]")
        items: list[dict[str, Any]] = [
            {"dataId": info.dataId, "condition": "frame == 3"},
            {"dataId": whole.dataId, "hitCondition": "2"},
        ]
        found = client.ask("setDataBreakpoints", breakpoints=items).breakpoints
        assert [item.verified for item in found] == [True, True]
        stop = client.move("continue")
        assert stop.reason == "data breakpoint"
        assert stop.hitBreakpointIds == [str(found[1].id)]
        assert (frame_of(client), client.line) == (2, SEND)  # the first change is in frame 1
        client.move("continue")
        assert (frame_of(client), client.line) == (3, CALL)
        assert client.move("reverseContinue").reason == "data breakpoint"
        assert frame_of(client) == 2


def test_breakpoints_in_the_language_of_the_debugger(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        names = ["more", "any value > 30", "output count > 4", "mask full"]
        items: list[dict[str, Any]] = [{"name": name} for name in names]
        items[0]["condition"] = "frame == 1"
        found = client.ask("setFunctionBreakpoints", breakpoints=items).breakpoints
        assert [item.verified for item in found] == [True, True, True, False]
        assert (found[0].line, found[1].line) == (MORE, None)
        client.start()
        places = []
        for _ in range(6):
            stop = client.move("continue")
            if stop.reason == "pause":
                break
            assert stop.reason == "function breakpoint"
            places.append((frame_of(client), client.line))
        # The value becomes more than 30 when 20 or 30 is doubled, and stays so from then on.
        assert places == [(1, MORE), (2, STORE), (3, STORE), (4, SEND + 1), (5, SEND + 1)]


def test_instruction_breakpoints(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        items = [{"instructionReference": "0x000", "offset": 6}, {"instructionReference": "700"}]
        found = client.ask("setInstructionBreakpoints", breakpoints=items).breakpoints
        assert [item.verified for item in found] == [True, False]
        assert (found[0].line, found[0].instructionReference) == (LOAD, "0x003")
        client.start()
        assert client.move("continue").reason == "instruction breakpoint"
        assert client.line == LOAD


def test_breakpoints_are_replaced_and_deleted(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        first = client.ask("setBreakpoints", **sample.lines(LOAD, CALL)).breakpoints
        again = client.ask("setBreakpoints", **sample.lines(CALL)).breakpoints
        assert again[0].id == first[1].id
        client.start()
        client.move("continue")
        assert client.line == CALL
        assert "breakpoint 3: more" in client.value("break more", "repl")
        made = client.event("breakpoint")
        assert (made.reason, made.breakpoint.id) == ("new", 3)
        assert client.move("continue").hitBreakpointIds == ["3"]
        client.value("delete 3", "repl")
        assert client.event("breakpoint").reason == "removed"
        client.ask("setBreakpoints", **sample.lines())
        assert client.move("continue").reason == "pause"
