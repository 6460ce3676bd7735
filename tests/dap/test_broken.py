"""The real process, and clients that are broken."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from tests.dap.client import ROOT, TIMEOUT, adapter, end, started
from tests.dap.sample import CALL, FRAMES, LOAD, START, Sample

pytestmark = pytest.mark.long


def message(command: str, number: int = 1, **arguments: object) -> bytes:
    body = {"seq": number, "type": "request", "command": command, "arguments": arguments}
    return framed(json.dumps(body).encode())


def framed(body: bytes) -> bytes:
    return b"Content-Length: %d\r\n\r\n" % len(body) + body


def answers(data: bytes) -> list[dict[str, Any]]:
    parts = data.split(b"Content-Length")[1:]
    return [json.loads(part[part.index(b"{") :]) for part in parts]


def served(data: bytes) -> subprocess.CompletedProcess[bytes]:
    """Send something to an adapter, and then close its input."""
    return subprocess.run(
        [sys.executable, "-m", "npchip", "dap"],
        input=data,
        capture_output=True,
        timeout=TIMEOUT,
        check=False,
    )


def test_a_session(sample: Sample) -> None:
    with adapter(**sample.launch()) as client:
        client.ask("setBreakpoints", **sample.lines(CALL))
        client.start()
        assert client.line == START
        for _ in range(FRAMES):
            assert client.move("continue").reason == "breakpoint"
            client.move("next")
        assert client.move("continue").description == "no frame is left"
        assert client.move("stepBack").reason == "step"
        for _ in range(FRAMES):
            assert client.move("reverseContinue").reason == "breakpoint"
        assert client.value("frame") == "0"


def test_every_program_of_asm_starts_and_ends() -> None:
    """Those that take frames end without any at their first expose; others may halt or be long."""
    programs = sorted((ROOT / "asm").glob("*.s"))
    assert len(programs) > 20
    for program in programs[::5]:
        with adapter(program=str(program), stopOnEntry=True) as client:
            client.start()
            path = client.frames()[0].source.path
            assert Path(path).is_relative_to(ROOT / "asm")
            assert client.move("continue").reason in {"pause", "exception"}


def test_an_endless_program_is_interrupted_soon(tmp_path: Path) -> None:
    (tmp_path / "loop.s").write_text("loop:   ADD r0, #1\n        JMP loop\n", encoding="utf-8")
    with adapter(program=str(tmp_path / "loop.s"), maxCycles=50_000_000) as client:
        client.protocol.configuration_done()
        client.answer()
        time.sleep(0.5)
        begin = time.perf_counter()
        client.ask("pause", threadId=1)
        assert client.stopped().reason == "pause"
        # 0.1 s on a quiet machine; a busy one has more time.
        assert time.perf_counter() - begin < 5
        assert int(client.value("instructions")) > 0


def test_garbage_is_left_out(sample: Sample) -> None:
    data = (
        b"GET / HTTP/1.1\r\nHost: x\r\n\r\n\x00\xff"
        + message("initialize", 1)
        + framed(b"{oops")
        + framed(b"[1, 2]")
        + framed(b'"text"')
        + framed(b"[" * 100_000)
        + framed(b'{"type": "request"}')
        + framed(b'{"type": "event", "event": "x"}')
        + framed(b'{"type": "request", "command": "launch", "arguments": [3]}')
        + b"nonsense "
        + message("threads", 2)
        + message("launch", 3, **sample.launch())
        + message("setBreakpoints", 4, source=3)
        + message("setBreakpoints", 5, source={"path": "\udc80"}, breakpoints=[{"line": "x"}])
        + message("variables", 6, variablesReference=10**30)
        + message("stackTrace", 7, startFrame=-1)
        + message("disassemble", 8, memoryReference="0x", instructionCount=3)
        + message("disassemble", 9, memoryReference="0x0", instructionCount=10**9)
        + message("readMemory", 10, memoryReference="np(0,0)", count=10**12)
        + message("evaluate", 11, expression="\x00" * 1000, context="repl")
        + message("setBreakpoints", 12, source={"path": "\0"}, breakpoints=[{"line": 1}])
        + message("completions", 13, text="", column=-4)
        + message("disconnect", 14)
    )
    done = served(data)
    assert (done.returncode, b"Traceback" in done.stderr) == (0, False)
    lines = done.stderr.decode().splitlines()
    assert all(line.startswith("npchip dap: ") for line in lines)
    assert len(lines) == 6
    found = {item["request_seq"]: item for item in answers(done.stdout) if "request_seq" in item}
    assert [number for number, item in found.items() if item["success"]] == [1, 3, 10, 12, 14]
    assert not any("internal error" in str(item) for item in found.values())
    assert found[12]["body"]["breakpoints"][0]["verified"] is False


@pytest.mark.parametrize(
    "data",
    [b"", b"Content-Le", b"Content-Length: 50\r\n\r\n{", b"\xff" * 100_000, message("initialize")],
)
def test_the_end_of_the_input_ends_the_adapter(data: bytes) -> None:
    done = served(data)
    assert (done.returncode, done.stderr) == (1, b"")


def test_a_message_that_is_too_long() -> None:
    done = served(b"Content-Length: 99999999999\r\n\r\n{}")
    assert done.returncode == 2
    assert done.stderr.startswith(b"error: a message of 99999999999 bytes")
    assert b"[NP359]" in done.stderr


@pytest.mark.parametrize("moving", [False, True])
def test_an_editor_that_dies(sample: Sample, moving: bool) -> None:
    sample.source.write_text("loop:   ADD r0, #1\n        JMP loop\n", encoding="utf-8")
    launch = sample.launch(frames=None, maxCycles=50_000_000, stopOnEntry=not moving)
    process = started()
    try:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdin.write(message("launch", **launch) + message("configurationDone"))
        process.stdin.flush()
        os.read(process.stdout.fileno(), 1)
        process.stdout.close()
        process.stdin.write(message("threads"))
        process.stdin.flush()
        process.stdin.close()
        assert process.wait(TIMEOUT) == 1
        assert process.stderr.read() == b""
    finally:
        end(process)


def test_an_output_that_nobody_reads(sample: Sample) -> None:
    """The input stays open, and the adapter ends as soon as it has something to say."""
    process = started()
    try:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdout.close()
        process.stdin.write(message("launch", **sample.launch()))
        process.stdin.flush()
        assert process.wait(TIMEOUT) == 1
    finally:
        end(process)


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c(sample: Sample) -> None:
    process = started()
    try:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdin.write(message("launch", **sample.launch()))
        process.stdin.flush()
        os.read(process.stdout.fileno(), 1)
        process.send_signal(signal.SIGINT)
        assert process.wait(TIMEOUT) == 130
        assert process.stderr.read().strip() == b"interrupted"
    finally:
        end(process)


def test_random_bytes_end_cleanly(sample: Sample) -> None:
    random_ = random.Random(1)
    whole = message("initialize") + message("launch", **sample.launch()) + message("scopes")
    whole += message("setBreakpoints", **sample.lines(LOAD)) + message("configurationDone")
    for _ in range(20):
        data = bytearray(whole)
        for _ in range(random_.randrange(1, 6)):
            at = random_.randrange(len(data))
            match random_.randrange(3):
                case 0:
                    data[at] = random_.randrange(256)
                case 1:
                    del data[at : at + random_.randrange(1, 50)]
                case _:
                    data[at:at] = random_.randbytes(random_.randrange(1, 50))
        done = served(bytes(data))
        assert done.returncode in {1, 2}
        assert b"Traceback" not in done.stderr
        assert b"internal error" not in done.stdout + done.stderr
