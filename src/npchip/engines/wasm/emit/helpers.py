"""Helper functions of a module: gather, scatter, conversions, frames, and calls of the host.

They depend on the machine only, not on the program.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial
from typing import Final, NamedTuple

from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit import pixels
from npchip.engines.wasm.emit.encode import I32, I64, Function, Signature
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.engines.wasm.emit.pixels import each_vector
from npchip.engines.wasm.translate.summary import ANY, SAME

HOST: Final[tuple[str, Signature]] = ("ask", ((I32, I32), (I32,)))
"""The only import: takes one of the request numbers below and an argument, returns an answer.

There is only one because every signature adds to the compile time.
"""

REFILL: Final = 0
"""Refill the ring buffer before a block (its number). Answer: 0 to return to the host."""
TICK: Final = 1
"""Check a frame that takes long before a block (its number). Answer: 1 to return to the host."""
DRAIN: Final = 2
"""Drain the log of sends."""
RECEIVE: Final = 3
"""Fetch the input of a block (its number). Answer: 0 if there is none."""


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
        close: close the frame: write its record, and begin another without cycles.
        expose: take the next frame from the ring buffer.
        assemble: write pictures as frames to `Layout.pictures`. The host calls it (parameters:
            first plane of the first picture, distance of a picture's planes, distance of the
            pictures, their number).
        complete: expand the variables that are uniform or known before a block to planes, after
            the module has left there. The host calls it (parameter: the block's number).
        active: return the number of NPs in `mask`.
    """

    ask: int = 0
    gather: int = 1
    gather_some: int = 2
    scatter: int = 3
    scatter_some: int = 4
    signal: int = 5
    noise: int = 6
    merge: int = 7
    close: int = 8
    expose: int = 9
    assemble: int = 10
    complete: int = 11
    active: int = 12


HELPERS: Final = Helpers()

_Access = Callable[[Function, Layout, int, int], None]


def functions(where: Layout, called: Collection[int]) -> list[Function]:
    """Return the helper functions from `gather` to `active`.

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
        _close,
        _expose,
        pixels.assemble,
        _complete,
        _active,
    )
    parameters = {
        HELPERS.signal: (I32, I32),
        HELPERS.noise: (I32,),
        HELPERS.merge: (I32,),
        HELPERS.assemble: (I32,) * 4,
        HELPERS.complete: (I32,),
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


def _close(where: Layout) -> Function:
    out = Function()
    record = out.local(I32)
    out.load("i32.load", at.CLOSED)
    out.i32(at.RECORD)
    out.op("i32.mul")
    out.set(record)
    for place, word in ((0, at.CYCLES), (8, at.INSTRUCTIONS)):
        out.get(record)
        out.load("i64.load", word)
        out.memory("i64.store", where.records + place)
        out.i32(0)
        out.i64(0)
        out.memory("i64.store", word)
    out.get(record)
    out.load("i32.load", at.LOG_END)
    out.memory("i32.store", where.records + 16)
    out.increase(at.CLOSED, 1)
    out.i32(0)
    out.load("i64.load", at.FIRST_CHECK)
    out.memory("i64.store", at.CHECK)
    return out


def _expose(where: Layout) -> Function:
    out = Function()
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
    return out


def _complete(where: Layout) -> Function:
    out = Function(parameters=(I32,))
    fact, plane = 0, out.local(I32)
    value = out.local(I32)
    out.get(fact)  # the number of the block, from here on the offset of its facts
    out.i32(2 * where.variables)
    out.op("i32.mul")
    out.set(fact)
    out.op("loop")
    out.get(fact)
    out.memory("i32.load16_u", where.facts)
    out.tee(value)
    out.i32(ANY)
    out.op("i32.ne", "if")
    out.get(plane)
    out.i32(where.state)
    out.op("i32.add")
    out.get(plane)
    out.memory("i32.load8_u", where.state)
    out.get(value)
    out.get(value)
    out.i32(SAME)
    out.op("i32.eq", "select")
    out.i32(where.stride)
    out.op("memory.fill", "end")
    out.advance({fact: 2})
    out.end_counting_loop(plane, where.stride, where.variables * where.stride)
    return out


def _active(where: Layout) -> Function:
    out = Function(results=(I64,))
    total = out.local(I32)

    def add(place: int) -> None:
        out.get(place)
        out.memory("v128.load", where.mask)
        out.get(place)
        out.memory("v128.load", where.inside)
        out.op("v128.and", "i8x16.bitmask", "i32.popcnt")
        out.get(total)
        out.op("i32.add")
        out.set(total)

    each_vector(out, where, add)
    out.get(total)
    out.op("i64.extend_i32_u")
    return out
