"""A module instance in wasmtime, with its memory and the state of the NPs in it."""

from __future__ import annotations

import ctypes
import weakref
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any, Final
from weakref import WeakKeyDictionary

import numpy as np
import wasmtime
from numpy.typing import NDArray

from npchip.engines.state import ChipState
from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.helpers import HOST
from npchip.engines.wasm.host.signals import Signals
from npchip.engines.wasm.translate.steps import TooLargeError
from npchip.engines.wasm.translate.summary import MASKS, SAME, is_bit
from npchip.engines.wasm.translation import Translation
from npchip.isa import REGISTERS
from npchip.isa.ir import CARRY, ZERO
from npchip.machine.layout import to_frames, to_planes

Bytes = NDArray[np.uint8]
_NO_MEMORY: Final = ("mmap", "allocate memory", "out of memory", "os error 12")
_Method = Callable[[Any, int], int]


@cache
def _engine(allocator: str) -> wasmtime.Engine:
    """Return the engine; its instances reserve just the addresses that they need.

    Nearly all addresses in a module are constants, so checked bounds cost no time.
    """
    config = wasmtime.Config()
    config.memory_reservation = 0
    config.memory_reservation_for_growth = 0
    config.memory_guard_size = 0
    config.parallel_compilation = False  # a module has one large function
    config.cranelift_flag_set("regalloc_algorithm", allocator)
    return wasmtime.Engine(config)


_COMPILED: Final = WeakKeyDictionary[Translation, tuple[wasmtime.Engine, wasmtime.Module]]()


def _compiled(translation: Translation) -> tuple[wasmtime.Engine, wasmtime.Module]:
    """Return an engine and the module that it has compiled, which instances share."""
    found = _COMPILED.get(translation)
    if found is None:
        engine = _engine(allocator_for(translation))
        found = _COMPILED[translation] = engine, wasmtime.Module(engine, translation.binary)
    return found


def allocator_for(translation: Translation) -> str:
    """Return the register allocator that Cranelift is to use.

    The single-pass one compiles faster, but its code is slower. It serves programs that wait for
    their partner in every frame.
    """
    blocks = translation.blocks
    work = [number for block in blocks if block.exposes for number in block.after]
    found: set[int] = set()  # reachable from an expose
    while work:
        number = work.pop()
        if number not in found:
            found.add(number)
            work += blocks[number].after
    waits = any(blocks[number].port is not None for number in found)
    return "single_pass" if waits else "backtracking"


class Instance:
    """An instance of a translated program.

    Args:
        translation: the translated program.
        methods: methods of this class that answer the module's requests, by request number.

    Raises:
        TooLargeError: the module exceeds a limit of wasmtime.
    """

    def __init__(self, translation: Translation, methods: Sequence[_Method]) -> None:
        where = self._layout = translation.layout
        self._begins = translation.begins
        self._uniform: dict[int, tuple[list[int], list[int], Bytes]] = {}
        self._signals = Signals()
        exports = self._exports(translation, methods)
        memory, run, assemble = (exports[name] for name in ("memory", "run", "assemble"))
        assert isinstance(memory, wasmtime.Memory)
        assert isinstance(run, wasmtime.Func)
        assert isinstance(assemble, wasmtime.Func)
        self._run = run
        self._assemble = partial(assemble, self._store)
        self._memory_owner = memory
        size = where.pages * at.PAGE
        pointer = ctypes.cast(memory.data_ptr(self._store), ctypes.POINTER(ctypes.c_ubyte * size))
        self._bytes: Bytes = np.frombuffer(memoryview(pointer.contents), np.uint8)
        self._words = self._bytes[: at.CONTROL_BYTES].view(np.int32)
        self._longs = self._bytes[: at.CONTROL_BYTES].view(np.int64)
        self._calls = self._part(where.calls, 4 * where.machine.stack_depth).view(np.int32)
        self._counts = self._part(where.counts, 8 * where.counters).view(np.int64)
        parts = self._part(where.parts, where.records - where.parts)
        self._parts = parts.view(np.uint32).reshape(-1, 4)
        records = self._part(where.records, at.RECORD * where.ring).view(np.int64)
        self._records = records.reshape(where.ring, 3)
        frames = self._part(where.frames, where.ring * where.frame_bytes)
        self._ring = frames.reshape(where.ring, -1)
        self._memory = self._planes(where.memory, where.machine.memory_bytes)

    def _exports(self, translation: Translation, methods: Sequence[_Method]) -> Any:
        """Instantiate the module."""
        kind = wasmtime.FuncType(*([wasmtime.ValType.i32() for _ in side] for side in HOST[1]))
        try:
            engine, compiled = _compiled(translation)
            self._store = wasmtime.Store(engine)
            ask = wasmtime.Func(self._store, kind, _weak(methods, self, self._signals))
            return wasmtime.Instance(self._store, compiled, [ask]).exports(self._store)
        except wasmtime.WasmtimeError as error:
            said = str(error)
            if "exceed" in said:
                raise TooLargeError("its module would be too large") from error
            if any(word in said for word in _NO_MEMORY):
                raise TooLargeError("there is not enough memory to compile it") from error
            raise  # a bug in the translation, not a limit of wasmtime or of the system

    def _enter(self) -> int:
        """Run the module and return its result: the number of the next block."""
        with self._signals.deferred():
            return int(self._run(self._store))

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
        self._memory[:, :lanes] = state.memory.reshape(len(self._memory), -1)
        first = self._part(where.first_frame, where.frame_bytes)
        first[:] = 0 if state.pixels is None else to_frames(state.pixels).reshape(-1)

    def _expand_uniforms(self, number: int) -> None:
        """Expand the variables that are uniform or known before a block to planes.

        The module has stored the first byte of each uniform one.
        """
        found = self._uniform.get(number)
        if found is None:
            facts = self._begins[number]
            same = [variable for variable, what in facts.items() if what == SAME]
            constant = {variable: what for variable, what in facts.items() if what < SAME}
            numbers = [255 * what if is_bit(v) else what for v, what in constant.items()]
            found = same, list(constant), np.array(numbers, np.uint8)
            self._uniform[number] = found
        same, constants, values = found
        planes = self._planes(self._layout.state, MASKS + self._layout.machine.mask_depth)
        planes[same] = planes[same, :1]
        planes[constants] = values[:, None]

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


def _weak(methods: Sequence[_Method], owner: Instance, signals: Signals) -> Callable[..., int]:
    """Return a callback that does not keep `owner` alive, as wasmtime never frees callbacks.

    No ``WeakMethod``: its own callback could run a signal handler whose exception is lost, and
    with it Ctrl-C.
    """
    reference = weakref.ref(owner)

    def ask(what: int, about: int) -> int:
        alive = reference()
        assert alive is not None
        signals.deliver()
        return methods[what](alive, about)

    return ask
