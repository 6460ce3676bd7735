"""Jobs for the hosts of ``examples/hosts``, and what npchip says about them."""

from __future__ import annotations

import io
import json
import shutil
import subprocess
from contextlib import redirect_stdout
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
import pytest

from examples.hosts import host
from npchip import Chip, Program
from npchip.formats.module import to_module
from npchip.isa import load_isa
from npchip.report.jsonform import to_document
from npchip.run.partner import sent_by

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip import Machine

ROOT = Path(__file__).parents[2]
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
    """Return npchip's own results of a job, with the state at its end."""
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
        document["error"] = {key: document["error"][key] for key in ("code", "address")}
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
    """Return a host's results of a job."""
    arguments = [*written(job, folder), "--max-cycles", str(job.limit), "--state"]
    if job.partner is not None:
        arguments += ["--partner", *written(job.partner, folder)]
    if way == "python":
        return printed(*arguments)
    command = ["node", str(ROOT / "examples/hosts/host.mjs"), *arguments]
    text = subprocess.run(command, capture_output=True, check=True, text=True).stdout
    document: dict[str, Any] = json.loads(text)
    return document


def printed(*arguments: str) -> dict[str, Any]:
    """Return the text that the host in Python prints."""
    with redirect_stdout(io.StringIO()) as text:
        host.main([*arguments])
    document: dict[str, Any] = json.loads(text.getvalue())
    return document


def written(job: Job, folder: Path) -> list[str]:
    """Write the files that a host takes, and return their paths."""
    module, clip = folder / f"{job.program.name}.wasm", folder / f"{job.program.name}.npy"
    module.write_bytes(to_module(job.program, job.machine, load_isa(), job.memory))
    np.save(clip, job.clip)
    return [str(module), str(clip)]


def check(way: Host, job: Job, folder: Path) -> dict[str, Any]:
    """Compare a host with npchip, and return what the host says about a job."""
    document, wanted = found(way, job, folder), expected(job)
    if way == "node" and wanted.get("error", {}).get("code") in ("NP310", "NP311"):
        wanted["state"] = document["state"]  # a later one, as its page says
    assert document == wanted
    for ours, theirs in zip(frames_of(document), frames_of(wanted), strict=True):
        assert [*ours["outputs"]] == [*theirs["outputs"]]
    return document


def frames_of(document: dict[str, Any]) -> list[dict[str, Any]]:
    return [document["setup"], *document["frames"]]
