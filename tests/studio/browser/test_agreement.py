"""The page gives what npchip gives: modules, outputs, cycles, and every state on the way."""

from __future__ import annotations

import base64
import hashlib
import json
from functools import cache
from itertools import product
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from npchip import Chip
from npchip.formats.files import write_program
from npchip.report.jsonform import to_document
from tests.studio.browser.driver import Driver
from tests.support.clips import CLIPS
from tests.support.page_code import site
from tests.support.programs import ASM, assembled

pytestmark = pytest.mark.long

PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
MACHINES = ("default", "conservative")
FILMS = ("coin_slide", "shapes_drawn")
LIMIT = 50_000_000

STATES = {"trajectory": 400, "keypoints": 200, "median": 200, "frame_difference": 200}
"""Number of random instructions of each program that are compared, 1,000 in all."""


@cache
def film(name: str) -> Any:
    return np.load(CLIPS / f"{name}.npy")


@cache
def memories() -> dict[str, list[tuple[int, Any]]]:
    """Return the NPs' memory before each example runs in the page."""
    examples = json.loads((site() / "programs" / "index.json").read_text(encoding="utf-8"))
    return {
        each["name"]: [(part["address"], planes(part)) for part in each["memory"]]
        for each in examples
    }


def planes(part: dict[str, Any]) -> Any:
    data = np.frombuffer(base64.b64decode(part["data"]), np.uint8)
    return data.reshape(part["planes"], 8, 10)


def wanted(program: str, clip: str, machine: str) -> dict[str, Any]:
    """A run as ``npchip run --json`` prints it, as far as the page knows it."""
    chip = Chip(assembled(program, machine), machine)
    for address, data in memories()[program]:
        chip.load_memory(address, data)
    document = to_document(chip.run(film(clip), max_cycles=LIMIT), 1)
    error = document.get("error")
    return {
        "status": document["status"],
        "cycles": document["cycles"],
        "instructions": document["instructions"],
        "frames": [
            {
                "cycles": frame["cycles"],
                "outputs": {name: flat(value) for name, value in frame["outputs"].items()},
            }
            for frame in document["frames"]
            if frame.get("complete", True)
        ],
    } | ({"error": {key: error[key] for key in ("code", "address")}} if error else {})


def flat(value: Any) -> Any:
    """Return a plane or picture as one list, as the page has it."""
    nested = isinstance(value, list) and value and isinstance(value[0], list)
    return [number for row in value for number in row] if nested else value


@pytest.mark.parametrize("machine", MACHINES)
def test_programs(driver: Driver, page: str, machine: str, tmp_path: Path) -> None:
    places = [{"example": program, "clip": clip} for program, clip in product(PROGRAMS, FILMS)]
    flow = "agreement: programs on clips"
    found = driver.run(flow, page, tmp_path, 420, places=places, machine=machine)["documents"]
    wrong = []
    for place, document in zip(places, found, strict=True):
        if error := document.pop("error", None):
            document["error"] = {key: error[key] for key in ("code", "address")}
        expected = wanted(place["example"], place["clip"], machine)
        if error:
            # A run that failed leaves its last frame incomplete: only complete ones are compared.
            document["frames"] = document["frames"][: len(expected["frames"])]
        wrong += [f"{place}: {text}" for text in differences(document, expected)]
    assert not wrong, "\n".join(wrong)


def differences(found: dict[str, Any], expected: dict[str, Any]) -> list[str]:
    """Say in short what differs."""
    texts = [
        f"{key} {found.get(key)}, not {expected.get(key)}"
        for key in ("status", "error", "cycles", "instructions")
        if found.get(key) != expected.get(key)
    ]
    if len(found["frames"]) != len(expected["frames"]):
        texts.append(f"{len(found['frames'])} frames, not {len(expected['frames'])}")
    for index, (ours, theirs) in enumerate(zip(found["frames"], expected["frames"], strict=False)):
        if ours["cycles"] != theirs["cycles"]:
            texts.append(f"frame {index}: {ours['cycles']} cycles, not {theirs['cycles']}")
        if ours["outputs"] != theirs["outputs"]:
            for name in sorted({*ours["outputs"], *theirs["outputs"]}):
                pair = [side["outputs"].get(name, "missing") for side in (ours, theirs)]
                if pair[0] != pair[1]:
                    texts.append(
                        f"frame {index}: {name} {str(pair[0])[:60]}, not {str(pair[1])[:60]}"
                    )
    return texts[:4]


