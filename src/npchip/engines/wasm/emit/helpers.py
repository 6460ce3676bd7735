"""The module's other functions: loads and stores with an address for each NP, conversions.

They are the same for every program; only the geometry matters.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final, NamedTuple

from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.control import ControlWords
from npchip.engines.wasm.emit.encode import I32, V128, Function, Signature
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.machine import PIXELS

HOST: Final[tuple[str, Signature]] = ("ask", ((I32, I32), (I32,)))
"""The only import, as each signature costs a tenth of a millisecond to compile: what is asked for,
one of the numbers below, and about what; an answer."""

REFILL: Final = 0
"""The ring is empty where the block of this number begins; 0 where the input ends."""
TICK: Final = 1
"""A frame takes long; 1 for a module that is to hand its state back: see `Session._tick`."""
DRAIN: Final = 2
"""Take the sends."""
CONVERT: Final = 3
"""A conversion into the buffer (1 signal, 0 reset), with noise."""
RECEIVE: Final = 4
"""The input of the block of this number; 0 where there is none."""
PROBE: Final = 5
"""The block of this number begins."""


class Helpers(NamedTuple):
    """Numbers of the functions that a program calls.

    Attributes:
        ask: ask the host.
        gather: `operand` := the byte at each NP's own address of `addresses`.
        scatter: the byte at each NP's own address := `operand` where `mask` is set.
        signal: planes at an address := those of the frame at another, plus offsets.
        merge: planes at an address := those of the buffer where `mask` is set.
        tick: ask the host whether a frame that has taken long may go on; its answer, else 0.
        expose: close the frame and take the next one from the ring.
    """

    ask: int = 0
    gather: int = 1
    scatter: int = 2
    signal: int = 3
    merge: int = 4
    tick: int = 5
    expose: int = 6


HELPERS: Final = Helpers()


def functions(where: Layout, called: Collection[int]) -> list[Function]:
    """The functions from `gather` to `expose`.

    Args:
        where: addresses.
        called: numbers of those that are called; the others stay empty.
    """
    makers = {
        HELPERS.gather: _gather,
        HELPERS.scatter: _scatter,
        HELPERS.signal: _signal,
        HELPERS.merge: _merge,
        HELPERS.tick: _tick,
        HELPERS.expose: _expose,
    }
    parameters = {HELPERS.signal: (I32, I32), HELPERS.merge: (I32,)}
    return [
        make(where) if number in called else Function(parameters.get(number, ()))
        for number, make in makers.items()
    ]


def _loop(out: Function, local: int, step: int, end: int) -> None:
    """Close a loop that counts `local` by `step` up to `end`."""
    out.get(local)
    out.i32(step)
    out.op("i32.add")
    out.tee(local)
    out.i32(end)
    out.op("i32.lt_u")
    out.br_if(0)
    out.op("end")


def _same_address(out: Function, where: Layout) -> None:
    """Push whether all NPs have the same address."""
    for index in range(where.vectors):
        out.i32(0)
        out.memory("v128.load", where.addresses + VECTOR * index)
        out.i32(0)
        out.memory("i32.load8_u", where.addresses)
        out.op("i8x16.splat", "v128.xor")
        if index == where.vectors - 1 and where.stride != where.lanes:
            inside = where.lanes - VECTOR * index
            out.v128(b"\xff" * inside + bytes(VECTOR - inside))
            out.op("v128.and")
        if index:
            out.op("v128.or")
    out.op("v128.any_true", "i32.eqz")


def _gather(where: Layout) -> Function:
    out = Function()
    lane = out.local(I32)
    _same_address(out, where)
    out.if_()
    out.i32(where.operand)
    _own_byte(out, where, None)
    out.i32(where.memory)
    out.op("i32.add")
    out.i32(where.stride)
    out.copy()
    out.op("else")
    out.loop()
    for extra in range(4):
        out.get(lane)
        _own_byte(out, where, lane, extra)
        out.memory("i32.load8_u", where.memory + extra)
        out.memory("i32.store8", where.operand + extra)
    _loop(out, lane, 4, where.stride)
    out.op("end")
    return out


def _own_byte(out: Function, where: Layout, lane: int | None, extra: int = 0) -> None:
    """Push where the byte of a lane lies in the memory, less `extra`; of the first if None."""
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
    out.loop()
    out.get(lane)
    out.memory("i32.load8_u", where.mask)
    out.if_()
    _own_byte(out, where, lane)
    out.get(lane)
    out.memory("i32.load8_u", where.operand)
    out.memory("i32.store8", where.memory)
    out.op("end")
    _loop(out, lane, 1, where.lanes)
    return out


def _tick(_where: Layout) -> Function:
    """Every loop does this, and a call takes far less code than what is called."""
    out = Function(results=(I32,))
    words = ControlWords(out)
    words.push_long(at.CYCLES)
    words.push_long(at.CHECK)
    out.op("i64.lt_s")
    out.if_()
    out.i32(0)
    out.op("return", "end")
    out.i32(TICK)
    out.i32(0)
    out.call(HELPERS.ask)
    return out


def _expose(where: Layout) -> Function:
    out = Function()
    words, record = ControlWords(out), out.local(I32)
    words.push(at.POSITION)
    out.if_()  # otherwise the host has filled the ring, and closed the frame
    words.push(at.POSITION)
    out.i32(at.RECORD)
    out.op("i32.mul")
    out.set(record)
    before = where.records - at.RECORD
    for place, word in ((before, at.CYCLES), (before + 8, at.INSTRUCTIONS)):
        out.get(record)
        words.push_long(word)
        out.memory("i64.store", place)
    out.get(record)
    words.push(at.LOG_END)
    out.memory("i32.store", before + 16)
    out.op("end")
    out.i32(0)
    words.push(at.POSITION)
    out.i32(where.frame_bytes)
    out.op("i32.mul")
    out.i32(where.frames)
    out.op("i32.add")
    out.memory("i32.store", at.FRAME)
    words.increase(at.POSITION, 1)
    out.i32(0)
    out.i32(0)
    out.memory("i32.store", at.CONVERSIONS)
    for word in (at.CYCLES, at.INSTRUCTIONS):
        out.i32(0)
        out.i64(0)
        out.memory("i64.store", word)
    out.i32(0)
    words.push_long(at.FIRST_CHECK)
    out.memory("i64.store", at.CHECK)
    return out


def _merge(where: Layout) -> Function:
    out = Function(parameters=(I32,))
    plane = out.local(I32)
    out.loop()
    for index in range(where.vectors):
        out.get(0)
        out.get(plane)
        out.op("i32.add")
        out.get(plane)
        out.memory("v128.load", where.converted + VECTOR * index)
        out.get(0)
        out.get(plane)
        out.op("i32.add")
        out.memory("v128.load", VECTOR * index)
        out.i32(0)
        out.memory("v128.load", where.mask + VECTOR * index)
        out.op("v128.bitselect")
        out.memory("v128.store", VECTOR * index)
    _loop(out, plane, where.stride, at.PLANES * where.stride)
    return out


def _signal(where: Layout) -> Function:
    """Deal the pixels of a frame out to planes: parameters target and frame.

    For each y and each 16 NPs, 16 groups of 8 bytes, one group for each NP, are interleaved four
    times over; what comes out is the byte x of all 16 NPs, for each x.
    """
    offsets = where.machine.sensor.fixed_pattern > 0
    out = Function(parameters=(I32, I32))
    target, frame = 0, 1
    offset, row = out.local(I32), out.local(I32)
    vectors = out.local(V128, 16)
    width = where.machine.cols
    out.loop()
    for index in range(where.vectors):
        _groups(out, where, index, frame, vectors)
        _interleave(out, vectors)
        for x in range(PIXELS):
            place = x * where.stride + VECTOR * index
            out.get(target)
            out.get(vectors + x)
            if offsets:
                out.get(offset)
                out.memory("v128.load", where.offsets + place)
                out.op("i8x16.add_sat_u")
            out.memory("v128.store", place)
    for local, step in ((target, PIXELS * where.stride), (offset, PIXELS * where.stride)):
        out.get(local)
        out.i32(step)
        out.op("i32.add")
        out.set(local)
    out.get(frame)
    out.i32(width)
    out.op("i32.add")
    out.set(frame)
    _loop(out, row, 1, PIXELS)
    return out


def _groups(out: Function, where: Layout, index: int, frame: int, vectors: int) -> None:
    """Load the bytes of 16 NPs in a row of pixels, those of two NPs into each local."""
    columns, width = where.machine.np_cols, where.machine.cols

    def place(lane: int) -> int:
        return lane // columns * PIXELS * width + lane % columns * PIXELS

    for pair in range(8):
        lane = VECTOR * index + 2 * pair
        out.get(frame)
        if lane >= where.lanes:
            out.op("i8x16.splat")  # of anything: these lanes are no NPs
        elif lane + 1 < where.lanes and lane // columns == (lane + 1) // columns:
            out.memory("v128.load", place(lane))
        elif lane + 1 < where.lanes:
            out.get(frame)
            out.memory("v128.load64_zero", place(lane))
            out.load64_lane(place(lane + 1), 1)
        else:
            out.memory("v128.load64_zero", place(lane))
        out.set(vectors + pair)


_LOW: Final = [number for lane in range(8) for number in (lane, lane + 16)]
_HIGH: Final = [number + 8 for number in _LOW]


def _interleave(out: Function, vectors: int) -> None:
    """16 groups of 8 bytes in 8 vectors to 8 vectors of 16 bytes; uses 16 locals.

    Number the 128 bytes with 7 bits: the NP's number n3 n2 n1 n0, then x2 x1 x0. Interleaving
    vectors k and k + 4 into 2k and 2k + 1 rotates all these numbers to the left by one bit, so
    that after four rounds x selects the vector and n the byte in it.
    """
    source, target = vectors, vectors + 8
    for _ in range(4):
        for pair in range(4):
            for half, lanes in enumerate((_LOW, _HIGH)):
                out.get(source + pair)
                out.get(source + pair + 4)
                out.shuffle(lanes)
                out.set(target + 2 * pair + half)
        source, target = target, source
