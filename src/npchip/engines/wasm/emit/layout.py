"""The layout of a module's memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from npchip.engines.wasm.translate.summary import MASKS
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
CLOSED: Final = 56  # frames whose records are complete
TAKEN: Final = 64  # frames exposed since reset before this batch (64 bits)
CONTROL_BYTES: Final = 80

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
_PICTURES: Final = 4
"""Least number of pictures that the log holds if the module assembles them."""


@dataclass(eq=False)
class Layout:
    """Addresses in the memory of a module, as byte offsets.

    A plane holds a byte for each NP, row by row, and takes `stride` bytes. The lanes after the
    last NP are padding.

    Args:
        machine: the machine.
        blocks: number of blocks.
        counters: number of counters.
        sends: largest number of sends in a block; each may take two planes.
        assembles: whether the module assembles pictures.

    Attributes:
        planes: number of planes from `kept` on; `LoopWriter` sets it.
        variables: number of variables.
        lanes: number of NPs.
        vectors: number of vectors of a plane, some of which may be padding.
        stride: size of a plane.
        starts: offset of each vector in a plane.
        frame_bytes: size of a frame.
        ring: capacity of the ring buffer, in frames.
        distances: distance of the neighbour in each direction, in lanes.
        state: planes of the variables, after a margin for reads north of the first plane.
        addresses: scratch plane: addresses of a gather or scatter.
        operand: scratch plane: result of a gather, or values of a scatter.
        mask: scratch plane: active NPs.
        anchor: scratch plane that nothing reads; see `Effects`.
        received: plane of the latest input.
        axes: planes of the NPs' row and column numbers.
        inside: plane that is 255 in the lanes of NPs and 0 in the padding.
        memory: planes of the NPs' memory.
        converted: planes of a conversion, before they are merged into the memory.
        offsets: planes of the sensor's fixed pattern.
        pixels: number of each NP's first pixel, 32 bits each.
        first_frame: frame that was exposed before the module ran.
        facts: for each block and variable its byte, `SAME` or `ANY`, 16 bits each; see `Helpers`.
        counts: counters, 64 bits each; see `translate.counters`.
        records: records of the complete frames.
        log, log_end: log of the sends.
        data, data_end: planes that were sent.
        pictures: frames assembled from them.
        frames: ring buffer of frames.
        kept: planes of slots that later vector loops of a block read.
    """

    machine: Machine
    blocks: int = 0
    counters: int = 0
    sends: int = 0
    assembles: bool = False
    planes: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        machine = self.machine
        self.lanes = machine.np_rows * machine.np_cols
        self.vectors = -(-self.lanes // VECTOR)
        if self.vectors % 64 == 0:  # the same bytes of all planes would share a few cache lines
            self.vectors += 4
        self.stride = stride = self.vectors * VECTOR
        self.starts = range(0, stride, VECTOR)
        self.frame_bytes = machine.rows * machine.cols
        self.ring = max(1, min(_RING_FRAMES, _RING_BYTES // self.frame_bytes))
        self.distances = -machine.np_cols, 1, machine.np_cols, -1
        self.state = CONTROL_BYTES + _FARTHEST
        self.variables = MASKS + machine.mask_depth
        self.addresses = self.variable(self.variables)
        self.operand = self.addresses + stride
        self.mask = self.operand + stride
        self.anchor = self.mask + stride
        self.received = self.anchor + stride
        self.axes = {"row": self.received + stride}
        self.axes["column"] = self.axes["row"] + stride
        self.inside = self.axes["column"] + stride
        self.memory = self.has_neighbour(len(self.distances))
        self.converted = self.memory + machine.memory_bytes * stride
        self.offsets = self.converted + PLANES * stride
        self.pixels = self.offsets + PLANES * stride
        self.first_frame = self.pixels + 4 * stride
        self.facts = _aligned(self.first_frame + self.frame_bytes)
        self.counts = _aligned(self.facts + 2 * self.variables * self.blocks)
        self.records = self.counts + 8 * self.counters
        self.log = self.records + RECORD * (self.ring + 1)
        self.log_end = self.log + max(_LOG_BYTES, ENTRY * self.sends)
        self.data = _aligned(self.log_end)
        room = 2 * stride * self.sends + self.assembles * _PICTURES * PLANES * stride
        self.data_end = self.data + max(_DATA_BYTES, room)
        self.pictures = self.data_end
        self.frames = self.pictures + self.assembles * (self.data_end - self.data)
        self.kept = _aligned(self.frames + self.ring * self.frame_bytes)

    def variable(self, number: int) -> int:
        """Return the plane of a variable."""
        return self.state + number * self.stride

    def has_room(self, entries: int, planes: int) -> bool:
        """Return whether the sends of any block fit behind entries and planes in the log."""
        free = (self.log_end - self.log) // ENTRY - entries
        free_planes = (self.data_end - self.data) // self.stride - planes
        return free >= self.sends and free_planes >= 2 * self.sends

    def has_neighbour(self, direction: int) -> int:
        """Return the plane that is 255 for NPs with a neighbour in a direction, else 0."""
        return self.inside + self.stride * (1 + direction)

    @property
    def pages(self) -> int:
        """Size of the memory, in pages of 64 KiB."""
        end = self.kept + self.planes * self.stride + _FARTHEST + VECTOR
        return -(-end // PAGE)


def _aligned(address: int) -> int:
    return address + VECTOR - 1 & -VECTOR
