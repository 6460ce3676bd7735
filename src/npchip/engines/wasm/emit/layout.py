"""Where things lie in the memory of a module."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

from npchip.engines.wasm.translate.summary import variables
from npchip.machine import PIXELS, Machine

VECTOR: Final = 16
PLANES: Final = PIXELS * PIXELS
PAGE: Final = 1 << 16

# The control words: where the GCU's state crosses the border between module and host.
POSITION: Final = 0  # frames taken from the ring
AVAILABLE: Final = 4  # frames in the ring
LOG_END: Final = 8  # end of the log of sends
DATA_END: Final = 12  # end of the planes sent
CONVERSIONS: Final = 16
FRAME: Final = 20  # address of the exposed frame
CYCLES: Final = 24  # of this frame (64 bits)
INSTRUCTIONS: Final = 32  # of this frame (64 bits)
CHECK: Final = 40  # cycles of a frame at which the host is asked (64 bits)
FIRST_CHECK: Final = 48  # the same for a frame that begins (64 bits)
CALLS: Final = 56  # open calls of routines that are shared
CONTROL_BYTES: Final = 64

RECORD: Final = 24
"""Bytes of the record of a frame: cycles, instructions (64 bits each), end of its log."""
ENTRY: Final = 4
"""Bytes of an entry of the log of sends: the byte sent, then the number of the site."""

_FARTHEST: Final = 256
"""Lanes between neighbours, at most."""
_RING_BYTES: Final = 8 << 20
_RING_FRAMES: Final = 1024
_LOG_BYTES: Final = 1 << 16
_DATA_BYTES: Final = 1 << 20


@dataclass(eq=False)
class Layout:
    """Addresses in the memory of a module.

    A plane holds a byte for each NP, row by row, in `stride` bytes: a whole number of vectors.

    Args:
        machine: gives geometry and memory size.
        counters: number of counters.
        plain: number of those that are none of masks; see `translate.counters`.
        sends: most that a block sends; each may take two planes.
        return_addresses: that a routine which is shared may return to; 0 where none is.

    Attributes:
        planes: of values that a block keeps.
    """

    machine: Machine
    counters: int = 0
    plain: int = 0
    sends: int = 0
    return_addresses: int = 0
    planes: int = field(default=0, init=False)

    @cached_property
    def lanes(self) -> int:
        """NPs."""
        return self.machine.np_rows * self.machine.np_cols

    @cached_property
    def vectors(self) -> int:
        """Vectors of a plane."""
        return -(-self.lanes // VECTOR)

    @cached_property
    def stride(self) -> int:
        """Bytes of a plane."""
        return self.vectors * VECTOR

    @cached_property
    def starts(self) -> range:
        """First byte of each vector of a plane."""
        return range(0, self.stride, VECTOR)

    @cached_property
    def frame_bytes(self) -> int:
        """Bytes of a frame."""
        return self.machine.rows * self.machine.cols

    @cached_property
    def ring(self) -> int:
        """Frames that the ring holds."""
        return max(1, min(_RING_FRAMES, _RING_BYTES // self.frame_bytes))

    @cached_property
    def state(self) -> int:
        """Planes of the variables; north of the first there is memory, too."""
        return CONTROL_BYTES + _FARTHEST

    def variable(self, number: int) -> int:
        """Plane of a variable."""
        return self.state + number * self.stride

    @cached_property
    def addresses(self) -> int:
        """Scratch plane: addresses for gather and scatter."""
        return self.variable(len(variables(self.machine.mask_depth)))

    @cached_property
    def operand(self) -> int:
        """Scratch plane: result of a gather, values of a scatter."""
        return self.addresses + self.stride

    @cached_property
    def mask(self) -> int:
        """Scratch plane: which NPs are active."""
        return self.operand + self.stride

    @cached_property
    def anchor(self) -> int:
        """Scratch plane that is only written to."""
        return self.mask + self.stride

    @cached_property
    def received(self) -> int:
        """Plane that an input has received."""
        return self.anchor + self.stride

    @cached_property
    def numbers(self) -> int:
        """Each number from 0 to 255 in all lanes of a vector."""
        return self.received + self.stride

    @cached_property
    def axes(self) -> dict[str, int]:
        """Planes with each NP's row and column."""
        start = self.numbers + 256 * VECTOR
        return {"row": start, "column": start + self.stride}

    @cached_property
    def inside(self) -> int:
        """Plane that is 255 where there is an NP."""
        return self.axes["column"] + self.stride

    def has_neighbour(self, direction: int) -> int:
        """Plane that is 255 where the neighbour in a direction is an NP."""
        return self.inside + self.stride * (1 + direction)

    @cached_property
    def distances(self) -> tuple[int, ...]:
        """How many lanes away the neighbour in each direction is."""
        return -self.machine.np_cols, 1, self.machine.np_cols, -1

    @cached_property
    def calls(self) -> int:
        """Return addresses of the open calls, 32 bits each."""
        return self.has_neighbour(len(self.distances))

    @cached_property
    def returns(self) -> int:
        """Numbers of blocks, 32 bits each, by open masked regions and return address."""
        return self.calls + 4 * self.machine.stack_depth

    @cached_property
    def memory(self) -> int:
        """Planes of the NPs' memory."""
        end = self.returns + 4 * self.return_addresses * (self.machine.mask_depth + 1)
        return end + VECTOR - 1 & -VECTOR

    @cached_property
    def converted(self) -> int:
        """Planes of a conversion on its way to the memory."""
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
        """Four parts, 32 bits each, of the counters of masks."""
        return self.counts + 8 * self.counters

    @cached_property
    def records(self) -> int:
        """Records of the frames that are complete."""
        return self.parts + VECTOR * (self.counters - self.plain)

    @cached_property
    def log(self) -> int:
        """Log of the sends."""
        return self.records + RECORD * self.ring

    @cached_property
    def log_end(self) -> int:
        """Where the log ends."""
        return self.log + max(_LOG_BYTES, ENTRY * self.sends)

    @cached_property
    def data(self) -> int:
        """Planes sent."""
        return self.log_end + VECTOR - 1 & -VECTOR

    @cached_property
    def data_end(self) -> int:
        """Where the planes end."""
        return self.data + max(_DATA_BYTES, 2 * self.stride * self.sends)

    @cached_property
    def first_frame(self) -> int:
        """The frame that was exposed before the module began."""
        return self.data_end

    @cached_property
    def frames(self) -> int:
        """The ring of frames."""
        return self.first_frame + self.frame_bytes

    @cached_property
    def kept(self) -> int:
        """Planes of values that a block keeps."""
        return self.frames + self.ring * self.frame_bytes + VECTOR - 1 & -VECTOR

    @property
    def pages(self) -> int:
        """Size of the memory."""
        end = self.kept + self.planes * self.stride + _FARTHEST + VECTOR
        return -(-end // PAGE)
