"""Cases for both engines: a program, and the machine, states, frames and partner for it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from npchip import Chip, Machine, Program, assemble_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from npchip.engines.base import Request
    from npchip.isa import Isa

Partnership = Literal["sends", "stops", "missing"]
STATES = ("zero", "varying", "uniform", "mixed")
"""Registers and flags at the start, by ``seed % 4``: as after reset, the same in all NPs or not."""


@dataclass(frozen=True)
class Sender:
    """A partner whose bytes tell all of what was asked.

    Attributes:
        seed: of the bytes.
        shape: NP rows and columns.
        sends: how many bytes there are for a port in a frame; None for any number.
    """

    seed: int
    shape: tuple[int, int]
    sends: int | None

    def __call__(self, request: Request) -> NDArray[np.uint8] | None:
        """Answer a request, as `Chip.connect` asks for."""
        if self.sends is not None and request.index >= self.sends:
            return None
        asked = (request.port, request.frame + 1, request.index, request.cycle)
        rng = np.random.default_rng((self.seed, *asked))
        shape = self.shape if request.port % 2 else (1, 1)
        return np.broadcast_to(rng.integers(0, 256, shape, np.uint8), self.shape).copy()


@dataclass(frozen=True)
class Case:
    """A case for both engines.

    Attributes:
        text: the source.
        machine: machine of both chips.
        seed: of memory, registers, flags and frames; see `STATES`.
        frames: number of frames.
        limit: cycles of a frame.
        again: run a second time with as many frames.
        states: begin anew that often, each time with another memory and other registers.
        partner: whether somebody sends to the chip's inputs: all that is asked for, too little, or
            nobody does.
        isa: instruction set; the built-in one if not given.
        profile: whether what is counted for a profile is compared as well.
        tight: whether the program is compiled as a large one is: no loop is unrolled, and vector
            loops are rolled.
        ring: frames that the compiled engine takes at once, and its log holds little more than a
            block sends; 0 for as many as always.
        hears: whether each run has a listener for its frames, and which of them it does not
            bear: an exception of the listener ends that run. 0 for none.
    """

    text: str
    machine: Machine
    seed: int
    frames: int
    limit: int
    again: bool
    states: int = 1
    partner: Partnership = "missing"
    isa: Isa | None = None
    profile: bool = False
    tight: bool = False
    ring: int = 0
    hears: int = 0

    def program(self) -> Program:
        """The assembled program."""
        return self._program

    @cached_property
    def _program(self) -> Program:
        return assemble_text(self.text, "random.s", self.machine, isa=self.isa)

    def chip(self, engine: Literal["wasm", "reference"]) -> Chip:
        """A chip in the first state, with its partner."""
        chip = Chip(self.program(), self.machine, engine, self.isa, profile=self.profile)
        if self.partner != "missing":
            sends = self.seed % 3 if self.partner == "stops" else None
            chip.connect(Sender(self.seed, self.machine.geometry, sends))
        self.fill(chip, 0)
        return chip

    def fill(self, chip: Chip, state: int) -> None:
        """Let a chip that was reset have random memory, and registers and flags as `STATES` says.

        Args:
            chip: the chip.
            state: from 0 to `states` - 1.
        """
        rng = np.random.default_rng((self.seed, state))
        chip.memory[...] = rng.integers(0, 256, chip.memory.shape, np.uint8)
        kind = STATES[self.seed % 4]
        if kind == "zero":
            return
        planes = [*chip.registers, *chip.flags.values()]
        values = rng.integers(0, 256, (len(planes), *chip.machine.geometry), np.uint8)
        for number, (plane, value) in enumerate(zip(planes, values, strict=True)):
            uniform = kind == "uniform" or (kind == "mixed" and (self.seed >> number) % 3 > 0)
            own = value[0, 0] if uniform else value
            plane[...] = own if plane.dtype == np.uint8 else own > 127

    def clip(self) -> NDArray[np.uint8]:
        """The frames."""
        shape = (self.frames, self.machine.rows, self.machine.cols)
        return np.random.default_rng(self.seed + 1).integers(0, 256, shape, np.uint8)
