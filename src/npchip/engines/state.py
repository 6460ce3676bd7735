"""The state of the emulated chip."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from npchip.engines.batch import FrameBatch, Send, SendLog
from npchip.engines.counts import Counts
from npchip.isa import REGISTERS
from npchip.machine import Machine


@dataclass(eq=False)
class Write:
    """A write by one instruction. The value may be the same as before.

    Attributes:
        kind: kind of the target; ``frame`` is the whole exposed frame.
        index: register number, flag name (``Z``, ``C``), or memory addresses: one, a range, or
            one for each NP (uint8, shape (R, C)).
        active: NPs that wrote: bool, shape (R, C); None for all.
    """

    kind: Literal["register", "flag", "memory", "frame"]
    index: int | str | range | NDArray[np.uint8]
    active: NDArray[np.bool_] | None


@dataclass(eq=False)
class ChipState:
    """State of the GCU and of all NPs. (R, C) is the array's shape in NPs; all starts at 0.

    Attributes:
        registers: uint8, shape (16, R, C).
        zero, carry: bool, shape (R, C): the flags Z and C.
        activity: uint8, shape (R, C): an NP is active while its counter is 0.
        memory: uint8, shape (bytes, R, C).
        executions: int64, shape (words,): executions of each address.
        pixels: uint8, shape (64, R, C): the exposed frame as planes; None before the first.
        pc: address of the next instruction.
        stack: return addresses, the newest last.
        depth: number of open masked regions.
        halted: whether a HALT was executed.
        frames_taken: frames exposed since reset.
        conversions: conversions started in this frame.
        cycles, instructions: since reset.
        frame_cycles, frame_instructions: since the last expose (included); before the first,
            since reset.
        sends: outputs of this frame so far.
        received: number of inputs of this frame so far, by port.
        counts: counters of a profile; None without one.
    """

    registers: NDArray[np.uint8]
    zero: NDArray[np.bool_]
    carry: NDArray[np.bool_]
    activity: NDArray[np.uint8]
    memory: NDArray[np.uint8]
    executions: NDArray[np.int64]
    pixels: NDArray[np.uint8] | None = None
    pc: int = 0
    stack: list[int] = field(default_factory=list)
    depth: int = 0
    halted: bool = False
    frames_taken: int = 0
    conversions: int = 0
    cycles: int = 0
    instructions: int = 0
    frame_cycles: int = 0
    frame_instructions: int = 0
    sends: list[Send] = field(default_factory=list)
    received: dict[int, int] = field(default_factory=dict)
    counts: Counts | None = None

    @classmethod
    def reset(cls, machine: Machine, words: int, *, profile: bool = False) -> ChipState:
        """Return the state after reset of a machine with a program of `words` words."""
        shape = machine.geometry
        return cls(
            registers=np.zeros((REGISTERS, *shape), np.uint8),
            zero=np.zeros(shape, np.bool_),
            carry=np.zeros(shape, np.bool_),
            activity=np.zeros(shape, np.uint8),
            # An NP's bytes are adjacent, which makes loads with an address per NP faster.
            memory=np.zeros((*shape, machine.memory_bytes), np.uint8).transpose(2, 0, 1),
            executions=np.zeros(words, np.int64),
            counts=Counts(words) if profile else None,
        )

    def close_frame(self) -> FrameBatch:
        """Return the record of the current frame as a batch of one, and begin the next."""
        log = SendLog.of(self.sends, self.zero.shape)
        cycles, instructions = np.array([self.frame_cycles]), np.array([self.frame_instructions])
        self.frame_cycles, self.frame_instructions, self.sends = 0, 0, []
        return FrameBatch(cycles, instructions, log)

    def copy(self) -> ChipState:
        """Return a deep copy."""
        return copy.deepcopy(self)

    def assign(self, other: ChipState) -> None:
        """Copy the values of another state into the arrays of this one."""
        for name, value in vars(other.copy()).items():
            own: Any = getattr(self, name)
            if isinstance(own, np.ndarray) and name != "pixels":
                own[...] = value
            else:
                setattr(self, name, value)
