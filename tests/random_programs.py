"""Random programs with valid control flow, and the machines, states and frames to run them on.

Drawn from any `random.Random`: from Hypothesis, which shrinks what fails, or from a seed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from random import Random
from typing import TYPE_CHECKING

import numpy as np

from npchip import Chip, Machine, Program, assemble_text, load_machine

if TYPE_CHECKING:
    from typing import Literal

    from numpy.typing import NDArray

    from npchip.isa import Isa

CONDITIONS = ("EQ", "NE", "LO", "HS", "HI", "LS")
GEOMETRIES = ((2, 3), (1, 1), (3, 6), (2, 8), (5, 7), (8, 10), (1, 33), (17, 1))
More = Callable[[Random, Callable[[], str]], str]
COUNTERS = ("r15", "r14", "r13")
REGISTERS = 13
"""Registers that a program may use freely; the rest count its loops."""


@dataclass(frozen=True)
class Case:
    """What both engines run.

    Attributes:
        text: the source.
        machine: machine of both chips.
        seed: of memory and frames; an even one makes registers uniform, as after reset.
        frames: number of frames.
        limit: cycles of a frame.
        again: run a second time with as many frames.
        isa: instruction set; the built-in one if not given.
    """

    text: str
    machine: Machine
    seed: int
    frames: int
    limit: int
    again: bool
    isa: Isa | None = None

    def program(self) -> Program:
        """The assembled program."""
        return assemble_text(self.text, "random.s", self.machine, isa=self.isa)

    def chip(self, engine: Literal["wasm", "reference"], *, profile: bool = False) -> Chip:
        """A chip with random memory and, where the seed is odd, random registers and flags."""
        chip = Chip(self.program(), self.machine, engine, self.isa, profile=profile)
        rng = np.random.default_rng(self.seed)
        chip.memory[...] = rng.integers(0, 256, chip.memory.shape, np.uint8)
        if self.seed % 2:
            chip.registers[...] = rng.integers(0, 256, chip.registers.shape, np.uint8)
            for flag in chip.flags.values():
                flag[...] = rng.integers(0, 2, flag.shape, np.uint8) != 0
        return chip

    def clip(self) -> NDArray[np.uint8]:
        """The frames."""
        shape = (self.frames, self.machine.rows, self.machine.cols)
        return np.random.default_rng(self.seed + 1).integers(0, 256, shape, np.uint8)


def draw_case(random: Random, isa: Isa | None = None, more: More | None = None) -> Case:
    """A random case.

    Args:
        random: draws it.
        isa: instruction set, if it is not the built-in one.
        more: draws an instruction of that set, given a function that draws a register.
    """
    rows, cols = random.choice(GEOMETRIES)
    machine = replace(
        load_machine(random.choice(["default", "conservative"])),
        name="random",
        np_rows=rows,
        np_cols=cols,
        memory_bytes=random.choice([256, 256, 128, 64]),
    )
    sensor = random.randrange(4)
    if sensor:
        machine = replace(
            machine,
            sensor=replace(
                machine.sensor,
                fixed_pattern=random.choice([0, 30, 200]),
                noise_rms=random.choice([0.0, 0.0, 4.0]),
            ),
        )
    return Case(
        _Writer(random, machine, more).program(),
        machine,
        seed=random.randrange(1000),
        frames=random.randrange(5),
        limit=random.choice([50_000_000, 50_000_000, 50_000_000, random.randrange(1, 4000)]),
        again=random.randrange(4) == 0,
        isa=isa,
    )


class _Writer:
    def __init__(self, random: Random, machine: Machine, more: More | None) -> None:
        self._random = random
        self._more = more
        self._machine = machine
        self._lines: list[str] = []
        self._labels = 0
        self._room = 90  # statements; repetition and calls multiply them
        # Few registers, so that instructions work on each other's results.
        self._registers = [f"r{random.randrange(REGISTERS)}" for _ in range(4)]
        self._routines = random.randrange(3)
        # Regions open where a routine is called: the same number for all its calls.
        self._depths = [random.choice([0, 0, 1, 2]) for _ in range(self._routines)]

    def program(self) -> str:
        random = self._random
        for port in range(random.randrange(4)):
            kind = random.choice(["scalar", "scalar", "scalar16", "list", "plane"])
            self._emit(f".output out{port}, {port}, {kind}")
        if random.randrange(3):
            self._block(depth=0, loops=0, routines=self._routines, top=True)
        self._emit("frame: EXPOSE")
        self._block(depth=0, loops=0, routines=self._routines, top=True)
        last = "NOP" if self._routines == 0 else "HALT"  # a NOP would run into the first routine
        self._emit(random.choice(["JMP frame", "JMP frame", "JMP frame", "HALT", "RET", last]))
        for number in range(self._routines):
            self._emit(f"routine{number}:")
            self._block(depth=self._depths[number], loops=1, routines=number, top=False)
            self._emit("RET")
        return "\n".join(self._lines) + "\n"

    def _emit(self, line: str) -> None:
        self._lines.append(line if line.endswith(":") else f"    {line}")

    def _label(self) -> str:
        self._labels += 1
        return f"l{self._labels}"

    def _block(self, *, depth: int, loops: int, routines: int, top: bool) -> None:
        for _ in range(self._random.randrange(1, 14)):
            if self._room <= 0:
                return
            self._room -= 1
            self._statement(depth=depth, loops=loops, routines=routines, top=top)

    def _statement(self, *, depth: int, loops: int, routines: int, top: bool) -> None:
        random = self._random
        inner = {"loops": loops, "routines": routines, "top": False}
        kind = random.randrange(20)
        if kind == 0 and depth < 4:
            self._emit(f"WHERE {random.choice(CONDITIONS)}")
            self._block(depth=depth + 1, **inner)  # type: ignore[arg-type]
            for _ in range(random.randrange(3)):
                self._emit("ELSE")
                self._block(depth=depth + 1, **inner)  # type: ignore[arg-type]
            self._emit("END")
        elif kind == 1 and loops < len(COUNTERS):
            label, counter = self._label(), COUNTERS[loops]
            self._emit(f"MOV {counter}, #{random.randrange(1, 4)}")
            self._emit(f"{label}:")
            self._block(depth=depth, loops=loops + 1, routines=routines, top=False)
            self._emit(f"SUB {counter}, #1")
            self._emit(f"JANY NE, {label}")
        elif kind == 2:
            label = self._label()
            self._emit(f"{random.choice(['JANY', 'JNONE'])} {random.choice(CONDITIONS)}, {label}")
            self._block(depth=depth, **inner)  # type: ignore[arg-type]
            self._emit(f"{label}:")
        elif kind == 3 and loops == 0 and depth in self._depths[:routines]:
            number = self._depths.index(depth)
            self._emit(f"CALL routine{number}")
        elif kind == 4:
            self._emit(f"OUT {random.randrange(5)}, {self._register()}")
        elif kind == 5:
            banks = range(0, self._machine.memory_bytes, 64)
            level = random.choice(["reset", "signal"])
            self._emit(f"SAMPLE {level}, {random.choice(list(banks))}")
        elif kind == 6 and top and random.randrange(3) == 0:
            self._emit("EXPOSE")
        else:
            self._emit(self._simple())

    def _register(self) -> str:
        return self._random.choice(self._registers)

    def _simple(self) -> str:
        random = self._random
        if self._more is not None and random.randrange(2):
            return self._more(random, self._register)
        rd, rs = self._register(), self._register()
        number = random.choice([0, 0, 1, 127, 128, 255, random.randrange(256)])
        address = random.randrange(self._machine.memory_bytes)
        bank = random.choice(range(0, self._machine.memory_bytes, 64))
        operation = random.choice(["ADD", "ADC", "SUB", "SBC", "CMP", "AND", "OR"])
        return random.choice(
            [
                f"MOV {rd}, {rs}",
                f"MOV {rd}, #{number}",
                f"MOV {rd}, #{number}",
                *[f"{operation} {rd}, {rs}"] * 6,
                *[f"{operation} {rd}, {rd}"] * 2,
                *[f"{operation} {rd}, #{number}"] * 4,
                f"SHL {rd}, #{random.randrange(1, 8)}",
                f"SHR {rd}, #{random.randrange(1, 8)}",
                f"RCR {rd}",
                f"NBR {rd}, {rs}, {random.choice(['north', 'east', 'south', 'west'])}",
                f"ROW {rd}",
                f"COL {rd}",
                f"LD {rd}, [{address}]",
                f"ST [{address}], {rs}",
                f"LD {rd}, [{rs} + {bank}]",
                f"ST [{rs} + {bank}], {rd}",
            ]
        )
