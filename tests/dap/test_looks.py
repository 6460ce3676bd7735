"""A client's view of a program that stands still, and the changes that it may make."""

from __future__ import annotations

import base64
from typing import Any

import pytest

from tests.dap.client import Client, Failed, adapter_here
from tests.dap.sample import CALL, DOUBLE, FRAME, INSIDE, LOAD, MORE, STORE, Sample


def at_store(client: Client, sample: Sample) -> None:
    """Stop in frame 1, where `value` is 20 and `r1` the NP's row."""
    client.ask("setBreakpoints", **sample.lines({"line": STORE, "condition": "frame == 1"}))
    client.start()
    client.move("continue")


ROWS = b"".join(bytes([row] * 10) for row in range(8))
"""The row of each NP of the default array."""


def plain(body: dict[str, Any]) -> bytes:
    return base64.b64decode(body["data"])


def test_stack_and_sources(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.ask("setBreakpoints", **sample.lines(MORE))
        client.start()
        client.move("continue")
        frames = client.frames()
        assert [(item.name, item.line) for item in frames] == [("more", MORE), ("frame+3", CALL)]
        assert frames[0].source.path == str(sample.source)
        assert frames[1].instructionPointerReference == "0x004"
        client.move("stepOut")
        frames = client.frames()
        names = [("frame+4", INSIDE), ("frame+4 (expanded here)", DOUBLE)]
        assert [(item.name, item.line) for item in frames] == names
        client.protocol.stack_trace(1, start_frame=1, levels=1)
        page = client.answer()
        assert (page.totalFrames, [item.line for item in page.stackFrames]) == (2, [DOUBLE])
        assert [item.name for item in client.ask("loadedSources").sources] == ["sample.s"]


def test_a_source_that_is_gone(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        sample.source.unlink()
        client.start()
        source = client.frames()[0].source
        assert (source.path, source.sourceReference) == (None, 1)
        text = client.ask("source", sourceReference=1).content
        assert text.splitlines()[FRAME - 1] == "frame:  EXPOSE"
        where = {"sourceReference": 1}
        found = client.ask("setBreakpoints", source=where, breakpoints=[{"line": LOAD}])
        assert found.breakpoints[0].verified
        with pytest.raises(Failed, match="no source file"):
            client.ask("source", sourceReference=9)


def test_scopes(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        at_store(client, sample)
        registers = client.scope("NP")
        assert registers["r3 value"].value == "20"
        assert registers["r3 value"].evaluateName == "np(0,0).r3"
        assert (registers["active"].value, registers["r1"].value) == ("1", "0")
        assert [name for name in registers if len(name) == 1] == ["Z", "C"]
        memory = client.scope("Memory")
        assert len(memory) == 256
        assert memory["mem[5]"].value == "10"
        array = client.scope("Array")
        assert array["r1"].value == "0 to 7, mean 3.5"
        assert array["active"].value == "80 of 80"
        rows = client.children(array["r1"].variablesReference)
        assert rows["row 6"].value == "6 6 6 6 6 6 6 6 6 6"
        processors = client.children(rows["row 6"].variablesReference, start=3, count=2)
        assert {name: item.value for name, item in processors.items()} == {
            "np(6,3)": "6",
            "np(6,4)": "6",
        }
        bytes_ = client.children(array["mem"].variablesReference, start=5, count=1)
        assert [item.value for item in bytes_.values()] == ["10"]
        control = client.scope("Control")
        assert (control["frame"].value, control["calls from"].value) == ("1", "none open")
        assert control["output count"].value == "nothing sent"
        client.protocol.scopes(1)
        first = client.answer().scopes[0].variablesReference
        client.protocol.variables(first, format={"hex": True})
        shown = {item.name: item.value for item in client.answer().variables}
        assert (shown["r3 value"], shown["Z"]) == ("0x14", "0")
        client.move("stepIn")
        with pytest.raises(Failed, match="nothing has this number now"):
            client.children(99)


MASKED = """\
        ROW     r1
        CMP     r1, #6
        WHERE   HS
          ADD   r2, r1
        END
        HALT
"""


def test_masked_regions(sample: Sample) -> None:
    sample.source.write_text(MASKED, encoding="utf-8")
    with adapter_here(**sample.launch(frames=None)) as client:
        client.ask("setBreakpoints", **sample.lines(5))
        client.start()
        client.move("continue")
        array = client.scope("Array")
        assert array["active"].value == "20 of 80"
        assert array["r1"].value == "0 to 7, mean 3.5; active: 6 to 7"
        assert array["r2"].value == "0 to 7, mean 1.6; active: 6 to 7"
        assert client.scope("NP")["active"].value == "0"
        assert client.scope("Control")["masks"].value == "1"
        assert client.children(2, filter="named") == {}


def test_another_np_is_chosen_in_three_ways(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        at_store(client, sample)
        client.protocol.scopes(1)
        reference = client.answer().scopes[0].variablesReference
        client.protocol.set_variable(reference, "row", "5")
        assert client.answer().value == "5"
        assert "variables" in client.event("invalidated").areas
        assert client.scope("NP (5,0)")["r1"].value == "5"
        client.value("choose 6 9", "repl")
        assert client.scope("NP (6,9)")["r1"].value == "6"
        assert client.ask("npchip/choose", row=7, column=1).body == {"row": 7, "column": 1}
        assert client.scope("NP (7,1)")["r1"].value == "7"
        assert client.value("r1", "hover") == "7 in np(7,1); all: 0 to 7, mean 3.5"
        for wrong in ({"row": 8, "column": 0}, {"row": "x", "column": 0}):
            with pytest.raises(Failed, match=r"8 x 10 NPs|expected a whole number"):
                client.ask("npchip/choose", **wrong)


def test_20480_nps_stay_usable(sample: Sample) -> None:
    source = sample.source.read_text(encoding="utf-8")
    sample.source.write_text(source.replace("EXPOSE", "NOP").replace("SAMPLE  signal, 0", "NOP"))
    with adapter_here(**sample.launch(frames=None, machine=str(sample.big))) as client:
        client.ask("setBreakpoints", **sample.lines(STORE))
        client.start()
        client.move("continue")
        assert len(client.ask("threads").threads) == 1
        array = client.scope("Array")
        assert array["r1"].value == "0 to 127, mean 63.5"
        rows = client.children(array["r1"].variablesReference, start=100, count=10)
        assert list(rows) == [f"row {row}" for row in range(100, 110)]
        assert rows["row 100"].value == " ".join(["100"] * 16) + " ..."
        assert len(client.children(rows["row 100"].variablesReference)) == 160
        client.value("choose 127,159", "repl")
        assert client.scope("NP (127,159)")["r1"].value == "127"
        picture = client.ask("npchip/picture", what="r1").body
        assert (picture["rows"], picture["cols"]) == (128, 160)


def test_expressions(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        at_store(client, sample)
        for text, value in {
            "np(3,4).value": "20",
            "np(3,4).mem[4 + STEP]": "10",
            "pixel(0,0)": "10",
            "frame": "1",
            "any r1 > 6": "true",
            "mask empty": "false",
            "STEP": "1, 0x01",
            "more": "10, 0x0A",
            "active": "1 in np(0,0); all: 80 of 80",
            "stack": "no call is open",
            "outputs": "count = nothing sent\nplane = nothing sent",
        }.items():
            assert client.value(text) == value
        client.protocol.evaluate("r1", context="watch")
        rows = client.children(client.answer().variablesReference)
        assert rows["row 2"].value == "2 2 2 2 2 2 2 2 2 2"
        for text, value in {"np(3,4).value": "0x14", "r1": "0x00 in np(0,0); all: 0x00 to"}.items():
            client.protocol.evaluate(text, format={"hex": True})
            assert client.answer().result.startswith(value)
        with pytest.raises(Failed, match="no register or label 'valu'"):
            client.value("valu")
        with pytest.raises(Failed, match="value:1:1: error"):
            client.value("edit r3 = 1")  # a watch changes nothing


def test_commands(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.start()
        assert "sample.s:10: SAMPLE" in client.value("step 2", "repl")
        client.event("continued")
        assert client.stopped().reason == "step"
        assert "no frame is left" in client.value("run", "repl")
        client.stopped()
        client.value("goto 5", "repl")
        assert client.stopped().reason == "step"
        assert client.value("instructions") == "5"
        assert client.value("print np(0,0).r0", "repl") == "np(0,0).r0 = 0"
        assert "address 0, sample.s:8: MOV" in client.value("who np(0,0).r0", "repl")
        assert client.value("expect calls == 1", "repl") == "holds: calls == 1"
        for wrong, said in {
            "step x": "no constant or label 'x'",
            "print": "expected a register",
            "edit np(0,0).r0 = 300": "expected 0 to 255",
        }.items():
            with pytest.raises(Failed, match=said):
                client.value(wrong, "repl")
        assert client.value("", "repl") == ""
        client.value("restart", "repl")
        assert client.stopped().reason == "entry"


def test_edits_are_part_of_what_happened(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        at_store(client, sample)
        client.protocol.scopes(1)
        first, *_ = client.answer().scopes
        client.protocol.set_variable(first.variablesReference, "r0", "STEP + 40")
        assert client.answer().value == "41"
        client.protocol.set_expression("np(1,1).mem[9]", "0x33")
        assert client.answer().value == "51"
        assert client.event("invalidated").areas == ["variables"]
        client.move("stepBack")
        assert client.value("np(0,0).r0") == "2"
        client.move("stepIn")
        assert client.value("np(0,0).r0") == "41"
        assert client.value("np(1,1).mem[9]") == "51"
        for reference, name, value, said in (
            (first.variablesReference, "r0", "256", "expected 0 to 255"),
            (first.variablesReference, "active", "0", "is not a register"),
            (first.variablesReference, "r99", "0", "no variable"),
        ):
            client.protocol.scopes(1)
            client.answer()  # after a movement the registers have their number again
            client.protocol.set_variable(reference, name, value)
            with pytest.raises(Failed, match=said):
                client.answer()


def test_outputs_are_told_once_and_again_after_an_edit(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.start()
        client.move("continue")
        lines = client.output("stdout").splitlines()
        assert lines[0] == "set-up: nothing sent; 1 cycles"
        assert lines[2].startswith("frame 1: count 2, plane 8 x 10 bytes; ")
        client.value("frame back 3", "repl")
        client.stopped()
        client.move("continue")
        assert client.output("stdout").splitlines() == lines
        client.value("frame back 3", "repl")
        client.stopped()
        client.value("edit r0 = 100", "repl")
        client.move("continue")
        new = client.output("stdout").splitlines()[len(lines) :]
        counts = [line.partition(",")[0] for line in new]
        assert counts == [f"frame {3 + n}: count {101 + n}" for n in range(3)]
        client.value("restart", "repl")
        client.stopped()
        client.move("continue")
        assert client.output("stdout").splitlines()[-len(lines) :] == lines


def test_disassembly(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.start()
        answer = client.ask(
            "disassemble", memoryReference="0x000", instructionOffset=-1, instructionCount=15
        )
        found = answer.body["instructions"]
        assert [item["address"] for item in found[:3]] == ["-1", "0x000", "0x001"]
        hints = ["invalid", *[None] * 13, "invalid"]
        assert [item.get("presentationHint") for item in found] == hints
        expected = {"instruction": "EXPOSE", "symbol": "frame", "instructionBytes": "006A"}
        assert found[2] == found[2] | expected
        assert found[5]["instruction"] == "CALL more"
        assert (found[6]["instruction"], found[6]["line"]) == ("ADD value, value", INSIDE)
        with pytest.raises(Failed, match="no address of an instruction"):
            client.ask("disassemble", memoryReference="np(0,0)", instructionCount=1)


def test_memory(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        at_store(client, sample)

        def read(reference: str, offset: int, count: int) -> Any:
            return client.ask("readMemory", memoryReference=reference, offset=offset, count=count)

        whole = read("np(2,3)", 0, 300)
        assert whole.unreadableBytes == 44
        assert base64.b64decode(whole.data)[:65] == bytes([10] * 64 + [0])
        assert base64.b64decode(read("np(2,3).mem[64]", -1, 2).data) == bytes([10, 0])
        assert base64.b64decode(read("r1", 0, 80).data) == ROWS
        assert base64.b64decode(read("pixels", 80, 3).data) == bytes([10] * 3)
        outside = read("np(2,3)", -5, 3)
        assert (outside.data, outside.unreadableBytes) == (None, 3)
        text = base64.b64encode(bytes([1, 2, 3])).decode()
        for reference, offset in (("np(2,3)", 100), ("r5", 78), ("pixels", 0)):
            arguments = {"memoryReference": reference, "offset": offset, "data": text}
            if reference == "r5":
                with pytest.raises(Failed, match="do not fit"):
                    client.ask("writeMemory", **arguments)
                arguments["allowPartial"] = True
            written = client.ask("writeMemory", **arguments).bytesWritten
            assert written == (2 if reference == "r5" else 3)
        assert client.value("np(2,3).mem[102]") == "3"
        assert client.value("np(7,9).r5") == "2"
        assert client.value("pixel(0,1)") == "2"
        client.move("stepIn")
        client.move("stepBack")
        assert client.value("np(2,3).mem[102]") == "3"
        for wrong in ({"data": "?"}, {"memoryReference": "nothing"}):
            with pytest.raises(Failed, match=r"not base64|no register"):
                client.ask("writeMemory", **{"memoryReference": "r5", "data": text} | wrong)


def test_pictures(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.start()
        before = client.ask("npchip/picture", what="pixels").body
        assert plain(before) == bytes(64 * 80)
        client.ask("setBreakpoints", **sample.lines({"line": 17, "condition": "frame == 1"}))
        client.move("continue")

        def picture(what: str) -> dict[str, Any]:
            return dict(client.ask("npchip/picture", what=what).body)

        frame = picture("pixels")
        assert (frame["rows"], frame["cols"], frame["dtype"], frame["frame"]) == (
            64,
            80,
            "uint8",
            1,
        )
        assert plain(frame) == bytes([10] * 64 * 80)
        assert plain(picture("bank 0")) == plain(frame)
        assert (picture("r1")["rows"], plain(picture("r1"))) == (8, ROWS)
        assert picture("active") | {"data": ""} == {
            "what": "active",
            "rows": 8,
            "cols": 10,
            "dtype": "bool",
            "data": "",
            "frame": 1,
        }
        assert plain(picture("active")) == bytes([1] * 80)
        assert plain(picture("mem[70]")) == bytes([20] * 80)
        assert plain(picture("port 1")) == plain(picture("output plane")) == bytes([20] * 80)
        assert plain(picture("output count")) == bytes([2])
        for wrong in ("bank 3", "port x", "port 9", "output nothing", "nothing"):
            with pytest.raises(Failed, match=r"NP351|NP358"):
                picture(wrong)


WIDE = ".output far, 2, scalar16\n MOV r0, #7\n OUT 2, r0\n MOV r0, #1\n OUT 2, r0\n HALT\n"


def test_a_picture_of_numbers(sample: Sample) -> None:
    sample.source.write_text(WIDE, encoding="utf-8")
    with adapter_here(**sample.launch(frames=None)) as client:
        client.start()
        empty = client.ask("npchip/picture", what="output far").body
        assert (empty["rows"], empty["cols"], plain(empty)) == (0, 0, b"")
        client.move("continue")
        found = client.ask("npchip/picture", what="port 2").body
        assert (found["rows"], found["cols"], plain(found)) == (1, 2, bytes([7, 1]))


def test_completions(sample: Sample) -> None:
    with adapter_here(**sample.launch()) as client:
        client.start()
        client.protocol.completions("print va", 9, 1)
        targets = client.answer().targets
        assert [(item.label, item.start, item.length) for item in targets] == [("value", 6, 2)]
        client.protocol.completions("st", 3, None)
        assert [item.label for item in client.answer().targets] == ["step"]
