"""The time until a program runs: from its source, and in a process of its own."""

from __future__ import annotations

import compileall
import sys
import tempfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.hard import PROGRAMS
from benchmarks.measure import interleaved, processes
from benchmarks.programs import CLIP, ROOT, made, sources
from npchip import Program, assemble, assemble_text
from npchip.assembler import disassemble
from npchip.isa import load_isa

Table = dict[str, dict[str, float]]


def ready(clip: Any) -> Table:
    """Measure from source to the first frame's result, in milliseconds of processor time."""
    return _ready({name: partial(assemble, path) for name, path in sources().items()}, clip)


def hard(clip: Any) -> Table:
    """The same for programs of up to 512 words that are made to take long.

    ``compiled`` is 1 for a program that the compiled engine runs, and 0 for one that it leaves to
    the reference engine with a notice.
    """
    makers = {name: partial(assemble_text, source) for name, source in PROGRAMS.items()}
    table: Table = {}
    for name, row in _ready(makers, clip).items():
        program = makers[name]()
        chip = made(program)
        chip.run(clip[:1])
        table[name] = {"words": len(program.words), **row, "compiled": float(not chip.notice)}
    return table


def _ready(makers: Mapping[str, Callable[[], Program]], clip: Any) -> Table:
    """All programs in turn, as the machine may be slow for as long as one of them takes."""
    works: dict[str, Callable[[], object]] = {}
    for name, make in makers.items():
        program = make()
        works[f"{name}, assemble"] = make
        works[name] = lambda p=program: made(p).run(clip[:1])  # type: ignore[misc]
    times = interleaved(works)
    table: Table = {}
    for name in makers:
        first, then = 1000 * times[f"{name}, assemble"], 1000 * times[name]
        table[name] = {"assemble ms": first, "compile and one frame ms": then}
        table[name]["total ms"] = first + then
    return table


def assembling() -> Table:
    """A program ROM of 512 words from its source, in milliseconds of processor time."""
    program = assemble(ROOT / "asm" / "dct.s")
    text = disassemble(program, load_isa())
    text += "        NOP\n" * (512 - len(program.words))
    sources = {
        "512 words, an instruction a line": lambda: assemble_text(text),
        f"dct.s, {len(program.words)} words from macros": lambda: assemble(ROOT / "asm" / "dct.s"),
    }
    return {name: {"ms": 1000 * value} for name, value in interleaved(sources).items()}


def start_up() -> Table:
    """Whole processes against the imports that they cannot do without.

    The package is compiled to bytecode first, as it is wherever it has been installed.
    """
    compileall.compile_dir(ROOT / "src", quiet=1)
    npchip = [sys.executable, "-m", "npchip"]
    run = [*npchip, "run", str(ROOT / "asm" / "trajectory.s"), "--json", "--frames"]
    clip = np.load(CLIP)
    with tempfile.TemporaryDirectory() as folder:
        clips = {count: str(Path(folder) / f"{count}.npy") for count in (15, 300)}
        for count, file in clips.items():
            np.save(file, np.concatenate([clip] * 10)[:count])
        times = processes(
            {
                "import numpy, yaml": [sys.executable, "-c", "import numpy, yaml"],
                "npchip --help": [*npchip, "--help"],
                "import numpy, wasmtime, yaml": [
                    sys.executable,
                    "-c",
                    "import numpy, wasmtime, yaml",
                ],
                "npchip run, 15 frames": [*run, clips[15]],
                "npchip run, 300 frames": [*run, clips[300]],
            }
        )
    small, large = times["import numpy, yaml"], times["import numpy, wasmtime, yaml"]
    bases = {"npchip --help": small, "npchip run, 15 frames": large}
    bases["npchip run, 300 frames"] = large
    return {
        name: {"ms": 1000 * value, "times of import": value / bases.get(name, value)}
        for name, value in times.items()
    }
