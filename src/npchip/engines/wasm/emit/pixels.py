"""Helper functions that move pixels: frames to planes and back, noise, and masked conversions.

They depend on the machine only, not on the program. `Helpers` says what they do.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from npchip.engines.wasm.emit import layout as at
from npchip.engines.wasm.emit.encode import I32, I64, V128, Function
from npchip.engines.wasm.emit.layout import VECTOR, Layout
from npchip.machine import PIXELS
from npchip.machine import noise as numbers

FEW: Final = 16
"""Most vectors of a plane for which pixels are rearranged without a loop over the array."""


def each_vector(out: Function, where: Layout, write: Callable[[int], None]) -> None:
    """Write a loop over the vectors of a plane.

    Args:
        out: the function to write to.
        where: addresses in the module's memory.
        write: writes the code for a vector, given a local with its place in a plane.
    """
    place = out.local(I32)
    out.write(f"i32.const 0 local.set {place} loop")
    write(place)
    out.end_counting_loop(place, VECTOR, where.stride)


def merge(where: Layout) -> Function:
    """Copy a conversion to the memory of the active NPs."""
    out = Function(parameters=(I32,))
    plane = out.local(I32)

    def merge(place: int) -> None:
        into = f"local.get 0 local.get {place} i32.add"
        out.write(f"""
            {into} local.get {plane} local.get {place} i32.add v128.load {where.converted}
            {into} v128.load 0 local.get {place} v128.load {where.mask}
            v128.bitselect v128.store 0
        """)

    out.op("loop")
    each_vector(out, where, merge)
    out.advance({0: where.stride})
    out.end_counting_loop(plane, where.stride, at.PLANES * where.stride)
    return out


def _each_group(
    out: Function, where: Layout, write: Callable[[int], None], planes: Sequence[int], frame: int
) -> None:
    """Write code for each 16 NPs: one after the other if they are few, else as a loop.

    Its body is a row of NPs, or 16 rows if these are shorter than a vector.

    Args:
        out: the function to write to.
        where: addresses in the module's memory.
        write: writes the code for 16 NPs, given their first lane, relative to the locals.
        planes: locals with addresses in planes.
        frame: local with the address of a row of pixels.
    """
    machine, across, rest = where.machine, where.machine.np_cols, 0
    if where.vectors > FEW:
        # The last 16 NPs of a row may overlap those before them: none lie beyond it.
        row = (*range(0, across - VECTOR, VECTOR), across - VECTOR)
        rows, starts = (1, row) if across >= VECTOR else (VECTOR, where.starts[:across])
        times, down = machine.np_rows // rows, rows * PIXELS * machine.cols
        turn = out.local(I32)
        out.write(f"i32.const 0 local.set {turn} loop")
        for start in starts:
            write(start)
        out.advance(dict.fromkeys(planes, rows * across) | {frame: down})
        out.end_counting_loop(turn, 1, times)
        rest = times * rows * across
        out.advance(dict.fromkeys(planes, -rest) | {frame: -times * down})
    for start in range(rest, where.lanes, VECTOR):
        write(start)


def signal(where: Layout) -> Function:
    """Rearrange the pixels of a frame into planes.

    For each pixel row y and each 16 NPs it loads 8 bytes of each NP, and transposes them by
    interleaving four times: vector x of the result holds pixel (y, x) of the 16 NPs.
    """
    machine = where.machine
    out = Function(parameters=(I32, I32))
    target, frame = 0, 1
    offset, row = out.local(I32), out.local(I32)
    vectors = out.local(V128, 16)

    def write(start: int) -> None:
        for pair, places in enumerate(_pairs(where, start)):
            out.get(frame)
            if not places:
                out.op("i8x16.splat")  # of anything: these lanes are padding
            elif len(places) == 1 or places[1] != places[0] + PIXELS:
                if places[1:]:
                    out.get(frame)
                out.memory("v128.load64_zero", places[0])
                if places[1:]:
                    out.lane64("load", places[1], 1)
            else:
                out.memory("v128.load", places[0])
            out.set(vectors + pair)
        _interleave(out, vectors, 4)
        for x in range(PIXELS):
            place = x * where.stride + start
            out.get(target)
            _lit(out, where, vectors + x)
            if machine.sensor.fixed_pattern and not machine.sensor.noise_rms:
                offsets = where.offsets + place
                out.write(f"local.get {offset} v128.load {offsets} i8x16.add_sat_u")
            out.write(f"v128.store {place}")

    out.op("loop")
    _each_group(out, where, write, (target, offset), frame)
    eight = PIXELS * where.stride
    out.advance({target: eight, offset: eight, frame: machine.cols})
    out.end_counting_loop(row, 1, PIXELS)
    return out


def _lit(out: Function, where: Layout, vector: int) -> None:
    """Put 16 pixels on the stack, scaled by the light that the sensor gets.

    The instruction drops 15 bits of a product and rounds; pixels shifted left by 3 leave 12.
    """
    gain = numbers.light_gain(where.machine.sensor)
    if gain is None:
        out.get(vector)
        return
    for half in ("low", "high"):
        out.write(f"local.get {vector} i16x8.extend_{half}_i8x16_u i32.const 3 i16x8.shl")
        out.v128(gain.to_bytes(2, "little") * 8)
        out.op("i16x8.q15mulr_sat_s")
    out.op("i8x16.narrow_i16x8_u")


def noise(where: Layout) -> Function:
    """Add offsets and noise to the planes of a conversion, as `machine.sensor` says."""
    out = Function(parameters=(I32,))
    key, low, high = out.local(I64), out.local(V128), out.local(V128)
    _key(out, numbers.step(where.machine.sensor.seed, numbers.NOISE), key)
    for half, shift in ((low, 0), (high, 32)):
        out.write(f"""
            local.get {key} i64.const {shift} i64.shr_u i32.wrap_i64 i32x4.splat local.set {half}
        """)
    plane, base, vector = out.local(I32), out.local(V128), out.local(V128)
    totals = out.local(V128, 2)
    scale = numbers.noise_scale(where.machine.sensor)

    def write(place: int) -> None:
        for quarter in range(4):
            numbered = where.pixels + VECTOR * quarter
            out.write(f"local.get {place} i32.const 4 i32.mul v128.load {numbered}")
            out.write(f"local.get {base} i32x4.add")
            _hash(out, vector, high)
            if quarter % 2:
                out.op("i16x8.narrow_i32x4_s")
                out.v128(numbers.MEAN.to_bytes(2, "little") * 8)
                out.op("i16x8.sub")
                out.v128(scale.to_bytes(2, "little") * 8)
                out.op("i16x8.q15mulr_sat_s")
                out.set(totals + quarter // 2)
        out.write(f"local.get 0 local.get {place} i32.add")
        for half, part in enumerate(("low", "high")):
            out.get(totals + half)
            for address, offset in ((0, 0), (plane, where.offsets)):
                out.write(f"""
                    local.get {address} local.get {place} i32.add v128.load {offset}
                    i16x8.extend_{part}_i8x16_u i16x8.add
                """)
        out.write("i8x16.narrow_i16x8_u v128.store 0")

    # Pixel (y, x) of an NP is its plane 8 y + x, and y rows and x columns on.
    out.write(f"""
        loop
            local.get {low}
            local.get {plane} i32.const {PIXELS * where.stride} i32.div_u
            i32.const {where.machine.cols - PIXELS} i32.mul
            local.get {plane} i32.const {where.stride} i32.div_u i32.add
            i32x4.splat i32x4.add local.set {base}
    """)
    each_vector(out, where, write)
    out.advance({0: where.stride})
    out.end_counting_loop(plane, where.stride, at.PLANES * where.stride)
    return out


def _key(out: Function, start: int, key: int) -> None:
    """Hash the numbers of the frame and of the conversion into a local."""
    out.write(f"i64.const {start} local.set {key}")
    frame = f"i32.load {at.POSITION} i64.extend_i32_u i64.add i32.const 0 i64.load {at.TAKEN}"
    for counted in (frame, f"i32.load {at.CONVERSIONS} i64.extend_i32_u"):
        out.write(f"""
            local.get {key} i32.const 0 {counted} i64.add
            i64.const {numbers.GOLDEN} i64.add local.set {key}
        """)
        for shift, factor in zip((30, 27, 31), (*numbers.MIXES, 1), strict=True):
            out.write(f"""
                local.get {key} local.get {key} i64.const {shift} i64.shr_u i64.xor
                i64.const {factor} i64.mul local.set {key}
            """)


def _hash(out: Function, vector: int, high: int) -> None:
    """Turn four numbers on the stack into the sums of the four bytes of their hashes."""
    for shift, factor in zip((16, 15, 16), (*numbers.NOISE_MIXES, 0), strict=True):
        out.write(f"local.tee {vector} local.get {vector} i32.const {shift} i32x4.shr_u v128.xor")
        if shift == 15:
            out.write(f"local.get {high} v128.xor")
        if factor:
            out.v128(factor.to_bytes(4, "little") * 4)
            out.op("i32x4.mul")
    out.op("i16x8.extadd_pairwise_i8x16_u", "i32x4.extadd_pairwise_i16x8_s")


def assemble(where: Layout) -> Function:
    """Rearrange the planes of pictures into frames, as `signal` backwards: three interleavings."""
    machine = where.machine
    out = Function(parameters=(I32,) * 4)
    first, distance, step, number = range(4)
    row, place, plane, frame = (out.local(I32) for _ in range(4))
    vectors = out.local(V128, 16)

    def write(start: int) -> None:
        out.write(f"local.get {place} local.set {plane}")
        for x in range(PIXELS):
            out.write(f"""
                local.get {plane} v128.load {start} local.set {vectors + x}
                local.get {plane} local.get {distance} i32.add local.set {plane}
            """)
        found = _interleave(out, vectors, 3)
        for pair, places in enumerate(_pairs(where, start)):
            if len(places) == 2 and places[1] == places[0] + PIXELS:
                out.write(f"local.get {frame} local.get {found + pair} v128.store {places[0]}")
                continue
            for lane, at_pixel in enumerate(places):
                out.write(f"local.get {frame} local.get {found + pair}")
                out.lane64("store", at_pixel, lane)

    out.write(f"""
        i32.const {where.pictures} local.set {frame}
        block
            loop
                local.get {number} i32.eqz br_if 1
                local.get {first} local.set {place}
                i32.const 0 local.set {row}
                loop
    """)
    _each_group(out, where, write, (place,), frame)
    out.write(f"local.get {place} local.get {distance} i32.const {PIXELS} i32.mul i32.add")
    out.set(place)
    out.advance({frame: machine.cols})
    out.end_counting_loop(row, 1, PIXELS)
    out.advance({frame: where.frame_bytes - PIXELS * machine.cols, number: -1})
    out.write(f"local.get {first} local.get {step} i32.add local.set {first} br 0 end end")
    return out


def _pairs(where: Layout, start: int) -> list[list[int]]:
    """Return for 8 pairs of NPs where their pixels are in a frame; less for lanes of padding."""
    columns, down = where.machine.np_cols, PIXELS * where.machine.cols
    places = [
        lane // columns * down + lane % columns * PIXELS
        for lane in range(start, min(start + VECTOR, where.lanes))
    ]
    return [places[first : first + 2] for first in range(0, VECTOR, 2)]


_LOW: Final = [number for lane in range(8) for number in (lane, lane + 16)]
_HIGH: Final = [number + 8 for number in _LOW]


def _interleave(out: Function, vectors: int, rounds: int) -> int:
    """Transpose bytes in the first 8 of 16 locals; return the first of the 8 with the result.

    Number the 128 bytes with 7 bits, those of the vector first. Interleaving vectors k and k + 4
    into 2k and 2k + 1 rotates these numbers left by one bit. Four rounds turn 16 groups (n3 n2 n1
    n0) of 8 bytes (x2 x1 x0) into 8 vectors x with a byte of each group; three turn them back.
    """
    source, target = vectors, vectors + 8
    for _ in range(rounds):
        for pair in range(4):
            for half, lanes in enumerate((_LOW, _HIGH)):
                out.get(source + pair)
                out.get(source + pair + 4)
                out.shuffle(lanes)
                out.set(target + 2 * pair + half)
        source, target = target, source
    return source
