"""Random sessions: what the adapter shows is what a debugger holds after the same moves."""

from __future__ import annotations

import base64
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from npchip import assemble, load_machine
from npchip.debugger import answers
from npchip.debugger.session import Debugger
from npchip.formats import load_program
from npchip.frames import open_frames
from npchip.machine.layout import to_frames
from npchip.run.chip import MAX_CYCLES
from tests.dap.client import Client, adapter_here
from tests.debugger.test_random import conditions_for, make_small, memory_of
from tests.support.profiles import THOROUGH
from tests.support.random_cases import Case
from tests.support.random_programs import draw_case

SESSIONS, PARTS, MOVES = 200 if THOROUGH else 60, 5, 12
COUNTERS = ("pc", "frame", "cycles", "frame_cycles", "instructions", "calls")
CELLS = (*(f"r{number}" for number in range(16)), "Z", "C", "active")


def launch_of(case: Case, folder: Path) -> dict[str, Any]:
    """Write the files of a case, and return its launch."""
    machine, sensor = case.machine, case.machine.sensor
    rows, columns = machine.geometry
    (folder / "random.s").write_text(case.text, encoding="utf-8")
    (folder / "machine.yaml").write_text(
        "extends: default\n"
        f"geometry: {{np_rows: {rows}, np_cols: {columns}}}\n"
        f"memory: {{np_bytes: {machine.memory_bytes}}}\n"
        f"sensor: {{fixed_pattern: {sensor.fixed_pattern}, noise_rms: {sensor.noise_rms},"
        f" seed: {sensor.seed}}}\n",
        encoding="utf-8",
    )
    np.save(folder / "memory.npy", memory_of(case))
    launch: dict[str, Any] = {
        "program": str(folder / "random.s"),
        "machine": str(folder / "machine.yaml"),
        "memory": {"0": str(folder / "memory.npy")},
        "maxCycles": min(case.limit, MAX_CYCLES),
        "stopOnEntry": True,
    }
    if case.frames:
        np.save(folder / "clip.npy", case.clip())
        launch["frames"] = str(folder / "clip.npy")
    return launch


def twin_of(case: Case, launch: dict[str, Any]) -> Debugger:
    """Return a debugger of the same launch."""
    machine = load_machine(launch["machine"])
    return Debugger(
        assemble(launch["program"], machine),
        case.clip() if case.frames else None,
        machine,
        memory=[(0, memory_of(case))],
        max_cycles=launch["maxCycles"],
    )


def shown(client: Client, twin: Debugger) -> None:
    """Compare all that a client can ask with what the debugger holds."""
    chip = twin.chip
    control = client.scope("Control")
    counters = {name: int(control[name].value) for name in (*COUNTERS, "masks")}
    taken = chip.frames_taken - 1
    values = (chip.pc, taken, chip.cycles, chip.frame_cycles, chip.instructions)
    expected = (*values, len(chip.stack), chip.depth)
    assert tuple(counters.values()) == expected
    for name, value in twin.outputs.items():
        assert control[f"output {name}"].value == answers.output(value)
    planes = [*chip.registers, *chip.flags.values(), chip.active]
    for name, plane in zip(CELLS, planes, strict=True):
        answer = client.ask("readMemory", memoryReference=name, count=plane.size)
        assert base64.b64decode(answer.data) == plane.astype(np.uint8).tobytes(), name
    for bank in range(0, len(chip.memory), 64):
        picture = client.ask("npchip/picture", what=f"bank {bank}").body
        assert (
            base64.b64decode(picture["data"]) == to_frames(chip.memory[bank : bank + 64]).tobytes()
        )
    if chip.frame is not None:
        picture = client.ask("npchip/picture", what="pixels").body
        assert base64.b64decode(picture["data"]) == chip.frame.tobytes()
    references = [int(item.instructionPointerReference, 16) for item in client.frames()]
    assert list(dict.fromkeys(references)) == list(
        dict.fromkeys((chip.pc, *(back - 1 for back in reversed(chip.stack))))
    )


def move(client: Client, twin: Debugger, random: Random) -> None:
    """Make the same random move with both."""
    ways = {
        "stepIn": twin.step,
        "next": twin.step_over,
        "stepOut": twin.step_out,
        "continue": twin.run,
        "stepBack": twin.step_back,
        "reverseContinue": twin.run_back,
    }
    name = random.choice([*ways, "goto"])
    if name in ways:
        client.ask(name, threadId=1)
        ways[name]()
    else:
        time = random.randrange(2 * twin.time + 20)
        client.value(f"goto {time}", "repl")
        twin.seek(time)
    stop = client.event("stopped", "exited")
    at_breakpoint = bool(getattr(stop, "hitBreakpointIds", None))
    assert at_breakpoint == (twin.stop.reason == "breakpoint"), name


@pytest.mark.long
@pytest.mark.parametrize("part", range(PARTS))
def test_states_are_those_of_the_debugger(
    part: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_small(monkeypatch)
    times = set()
    for seed in range(part, SESSIONS, PARTS):
        random = Random(seed)
        case = draw_case(random, plain=True)
        launch = launch_of(case, tmp_path)
        twin = twin_of(case, launch)
        words = len(twin.program.words)
        texts = [text.removeprefix("at ") for text in conditions_for(random, case, words)]
        for text in texts:
            twin.add(text)
        # A log point changes nothing, so the twin has none.
        log = {"name": str(random.randrange(words)), "logMessage": "{pc}"}
        with adapter_here(**launch) as client:
            points = [{"name": text} for text in texts]
            client.ask("setFunctionBreakpoints", breakpoints=[*points, log])
            client.start()
            for _ in range(MOVES):
                move(client, twin, random)
                shown(client, twin)
                times.add((seed, twin.time))
        (tmp_path / "clip.npy").unlink(missing_ok=True)
    assert len(times) > SESSIONS // PARTS * MOVES // 4


@pytest.mark.long
def test_an_interrupted_run_stands_at_a_moment_of_the_run() -> None:
    launch = {"program": "keypoints", "frames": "shapes_photo", "stopOnEntry": True}
    machine = load_machine("default")
    twin = Debugger(load_program("keypoints"), open_frames("shapes_photo", 64, 80), machine)
    random = Random(1)
    times = set()
    with adapter_here(**launch) as client:
        client.ask("setFunctionBreakpoints", breakpoints=[{"name": "any r0 > 300"}])  # never
        client.start()
        for _ in range(20):
            client.ask("continue" if random.randrange(3) else "reverseContinue", threadId=1)
            for _ in range(random.randrange(3)):
                client.ask("setInstructionBreakpoints", breakpoints=[])
            client.ask("pause", threadId=1)
            assert client.stopped().reason in {"pause", "entry"}
            time = int(client.value("instructions"))
            times.add(time)
            twin.seek(time)
            shown(client, twin)
            client.value(f"goto {random.randrange(40_000)}", "repl")
            client.stopped()
    assert len(times) > 10
