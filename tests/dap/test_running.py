"""Programs that run: how they end, what interrupts them, and what goes wrong."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from tests.dap.client import Failed, adapter_here
from tests.dap.sample import FRAME, FRAMES, LOAD, Sample

TRAP = "        MOV r0, #1\n        RET\n"
ENDLESS = "loop:   ADD r0, #1\n        JMP loop\n"
TORN = ".output x, 0, scalar\n        COL r0\n        OUT 0, r0\n        NOP\n        HALT\n"


@pytest.mark.parametrize(
    ("source", "name", "said", "code"),
    [
        (TRAP, "trap", "NP302", 1),
        (ENDLESS, "cycle-limit", "has reached 500 cycles", 3),
        (TORN, "outputs", "NP310", 0),
        ("        HALT\n", "end", "halted", 0),
    ],
)
def test_exception_filters(sample: Sample, source: str, name: str, said: str, code: int) -> None:
    sample.source.write_text(source, encoding="utf-8")
    launch = sample.launch(frames=None, maxCycles=500)
    with adapter_here(**launch) as client:
        filters = [item.filter for item in client.capabilities.exceptionBreakpointFilters]
        assert filters == ["trap", "cycle-limit", "outputs", "end"]
        client.start()
        stop = client.move("continue")
        if name == "end":
            assert stop.reason == "pause"
            assert said in stop.description
        else:
            assert stop.reason == "exception"
            assert said in stop.text
            info = client.ask("exceptionInfo", threadId=1)
            assert (info.exceptionID, said in info.description) == (name, True)
            assert client.move("stepBack").reason in {"step", "entry"}
    with adapter_here(**launch) as client:
        client.ask("setExceptionBreakpoints", filters=[item for item in filters if item != name])
        client.start()
        client.ask("continue", threadId=1)
        if name == "outputs":
            assert "halted" in client.stopped().description
        else:
            assert client.event("exited").exitCode == code
            client.event("terminated")


def test_going_on_from_the_end_ends_the_session(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.start()
        assert client.move("continue").description == "no frame is left"
        assert client.move("stepBack").reason == "step"
        assert client.move("continue").description == "no frame is left"
        client.ask("next", threadId=1)
        assert client.event("exited", "stopped").exitCode == 0
        client.event("terminated")


def test_without_debugging_nothing_stops(sample: Sample) -> None:
    with adapter_here(**sample.launch(noDebug=True)) as client:
        client.ask("setBreakpoints", **sample.lines(LOAD))
        client.ask("setExceptionBreakpoints", filters=["end"])
        client.protocol.configuration_done()
        client.answer()
        assert client.event("exited", "stopped").exitCode == 0
        assert f"frame {FRAMES - 1}: count {FRAMES}, plane 8 x 10 bytes" in client.output("stdout")


ROUND = ENDLESS + "more:   NOP\n        JMP loop\n"


def test_an_endless_program_can_be_interrupted(sample: Sample) -> None:
    sample.source.write_text(ROUND, encoding="utf-8")
    with adapter_here(**sample.launch(frames=None, maxCycles=50_000_000)) as client:
        client.start()
        for _ in range(3):
            client.ask("continue", threadId=1)
            with pytest.raises(Failed, match="the program runs"):
                client.frames()
            assert len(client.ask("threads").threads) == 1
            found = client.ask("setBreakpoints", **sample.lines(3)).breakpoints  # and it goes on
            assert found[0].verified
            client.ask("pause", threadId=1)
            assert client.stopped().reason == "pause"
        time = int(client.value("instructions"))
        client.ask("continue", threadId=1)
        client.ask("setBreakpoints", **sample.lines(2))
        assert client.stopped().reason == "breakpoint"
        assert int(client.value("instructions")) > time
        client.ask("pause", threadId=1)  # nothing runs
        assert client.line == 2


def test_a_session_may_end_while_the_program_runs(sample: Sample) -> None:
    sample.source.write_text(ENDLESS, encoding="utf-8")
    with adapter_here(**sample.launch(frames=None, maxCycles=50_000_000)) as client:
        client.start()
        client.ask("continue", threadId=1)


def test_what_is_wrong_while_the_program_runs(sample: Sample) -> None:
    sample.source.write_text(ENDLESS, encoding="utf-8")
    with adapter_here(**sample.launch(frames=None, maxCycles=50_000_000)) as client:
        client.start()
        client.ask("continue", threadId=1)
        with pytest.raises(Failed, match="there is no request nonsense"):
            client.ask("nonsense")
        with pytest.raises(Failed, match="line: expected a whole number from 1 on"):
            client.ask("setBreakpoints", **sample.lines(-1))
        for command in ("next", "reverseContinue"):
            with pytest.raises(Failed, match="the program runs"):
                client.ask(command, threadId=1)
        client.ask("pause", threadId=1)
        assert client.stopped().reason == "pause"


def test_a_log_point_in_an_endless_loop_can_be_interrupted(sample: Sample) -> None:
    sample.source.write_text(ENDLESS, encoding="utf-8")
    with adapter_here(**sample.launch(frames=None, maxCycles=50_000_000)) as client:
        client.ask("setBreakpoints", **sample.lines({"line": 1, "logMessage": "round"}))
        client.start()
        client.ask("continue", threadId=1)
        client.ask("pause", threadId=1)
        assert client.stopped().reason == "pause"


def test_a_frame_that_cannot_be_read_is_an_exception(sample: Sample) -> None:
    folder = sample.source.parent / "frames"
    folder.mkdir()
    picture = Image.fromarray(np.full((64, 80), 7, np.uint8))
    for number in range(3):
        picture.save(folder / f"{number}.png")
    (folder / "1.png").write_bytes(b"no picture")
    with adapter_here(**sample.launch(frames=str(folder))) as client:
        client.start()
        stop = client.move("continue")
        assert stop.reason == "exception"
        assert "1.png" in stop.text
        assert client.value("frame") == "0"
        assert client.line == FRAME
        assert client.move("stepBack").reason == "step"
        assert client.line == FRAME + 8


CALLING = """\
        CALL    more
        HALT
