"""The initial content of a module's memory: what the code reads and nothing writes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from npchip.engines.wasm.emit.layout import Layout
from npchip.engines.wasm.translate.summary import ANY, SAME, Facts, is_bit
from npchip.machine import PIXELS
from npchip.machine.offsets import offset_planes


def constants(where: Layout, begins: Sequence[Facts]) -> list[tuple[int, bytes]]:
    """Return the constants of a module, with their addresses.

    Args:
        where: addresses in the module's memory.
        begins: facts about the variables before each block.
    """
    machine = where.machine
    height, width = machine.geometry
    row = b"".join(bytes([number]) * width for number in range(height))
    inside = bytes([255]) * width
    facts = (_plain(v, at.get(v, ANY)) for at in begins for v in range(where.variables))
    found = [
        (where.axes["row"], row),
        (where.axes["column"], bytes(range(width)) * height),
        (where.inside, inside * height),
        (where.has_neighbour(0), bytes(width) + inside * (height - 1)),
        (where.has_neighbour(1), (inside[1:] + b"\0") * height),
        (where.has_neighbour(2), inside * (height - 1)),  # the rest is 0
        (where.has_neighbour(3), (b"\0" + inside[1:]) * height),
        (where.facts, _words(facts, 2)),
    ]
    if machine.sensor.noise_rms:
        rows = range(0, PIXELS * height * machine.cols, PIXELS * machine.cols)
        first = (start + col for start in rows for col in range(0, machine.cols, PIXELS))
        found.append((where.pixels, _words(first)))
    if machine.sensor.fixed_pattern:
        places = range(where.offsets, where.pixels, where.stride)
        found += zip(places, offset_planes(machine.sensor, height, width), strict=True)
    return found


def _plain(variable: int, fact: int) -> int:
    """Return a fact whose number is a byte of the variable's plane."""
    return 255 * fact if is_bit(variable) and fact < SAME else fact


def _words(numbers: Iterable[int], size: int = 4) -> bytes:
    return b"".join(number.to_bytes(size, "little") for number in numbers)
