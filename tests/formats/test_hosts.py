"""The hosts of ``examples/hosts`` run modules with the results and the state of npchip."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from npchip import Chip, Program, assemble_text, load_machine
from npchip.frames.memory import initial_memory
from tests.support.chips import clip_of, machine_of, word
from tests.support.clips import CLIPS
from tests.support.hosts import HOSTS, LIMIT, NODE, ROOT, Host, Job, check, expected, written
from tests.support.profiles import THOROUGH
from tests.support.programs import ASM, assembled
from tests.support.random_programs import draw_case

if TYPE_CHECKING:
    from numpy.typing import NDArray


PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))


@cache
def bundled(name: str) -> NDArray[np.uint8]:
    clip: NDArray[np.uint8] = np.load(CLIPS / f"{name}.npy")
    return clip


def job_of(name: str, machine: str, clip: str, **changes: Any) -> Job:
    """A program of ``asm/`` on a clip of ``examples/clips``."""
    job = Job(assembled(name, machine), load_machine(machine), bundled(clip), **changes)
    if job.program.memory:
        return job._replace(memory=tuple(initial_memory(job.program, job.machine)))
    if name != "fusion_lut":
        return job
    table = np.load(ROOT / "examples/templates/fusion_chip.npy")
    return job._replace(memory=((192, table),), partner=job_of("sighting", machine, "shapes_drawn"))


QUICK = {("trajectory", "default", "coin_slide")}
CASES = [
    pytest.param(*case, marks=() if case in QUICK else pytest.mark.long)
    for case in product(PROGRAMS, ("default", "conservative"), ("coin_slide", "shapes_drawn"))
]


@pytest.mark.parametrize("way", HOSTS)
@pytest.mark.parametrize(("name", "machine", "clip"), CASES)
def test_programs(way: Host, name: str, machine: str, clip: str, tmp_path: Path) -> None:
    check(way, job_of(name, machine, clip), tmp_path)


HEAD = """
.output w, 2, scalar16
.output n, 1, scalar
.output l, 3, list
.output port13, 6, plane
        MOV r0, #1
        OUT 5, r0
frame:  EXPOSE
        ADD r0, #1
        OUT 1, r0
        OUT 2, r0
        OUT 2, r0
        CMP r0, #4
        JANY EQ, last
        JMP frame
