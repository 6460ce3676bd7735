"""Helper functions of a module: gather, scatter, conversions, frames, and calls of the host.

They depend on the machine only, not on the program.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial
from typing import Final, NamedTuple

from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit import pixels
from npchip.engines.wasm.emit.encode import I32, Function, Signature
from npchip.engines.wasm.emit.layout import VECTOR, Layout

HOST: Final[tuple[str, Signature]] = ("ask", ((I32, I32), (I32,)))
"""The only import: takes one of the request numbers below and an argument, returns an answer.

There is only one because every signature adds to the compile time.
"""

REFILL: Final = 0
"""Refill the ring buffer before a block (its number). Answer: 0 if the input has ended."""
TICK: Final = 1
"""Check a frame that takes long. Answer: 1 if the module must return to the host."""
DRAIN: Final = 2
"""Drain the log of sends."""
RECEIVE: Final = 3
"""Fetch the input of a block (its number). Answer: 0 if there is none."""
PROBE: Final = 4
"""Show the state before a block (its number)."""


class Helpers(NamedTuple):
    """Numbers of the helper functions. Names in backquotes are scratch planes of `Layout`.

    Attributes:
        ask: ask the host.
        gather: load the byte at each NP's address in `addresses` into `operand`.
        gather_some: the same for the NPs whose byte in `mask` is not 0.
        scatter: store `operand` at each NP's address in `addresses`.
        scatter_some: the same for the NPs whose byte in `mask` is not 0.
        signal: write a frame as planes, plus the fixed pattern if there is no noise (parameters:
            planes, frame).
        noise: add the fixed pattern and the noise of a conversion to planes (parameter: planes).
        merge: copy the conversion buffer to planes where `mask` is set (parameter: planes).
        tick: ask the host if the frame has reached its next check; return its answer, else 0.
        expose: close the frame and take the next one from the ring buffer.
        assemble: write pictures as frames to `Layout.pictures`. The host calls it (parameters:
            first plane of the first picture, distance of a picture's planes, distance of the
            pictures, their number).
    """

    ask: int = 0
    gather: int = 1
    gather_some: int = 2
    scatter: int = 3
    scatter_some: int = 4
    signal: int = 5
    noise: int = 6
    merge: int = 7
    tick: int = 8
    expose: int = 9
    assemble: int = 10


HELPERS: Final = Helpers()

_Access = Callable[[Function, Layout, int, int], None]


def functions(where: Layout, called: Collection[int]) -> list[Function]:
    """Return the helper functions from `gather` to `assemble`.

    Args:
        where: addresses in the module's memory.
        called: numbers of the functions that are called; the others stay empty.
    """
    makers: Sequence[Callable[[Layout], Function]] = (
        _gather,
        partial(_some, _load),
        _scatter,
        partial(_some, _store),
        pixels.signal,
        pixels.noise,
        pixels.merge,
        _tick,
        _expose,
        pixels.assemble,
    )
    parameters = {
        HELPERS.signal: (I32, I32),
        HELPERS.noise: (I32,),
        HELPERS.merge: (I32,),
        HELPERS.assemble: (I32,) * 4,
    }
    return [
        make(where) if number in called else Function(parameters.get(number, ()))
        for number, make in enumerate(makers, HELPERS.gather)
    ]


def _gather(where: Layout) -> Function:
    """Load the byte that the first NP addresses for all, then those with other addresses."""
    out = Function()
    plane = out.local(I32)

    def push(start: int) -> None:
        out.get(start)
        for local in (start, plane):
            out.get(local)
        out.op("i32.add")
        out.memory("v128.load", where.memory)
        out.memory("v128.store", where.operand)
        out.get(start)
        out.memory("v128.load", where.addresses)
        out.load("i32.load8_u", where.addresses)
        out.op("i8x16.splat")

    out.load("i32.load8_u", where.addresses)
    out.i32(where.stride)
    out.op("i32.mul")
    out.set(plane)
    return _each(out, where, push, _load)


def _some(access: _Access, where: Layout) -> Function:
    out = Function()

    def push(start: int) -> None:
        out.get(start)
        out.memory("v128.load", where.mask)
        out.v128(bytes(VECTOR))

    return _each(out, where, push, access)


def _scatter(where: Layout) -> Function:
    out = Function()
    lane = out.local(I32)
    out.op("loop")
    for extra in range(4):
        _store(out, where, lane, extra)
    out.end_counting_loop(lane, 4, where.stride)
    return out


def _load(out: Function, where: Layout, lane: int, extra: int) -> None:
    out.get(lane)
    _own_byte(out, where, lane, extra)
    out.memory("i32.load8_u", where.memory + extra)
    out.memory("i32.store8", where.operand + extra)


def _store(out: Function, where: Layout, lane: int, extra: int) -> None:
    _own_byte(out, where, lane, extra)
    out.get(lane)
    out.memory("i32.load8_u", where.operand + extra)
    out.memory("i32.store8", where.memory + extra)


def _own_byte(out: Function, where: Layout, lane: int, extra: int) -> None:
    """Push where the byte that NP `lane` + `extra` addresses is in the memory, less `extra`."""
    out.get(lane)
    out.memory("i32.load8_u", where.addresses + extra)
    out.i32(where.stride)
    out.op("i32.mul")
    out.get(lane)
    out.op("i32.add")


def _each(out: Function, where: Layout, push: Callable[[int], None], access: _Access) -> Function:
    """Write an access for each NP in which the two vectors differ that `push` pushes.

    Where most of 16 NPs do, all of them load.
    """
    start, lane, bits = (out.local(I32) for _ in range(3))
    out.op("loop")
    push(start)
    out.op("i8x16.eq", "i8x16.bitmask")
    out.i32((1 << VECTOR) - 1)
    out.op("i32.xor")
    out.tee(bits)
    if access is _load:
        out.op("i32.popcnt")
        out.i32(VECTOR // 2)
        out.op("i32.gt_u", "if")
        out.i32(0)
        out.set(bits)
        out.get(start)
        out.set(lane)
        out.op("loop")
        for extra in range(4):
            access(out, where, lane, extra)
        out.get(lane)
        out.i32(4)
        out.op("i32.add")
        out.tee(lane)
        out.i32(VECTOR - 1)
        out.op("i32.and")
        out.br_if(0)
        out.op("end", "end")
        out.get(bits)
    out.op("if", "loop")
    out.get(bits)
    out.op("i32.ctz")
    out.get(start)
    out.op("i32.add")
    out.set(lane)
    access(out, where, lane, 0)
    out.get(bits)
    out.get(bits)
    out.i32(1)
    out.op("i32.sub", "i32.and")
    out.tee(bits)
    out.br_if(0)
    out.op("end", "end")
    out.end_counting_loop(start, VECTOR, where.stride)
    return out


def _tick(_where: Layout) -> Function:
    out = Function(results=(I32,))
    out.load("i64.load", at.CYCLES)
    out.load("i64.load", at.CHECK)
    out.op("i64.lt_s")
    out.op("if")
    out.i32(0)
    out.op("return", "end")
    out.i32(TICK)
    out.i32(0)
    out.call(HELPERS.ask)
    return out


def _expose(where: Layout) -> Function:
    out = Function()
    record = out.local(I32)
    out.load("i32.load", at.POSITION)
    out.op("if")  # else the host has refilled the ring buffer and closed the frame
    out.load("i32.load", at.POSITION)
    out.i32(at.RECORD)
    out.op("i32.mul")
    out.set(record)
    before = where.records - at.RECORD
    for place, word in ((before, at.CYCLES), (before + 8, at.INSTRUCTIONS)):
        out.get(record)
        out.load("i64.load", word)
        out.memory("i64.store", place)
    out.get(record)
    out.load("i32.load", at.LOG_END)
    out.memory("i32.store", before + 16)
    out.op("end")
    out.i32(0)
    out.load("i32.load", at.POSITION)
    out.i32(where.frame_bytes)
    out.op("i32.mul")
    out.i32(where.frames)
    out.op("i32.add")
    out.memory("i32.store", at.FRAME)
    out.increase(at.POSITION, 1)
    out.i32(0)
    out.i32(0)
    out.memory("i32.store", at.CONVERSIONS)
    for word in (at.CYCLES, at.INSTRUCTIONS):
        out.i32(0)
        out.i64(0)
        out.memory("i64.store", word)
    out.i32(0)
    out.load("i64.load", at.FIRST_CHECK)
    out.memory("i64.store", at.CHECK)
    return out
