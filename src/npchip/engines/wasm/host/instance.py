"""A module instance in wasmtime, with its memory and the state of the NPs in it."""

from __future__ import annotations

import ctypes
import threading
from functools import cache, partial
from typing import Any, Final
from weakref import WeakKeyDictionary

import numpy as np
import wasmtime
from numpy.typing import NDArray

from npchip.engines.state import ChipState
from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.helpers import DRAIN, HOST, RECEIVE, REFILL, TICK
from npchip.engines.wasm.host.signals import Signals
from npchip.engines.wasm.translate.steps import TooLargeError
from npchip.engines.wasm.translate.summary import MASKS
from npchip.engines.wasm.translation import Translation
from npchip.isa import REGISTERS
from npchip.isa.ir import CARRY, ZERO
from npchip.machine.layout import to_frames, to_planes

Bytes = NDArray[np.uint8]
_NO_MEMORY: Final = ("mmap", "allocate memory", "out of memory", "os error 12")
_METHODS: Final = {REFILL: "_refill", TICK: "_tick", DRAIN: "_drain", RECEIVE: "_receive"}
"""Methods that answer a module's requests. They get the number of the block."""


@cache
def _engine(*, roomy: bool) -> wasmtime.Engine:
    """Return an engine whose instances reserve 4 GiB of addresses, or just what they need.

    With 4 GiB no access to the memory needs a check of its bounds.
    """
    config = wasmtime.Config()
    if not roomy:
        config.memory_reservation = 0
        config.memory_reservation_for_growth = 0
        config.memory_guard_size = 0
        config.cranelift_flag_set("enable_heap_access_spectre_mitigation", "false")
    config.memory_init_cow = False  # it takes a file, whose size may be limited
    config.parallel_compilation = False  # a module has one large function
    return wasmtime.Engine(config)


@cache
def _limits_addresses() -> bool:
    """Return whether the system limits this process's addresses, as ``ulimit -v`` does."""
    try:
        import resource  # noqa: PLC0415 - it is there on Unix only
    except ImportError:
        return False
    return resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY


class _Entered(threading.local):
    """The instance whose module this thread runs."""

    instance: Instance | None = None


_ENTERED: Final = _Entered()


def _ask(what: int, about: int) -> int:
    """Answer a request of the running module."""
    instance = _ENTERED.instance
    assert instance is not None
    return instance.answer(what, about)


_LINKING: Final = threading.Lock()


@cache
def _linker(*, roomy: bool) -> wasmtime.Linker:
    """Return a linker that gives every instance the same callback. Hold `_LINKING`.

    The table of callbacks in wasmtime before 50 breaks if two threads write to it.
    """
    linker = wasmtime.Linker(_engine(roomy=roomy))
    kind = wasmtime.FuncType(*([wasmtime.ValType.i32() for _ in side] for side in HOST[1]))
    linker.define_func("host", HOST[0], kind, _ask)
    return linker


_COMPILED: Final = WeakKeyDictionary[Translation, tuple[bool, wasmtime.Module]]()


def _compiled(translation: Translation, *, roomy: bool) -> wasmtime.Module:
    """Return the compiled module, which the instances of all threads share."""
    found = _COMPILED.get(translation)
    if found is None or found[0] != roomy:
        found = roomy, wasmtime.Module(_engine(roomy=roomy), translation.binary)
        _COMPILED[translation] = found
    return found[1]


