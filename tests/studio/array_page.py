"""What tests of the array have in common: the page's code for Node, and chips as it sees them."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip import Chip
from npchip.assembler.disassembler import disassemble_word
from npchip.isa import load_isa
from npchip.program.model import Program
from npchip.studio.toolchain.moves import moves
from tests.support.clips import CLIPS

ROOT = Path(__file__).parents[2]
STUDIO = ROOT / "src" / "npchip" / "studio"
SOURCES = Path(__file__).parent / "array"
ISA = load_isa()


def bundled(folder: Path, source: str, *options: str) -> Path:
    """Bundle a file of ``array/`` with the page's code; skip the test where that cannot be."""
    esbuild = STUDIO / "node_modules" / ".bin" / "esbuild"
    if not esbuild.exists():
        pytest.skip(f"no {esbuild}: run npm ci in {STUDIO}")
    if shutil.which("node") is None:
        pytest.skip("no node here")
    made = (folder / source).with_suffix(".mjs")
    jsx = ["--jsx=automatic", "--jsx-import-source=preact"]
    command = [str(esbuild), str(SOURCES / source), "--bundle", f"--outfile={made}", *jsx]
    # The sources stand beside the tests, and the packages beside the page.
    surroundings = os.environ | {"NODE_PATH": str(STUDIO / "node_modules")}
    subprocess.run([*command, *options, "--log-level=warning"], check=True, env=surroundings)
    return made


def harness_in(folder: Path) -> Path:
    """The page's code for Node."""
    return bundled(folder, "harness.ts", "--platform=node", "--format=esm")


def ask(harness: Path, name: str, **question: Any) -> Any:
    """Return the page's answer to a question."""
    text = json.dumps({"ask": name, **question}, default=plain)
    done = subprocess.run(
        ["node", harness], input=text, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def plain(value: Any) -> Any:
    assert isinstance(value, np.ndarray | np.integer), value
    return value.astype(int).ravel().tolist() if isinstance(value, np.ndarray) else int(value)


def view_of(chip: Chip, **more: Any) -> dict[str, Any]:
    """A chip as the page sees it."""
    return {
        "address": chip.pc,
        "instructions": chip.instructions,
        "registers": chip.registers,
        "zero": chip.flags["Z"] * 255,
        "carry": chip.flags["C"] * 255,
        "active": chip.active,
        "memory": chip.memory,
        "exposed": chip.frame,
        **more,
    }


def info_of(program: Program) -> dict[str, Any]:
    """A program as the page sees it."""
    words = [
        {
            "text": disassemble_word(word, ISA, program.label_names),
            "origins": [{"file": item.file, "line": item.line} for item in line.origins],
            "moves": [move._asdict() for move in moves(decoded)] if decoded else [],
        }
        for word, line, decoded in zip(
            program.words, program.source, program.decoded(ISA), strict=True
        )
    ]
    named = {"labels": dict(program.labels), "registers": dict(program.registers)}
    return {**named, "words": words}


def after(program: Program, steps: int) -> Chip:
    chip = Chip(program, engine="reference")
    chip.feed(np.load(CLIPS / "shapes_photo.npy"))
    for _ in range(steps):
        chip.step()
    return chip
