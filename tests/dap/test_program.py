"""Answers from the program alone: to clients that draw the array, and while it moves."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.dap.client import Failed, adapter_here
from tests.dap.sample import FRAME, START, Sample

NEIGHBOURS = """\
        MOV     r4, #1
        NBR     r5, r4, west
        HALT
"""
ENDLESS = "loop:   ADD     r0, #1\n        JMP     loop\n"


def test_names_and_machine(sample: Sample) -> None:
    with adapter_here(**sample.launch(machine=str(sample.big), fit="resize")) as client:
        client.start()
        found = client.ask("npchip/program").body
        assert found["registers"] == {"value": 3}
        assert found["symbols"]["STEP"] == 1
        assert found["labels"]["frame"] == FRAME - START
        machine = found["machine"]
        assert (machine["np_rows"], machine["np_cols"], machine["memory_bytes"]) == (128, 160, 256)
        assert not any(found["words"])


def test_what_moves_between_neighbours(tmp_path: Path) -> None:
    path = tmp_path / "west.s"
    path.write_text(NEIGHBOURS)
    with adapter_here(program=str(path), stopOnEntry=True) as client:
        client.start()
        moves = [{"row": 0, "column": -1, "register": 4}]
        assert client.ask("npchip/program").body["words"] == [{}, {"moves": moves}, {}]


def test_it_is_answered_while_the_program_moves(tmp_path: Path) -> None:
    path = tmp_path / "endless.s"
    path.write_text(ENDLESS)
    with adapter_here(program=str(path), stopOnEntry=True, maxCycles=50_000_000) as client:
        client.start()
        client.ask("continue", threadId=1)
        source = {"path": str(path)}
        places = client.ask("breakpointLocations", source=source, line=1, endLine=2).breakpoints
        assert [item.line for item in places] == [1, 2]
        assert len(client.ask("npchip/program").body["words"]) == 2
        with pytest.raises(Failed, match="the program runs"):
            client.ask("npchip/picture", what="r0")
        client.ask("pause", threadId=1)
        assert client.stopped().reason == "pause"