"""
FRAME = "SAMPLE signal, 0\nLD r1, [0]\nCMP r1, #70\n"
ENDS = {
    "halts": ("MOV r1, #3\nOUT 3, r1\nHALT", "halted", None),
    "calls too deep": ("CALL last", "failed", "NP301"),
    "returns": ("MOV r1, #3\nRET", "failed", "NP302"),
    "runs off the end": ("NOP", "failed", "NP305"),
    "hears nothing": ("IN r1, 4", "failed", "NP306"),
    "disagrees": (FRAME + "OUT 1, r1\nJMP frame", "failed", "NP310"),
    "disagrees before the last send": (
        FRAME + "OUT 1, r1\nOUT 1, r0\nJMP frame",
        "frames-exhausted",
        None,
    ),
    "disagrees, then traps": (FRAME + "OUT 1, r1\nOUT 7, r0\nRET", "failed", "NP302"),
    "some do not send": (
        FRAME + "WHERE HI\nOUT 1, r0\nOUT 3, r0\nOUT 7, r1\nEND\nJMP frame",
        "frames-exhausted",
        None,
    ),
    "none sends": (
        "CMP r0, #4\nWHERE NE\nOUT 2, r0\nOUT 3, r0\nOUT 7, r0\nEND\nJMP frame",
        "frames-exhausted",
        None,
    ),
    "breaks two rules": (FRAME + "OUT 1, r1\nOUT 2, r0\nJMP frame", "failed", "NP311"),
    "sends one byte too many": ("OUT 2, r0\nJMP frame", "failed", "NP311"),
    "breaks a rule, then halts": ("OUT 2, r0\nHALT", "failed", "NP311"),
    "breaks a rule, later halts": ("OUT 2, r0\nEXPOSE\nHALT", "failed", "NP311"),
    "sends to ports without a name": (
        "OUT 13, r0\nOUT 12, r0\nOUT 7, r0\nOUT 12, r0\nJMP frame",
        "frames-exhausted",
        None,
    ),
    "never ends": (FRAME + "WHERE HI\nOUT 7, r1\nEND\nJMP last", "cycle-limit", None),
    "stops in masked regions": (
        "WHERE EQ\nCMP r0, #9\nWHERE LO\n" + "NOP\n" * 9 + "END\nEND\nJMP frame",
        "cycle-limit",
        None,
    ),
}
LIMITS = {"never ends": 5_000, "stops in masked regions": 20}
QUICK_ENDS = {"halts", "returns", "disagrees", "never ends"}
"""Endings that both hosts run in the quick profile; the host in Python runs all."""


@pytest.mark.parametrize(
    ("way", "end"),
    [
        pytest.param(
            *(way.values[0], end),
            marks=[*way.marks, *[pytest.mark.long] * (way is HOSTS[1] and end not in QUICK_ENDS)],
        )
        for way, end in product(HOSTS, ENDS)
    ],
)
def test_ends(way: Host, end: str, tmp_path: Path) -> None:
    text, status, code = ENDS[end]
    job = job_with(f"{HEAD}last: {text}", LIMITS.get(end, LIMIT))
    document = check(way, job, tmp_path)
    assert (document["status"], document.get("error", {}).get("code")) == (status, code)
    assert document["state"]["depth"] == 2 * (end == "stops in masked regions")


def job_with(source: str, limit: int = LIMIT) -> Job:
    machine = machine_of()
    program = assemble_text(source, "program.s", machine)
    return Job(program, machine, clip_of(7, machine), limit)


@pytest.mark.parametrize("way", HOSTS)
def test_a_halt_in_the_setup(way: Host, tmp_path: Path) -> None:
    document = check(way, job_with(".output n, 1, scalar\nMOV r1, #3\nOUT 1, r1\nHALT"), tmp_path)
    assert (document["setup"]["outputs"], document["frames"]) == ({"n": 3}, [])


@pytest.mark.parametrize("way", HOSTS)
@pytest.mark.parametrize("words", [[0], [word("WHERE", cc="EQ")] * 16])
def test_words_that_cannot_be_executed(way: Host, words: list[int], tmp_path: Path) -> None:
    program = Program("raw", (word("EXPOSE"), *words))
    document = check(way, job_with("HALT")._replace(program=program), tmp_path)
    assert document["error"]["code"] == ("NP303" if words == [0] else "NP304")


@pytest.mark.parametrize("way", HOSTS)
@pytest.mark.parametrize(
    "limit", [0, 1, *[pytest.param(n, marks=pytest.mark.long) for n in range(2, 30)]]
)
def test_limits(way: Host, limit: int, tmp_path: Path) -> None:
    check(way, job_with(f"{HEAD}last: HALT", limit), tmp_path)


@pytest.mark.parametrize("way", HOSTS)
def test_a_number_that_only_the_fast_form_knows(way: Host, tmp_path: Path) -> None:
    source = """
        MOV r0, #2
count:  ADD r0, #1
        CMP r0, #5
        JANY NE, count
frame:  EXPOSE
        ADD r1, #1
        CMP r1, #3
        JANY EQ, slow
        JMP frame
slow:   JMP slow
    """
    document = check(way, job_with(source, 30), tmp_path)
    assert document["status"] == "cycle-limit"
    assert document["state"]["registers"][0][0][0] == 5


@pytest.mark.parametrize("way", HOSTS)
@pytest.mark.parametrize("frames", [1, 3])
def test_a_partner_that_ends_first(way: Host, frames: int, tmp_path: Path) -> None:
    source = "frame: EXPOSE\nIN r1, 3\nIN r2, 3\nOUT 1, r1\nOUT 2, r2\n"
    listener = job_with(
        f".output n, 1, plane\n{source}CMP r1, #3\nJANY EQ, last\nJMP frame\nlast: IN r1, 3"
    )
    speaker = job_with(
        ".output l, 3, list\nframe: EXPOSE\nADD r1, #1\nOUT 3, r1\nOUT 3, r1\nJMP frame"
    )
    speaker = speaker._replace(
        program=replace(speaker.program, name="speaker"), clip=speaker.clip[:frames]
    )
    document = check(way, listener._replace(partner=speaker), tmp_path)
    assert document["error"]["code"] == "NP306"
    assert len(document["frames"]) == max(frames, 2)


@pytest.mark.parametrize("way", HOSTS)
def test_a_limit_late_in_a_long_clip_of_a_noisy_sensor(way: Host, tmp_path: Path) -> None:
    source = f"""
        .output sum, 1, list
        MOV r6, #1
frame:  EXPOSE
        {FRAME}
        OUT 1, r6
        JANY HI, slow
        ADD r5, r1
        JMP frame
