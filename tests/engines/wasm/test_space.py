"""Compiled programs need little address space where there is little."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ASM = Path(__file__).parents[3] / "asm"

SCRIPT = """
import resource
import numpy as np
import wasmtime
from npchip import Chip, assemble_text
from npchip.engines.wasm.host import instance
def used():
    return next(int(l.split()[1]) for l in open("/proc/self/status") if l.startswith("VmSize"))
LOOP = "l: EXPOSE\\n MOV r0, #1\\n OUT 0, r0\\n JMP l\\n"
clip = np.zeros((2, 64, 80), np.uint8)
"""


def said(script: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT + script], capture_output=True, text=True, check=False
    )
    assert not done.returncode, done.stderr
    return done.stdout.split("\n")[:-1]


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads /proc")
def test_many_chips_reserve_little_where_addresses_are_limited() -> None:
    lines = said(
        "resource.setrlimit(resource.RLIMIT_AS, (8 << 30, resource.RLIM_INFINITY))\n"
        "chips = [Chip(assemble_text(LOOP)) for _ in range(30)]\n"
        "results = [chip.run(clip) for chip in chips]\n"
        "print({(r.engine, r.frames) for r in results}, used() < 100 << 20)\n"
    )
    assert lines == ["{('wasm', 2)} True"]


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads /proc")
def test_a_run_in_little_address_space_is_compiled_or_interpreted() -> None:
    lines = said(
        "space = used() * 1024 + (1 << 30)\n"
        "resource.setrlimit(resource.RLIMIT_AS, (space, space))\n"
        "chip = Chip(assemble_text(LOOP))\n"
        "print(chip.run(clip).engine)\n"
        "def full(*_):\n"
        "    raise wasmtime.WasmtimeError('mmap failed to reserve 0x1000 bytes')\n"
        "instance.wasmtime.Linker.instantiate = full\n"
        "chip = Chip(assemble_text(LOOP))\n"
        "print(chip.run(clip).engine)\n"
        "print(chip.notice)\n"
    )
    assert lines[:2] == ["wasm", "reference"]
    assert lines[2].startswith("there is not enough memory to compile it: the reference engine")


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads /proc")
def test_300_chips_work_within_8_gb() -> None:
    """Each of them stays, with its results."""
    lines = said(
        "from pathlib import Path\n"
        "from npchip import assemble\n"
        "resource.setrlimit(resource.RLIMIT_AS, (8_000_000_000, 8_000_000_000))\n"
        "names = ('imaging', 'trajectory', 'statistics', 'edges')\n"
        f"programs = [assemble(Path({str(ASM)!r}) / f'{{name}}.s') for name in names]\n"
        "chips = [Chip(programs[k % 4]) for k in range(300)]\n"
        "results = [chip.run(clip) for chip in chips]\n"
        "print(len(results), {(r.engine, r.frames) for r in results})\n"
    )
    assert lines == ["300 {('wasm', 2)}"]
