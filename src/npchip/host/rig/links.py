"""Links between the two cameras, and their cost in cycles.

Both cameras expose at the same moment, time 0. Camera 2 sends its results after T2 cycles. Camera 1
needs A cycles until it asks for them, and B more to compute the position. All three are measured.
The link carries n bytes in L cycles, which the machine file determines:

    serial     L = n · serial_byte · serial_bit
    parallel   L = ceil(8·n / parallel_bits) · parallel_word

The *latency* of a position is max(A, T2 + L) + B cycles. With a separate processor each camera has
its own serial line, and the latency is max(T1, T2) + L + host_latency.

Without pipelining a frame takes as long as its latency. A pipelined rig starts the next frame while
the link still carries the last, so the slowest part decides: max(A + B, T2, L), or max(T1, T2, L,
host_latency). Camera 1 then keeps its own result for a frame in two bytes of memory, in the same
number of cycles. All of this is a decision: the thesis (4.1.1) names the three links and gives no
figure.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from npchip.machine import Link

LINKS: Final = ("serial", "parallel", "host")
"""Names of the links: two to camera 1, which computes the position, one to a processor."""

Cycles = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Timing:
    """Cycles of each frame with one kind of link; all arrays int64 of shape (T,).

    Attributes:
        link: a name of `LINKS`.
        sent: bytes that the link carries in a frame; with a processor those of the busier line.
        parts: cycles of camera 1, camera 2, the link and the processor, by name.
        latency: cycles from exposure to position.
    """

    link: str
    sent: Cycles
    parts: dict[str, Cycles]
    latency: Cycles

    @property
    def period(self) -> Cycles:
        """Cycles of each frame in a pipelined rig."""
        return np.asarray(np.max(list(self.parts.values()), axis=0))

    @property
    def limit(self) -> str:
        """Name of the part that limits the frame rate of a pipelined rig in its worst frame."""
        return max(self.parts, key=lambda name: int(self.parts[name].max(initial=0)))


def transfer_cycles(link: Link, kind: str, sent: Any) -> Any:
    """Return the cycles that the serial or parallel link takes for a number of bytes.

    Args:
        link: links of a machine.
        kind: ``"serial"`` or ``"parallel"``.
        sent: number of bytes, an integer or an integer array.
    """
    if kind == "serial":
        return sent * link.serial_byte * link.serial_bit
    return -(-8 * sent // link.parallel_bits) * link.parallel_word


def camera_to_camera(
    link: Link, kind: str, sent: Cycles, *, asked: Cycles, first: Cycles, second: Cycles
) -> Timing:
    """Time a rig whose camera 2 sends to camera 1.

    Args:
        link: links of the machine.
        kind: ``"serial"`` or ``"parallel"``.
        sent: bytes of each frame.
        asked: cycles of camera 1 in each frame before it asks for the bytes.
        first: cycles of camera 1 in each frame.
        second: cycles of camera 2 in each frame.
    """
    carried = np.asarray(transfer_cycles(link, kind, sent))
    latency = np.maximum(asked, second + carried) + first - asked
    parts = {"camera 1": first, "camera 2": second, "link": carried}
    return Timing(kind, sent, parts, latency)


def with_processor(link: Link, sent: Cycles, *, first: Cycles, second: Cycles) -> Timing:
    """Time a rig whose cameras send to a separate processor.

    Args:
        link: links of the machine.
        sent: bytes of each frame from the camera that sends more.
        first: cycles of camera 1 in each frame.
        second: cycles of camera 2 in each frame.
    """
    carried = np.asarray(transfer_cycles(link, "serial", sent))
    thinking = np.full_like(first, link.host_latency)
    latency = np.maximum(first, second) + carried + thinking
    parts = {"camera 1": first, "camera 2": second, "link": carried, "processor": thinking}
    return Timing("host", sent, parts, latency)