slow:   OUT 4, r5
        ADD r6, #1
        JMP slow
    """
    sensor = replace(load_machine("default").sensor, noise_rms=4.0, fixed_pattern=30, seed=3)
    machine = machine_of(sensor=sensor)
    clip = np.zeros((1_500, machine.rows, machine.cols), np.uint8)
    clip[1_400:] = 255
    job = job_with(source, 400)._replace(machine=machine, clip=clip)
    document = check(way, job, tmp_path)
    assert (document["status"], len(document["frames"])) == ("cycle-limit", 1_401)
    assert len(set(document["state"]["registers"][5][0])) > 1


@pytest.mark.long
@pytest.mark.parametrize("way", HOSTS)
def test_a_log_that_fills_within_pictures(way: Host, tmp_path: Path) -> None:
    machine = machine_of()
    job = Job(assembled("imaging", machine), machine, clip_of(1_100, machine))
    check(way, job, tmp_path)


PROGRAMS_DRAWN = 2_000 if THOROUGH else 40


@pytest.mark.long
@pytest.mark.parametrize("way", HOSTS)
def test_random_programs(way: Host, tmp_path: Path) -> None:
    for seed in range(PROGRAMS_DRAWN):
        case = draw_case(Random(seed))
        program = assemble_text(case.text, "program.s", case.machine)
        shape = (case.machine.memory_bytes, *case.machine.geometry)
        planes = np.random.default_rng(seed).integers(0, 256, shape, np.uint8)
        clip = clip_of(1 + 2 * case.frames, case.machine, seed)
        job = Job(program, case.machine, clip, case.limit, ((0, planes),))
        check(way, job, tmp_path)


PAGE = (ROOT / "docs" / "module.md").read_text(encoding="utf-8")
COMMANDS = [line for line in PAGE.splitlines() if " examples/hosts/host." in line]


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(line, marks=HOSTS[line.startswith("node")].marks, id=line.split()[0])
        for line in COMMANDS
    ],
)
def test_the_commands_of_the_page(command: str, tmp_path: Path) -> None:
    job = job_of("trajectory", "default", "coin_slide", limit=10_000)
    written(job, tmp_path)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    program, *arguments = command.split()
    program = sys.executable if program == "python" else program
    done = subprocess.run([program, *arguments], cwd=tmp_path, capture_output=True, check=True)
    wanted = expected(job)
    shown = wanted if "--state" in arguments else {**wanted, "state": None}
    assert {"state": None} | json.loads(done.stdout) == shown


def test_the_host_in_python_needs_wasmtime_alone() -> None:
    lines = (ROOT / "examples/hosts/host.py").read_text(encoding="utf-8").splitlines()
    imported = {line.split()[1] for line in lines if line.startswith(("import ", "from "))}
    assert imported - sys.stdlib_module_names == {"wasmtime"}


STEPPER = """
import { readFileSync } from 'node:fs';
const whole = new WebAssembly.Module(readFileSync(process.argv[2]));
const module = new WebAssembly.Module(WebAssembly.Module.customSections(whole, 'npchip.step')[0]);
const [text] = WebAssembly.Module.customSections(module, 'npchip');
const form = JSON.parse(new TextDecoder().decode(text));
let tick;
const ask = (request) => (request === form.requests.tick ? tick() : 0);
const { memory, run, complete } = new WebAssembly.Instance(module, { host: { ask } }).exports;
const view = new DataView(memory.buffer);
view.setUint32(form.words.log_end, form.log, true);
view.setUint32(form.words.data_end, form.data, true);
let block = 0;
for (let k = 0; k < 40; k++) {
  block = step(block);
  console.log(form.blocks[block].address, view.getUint8(form.planes.registers));
}
"""


@pytest.mark.skipif(not NODE, reason="Node is not installed")
def test_the_page_s_step(tmp_path: Path) -> None:
    source = "MOV r0, #9\nloop: CALL less\nOUT 1, r0\nJANY NE, loop\nHALT\nless: SUB r0, #1\nRET"
    job = job_with(source)
    snippet = PAGE.split("```js\n")[1].split("```")[0]
    (tmp_path / "step.mjs").write_text(STEPPER + snippet)
    command = ["node", str(tmp_path / "step.mjs"), written(job, tmp_path)[0]]
    shown = subprocess.run(command, capture_output=True, check=True, text=True).stdout
    chip, wanted = Chip(job.program, job.machine), []
    for _ in range(40):
        chip.step()
        wanted.append(f"{chip.pc} {chip.registers[0, 0, 0]}")
    assert shown.splitlines() == wanted
