"""The reference engine, for debugging and comparison."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, get_args

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.engines.base import Feed, Partner, Request, Sink, Stop
from npchip.engines.batch import FrameBatch, Send
from npchip.engines.reference.lowering import Environment, Execute, Lowering, Plane
from npchip.engines.rows import ACTIVE, ENTERED, EXECUTED, TAKEN
from npchip.engines.state import ChipState, Write
from npchip.engines.traps import trap_of_effect, trap_of_word
from npchip.isa import Isa, ir
from npchip.machine import Machine
from npchip.machine.sensor import SensorModel
from npchip.program.graph import Place
from npchip.program.model import Program

_PIXELS: Final = 64


class ReferenceEngine(Environment):
    """Executes the intermediate form of each word with NumPy.

    Args:
        program: the program to execute.
        machine: geometry, memories, cycles and sensor.
        isa: the program's instruction set.
        profile: whether to keep profile counters.
    """

    name = "reference"
    notice = ""

    def __init__(
        self, program: Program, machine: Machine, isa: Isa, *, profile: bool = False
    ) -> None:
        self.state = ChipState.reset(machine, len(program.words), profile=profile)
        self.active = None
        self.partner: Partner | None = None
        self.written = None
        self._program = program
        self._machine = machine
        self._isa = isa
        self._sensor = SensorModel(machine.sensor, machine.np_rows, machine.np_cols)
        self.effects = {name: getattr(self, f"_{name}") for name in get_args(ir.EffectName)}
        self._lowering = Lowering(isa, self)
        # Words are lowered when first reached: an unreachable word may be undefined.
        self._decoded: dict[int, tuple[list[Execute], int]] = {}
        self._stop: Stop | None = None
        self._feed: Feed | None = None
        self._on_frame: Callable[[FrameBatch], None] | None = None
        self._target: int | None = None  # of a jump, call or return

    def run(self, feed: Feed, limit: int, sink: Sink) -> Stop:
        """See `Engine.run`."""
        state = self.state
        while state.frame_cycles < limit or state.halted or self._closes(limit):
            stop = self.step(feed, sink.take)
            if stop is not None:
                return stop
        return "cycle-limit"

    def another(self) -> None:
        """See `Engine.another`. Only compiled code runs beside another thread."""

    def _closes(self, limit: int) -> bool:
        """Return whether the frame has taken just its limit and an expose comes next."""
        state, words = self.state, self._program.words
        if state.frame_cycles != limit or state.pc >= len(words):
            return False
        word = self._isa.decode(words[state.pc])
        return word is not None and word.form.exposes

    def step(
        self, feed: Feed, on_frame: Callable[[FrameBatch], None], written: list[Write] | None = None
    ) -> Stop | None:
        """See `Engine.step`."""
        state = self.state
        self.written = written
        if state.halted:
            return "halted"
        address = state.pc
        statements, cycles = self._decoded.get(address) or self._decode(address)
        self._begin(feed, on_frame)
        counts = None if state.counts is None else state.counts.table(tuple(state.stack))
        active = 0 if counts is None else self._active_nps()
        depth = state.depth
        for execute in statements:
            execute()
        if self._stop == "frames-exhausted":
            return self._stop  # the expose is not complete: more frames may come
        if counts is not None:
            counts[EXECUTED, address] += 1
            counts[ACTIVE, address] += active
            counts[TAKEN, address] += self._target is not None
            counts[ENTERED, address] += self._active_nps() if state.depth > depth else 0
        state.pc = address + 1 if self._target is None else self._target
        state.cycles += cycles
        state.instructions += 1
        state.frame_cycles += cycles
        state.frame_instructions += 1
        state.executions[address] += 1
        return self._stop

    def _begin(self, feed: Feed, on_frame: Callable[[FrameBatch], None]) -> None:
        self._feed, self._on_frame, self._stop, self._target = feed, on_frame, None, None

    def _active_nps(self) -> int:
        return self.state.zero.size if self.active is None else int(np.count_nonzero(self.active))

    def refresh(self) -> None:
        """See `Engine.refresh`."""
        self.active = None if self.state.depth == 0 else self.state.activity == 0

    def _decode(self, address: int) -> tuple[list[Execute], int]:
        words = self._program.words
        decoded = self._isa.decode(words[address]) if address < len(words) else None
        if decoded is None:
            raise trap_of_word(words, address)
        statements = self._lowering.lower(decoded)
        cycles = self._machine.cycles(decoded.form.timing)
        self._decoded[address] = statements, cycles
        return statements, cycles

    # ---- effects on the flow

    def _jump(self, target: int) -> None:
        self._target = target

    def _call(self, target: int) -> None:
        self._check("call")
        self.state.stack.append(self.state.pc + 1)
        self._target = target

    def _ret(self) -> None:
        self._check("ret")
        self._target = self.state.stack.pop()

    def _halt(self) -> None:
        self.state.halted = True
        self._stop = "halted"

    # ---- sensor and output

    def _expose(self) -> None:
        state = self.state
        assert self._feed is not None
        assert self._on_frame is not None
        planes = self._feed.planes(state.frames_taken)
        self._on_frame(state.close_frame())
        if planes is None:
            self._stop = "frames-exhausted"
            return
        state.pixels = planes
        if self.written is not None:
            self.written.append(Write("frame", "", None))
        state.frames_taken += 1
        state.conversions = 0
        state.received = {}

    def _sample(self, level: str, bank: int) -> None:
        state = self.state
        data = self._sensor.sample(
            level == "signal", state.pixels, state.frames_taken, state.conversions
        )
        state.conversions += 1
        target = state.memory[bank : bank + _PIXELS]
        np.copyto(target, data, where=True if self.active is None else self.active)
        if self.written is not None:
            self.written.append(Write("memory", range(bank, bank + _PIXELS), self.active))

    def _output(self, port: int, value: Plane) -> None:
        state = self.state
        data = np.zeros(state.zero.shape, np.uint8)
        active = None if self.active is None else self.active.copy()
        np.copyto(data, value, where=True if active is None else active)
        state.sends.append(Send(port, state.pc, data, active))

    def hear(self, request: Request) -> NDArray[np.uint8] | None:
        """See `Environment.hear`.

        Raises:
            InputError: NP105, the partner returns something else.
        """
        data = None if self.partner is None else self.partner(request)
        if data is None:
            return None
        data, shape = np.asarray(data), self.state.zero.shape
        if data.dtype != np.uint8 or data.shape != shape:
            raise InputError(
                "NP105",
                f"from the partner: expected uint8 of shape {shape}, "
                f"found {data.dtype} {data.shape}",
                hint="a function given to Chip.connect returns a byte for each NP, or None",
            )
        return data

    # ---- masks (activity counters: Keryell and Paris 1993)

    def _mask_push(self, condition: Any) -> None:
        self._check("mask_push")
        state, counter = self.state, self.state.activity
        counter += ((counter > 0) | ~condition).view(np.uint8)
        state.depth += 1
        self.refresh()

    def _mask_invert(self) -> None:
        self._check("mask_invert")
        counter = self.state.activity
        counter ^= (counter <= 1).view(np.uint8)  # swap 0 and 1
        self.refresh()

    def _mask_pop(self) -> None:
        self._check("mask_pop")
        counter = self.state.activity
        counter -= (counter > 0).view(np.uint8)
        self.state.depth -= 1
        self.refresh()

    def _check(self, effect: str) -> None:
        """Raise the trap that an effect is in this state, if it is one."""
        state = self.state
        place = Place(state.pc, tuple(state.stack), state.depth)
        if trap := trap_of_effect(effect, place, self._machine):
            raise trap
