"""Measure what the instructions of examples/silicon.yaml would save in the programs of asm/.

Each stands for a few lines that occur again and again. The lines are replaced in copies of the
programs, the copies run, and what they send must be what the programs send.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from shutil import copytree
from tempfile import TemporaryDirectory

import numpy as np

from examples.measure import MACHINES, PROGRAMS, ROOT, case_of, run, table
from npchip import RunResult, assemble
from npchip.isa import read_isa
from npchip.testing.runner import Settings, execute

SUBSTITUTIONS = {
    "SUBS": [
        (
            r"SUB +(\w+), (\w+).*\n +WHERE +LO.*\n +MOV +\1, #0\n +END\n",
            r"SUBS \1, \2\n",
        ),
    ],
    "MIN, MAX": [
        (r"CMP +(\w+), (\w+)\n +WHERE +LO\n +MOV +\1, \2\n +END\n", r"MAX \1, \2\n"),
        (r"CMP +(\w+), (\w+)\n +WHERE +LO\n +MOV +\2, \1\n +END\n", r"MIN \2, \1\n"),
        (r"CMP +(\w+), (\w+)\n +WHERE +HI\n +MOV +\1, \2\n +END\n", r"MIN \1, \2\n"),
        (  # sort
            r"CMP +a, b\n +WHERE +HI\n +MOV +t, a\n +MOV +a, b\n +MOV +b, t\n +END\n",
            "MOV t, a\nMIN a, b\nMAX b, t\n",
        ),
        (  # insert
            r"CMP +c, b\n(.*\n){5} +CMP +t, a\n(.*\n){5}",
            "MOV t, c\nMAX c, b\nMIN t, b\nMOV b, a\nMAX b, t\nMIN a, t\n",
        ),
    ],
    "ABSD": [
        (  # frame_difference.s
            r"SUB +change, before\n(.*\n){4}",
            "ABSD change, before\n",
        ),
        (  # lib/moving_box.s
            r"SUB +f, t\n +SBC +t, t\n +ADD +f, #THRESHOLD - 1\n(.*\n){3}",
            "ABSD f, t\nCMP f, #THRESHOLD\n",
        ),
        (r"size    v\n", "ABSD t, v\n"),  # recognise.s
    ],
    "ASR": [
        (r"SHR +xh, #1\n +RCR +x\n +ADD +xh, #0x40.*\n", "ASR xh\nRCR x\n"),  # dct.s
        (r" +ADD +xh, #0x80\n", ""),  # no bias is needed
    ],
}
"""Replacements of each instruction: a pattern, and the text that takes its place."""


@cache
def changed(name: str, wanted: tuple[str, ...], machine: str) -> tuple[int, RunResult]:
    """Words and run of a program in which some of the substitutions were made.

    Raises:
        AssertionError: it does not send what the program sends.
    """
    isa, before = read_isa(ROOT / "examples" / "silicon.yaml"), run(name, machine)
    with TemporaryDirectory() as folder:
        sources = Path(folder) / "asm"
        copytree(ROOT / "asm", sources)
        (Path(folder) / "examples").symlink_to(ROOT / "examples")
        for file in sources.rglob("*.s"):
            text = file.read_text(encoding="utf-8")
            # Macros that are called like instructions now: median.s has both.
            text = re.sub(r"^(\.macro| {8}) ?(min|max)\b", r"\1 keep_\2", text, flags=re.MULTILINE)
            for instruction in wanted:
                for pattern, replacement in SUBSTITUTIONS[instruction]:
                    text = re.sub(pattern, replacement, text)
            file.write_text(text, encoding="utf-8")
        case = case_of(sources / f"{name}.s", machine)
        program = assemble(case.program, machine, case.run.defines, isa)
        if program.words == before.program.words:
            return len(program.words), before.column.result
        _, result = execute(case, Settings(isa=isa))
    assert same_outputs(result, before.column.result), f"{name} with {wanted} on {machine}"
    return len(program.words), result


def same_outputs(a: RunResult, b: RunResult) -> bool:
    """Return whether two runs have sent the same."""
    return all(
        np.array_equal(np.array(a.value(name, k)), np.array(b.value(name, k)))
        for name in a.outputs
        for k in range(a.frames)
    )


def row(name: str) -> list[str]:
    """Cycles of a mean frame that each instruction saves, then what all save together."""
    now = run(name).column
    cells = [f"`{name}`"]
    for key in SUBSTITUTIONS:
        words, result = changed(name, (key,), "default")
        saved = now.cycles - float(result.frame_cycles.mean())
        cells.append(f"{saved:,.0f}" if words < now.words else "–")
    for machine in MACHINES:
        words, result = changed(name, tuple(SUBSTITUTIONS), machine)
        before = run(name, machine).column.cycles
        cells.append(f"{100 * (1 - float(result.frame_cycles.mean()) / before):.1f} %")
    return [*cells, f"{now.words - words}"]


def document() -> str:
    """Return the table."""
    head = ["saved", *SUBSTITUTIONS, *(f"all, {machine}" for machine in MACHINES), "words"]
    return table(head, [row(name) for name in PROGRAMS], len(head) - 1)
