"""Helper functions of a module: gather, scatter, conversions, frames, and calls of the host.

They depend on the machine only, not on the program.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final, NamedTuple

from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit import pixels
from npchip.engines.wasm.emit.encode import I32, I64, V128, Function, Signature
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.engines.wasm.emit.pixels import FEW, each_vector
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
        scatter: store `operand` at each NP's address in `addresses` where `mask` is set.
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
    scatter: int = 2
    signal: int = 3
    noise: int = 4
    merge: int = 5
    close: int = 6
    expose: int = 7
    assemble: int = 8
    complete: int = 9
    active: int = 10


HELPERS: Final = Helpers()


def functions(where: Layout, called: Collection[int]) -> list[Function]:
    """Return the helper functions from `gather` to `active`.

    Args:
        where: addresses in the module's memory.
        called: numbers of the functions that are called; the others stay empty.
    """
    makers = (
        _gather,
        _scatter,
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


def _same_address(out: Function, where: Layout) -> None:
    """Push whether all NPs have the same address."""
    differ = out.local(V128)

    def compare(place: int, start: int) -> None:
        out.get(place)
        out.memory("v128.load", where.addresses + start)
        out.load("i32.load8_u", where.addresses)
        out.op("i8x16.splat", "v128.xor")
        if start + VECTOR > where.lanes or where.vectors > FEW:
            out.get(place)
            out.memory("v128.load", where.inside + start)
            out.op("v128.and")
        out.get(differ)
        out.op("v128.or")
        out.set(differ)

    each_vector(out, where, compare)
    out.get(differ)
    out.op("v128.any_true", "i32.eqz")


def _gather(where: Layout) -> Function:
    out = Function()
    lane = out.local(I32)
    _same_address(out, where)
    out.op("if")
    out.i32(where.operand)
    _own_byte(out, where, None)
    out.i32(where.memory)
    out.op("i32.add")
    out.i32(where.stride)
    out.op("memory.copy")
    out.op("else")
    out.op("loop")
    for extra in range(4):
        out.get(lane)
        _own_byte(out, where, lane, extra)
        out.memory("i32.load8_u", where.memory + extra)
        out.memory("i32.store8", where.operand + extra)
    out.end_counting_loop(lane, 4, where.stride)
    out.op("end")
    return out


def _own_byte(out: Function, where: Layout, lane: int | None, extra: int = 0) -> None:
    """Push the offset in the NPs' memory of the byte that an NP addresses, less `extra`.

    Args:
        out: the function to write to.
        where: addresses in the module's memory.
        lane: local with a lane; None for lane 0, whose own offset is 0.
        extra: added to the lane.
    """
    if lane is None:
        out.i32(0)
    else:
        out.get(lane)
    out.memory("i32.load8_u", where.addresses + extra)
    out.i32(where.stride)
    out.op("i32.mul")
    if lane is not None:
        out.get(lane)
        out.op("i32.add")


def _scatter(where: Layout) -> Function:
    out = Function()
    lane = out.local(I32)
    out.op("loop")
    out.get(lane)
    out.memory("i32.load8_u", where.mask)
    out.op("if")
    _own_byte(out, where, lane)
    out.get(lane)
    out.memory("i32.load8_u", where.operand)
    out.memory("i32.store8", where.memory)
    out.op("end")
    out.end_counting_loop(lane, 1, where.lanes)
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

    def add(place: int, start: int) -> None:
        out.get(place)
        out.memory("v128.load", where.mask + start)
        out.get(place)
        out.memory("v128.load", where.inside + start)
        out.op("v128.and", "i8x16.bitmask", "i32.popcnt")
        out.get(total)
        out.op("i32.add")
        out.set(total)

    each_vector(out, where, add)
    out.get(total)
    out.op("i64.extend_i32_u")
    return out
