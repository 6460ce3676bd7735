"""Features of a case, to know which of them a large number of cases has covered."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import numpy as np

from npchip import RunResult
from npchip.engines.wasm.emit.layout import VECTOR
from npchip.engines.wasm.emit.pixels import FEW
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
    pictures = re.findall(r"\.output (\w+), \d+, picture", case.text)
    for result in results:
        found |= set(_arrays(result, pictures))
        found.add(f"ends: {result.error.code if result.error else result.status}")
        if result.frames > 1:
            found.add("more than one frame in a run")
    return found


def _arrays(result: RunResult, pictures: Sequence[str]) -> Iterable[str]:
    """Yield the features of a run's pictures."""
    sent = 0
    for name in pictures:
        values = result.outputs[name]
        missing = np.ma.getmaskarray(values)[:, 0, 0]
        here = len(values) - int(np.count_nonzero(missing))
        sent += here > 1
        if here > 1:
            yield f"pictures in {'some frames' if missing.any() else 'all frames'}"
    if sent > 1:
        yield "pictures at several ports"


def _nesting(lines: Sequence[str]) -> Iterable[str]:
    """Yield which blocks stand in which; a loop is from its label to a line that leads back."""
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
    if vectors > 10:
        yield f"large arrays: {'up to' if vectors <= FEW else 'more than'} {FEW} vectors"
        yield f"large arrays: {'up to' if machine.np_cols <= VECTOR else 'more than'} 16 NPs a row"
        if machine.np_cols == 256 or machine.np_rows == 256:
            yield "large arrays: 256 rows or columns"
        if VECTOR * vectors > 1000:
            yield "large arrays: more than 1,000 NPs"
    yield f"registers: {STATES[case.seed % 4]}"
    if "IN " in case.text:
        yield f"partner: {case.partner}"
    if case.states > 1:
        yield "several states"
    if case.again:
        yield "a second run from where the first ended"
    if case.text.count("\n") > 60:
        yield "more than 60 lines"
    sensor = machine.sensor
    if "SAMPLE" in case.text and (sensor.noise_rms or sensor.fixed_pattern):
        yield from ["noise"] * (sensor.noise_rms > 0)
        yield from ["fixed pattern"] * (sensor.fixed_pattern > 0)
        if sensor.noise_rms and sensor.fixed_pattern:
            yield "noise and fixed pattern"
    if case.ring:
        yield "little room for frames and sends"
    if case.hears:
        yield "a listener"
