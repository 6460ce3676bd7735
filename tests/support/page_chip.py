"""The chip of the studio's page, driven in Node, and what npchip says in its words."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from npchip.assembler.disassembler import disassemble_word
from npchip.debugger.conditions import Changes, Compare, Condition, MaskEmpty, Sent
from npchip.debugger.values import Cell, Counter, One, Pixel, Quantity
from npchip.formats.module import to_module
from npchip.isa import load_isa
from npchip.report.jsonform import to_document
from tests.support.page_code import Answers

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from npchip import Chip, Machine, Program, RunResult
    from tests.support.random_cases import Case

LIMIT: Final = 1_000_000
"""Cycles of a frame, unless a test says otherwise."""

CALLS: Final = """
.output total, 0, scalar
.macro bump, x
        ADD     x, #1
.endm
start:  MOV     r0, #0
loop:   EXPOSE
        MOV     r1, #3
        CALL    down
        ROW     r2
        CMP     r2, #0
        WHERE   EQ
        bump    r0
        CALL    twice
        ELSE
        bump    r0
        END
        OUT     0, r1
        JMP     loop
down:   CMP     r1, #0
        JANY    EQ, back
        SUB     r1, #1
        ST      [r1 + 64], r1
        CALL    down
        bump    r3
back:   RET
twice:  CALL    once
once:   bump    r3
        ST      [9], r3
        RET
"""
"""A program with macros, masked calls, calls in calls, and recursion."""


class PageChip:
    """A chip of the page in a process of its own.

    Args:
        driver: the bundled ``chip_driver.ts``.
        folder: for modules and clips.
        memory: spacing and budget of snapshots.
    """

    def __init__(self, driver: Path, folder: Path, memory: dict[str, int] | None = None) -> None:
        self.folder = folder
        self._answers = Answers(driver, json.dumps(memory or {}))

    def close(self) -> None:
        """End the process."""
        self._answers.close()

    def ask(self, do: str, **order: Any) -> Any:
        """Give an order, and return the answer.

        Raises:
            ValueError: the chip refused it.
        """
        return self._answers.ask({"do": do, **order})

    def load(
        self,
        program: Program,
        machine: Machine,
        clip: NDArray[np.uint8] | None,
        limit: int,
        memory: Sequence[tuple[int, NDArray[np.uint8]]] = (),
    ) -> None:
        """Put in a program and a clip, without breakpoints."""
        self.ask("breakpoints", all=[])
        module, frames = self.written(program, machine, clip, memory)
        self.ask("load", module=module, program=about(program), limit=limit)
        self.ask("frames", clip=frames)

    def written(
        self,
        program: Program,
        machine: Machine,
        clip: NDArray[np.uint8] | None,
        memory: Sequence[tuple[int, NDArray[np.uint8]]] = (),
    ) -> tuple[str, str | None]:
        """Write the files that an order names."""
        module, frames = self.folder / "program.wasm", self.folder / "clip.npy"
        module.write_bytes(to_module(program, machine, load_isa(), memory))
        if clip is None:
            return str(module), None
        np.save(frames, clip)
        return str(module), str(frames)

    def go(self, to: str, *, back: bool = False, **more: Any) -> dict[str, str]:
        """Travel, and return the stop."""
        stop: dict[str, str] = self.ask("go", travel={"to": to, **more}, back=back)["stop"]
        return stop

    @property
    def view(self) -> dict[str, Any]:
        """The chip as the page sees it."""
        seen: dict[str, Any] = self.ask("view")
        return seen


def about(program: Program) -> dict[str, Any]:
    """Return the facts about a program that the chip needs."""
    isa = load_isa()
    words = [{"text": disassemble_word(word, isa, {}), "cycles": 0} for word in program.words]
    return {"words": words}


def view_of(chip: Chip) -> dict[str, Any]:
    """Return the view that the page must have of a chip: the state in the reference engine."""
    state = chip.snapshot().state
    frame = chip.frame
    return {
        "address": state.pc,
        "stack": list(state.stack),
        "depth": state.depth,
        "frame": chip.frames_taken - 1,
        "frameCycles": chip.frame_cycles,
        "frameInstructions": state.frame_instructions,
        "cycles": chip.cycles,
        "instructions": chip.instructions,
        "registers": state.registers.ravel().tolist(),
        "zero": state.zero.astype(int).ravel().tolist(),
        "carry": state.carry.astype(int).ravel().tolist(),
        "active": chip.active.astype(int).ravel().tolist(),
        "masks": [
            (state.activity < k).astype(int).ravel().tolist() for k in range(state.depth, 0, -1)
        ],
        "memory": state.memory.ravel().tolist(),
        "exposed": None if frame is None else frame.ravel().tolist(),
    }


def document_of(result: RunResult) -> dict[str, Any]:
    """A run as the page has it: without what it leaves out."""
    document = to_document(result, 1)
    found = {key: document[key] for key in ("status", "instructions", "cycles", "setup")}
    if "error" in document:
        error = document["error"]
        found["error"] = {key: error[key] for key in ("code", "message", "address")}
    frames = document["frames"]
    return found | {"frames": [{k: v for k, v in f.items() if k != "index"} for f in frames]}


def without_instructions(document: dict[str, Any]) -> dict[str, Any]:
    """A run of the page without the instructions of frames, which the JSON of npchip leaves out."""
    frames = [without_count(frame) for frame in document["frames"]]
    return document | {"setup": without_count(document["setup"]), "frames": frames}


def without_count(frame: dict[str, Any]) -> dict[str, Any]:
    """A frame without the number of its instructions."""
    return {key: value for key, value in frame.items() if key != "instructions"}


def tree(condition: Condition) -> dict[str, Any]:
    """A condition as the page has it."""
    event: dict[str, Any] | None = None
    match condition.event:
        case Changes(value):
            event = {"kind": "changes", "value": quantity(value)}
        case Sent(port, op, number):
            event = {"kind": "sent", "port": port, "op": op, "number": number}
    test: dict[str, Any] | None = None
    match condition.test:
        case Compare(value, op, number, quantifier):
            test = {"kind": "compare", "value": quantity(value), "op": op, "number": number}
            test["quantifier"] = quantifier
        case MaskEmpty():
            test = {"kind": "mask-empty"}
    return {
        "text": condition.text,
        "places": sorted(condition.places) or None,
        "test": test,
        "event": event,
        "triggers": sorted(condition.triggers) if not condition.places else None,
    }


def quantity(value: Quantity) -> dict[str, Any]:
    """A quantity as the page has it."""
    match value:
        case Cell():
            return {"kind": "cell", "cell": _cell(value)}
        case One(cell, row, column):
            return {"kind": "one", "cell": _cell(cell), "row": row, "column": column}
        case Pixel(row, column):
            return {"kind": "pixel", "row": row, "column": column}
        case Counter(name):
            return {"kind": "counter", "name": name}


def _cell(cell: Cell) -> dict[str, Any]:
    return {"kind": cell.kind, "index": cell.index}


def memory_of(case: Case) -> NDArray[np.uint8]:
    """Return the memories before a random program runs."""
    shape = (case.machine.memory_bytes, *case.machine.geometry)
    return np.random.default_rng(case.seed).integers(0, 256, shape, np.uint8)


def assert_sees(page: PageChip, wanted: dict[str, Any]) -> None:
    """Compare what the page sees with what it should."""
    seen = page.view
    for key, value in wanted.items():
        assert seen[key] == value, (wanted["instructions"], key)
