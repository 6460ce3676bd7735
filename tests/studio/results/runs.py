"""Real runs in the form in which the page of the studio gets them."""

from __future__ import annotations

import json
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from npchip import Chip
from npchip.machine import Machine, load_machine
from npchip.profile import profile_of
from npchip.profile.jsonform import to_document as profile_document
from npchip.program.model import Program
from npchip.report.jsonform import to_document, to_text
from npchip.run.result import RunResult
from tests.support.clips import CLIPS
from tests.support.programs import assembled

CLOCK_HZ = 10_000_000


class Run:
    """A run of a program of ``asm/`` on a bundled clip.

    Attributes:
        program: the program.
        clip: the clip, uint8 of shape (T, rows, columns).
        result: the run.
        profile: its profile, as ``npchip profile --json`` prints it.
    """

    def __init__(self, program: str, clip: str, frames: int | None = None) -> None:
        self.program: Program = assembled(program)
        self.clip: NDArray[np.uint8] = np.load(CLIPS / f"{clip}.npy")[:frames]
        self.machine: Machine = load_machine("default")
        chip = Chip(self.program, machine=self.machine, profile=True)
        self.result: RunResult = chip.run(self.clip)
        self.profile: dict[str, Any] = profile_document(profile_of(chip, self.result))

    @cached_property
    def json(self) -> str:
        """Return what ``npchip run --json`` prints, of whichever engine."""
        document = to_document(self.result, CLOCK_HZ)
        return to_text(document | {"engine": "wasm"})

    @cached_property
    def for_page(self) -> dict[str, Any]:
        """Return program, document and clip as the test's TypeScript reads them."""
        document = json.loads(self.json)
        counts = self.result.frame_instructions.tolist()
        for frame, count in zip(document["frames"], counts, strict=True):
            frame["instructions"] = count
        document["setup"]["instructions"] = self.result.setup.instructions
        return {
            "program": self._program(),
            "document": document,
            "clip": self.clip.reshape(len(self.clip), -1).tolist(),
            "profile": [word["cycles"] for word in self.profile["words"]],
        }

    def _program(self) -> dict[str, Any]:
        """Return what the results read of a ``ProgramInfo``."""
        program, machine = self.program, self.machine
        places = [program.place(address) for address in range(len(program.words))]
        return {
            "name": program.name,
            "words": [
                {
                    "origins": [{"file": place.file, "line": place.line}] if place else [],
                    "text": place.code if place else "",
                    "cycles": 1,
                }
                for place in places
            ],
            "labels": dict(program.labels),
            "symbols": dict(program.symbols),
            "registers": dict(program.registers),
            "outputs": [
                {"name": output.name, "port": output.port, "kind": output.kind}
                for output in program.outputs
            ],
            "definitions": [],
            "machine": {
                "name": machine.name,
                "summary": "",
                "np_rows": machine.np_rows,
                "np_cols": machine.np_cols,
                "memory_bytes": 512,
                "mask_depth": 8,
                "rom_words": 4096,
            },
            "exposes": True,
            "budgets": {"words": program.budget.words, "cycles": program.budget.cycles},
            "bounds": None,
        }
