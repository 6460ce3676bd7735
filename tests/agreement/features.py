"""What a case has in it, to know what a large number of them has covered."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from npchip import RunResult
from npchip.engines.wasm.emit.layout import VECTOR
from tests.support.random_cases import STATES, Case

_IN_TEXT = {
    "calls": r"\bCALL\b",
    "masks": r"\bWHERE\b",
    "varying or unknown addresses": r"\[r\d+ \+",
    "constant addresses": r"\[\d+\]",
    "branches": r"\bJ(ANY|NONE)\b",
    "neighbours": r"\bNBR\b",
    "sends": r"\bOUT\b",
    "inputs": r"\bIN\b",
    "conversions": r"\bSAMPLE\b",
    "a branch around one instruction": r"\bJ(ANY|NONE) \w+, (\w+)\n.*\n *\2:",
    "several exposes": r"(?s)\bEXPOSE\b.*\bEXPOSE\b",
}


def features(case: Case, results: Sequence[RunResult]) -> set[str]:
    """Names of everything that a case has in its text, its surroundings and its results."""
    found = {name for name, pattern in _IN_TEXT.items() if re.search(pattern, case.text)}
    found |= {f"loop {kind}" for kind in re.findall(r"^l\d+: ; (.*)$", case.text, re.MULTILINE)}
    found |= set(_nesting(case.text.splitlines()))
    found |= set(_surroundings(case))
    for result in results:
        found.add(f"ends: {result.error.code if result.error else result.status}")
        if result.frames > 1:
            found.add("more than one frame in a run")
    return found


def _nesting(lines: Sequence[str]) -> Iterable[str]:
    """What stands inside what; a loop is between its label and a later line that leads back."""
    depth = 0
    begun: set[str] = set()  # labels of the loops around
    for line in lines:
        words = line.replace(",", " ").split()
        if not words:
            continue
        if ";" in line:
            if begun:
                yield "nested loops"
            if depth:
                yield "loop inside a mask"
            begun.add(words[0].rstrip(":"))
        elif words[0] == "WHERE":
            depth += 1
            if depth > 1:
                yield "nested masks"
        elif words[0] == "END":
            depth -= 1
        elif words[0][0] == "J" and words[-1] in begun:
            begun.remove(words[-1])
        if begun and words[0] in {"WHERE", "CALL", "EXPOSE", "IN", "OUT", "SAMPLE"}:
            yield f"{words[0]} in a loop"


def _surroundings(case: Case) -> Iterable[str]:
    machine = case.machine
    vectors = -(-machine.np_rows * machine.np_cols // VECTOR)
    yield f"vectors: {vectors if vectors < 3 else 'more'}"
    yield f"registers: {STATES[case.seed % 4]}"
    if "IN " in case.text:
        yield f"partner: {case.partner}"
    if case.states > 1:
        yield "several states"
    if case.again:
        yield "a second run from where the first ended"
    if case.text.count("\n") > 60:
        yield "more than 60 lines"
    if "SAMPLE" in case.text and machine.sensor.noise_rms:
        yield "noise"
    if "SAMPLE" in case.text and machine.sensor.fixed_pattern:
        yield "fixed pattern"
