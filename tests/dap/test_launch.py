"""Launches: the keys that they take, and the errors of those that fail."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.dap.client import Client, Failed, adapter_here
from tests.dap.sample import LOAD, START, Sample


def refused(**launch: Any) -> str:
    """Return why a launch is refused; after that another one works."""
    with adapter_here() as client:
        with pytest.raises(Failed) as caught:
            client.ask("launch", **launch)
        client.launch(program="imaging")
        return str(caught.value)


def test_everything_that_a_launch_takes(sample: Sample) -> None:
    folder = sample.source.parent
    np.save(folder / "m.npy", np.full((2, 8, 10), 9, np.uint8))
    (folder / "inc").mkdir()
    (folder / "inc" / "more.s").write_text(".equ MORE, 7\n", encoding="utf-8")
    text = f'.include "more.s"\n{sample.source.read_text(encoding="utf-8")}'
    sample.source.write_text(text, encoding="utf-8")
    launch = {
        "machine": "conservative",
        "defines": {"STEP": "0x2"},
        "memory": {"0xC8": str(folder / "m.npy")},
        "include": [str(folder / "inc")],
        "fit": "crop",
        "maxCycles": 1_000_000,
        "frame": "x",
        "__sessionId": "what editors add",
    }
    with adapter_here(**sample.launch(**launch)) as client:
        assert "'frame' has no effect: did you mean 'frames'?" in client.output("important")
        client.start()
        assert client.line == START + 1
        assert client.value("STEP") == "2, 0x02"
        assert client.value("MORE") == "7, 0x07"
        assert client.value("np(7,9).mem[201]") == "9"
        name = client.ask("threads").threads[0].name
        assert name == "sample on conservative, 8 x 10 NPs"


def test_lists_as_options_have_them(sample: Sample) -> None:
    np.save(sample.source.parent / "m.npy", np.full((1, 8, 10), 9, np.uint8))
    memory = [f"200={sample.source.parent / 'm.npy'}"]
    with adapter_here(**sample.launch(defines=["STEP=3"], memory=memory)) as client:
        client.start()
        assert client.value("STEP") == "3, 0x03"
        assert client.value("np(0,0).mem[200]") == "9"


def test_bundled_names(sample: Sample) -> None:
    launch = {"program": "trajectory", "frames": "coin_slide"}
    with adapter_here(**sample.launch(**launch)) as client:
        client.start()
        client.move("continue")
        assert "frame 12: " in client.output("stdout")


def test_what_the_project_file_says_holds(sample: Sample) -> None:
    project = sample.source.parent / "npchip.toml"
    project.write_text('machine = "big.yaml"\n[defines]\nSTEP = 5\n', encoding="utf-8")
    launch = sample.launch(frames=None)
    with adapter_here(**launch) as client:
        client.start()
        assert client.value("STEP") == "5, 0x05"
        assert client.ask("npchip/picture", what="r0").body["rows"] == 128
    with adapter_here(**launch, machine="default", defines={"STEP": 6}) as client:
        client.start()
        assert client.value("STEP") == "6, 0x06"
        assert client.ask("npchip/picture", what="r0").body["rows"] == 8
    project.write_text("machine = 3\n", encoding="utf-8")
    assert "npchip.toml:1: error: machine: expected a text" in refused(**launch)


def test_programs_without_a_source(sample: Sample) -> None:
    file = sample.source.with_suffix(".hex")
    file.write_text("1005\n006A\n0001\n", encoding="utf-8")
    with adapter_here(**sample.launch(program=str(file))) as client:
        found = client.ask("setBreakpoints", **sample.lines(LOAD)).breakpoints
        assert not found[0].verified
        client.ask("setInstructionBreakpoints", breakpoints=[{"instructionReference": "1"}])
        client.start()
        frame = client.frames()[0]
        assert (frame.source, frame.line, frame.instructionPointerReference) == (None, 0, "0x000")
        assert client.move("continue").reason == "instruction breakpoint"
        assert client.ask("loadedSources").sources == []


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"program": None}, "launch: program: expected a text, found nothing [NP358]"),
        ({"program": 3}, "launch: program: expected a text, found 3 [NP358]"),
        ({"program": "nowhere.s"}, "cannot read nowhere.s"),
        ({"frames": "nowhere.npy"}, "nowhere.npy"),
        ({"frames": []}, "launch: frames: expected a text"),
        ({"machine": "fast"}, "fast"),
        ({"defines": {"STEP": "many"}}, "launch: defines: STEP: expected a whole number"),
        ({"defines": {"STOP": 1}}, "STOP"),
        ({"defines": "STEP=1"}, "launch: defines: expected an object"),
        ({"memory": {"x": "m.npy"}}, "launch: memory: expected an address"),
        ({"memory": {"0": 7}}, "the name of a .npy file"),
        ({"memory": {"0": "nowhere.npy"}}, "nowhere.npy"),
        ({"fit": "stretch"}, "launch: fit: expected crop or resize"),
        ({"isa": "nowhere.yaml"}, "nowhere.yaml"),
        ({"include": "folder"}, "launch: include: expected a list"),
        ({"include": [3]}, "launch: include: expected a list of texts"),
        ({"maxCycles": 0}, "expected a whole number from 1 to 50000000"),
        ({"stopOnEntry": "yes"}, "launch: stopOnEntry: expected true or false"),
    ],
)
def test_arguments_that_cannot_be(sample: Sample, changed: dict[str, Any], said: str) -> None:
    text = refused(**sample.launch(**changed))
    assert "error: " in text
    assert said in text
    assert "Traceback" not in text


def test_a_source_with_errors_shows_what_asm_shows(sample: Sample) -> None:
    text = sample.source.read_text(encoding="utf-8").replace("ROW     r1", "ROWS    r1")
    sample.source.write_text(text, encoding="utf-8")
    said = refused(**sample.launch())
    assert f"{sample.source}:20:9: error: unknown instruction 'ROWS'" in said
    assert "^" in said


def test_warnings(sample: Sample) -> None:
    text = sample.source.read_text(encoding="utf-8")
    sample.source.write_text(f"{text}        NOP\n", encoding="utf-8")
    with adapter_here(**sample.launch()) as client:
        assert f"{sample.source}:22:" in client.output("important")
    sample.source.write_text("        HALT\n", encoding="utf-8")
    with adapter_here(**sample.launch()) as client:
        assert "takes no frames" in client.output("important")


def test_requests_out_of_order(sample: Sample) -> None:
    with adapter_here() as client:
        for command in ("threads", "next", "nonsense"):
            with pytest.raises(Failed, match="no program has been launched"):
                client.ask(command, threadId=1)
        with pytest.raises(Failed, match="launch a program instead"):
            client.ask("attach")
        client.launch(**sample.launch())
        assert client.move("stepIn").reason == "step"  # no client should, before it has configured
        assert client.move("stepBack").reason == "entry"
        with pytest.raises(Failed, match="launched already"):
            client.ask("launch", **sample.launch())
        client.start()
        client.ask("configurationDone")
        with pytest.raises(Failed, match="there is no request nonsense"):
            client.ask("nonsense")
        assert client.line == START


def test_a_client_that_counts_from_nought(sample: Sample) -> None:
    def first_line(client: Client) -> None:
        client.protocol.initialize("npchip", lines_start_at1=False)
        client.answer()

    with adapter_here() as client:
        first_line(client)
        client.launch(**sample.launch())
        found = client.ask("setBreakpoints", **sample.lines(LOAD - 1)).breakpoints[0]
        assert found.line == LOAD - 1
        client.start()
        client.move("continue")
        assert client.line == LOAD - 1
        with pytest.raises(Failed, match="pathFormat"):
            client.ask("initialize", pathFormat="uri")


def test_the_adapter_reads_paths_from_its_folder(
    sample: Sample, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(sample.source.parent)
    with adapter_here(**sample.launch(program=sample.source.name)) as client:
        found = client.ask("setBreakpoints", **sample.lines(LOAD)).breakpoints[0]
        assert found.verified
        assert Path(found.source.path) == sample.source