more:   ADD     r0, #1
        JANY    NE, more
        RET
"""


def test_a_step_over_a_call_goes_on_at_what_does_not_count(sample: Sample) -> None:
    """Breakpoints set on the way count, and the step goes on where they do not."""
    text = (
        "        CALL more\n        HALT\nmore:   ADD r0, #1\n        JANY NE, more\n        RET\n"
    )
    sample.source.write_text(text, encoding="utf-8")
    with adapter_here(**sample.launch(frames=None)) as client:
        count = {"line": 3, "hitCondition": "> 1000"}
        client.ask("setBreakpoints", **sample.lines(count, {"line": 4, "logMessage": "x"}))
        client.start()
        assert client.move("next").reason == "step"
        assert client.line == 2
        assert client.output("console") == "x\n" * 256


@pytest.mark.long
def test_a_search_can_be_interrupted(sample: Sample) -> None:
    with adapter_here(**sample.launch(program="keypoints", frames="shapes_photo")) as client:
        client.start()
        client.move("continue")
        time = client.value("instructions")
        asked = "who np(0,0).mem[255]"
        said = client.value(asked, "repl")
        assert "nothing has written it since reset" in said or "in frame" in said
        assert client.value("instructions") == time
        before = len(client.events)
        client.protocol.evaluate(asked, context="repl")
        client.protocol.pause(1)
        first, second = client.answer(), client.answer()
        results = [getattr(item, "result", None) for item in (first, second)]
        assert next(item for item in results if item is not None) in {"interrupted", said}
        assert client.value("instructions") == time
        assert not [name for name, _ in client.events[before:] if name in {"stopped", "continued"}]
