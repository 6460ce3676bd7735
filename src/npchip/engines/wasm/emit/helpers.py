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
    return [
        make(where) if number in called else Function()
        for number, make in enumerate(makers, HELPERS.gather)
    ]


def _gather(where: Layout) -> Function:
    """Load the byte that the first NP addresses for all, then those with other addresses."""
    out = Function()
    plane = out.local(I32)
    first = f"i32.const 0 i32.load8_u {where.addresses}"
    out.write(f"{first} i32.const {where.stride} i32.mul local.set {plane}")

    def push(start: int) -> None:
        out.write(f"""
            local.get {start} local.get {start} local.get {plane} i32.add
            v128.load {where.memory} v128.store {where.operand}
            local.get {start} v128.load {where.addresses} {first} i8x16.splat
        """)

    return _each(out, where, push, _load)


def _some(access: _Access, where: Layout) -> Function:
    out = Function()

    def push(start: int) -> None:
        out.write(f"local.get {start} v128.load {where.mask}")
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
    out.write(f"""
        local.get {lane} {_own_byte(where, lane, extra)}
        i32.load8_u {where.memory + extra} i32.store8 {where.operand + extra}
    """)


def _store(out: Function, where: Layout, lane: int, extra: int) -> None:
    out.write(f"""
        {_own_byte(where, lane, extra)}
        local.get {lane} i32.load8_u {where.operand + extra} i32.store8 {where.memory + extra}
    """)


def _own_byte(where: Layout, lane: int, extra: int) -> str:
    """Push where the byte that NP `lane` + `extra` addresses is in the memory, less `extra`."""
    return f"""
        local.get {lane} i32.load8_u {where.addresses + extra} i32.const {where.stride} i32.mul
        local.get {lane} i32.add
    """


def _each(out: Function, where: Layout, push: Callable[[int], None], access: _Access) -> Function:
    """Write an access for each NP in which the two vectors differ that `push` pushes.

    Where most of 16 NPs do, all of them load.
    """
    start, lane, bits = (out.local(I32) for _ in range(3))
    out.op("loop")
    push(start)
    out.write(f"i8x16.eq i8x16.bitmask i32.const {(1 << VECTOR) - 1} i32.xor local.tee {bits}")
    if access is _load:
        out.write(f"""
            i32.popcnt i32.const {VECTOR // 2} i32.gt_u
            if
                i32.const 0 local.set {bits}
                local.get {start} local.set {lane}
                loop
        """)
        for extra in range(4):
            access(out, where, lane, extra)
        out.write(f"""
                    local.get {lane} i32.const 4 i32.add local.tee {lane}
                    i32.const {VECTOR - 1} i32.and br_if 0
                end
            end
            local.get {bits}
        """)
    out.write(f"if loop local.get {bits} i32.ctz local.get {start} i32.add local.set {lane}")
    access(out, where, lane, 0)
    out.write(f"""
        local.get {bits} local.get {bits} i32.const 1 i32.sub i32.and local.tee {bits} br_if 0
        end end
    """)
    out.end_counting_loop(start, VECTOR, where.stride)
    return out


def _close(where: Layout) -> Function:
    out = Function()
    record = out.local(I32)
    out.write(f"i32.const 0 i32.load {at.CLOSED} i32.const {at.RECORD} i32.mul local.set {record}")
    for place, word in ((0, at.CYCLES), (8, at.INSTRUCTIONS)):
        out.write(f"""
            local.get {record} i32.const 0 i64.load {word} i64.store {where.records + place}
            i32.const 0 i64.const 0 i64.store {word}
        """)
    out.write(
        f"local.get {record} i32.const 0 i32.load {at.LOG_END} i32.store {where.records + 16}"
    )
    out.increase(at.CLOSED, 1)
    out.write(f"i32.const 0 i32.const 0 i64.load {at.FIRST_CHECK} i64.store {at.CHECK}")
    return out


def _expose(where: Layout) -> Function:
    out = Function()
    out.write(f"""
        i32.const 0 i32.const 0 i32.load {at.POSITION} i32.const {where.frame_bytes} i32.mul
        i32.const {where.frames} i32.add i32.store {at.FRAME}
    """)
    out.increase(at.POSITION, 1)
    out.write(f"i32.const 0 i32.const 0 i32.store {at.CONVERSIONS}")
    return out


def _complete(where: Layout) -> Function:
    out = Function(parameters=(I32,))
    fact, plane = 0, out.local(I32)  # the number of the block, then the offset of its facts
    value = out.local(I32)
    out.write(f"""
        local.get {fact} i32.const {2 * where.variables} i32.mul local.set {fact}
        loop
            local.get {fact} i32.load16_u {where.facts} local.tee {value} i32.const {ANY} i32.ne
            if
                local.get {plane} i32.const {where.state} i32.add
                local.get {plane} i32.load8_u {where.state} local.get {value}
                local.get {value} i32.const {SAME} i32.eq select
                i32.const {where.stride} memory.fill
            end
    """)
    out.advance({fact: 2})
    out.end_counting_loop(plane, where.stride, where.variables * where.stride)
    return out


def _active(where: Layout) -> Function:
    out = Function(results=(I64,))
    total = out.local(I32)
    each_vector(
        out,
        where,
        lambda place: out.write(f"""
            local.get {place} v128.load {where.mask} local.get {place} v128.load {where.inside}
            v128.and i8x16.bitmask i32.popcnt local.get {total} i32.add local.set {total}
        """),
    )
    out.write(f"local.get {total} i64.extend_i32_u")
    return out
