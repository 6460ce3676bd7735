"""The hosts of ``examples/hosts`` run modules with the results and the state of npchip."""

from __future__ import annotations

import json
import shutil
import subprocess
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
import pytest

from examples.hosts import host
from npchip import Chip, Program, assemble_text, load_machine
from npchip.formats.module import to_module
from npchip.isa import load_isa
from npchip.report.jsonform import to_document
from npchip.run.partner import sent_by
from tests.support.chips import LOOP, clip_of, machine_of, word
from tests.support.clips import CLIPS
from tests.support.programs import ASM, assembled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip import Machine

ROOT = Path(__file__).parents[2]
PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
LIMIT = 50_000_000
NODE = shutil.which("node")
Host = Literal["python", "node"]
HOSTS = [
    pytest.param("python"),
    pytest.param("node", marks=pytest.mark.skipif(not NODE, reason="Node is not installed")),
]


class Job(NamedTuple):
    """A program on a clip, with a table in the NPs' memory and a partner's job."""

    program: Program
    machine: Machine
    clip: NDArray[np.uint8]
    limit: int = LIMIT
    memory: tuple[tuple[int, NDArray[np.uint8]], ...] = ()
    partner: Any = None


def expected(job: Job) -> dict[str, Any]:
    """What npchip says about a job, with the state at its end."""
    chip = Chip(job.program, job.machine)
    for address, planes in job.memory:
        chip.load_memory(address, planes)
    if job.partner is not None:
        partner = Chip(job.partner.program, job.partner.machine)
        result = partner.run(job.partner.clip, max_cycles=job.limit)
        chip.connect(sent_by(job.partner.program, result, job.machine.geometry[:2]))
    document = to_document(chip.run(job.clip, max_cycles=job.limit), 1)
    for key in ("schema", "engine", "clock_hz"):
        del document[key]
    if "error" in document:
        error = document["error"]
        message = None if error["code"] in ("NP310", "NP311") else error["message"]
        document["error"] = {"code": error["code"], "message": message, "address": error["address"]}
    state = chip.snapshot().state
    return document | {
        "state": {
            "address": state.pc,
            "stack": list(state.stack),
            "depth": state.depth,
            "registers": state.registers.tolist(),
            "zero": state.zero.astype(int).tolist(),
            "carry": state.carry.astype(int).tolist(),
            "masks": [(state.activity < k).astype(int).tolist() for k in range(state.depth, 0, -1)],
            "memory": state.memory.tolist(),
        }
    }


def found(way: Host, job: Job, folder: Path) -> dict[str, Any]:
    """What a host says about a job."""
    files, partner = written(job, folder), []
    if job.partner is not None:
        partner = written(job.partner, folder)
    if way == "python":
        frames = host.run(partner, job.limit, []).frames if partner else []
        run = host.run(files, job.limit, frames)
        through_json: dict[str, Any] = json.loads(
            json.dumps(run.document() | {"state": run.state()})
        )
        return through_json
    command = ["node", ROOT / "examples/hosts/host.mjs", *files, "--max-cycles", str(job.limit)]
    command += ["--partner", *partner] * bool(partner)
    printed = subprocess.run([*command, "--state"], capture_output=True, check=True).stdout
    document: dict[str, Any] = json.loads(printed)
    return document


def written(job: Job, folder: Path) -> list[Path]:
    """Write the files that a host takes."""
    module, clip = folder / f"{job.program.name}.wasm", folder / f"{job.program.name}.npy"
    module.write_bytes(to_module(job.program, job.machine, load_isa(), job.memory))
    np.save(clip, job.clip)
    return [module, clip]


def check(way: Host, job: Job, folder: Path) -> dict[str, Any]:
    document = found(way, job, folder)
    assert document == expected(job)
    assert [*document["setup"]["outputs"]]
    return document


@cache
def bundled(name: str) -> NDArray[np.uint8]:
    clip: NDArray[np.uint8] = np.load(CLIPS / f"{name}.npy")
    return clip


def job_of(name: str, machine: str, clip: str, **changes: Any) -> Job:
    """A program of ``asm/`` on a clip of ``examples/clips``."""
    job = Job(assembled(name, machine), load_machine(machine), bundled(clip), **changes)
    if name != "fusion_lut":
        return job
    table = np.load(ROOT / "examples/templates/fusion_chip.npy")
    return job._replace(memory=((192, table),), partner=job_of("sighting", machine, "shapes_drawn"))


QUICK = {("trajectory", "default", "coin_slide"), ("fusion_lut", "default", "coin_slide")}
CASES = [
    pytest.param(*case, marks=() if case in QUICK else pytest.mark.long)
    for case in product(PROGRAMS, ("default", "conservative"), ("coin_slide", "shapes_drawn"))
]


@pytest.mark.parametrize("way", HOSTS)
@pytest.mark.parametrize(("name", "machine", "clip"), CASES)
def test_programs(way: Host, name: str, machine: str, clip: str, tmp_path: Path) -> None:
    check(way, job_of(name, machine, clip), tmp_path)


HEAD = """
.output n, 1, scalar
.output w, 2, scalar16
.output l, 3, list
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
ENDS = {
    "halts": ("last: MOV r1, #3\nOUT 3, r1\nHALT", "halted", None),
    "calls too deep": ("last: CALL last", "failed", "NP301"),
    "returns": ("last: MOV r1, #3\nRET", "failed", "NP302"),
    "runs off the end": ("last: NOP", "failed", "NP305"),
    "hears nothing": ("last: IN r1, 4", "failed", "NP306"),
    "disagrees": (
        "last: LD r1, [0]\nSAMPLE signal, 0\nLD r1, [0]\nOUT 1, r1\nJMP frame",
        "failed",
        "NP310",
    ),
    "disagrees, then agrees": (
        "last: SAMPLE signal, 0\nLD r1, [0]\nOUT 1, r1\nOUT 1, r0\nJMP frame",
        "frames-exhausted",
        None,
    ),
    "sends one byte too many": ("last: OUT 2, r0\nJMP frame", "failed", "NP311"),
    "breaks a rule, then halts": ("last: OUT 2, r0\nHALT", "failed", "NP311"),
    "breaks a rule, then traps": ("last: OUT 2, r0\nRET", "failed", "NP302"),
    "sends to ports without a name": (
        "last: OUT 12, r0\nOUT 7, r0\nOUT 12, r0\nJMP frame",
        "frames-exhausted",
        None,
    ),
    "never ends": (
        "last: SAMPLE signal, 0\nLD r1, [9]\nWHERE EQ\nOUT 7, r1\nJMP last",
        "cycle-limit",
        None,
    ),
}


@pytest.mark.parametrize("way", HOSTS)
@pytest.mark.parametrize("end", ENDS)
def test_ends(way: Host, end: str, tmp_path: Path) -> None:
    text, status, code = ENDS[end]
    if end == "never ends":
        text = text.replace("WHERE EQ", "CMP r1, #70\nWHERE HI\nNOP").replace(
            "JMP last", "END\nJMP last"
        )
    machine = machine_of()
    program = assemble_text(HEAD + text, "program.s", machine)
    job = Job(replace(program, name="program"), machine, clip_of(7, machine), 5_000)
    document = check(way, job, tmp_path)
    assert (document["status"], document.get("error", {}).get("code")) == (status, code)