class Instance:
    """An instance of a translated program.

    Args:
        translation: the translated program.

    Raises:
        TooLargeError: the module exceeds a limit of wasmtime.
    """

    def __init__(self, translation: Translation) -> None:
        where = self._layout = translation.layout
        self._signals = Signals()
        exports = self._exports(translation)
        memory = self._memory_owner = exports["memory"]
        self._run, self._complete, self._assemble = (
            partial(exports[name], self._store) for name in ("run", "complete", "assemble")
        )
        self._is_new = True
        size = where.pages * at.PAGE
        pointer = ctypes.cast(memory.data_ptr(self._store), ctypes.POINTER(ctypes.c_ubyte * size))
        self._bytes: Bytes = np.frombuffer(memoryview(pointer.contents), np.uint8)
        self._words = self._bytes[: at.CONTROL_BYTES].view(np.int32)
        self._longs = self._bytes[: at.CONTROL_BYTES].view(np.int64)
        self._counts = self._part(where.counts, 8 * where.counters).view(np.int64)
        records = self._part(where.records, at.RECORD * (where.ring + 1)).view(np.int64)
        self._records = records.reshape(-1, 3)
        frames = self._part(where.frames, where.ring * where.frame_bytes)
        self._ring = frames.reshape(where.ring, -1)
        self._memory = self._planes(where.memory, where.machine.memory_bytes)

    def _exports(self, translation: Translation) -> Any:
        """Instantiate the module, with little memory if there is no more."""
        for roomy in (False,) if _limits_addresses() else (True, False):
            with _LINKING:
                linker = _linker(roomy=roomy)
            self._store = wasmtime.Store(linker.engine)
            try:
                compiled = _compiled(translation, roomy=roomy)
                return linker.instantiate(self._store, compiled).exports(self._store)
            except wasmtime.WasmtimeError as error:
                said = str(error)
                if "exceed" in said:
                    raise TooLargeError("its module would be too large") from error
                if not any(word in said for word in _NO_MEMORY):
                    raise  # a bug in the translation, not a limit of wasmtime or of the system
        raise TooLargeError("there is not enough memory to compile it")

    def _enter(self) -> int:
        """Run the module and return its result: the number of the next block."""
        before, _ENTERED.instance = _ENTERED.instance, self
        self._raised: BaseException | None = None
        with self._signals.deferred():
            try:
                return int(self._run(0))
            except BaseException:
                if self._raised is None:
                    raise
                # wasmtime keeps one exception for all threads, so it may have raised another's.
                raise self._raised  # noqa: B904 - no cause of this one
            finally:
                _ENTERED.instance = before

    def answer(self, what: int, about: int) -> int:
        """Answer a request of the module with the number of its block."""
        try:
            self._signals.deliver()
            return int(getattr(self, _METHODS[what])(about))
        except BaseException as error:
            self._raised = error
            raise

    # ---- the state of the NPs

    def _load_arrays(self, state: ChipState) -> None:
        """Write registers, flags, masks, memory and the exposed frame to the module."""
        where = self._layout
        lanes = where.lanes
        planes = self._planes(where.state, MASKS + state.depth)
        planes[:REGISTERS, :lanes] = state.registers.reshape(REGISTERS, -1)
        planes[ZERO, :lanes] = state.zero.reshape(-1) * np.uint8(255)
        planes[CARRY, :lanes] = state.carry.reshape(-1) * np.uint8(255)
        for region in range(state.depth):  # active if only the regions inside it switch off
            active = state.activity.reshape(-1) < state.depth - region
            planes[MASKS + region, :lanes] = active * np.uint8(255)
        if not self._is_new or state.memory.any():  # a new instance holds zeros
            self._memory[:, :lanes] = state.memory.reshape(len(self._memory), -1)
        self._is_new = False
        first = self._part(where.first_frame, where.frame_bytes)
        first[:] = 0 if state.pixels is None else to_frames(state.pixels).reshape(-1)

    def _unload_arrays(self, depth: int, state: ChipState) -> None:
        """Read registers, flags, `depth` open masks and memory from the module."""
        shape, lanes = state.zero.shape, self._layout.lanes
        planes = self._planes(self._layout.state, MASKS + depth)[:, :lanes]
        state.registers[...] = planes[:REGISTERS].reshape(REGISTERS, *shape)
        state.zero[...] = planes[ZERO].reshape(shape) & 1
        state.carry[...] = planes[CARRY].reshape(shape) & 1
        inactive = (planes[MASKS:] == 0).sum(axis=0, dtype=np.uint8)
        state.activity[...] = inactive.reshape(shape)
        state.memory[...] = self._memory[:, :lanes].reshape(len(self._memory), *shape)

    def _pixels(self) -> Bytes:
        """Return the exposed frame as planes."""
        machine = self._layout.machine
        address = int(self._words[at.FRAME // 4])
        frame = self._part(address, self._layout.frame_bytes)
        return to_planes(frame.reshape(machine.rows, machine.cols).copy())

    # ---- the memory

    def _part(self, start: int, size: int) -> Bytes:
        return self._bytes[start : start + size]

    def _planes(self, start: int, count: int) -> Bytes:
        """Return a view of `count` planes: uint8, shape (count, stride)."""
        stride = self._layout.stride
        return self._part(start, count * stride).reshape(count, stride)
