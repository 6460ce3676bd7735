"""The layout of a module's memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

from npchip.engines.wasm.translate.executed import variables
from npchip.machine import PIXELS, Machine

VECTOR: Final = 16
PLANES: Final = PIXELS * PIXELS
PAGE: Final = 1 << 16

# The control words, which hold the GCU's state; the module and the host share them.
POSITION: Final = 0  # frames taken from the ring buffer
AVAILABLE: Final = 4  # frames in the ring buffer
LOG_END: Final = 8  # end of the log of sends
DATA_END: Final = 12  # end of the planes sent
CONVERSIONS: Final = 16
FRAME: Final = 20  # address of the exposed frame
CYCLES: Final = 24  # of this frame (64 bits)
INSTRUCTIONS: Final = 32  # of this frame (64 bits)
CHECK: Final = 40  # cycles of this frame at which to ask the host (64 bits)
FIRST_CHECK: Final = 48  # initial CHECK of a new frame (64 bits)
CALLS: Final = 56  # open calls of shared routines
CONTROL_BYTES: Final = 64

RECORD: Final = 24
"""Bytes of a frame's record: cycles, instructions, end of its log (64 bits each)."""
ENTRY: Final = 4
"""Bytes of an entry of the log of sends: the byte sent (8 bits), the site's number (24 bits)."""

_FARTHEST: Final = 256
"""Largest distance of neighbours, in lanes."""
_RING_BYTES: Final = 8 << 20
_RING_FRAMES: Final = 1024
_LOG_BYTES: Final = 1 << 16
_DATA_BYTES: Final = 1 << 20


@dataclass(eq=False)
class Layout:
    """Addresses in the memory of a module, as byte offsets.

    A plane holds a byte for each NP, row by row, and takes `stride` bytes. The lanes after the
    last NP are padding.

    Args:
        machine: the machine.
        counters: number of counters.
        plain: number of counters before those of masks; see `translate.counters`.
        sends: largest number of sends in a block; each may take two planes.
        return_addresses: number of addresses that a shared routine may return to; 0 without one.

    Attributes:
        planes: number of planes for values that several vector loops of a block use.
    """

    machine: Machine
    counters: int = 0
    plain: int = 0
    sends: int = 0
    return_addresses: int = 0
    planes: int = field(default=0, init=False)

    @cached_property
    def lanes(self) -> int:
        """Number of NPs."""
        return self.machine.np_rows * self.machine.np_cols

    @cached_property
    def vectors(self) -> int:
        """Number of vectors of a plane."""
        return -(-self.lanes // VECTOR)

    @cached_property
    def stride(self) -> int:
        """Size of a plane."""
        return self.vectors * VECTOR

    @cached_property
    def starts(self) -> range:
        """Offset of each vector in a plane."""
        return range(0, self.stride, VECTOR)

    @cached_property
    def frame_bytes(self) -> int:
        """Size of a frame."""
        return self.machine.rows * self.machine.cols

    @cached_property
    def ring(self) -> int:
        """Capacity of the ring buffer, in frames."""
        return max(1, min(_RING_FRAMES, _RING_BYTES // self.frame_bytes))

    @cached_property
    def state(self) -> int:
        """Planes of the variables, after a margin for reads north of the first plane."""
        return CONTROL_BYTES + _FARTHEST

    def variable(self, number: int) -> int:
        """Plane of a variable."""
        return self.state + number * self.stride

    @cached_property
    def addresses(self) -> int:
        """Scratch plane: addresses of a gather or scatter."""
        return self.variable(len(variables(self.machine.mask_depth)))

    @cached_property
    def operand(self) -> int:
        """Scratch plane: result of a gather, or values of a scatter."""
        return self.addresses + self.stride

    @cached_property
    def mask(self) -> int:
        """Scratch plane: which NPs are active."""
        return self.operand + self.stride

    @cached_property
    def anchor(self) -> int:
        """Scratch plane that nothing reads; see `Effects`."""
        return self.mask + self.stride

    @cached_property
    def received(self) -> int:
        """Plane of the latest input."""
        return self.anchor + self.stride

    @cached_property
    def numbers(self) -> int:
        """Vectors with each number from 0 to 255 in all lanes."""
        return self.received + self.stride

    @cached_property
    def axes(self) -> dict[str, int]:
        """Planes of the NPs' row and column numbers."""
        start = self.numbers + 256 * VECTOR
        return {"row": start, "column": start + self.stride}

    @cached_property
    def inside(self) -> int:
        """Plane that is 255 in the lanes of NPs and 0 in the padding."""
        return self.axes["column"] + self.stride

    def has_neighbour(self, direction: int) -> int:
        """Plane that is 255 for NPs with a neighbour in a direction, else 0."""
        return self.inside + self.stride * (1 + direction)

    @cached_property
    def distances(self) -> tuple[int, ...]:
        """Distance of the neighbour in each direction, in lanes."""
        return -self.machine.np_cols, 1, self.machine.np_cols, -1

    @cached_property
    def calls(self) -> int:
        """Call stack: return addresses, 32 bits each."""
        return self.has_neighbour(len(self.distances))

    @cached_property
    def returns(self) -> int:
        """Table of block numbers (32 bits each) by mask depth and return address."""
        return self.calls + 4 * self.machine.stack_depth

    @cached_property
    def memory(self) -> int:
        """Planes of the NPs' memory."""
        end = self.returns + 4 * self.return_addresses * (self.machine.mask_depth + 1)
        return end + VECTOR - 1 & -VECTOR

    @cached_property
    def converted(self) -> int:
        """Planes of a conversion, before they are merged into the memory."""
        return self.memory + self.machine.memory_bytes * self.stride

    @cached_property
    def offsets(self) -> int:
        """Planes of the sensor's fixed pattern."""
        return self.converted + PLANES * self.stride

    @cached_property
    def counts(self) -> int:
        """Counters, 64 bits each; see `translate.counters`."""
        return self.offsets + PLANES * self.stride

    @cached_property
    def parts(self) -> int:
        """Vectors of four 32-bit partial sums, one vector for each mask counter."""
        return self.counts + 8 * self.counters

    @cached_property
    def records(self) -> int:
        """Records of the complete frames."""
        return self.parts + VECTOR * (self.counters - self.plain)

    @cached_property
    def log(self) -> int:
        """Log of the sends."""
        return self.records + RECORD * self.ring

    @cached_property
    def log_end(self) -> int:
        """End of the log's memory."""
        return self.log + max(_LOG_BYTES, ENTRY * self.sends)

    @cached_property
    def data(self) -> int:
        """Planes that were sent."""
        return self.log_end + VECTOR - 1 & -VECTOR

    @cached_property
    def data_end(self) -> int:
        """End of the memory for planes that were sent."""
        return self.data + max(_DATA_BYTES, 2 * self.stride * self.sends)

    @cached_property
    def first_frame(self) -> int:
        """Frame that was exposed before the module ran."""
        return self.data_end

    @cached_property
    def frames(self) -> int:
        """Ring buffer of frames."""
        return self.first_frame + self.frame_bytes

    @cached_property
    def kept(self) -> int:
        """Planes of values that several vector loops of a block use."""
        return self.frames + self.ring * self.frame_bytes + VECTOR - 1 & -VECTOR

    @property
    def pages(self) -> int:
        """Size of the memory, in pages of 64 KiB."""
        end = self.kept + self.planes * self.stride + _FARTHEST + VECTOR
        return -(-end // PAGE)
