"""The initial content of a module's memory: what the code reads and nothing writes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from npchip.engines.wasm.emit.layout import PLANES, VECTOR, Layout
from npchip.engines.wasm.translate.steps import Block
from npchip.machine import PIXELS


def constants(where: Layout, blocks: Sequence[Block]) -> list[tuple[int, bytes]]:
    """Return the constants of a module, with their addresses.

    Args:
        where: addresses in the module's memory.
        blocks: blocks of the program, for the returns of shared routines.
    """
    machine = where.machine
    height, width = machine.geometry
    row = b"".join(bytes([number]) * width for number in range(height))
    inside = bytes([255]) * width
    found = [
        (where.numbers, b"".join(bytes([number]) * VECTOR for number in range(256))),
        (where.axes["row"], row),
        (where.axes["column"], bytes(range(width)) * height),
        (where.inside, inside * height),
        (where.has_neighbour(0), bytes(width) + inside * (height - 1)),
        (where.has_neighbour(1), (inside[1:] + b"\0") * height),
        (where.has_neighbour(2), inside * (height - 1)),  # the rest is 0
        (where.has_neighbour(3), (b"\0" + inside[1:]) * height),
    ]
    if machine.sensor.noise_rms:
        rows = range(0, PIXELS * height * machine.cols, PIXELS * machine.cols)
        first = (start + col for start in rows for col in range(0, machine.cols, PIXELS))
        found.append((where.pixels, _words(first)))
    if machine.sensor.fixed_pattern:
        from npchip.machine.sensor import SensorModel  # noqa: PLC0415 - it takes NumPy

        offsets = SensorModel(machine.sensor, height, width).offsets.reshape(PLANES, -1)
        places = range(where.offsets, where.pixels, where.stride)
        found += [(place, plane.tobytes()) for place, plane in zip(places, offsets, strict=True)]
    if where.return_addresses:
        found.append((where.returns, _returns(where, blocks)))
    return found


def _returns(where: Layout, blocks: Sequence[Block]) -> bytes:
    """Return the table of the blocks that returns lead to."""
    table = [0] * ((where.machine.mask_depth + 1) * where.return_addresses)
    for block in blocks:
        if block.returns:
            for number in block.after:
                place = blocks[number].first.place
                table[place.depth * where.return_addresses + place.address] = number
    return _words(table)


def _words(numbers: Iterable[int]) -> bytes:
    return b"".join(number.to_bytes(4, "little") for number in numbers)