def test_clicks(driver: Driver, page: str, tmp_path: Path) -> None:
    """However fast a reader clicks, what was chosen last is there, and its outputs alone."""
    random = Random(21)
    names = ("tracking", "trajectory", "statistics")
    sequences, chosen = [], []
    for _ in range(12):
        clicks: list[tuple[str, str, int]] = []
        for _ in range(14):
            kind = random.choice(("Example", "Clip", "Run", "Run", "Reset", "Pause", "Step"))
            options = {"Example": names, "Clip": FILMS}.get(kind, ("",))
            clicks.append((kind, random.choice(options), random.choice((0, 0, 5, 40, 200))))
        clicks += [("Example", random.choice(names), 3), ("Clip", random.choice(FILMS), 3)]
        sequences.append(clicks)
        chosen.append((clicks[-2][1], clicks[-1][1]))
    flow = "agreement: clicks that do not wait"
    found = driver.run(flow, page, tmp_path, 420, sequences=sequences)["found"]
    assert [(each["program"], each["clip"]) for each in found] == chosen
    wrong = []
    for (program, clip), each in zip(chosen, found, strict=True):
        each["document"].pop("error", None)
        texts = differences(each["document"], wanted(program, clip, "default"))
        wrong += [f"{program} on {clip}: {text}" for text in texts]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("driver", ["chromium"], indirect=True)
def test_modules(driver: Driver, page: str, tmp_path: Path) -> None:
    """The assembler and the translator in the page make the same bytes as here.

    One browser will do: what the other one assembles runs in `test_programs`.
    """
    library = {
        f"lib/{path.name}": path.read_text(encoding="utf-8") for path in (ASM / "lib").glob("*.s")
    }
    sources = {
        name: {f"{name}.s": (ASM / f"{name}.s").read_text(encoding="utf-8"), **library}
        for name in PROGRAMS
    }
    flow = "agreement: modules are the same bytes"
    found = driver.run(flow, page, tmp_path, 260, sources=sources, machines=MACHINES)["digests"]
    wanted = {}
    for name, machine in product(PROGRAMS, MACHINES):
        file = tmp_path / f"{name}.wasm"
        write_program(assembled(name, machine), file, machine=machine)
        wanted[f"{name} {machine}"] = hashlib.sha256(file.read_bytes()).hexdigest()
    assert found == wanted


@pytest.mark.parametrize("program", STATES)
def test_states(driver: Driver, page: str, program: str, tmp_path: Path) -> None:
    """The chip in the page is that of the reference engine at random instructions, to and fro."""
    clip = film("shapes_drawn")
    total = Chip(assembled(program)).run(clip).instructions
    random = Random(program)
    numbers = [random.randrange(1, min(total, 60_000)) for _ in range(STATES[program])]
    states = reference(program, clip, numbers)
    flow = "agreement: states at instructions"
    found = driver.run(
        flow, page, tmp_path, 220, program=program, clip="shapes_drawn", numbers=numbers
    )["states"]
    wrong = [
        (number, {key: (state[key], ours[key]) for key in state if state[key] != ours[key]})
        for number, ours in zip(numbers, found, strict=True)
        if (state := states[number]) != ours
    ]
    assert not wrong, f"{len(wrong)} of {len(numbers)} states differ, as {wrong[:3]}"


def reference(program: str, clip: Any, numbers: list[int]) -> dict[int, dict[str, Any]]:
    """Return the states of the reference engine after numbers of instructions."""
    chip = Chip(assembled(program), engine="reference")
    chip.feed(clip)
    states = {}
    awaited = {*numbers}
    while awaited:
        chip.step()
        if (number := chip.instructions) in awaited:
            awaited.remove(number)
            states[number] = state_of(chip)
    return states


def state_of(chip: Chip) -> dict[str, Any]:
    state = chip.snapshot().state
    masks = [state.activity < depth for depth in range(state.depth, 0, -1)]
    parts = [state.registers, state.zero, state.carry, chip.active, *masks, state.memory]
    data = b"".join(np.ascontiguousarray(part, dtype=np.uint8).tobytes() for part in parts)
    return {
        "address": chip.pc,
        "stack": list(chip.stack),
        "depth": chip.depth,
        "frame": chip.frames_taken - 1,
        "frameCycles": chip.frame_cycles,
        "cycles": chip.cycles,
        "instructions": chip.instructions,
        "planes": hashlib.sha256(data).hexdigest(),
    }
