"""The public chip: load a program, feed frames, run, step, inspect, go back."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from copy import deepcopy
from functools import wraps
from pathlib import Path
from threading import RLock
from typing import Any, Concatenate, Literal, NamedTuple, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from npchip.base.errors import InputError
from npchip.engines.base import Engine, Partner, Stop
from npchip.engines.batch import Send
from npchip.engines.counts import Counts
from npchip.engines.reference import ReferenceEngine
from npchip.engines.state import ChipState, Write
from npchip.frames.feed import Frames, SourceFeed, frame_source
from npchip.frames.memory import Memory, initial_memory
from npchip.isa import Isa, load_isa
from npchip.machine import Machine, load_machine
from npchip.machine.layout import to_frames, to_planes
from npchip.program.model import Program
from npchip.run.checks import check_fit
from npchip.run.job import Job
from npchip.run.result import FrameRecord, RunResult

_P = ParamSpec("_P")
_T = TypeVar("_T")

ENGINES = ("auto", "wasm", "reference")
"""Names of the engines for `Chip`."""

MAX_CYCLES = 50_000_000
"""Default cycle limit of one frame."""


class Snapshot(NamedTuple):
    """The state of a chip at one moment, for `Chip.restore`; its contents are private."""

    state: ChipState
    feed: SourceFeed

    def __repr__(self) -> str:
        return f"<Snapshot at pc {self.state.pc}, {self.state.cycles:,} cycles>"


def _alone(method: Callable[Concatenate[Chip, _P], _T]) -> Callable[Concatenate[Chip, _P], _T]:
    """Refuse a call while another thread is in the same chip."""

    @wraps(method)
    def entered(self: Chip, /, *args: _P.args, **kwargs: _P.kwargs) -> _T:
        if not self._entry.acquire(blocking=False):
            raise InputError(
                "NP107",
                f"{method.__name__}: another thread is using this chip",
                hint="make a chip for each thread; they can share a program",
            )
        try:
            return method(self, *args, **kwargs)
        finally:
            self._entry.release()

    return entered


class Chip:
    """An emulated chip with a program in its ROM.

    Args:
        program: a program, from `npchip.assemble`.
        machine: a shipped name, a ``.yaml`` path or a `Machine`.
        engine: ``"wasm"`` compiles the program, ``"reference"`` executes one instruction at a
            time; results are the same. ``"auto"`` takes the fastest possible.
        isa: instruction set of the program; the built-in one by default.
        profile: also count branches, masks and calls, for `counts`.
        memory: what the NPs' memory holds at reset, as for `load_memory`, besides what the
            program's ``.memory`` lines name; at the address of such a line, instead of it.

    Raises:
        InputError: the machine is unknown, the program does not fit it (NP101 to NP103), or
            memory cannot be read or does not fit (NP105, NP243); by
            every method that changes the state, NP107 another thread is in one of them.
    """

    def __init__(
        self,
        program: Program,
        machine: str | Path | Machine = "default",
        engine: Literal["auto", "wasm", "reference"] = "auto",
        isa: Isa | None = None,
        *,
        profile: bool = False,
        memory: Memory = (),
    ) -> None:
        if engine not in ENGINES:
            raise InputError("NP104", f"unknown engine '{engine}': expected {', '.join(ENGINES)}")
        self.isa = isa or load_isa()
        self.program = program
        self.machine = load_machine(machine, self.isa.timing_classes)
        check_fit(program, self.machine, self.isa)
        self._entry = RLock()  # a function called during a run may look at the chip
        self._wanted, self._profile = engine, profile
        self._engine = _engine(engine, program, self.machine, self.isa, profile=profile)
        self._feed = SourceFeed(None, 0)
        self._initial = initial_memory(program, self.machine, memory)
        self._fill_memory()

    def __reduce__(self) -> tuple[Any, ...]:
        isa = None if self.isa is load_isa() else self.isa
        made = self.program, self.machine, self._wanted, isa, self._profile, self._initial
        return _revived, (made, self._engine.partner, self.snapshot())

    def __repr__(self) -> str:
        return (
            f"<Chip with {self.program.name!r} on {self.machine.name!r}: pc {self.pc}, "
            f"{self.cycles:,} cycles>"
        )

    # ---- state

    @property
    def pc(self) -> int:
        """Address of the next instruction."""
        return self._engine.state.pc

    @property
    def registers(self) -> NDArray[np.uint8]:
        """Live registers, uint8, shape (16, NP rows, NP columns); may be written to."""
        return self._engine.state.registers

    @property
    def memory(self) -> NDArray[np.uint8]:
        """Live memory, uint8, shape (bytes, NP rows, NP columns); may be written to."""
        return self._engine.state.memory

    @property
    def flags(self) -> dict[str, NDArray[np.bool_]]:
        """Live flags ``Z`` and ``C``, bool, shape (NP rows, NP columns); may be written to."""
        return {"Z": self._engine.state.zero, "C": self._engine.state.carry}

    @property
    def active(self) -> NDArray[np.bool_]:
        """The active NPs: bool, shape (NP rows, NP columns), a copy."""
        return np.equal(self._engine.state.activity, 0)

    @property
    def depth(self) -> int:
        """Number of open masked regions."""
        return self._engine.state.depth

    @property
    def stack(self) -> tuple[int, ...]:
        """Return addresses, the newest last."""
        return tuple(self._engine.state.stack)

    @property
    def cycles(self) -> int:
        """Cycles since reset."""
        return self._engine.state.cycles

    @property
    def instructions(self) -> int:
        """Instructions executed since reset."""
        return self._engine.state.instructions

    @property
    def executions(self) -> NDArray[np.int64]:
        """Executions of each address since reset: int64, shape (words,), a copy.

        Their sum is `instructions`; an expose that found no frame is not counted.
        """
        return self._engine.state.executions.copy()

    @property
    def counts(self) -> Counts | None:
        """Counts of a profile since reset, a copy; None without ``profile=True``."""
        return deepcopy(self._engine.state.counts)

    @property
    def frames_taken(self) -> int:
        """Frames exposed since reset."""
        return self._engine.state.frames_taken

    @property
    def notice(self) -> str:
        """Reason for which another engine runs than the requested one; else empty."""
        return self._engine.notice

    @property
    def frame_cycles(self) -> int:
        """Cycles since the last expose, with it; before the first, since reset."""
        return self._engine.state.frame_cycles

    @property
    def sends(self) -> tuple[Send, ...]:
        """Sends since the last expose."""
        return tuple(self._engine.state.sends)

    @property
    def frame(self) -> NDArray[np.uint8] | None:
        """The exposed frame: uint8, shape (rows, columns), a copy; None before the first.

        May be set, which puts another picture on the sensor until the next expose.
        """
        pixels = self._engine.state.pixels
        return None if pixels is None else to_frames(pixels)

    @frame.setter
    def frame(self, picture: NDArray[np.uint8]) -> None:
        picture = np.asarray(picture)
        shape = (self.machine.rows, self.machine.cols)
        if picture.dtype != np.uint8 or picture.shape != shape:
            raise InputError(
                "NP105",
                f"frame: expected uint8 of shape {shape}, found {picture.dtype} {picture.shape}",
            )
        self._engine.state.pixels = to_planes(picture.copy())

    def _repr_html_(self) -> str:
        from npchip.run.html import chip_html  # noqa: PLC0415 - notebooks only

        return chip_html(self)

    # ---- going back

    @_alone
    def snapshot(self) -> Snapshot:
        """Return the whole state, with the position in the input."""
        return Snapshot(self._engine.state.copy(), self._feed)

    @_alone
    def restore(self, snapshot: Snapshot) -> None:
        """Go back (or forward) to a snapshot of this chip.

        Frames of an iterator cannot be taken twice; see `feed`.
        """
        self._engine.state.assign(snapshot.state)
        self._engine.refresh()
        self._feed = snapshot.feed

    @_alone
    def reset(self) -> None:
        """Set all state to what it is at first and take the frames away; keep the program.

        All is 0 but the NPs' memory, which holds what ``.memory`` lines and `memory` say.
        """
        words = len(self.program.words)
        self._engine.state.assign(ChipState.reset(self.machine, words, profile=self._profile))
        self._engine.refresh()
        self._feed = SourceFeed(None, 0)
        self._fill_memory()

    def _fill_memory(self) -> None:
        for address, planes in self._initial:
            self.load_memory(address, planes)

    # ---- running

    def connect(self, partner: Partner | None) -> None:
        """Set the source of the bytes of input instructions.

        The partner is not part of a snapshot, and a reset keeps it.

        Args:
            partner: a function that takes a `Request` for each input instruction and returns the
                bytes of all NPs, uint8 of shape (NP rows, NP columns), or None, which is a trap
                (NP306). Equal requests must have equal answers, as a run may repeat them. An
                exception ends the run before the instruction, as does a plane of another type or
                shape (InputError NP105). None removes the partner.
        """
        self._engine.partner = partner

    @_alone
    def load_memory(self, address: int, planes: NDArray[np.uint8]) -> None:
        """Write NP memory, as a scan-in over the column bus does (decision).

        Args:
            address: first byte, from 0.
            planes: uint8, shape (n, NP rows, NP columns): n bytes for every NP.

        Raises:
            InputError: NP105 wrong shape, type or range.
        """
        planes = np.asarray(planes)
        rows, cols = shape = self.machine.geometry
        wanted = f"uint8 of shape (n, {rows}, {cols})"
        if planes.dtype != np.uint8 or planes.ndim != 3 or planes.shape[1:] != shape:
            raise InputError(
                "NP105", f"NP memory: expected {wanted}, found {planes.dtype} {planes.shape}"
            )
        room = len(self.memory)
        if address < 0 or address + len(planes) > room:
            raise InputError(
                "NP105",
                f"NP memory: {len(planes)} bytes from {address} on do not fit in {room} bytes",
            )
        self.memory[address : address + len(planes)] = planes

    @_alone
    def feed(self, frames: Frames | None) -> None:
        """Provide the frames for the next expose instructions.

        Args:
            frames: a source from `npchip.frames`; an integer array (T, rows, columns) or
                (rows, columns) with values 0 to 255; or an iterable of (rows, columns) arrays,
                which is read during the run, by the compiled engine up to 1,024 ahead; an iterator
                can be read only once. None for no frames.

        Raises:
            InputError: frames of another size or type.
        """
        source = None if frames is None else frame_source(frames, self.machine)
        self._feed = SourceFeed(source, self.frames_taken)

    @_alone
    def run(
        self,
        frames: Frames | None = None,
        *,
        max_cycles: int = MAX_CYCLES,
        on_frame: Callable[[FrameRecord], None] | None = None,
    ) -> RunResult:
        """Run until the program halts, the frames end, or a frame reaches the cycle limit.

        A second run continues where the first ended; the part before its first expose is its
        setup.

        Args:
            frames: frames as for `feed`; None continues with the present ones.
            max_cycles: cycle limit of one frame, tested before each instruction.
            on_frame: function called with each completed frame. The compiled engine calls it
                batch by batch, when the chip itself is already further.

        Raises:
            InputError: frames that cannot be used.
        """
        if frames is not None:
            self.feed(frames)
        job = Job(self.program, self.machine, max_cycles)
        return job.run(self._engine, self._feed, on_frame)

    @_alone
    def run_many(
        self,
        clips: Iterable[Frames],
        *,
        jobs: int | None = None,
        max_cycles: int = MAX_CYCLES,
        on_clip: Callable[[int, RunResult], None] | None = None,
    ) -> list[RunResult]:
        """Run each of several clips from the present state, on all cores; stay in that state.

        Threads share the compiled program and the clips. They help as soon as it pays; clips that
        take less than a few milliseconds and the reference engine have this thread alone.

        Args:
            clips: for each run its frames as for `run`. An iterable is read as clips are begun.
            jobs: number of threads at most, this one included; by default one for each core.
            max_cycles: cycle limit of one frame.
            on_clip: function called in this thread with each clip's number and result, in order.

        Returns:
            The results in the order of the clips, each as that of `run`. A run that fails is a
            result too.

        Raises:
            InputError: frames that cannot be used, with the number of the first such clip; NP108
                the chip has a partner, or `clips` or `jobs` make no sense.
        """
        from npchip.run.many import run_many  # noqa: PLC0415 - not for single runs

        job = Job(self.program, self.machine, max_cycles)
        return run_many(job, self._engine, clips, jobs, on_clip)

    @_alone
    def step(self, written: list[Write] | None = None) -> Stop | None:
        """Execute one instruction; return None while the program can continue.

        Outputs of frames that are completed by steps belong to no result.

        Args:
            written: list to which the writes of the instruction are added, in their order.

        Raises:
            TrapError: the instruction cannot be executed.
        """
        return self._engine.step(self._feed, lambda _: None, written)


def _revived(made: tuple[Any, ...], partner: Partner | None, snapshot: Snapshot) -> Chip:
    """Return a chip in the state of one that was pickled or copied."""
    *arguments, profile, memory = made
    chip = Chip(*arguments, profile=profile, memory=memory)
    chip.connect(partner)
    chip.restore(snapshot)
    return chip


def _engine(name: str, program: Program, machine: Machine, isa: Isa, *, profile: bool) -> Engine:
    if name == "reference":
        return ReferenceEngine(program, machine, isa, profile=profile)
    from npchip.engines.wasm.host.engine import WasmEngine  # noqa: PLC0415 - not for reference runs

    return WasmEngine(program, machine, isa, profile=profile)  # it steps with the reference engine
