"""What joins the two cameras, and what it costs: cycles of a frame, and what is slowest.

Both cameras expose at the same moment, time 0. Camera 2 needs T2 cycles until it has sent what it
has found, camera 1 needs A until it asks for that and B from there to the position; both are
measured. The link carries n bytes, in L cycles as the machine file says:

    serial     L = n · serial_byte · serial_bit
    parallel   L = ceil(8·n / parallel_bits) · parallel_word

A position is there after max(A, T2 + L) + B cycles, the *latency*. With a separate processor each
camera sends its findings over a serial line of its own, which the processor answers:
max(T1, T2) + L + host_latency.

A rig that exposes the next frame only then takes as long for a frame. One that is pipelined goes on
with the next frame while the link still carries the last; then the slowest part alone decides:
max(A + B, T2, L), or max(T1, T2, L, host_latency). On camera 1 that asks for two bytes of memory,
which keep its own place for a frame; the cycles are the same. All of this is a decision: the thesis
(4.1.1) names the three links and gives no figure.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from npchip.machine import Link

LINKS: Final = ("serial", "parallel", "host")
"""By name: to camera 1, which works the position out; or to a separate processor."""

Cycles = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Timing:
    """Cycles of each frame with one kind of link; all arrays int64 of shape (T,).

    Attributes:
        link: a name of `LINKS`.
        sent: bytes that the link carries in a frame; with a processor those of the busier line.
        parts: what works at the same time in a pipelined rig, by name: camera 1, camera 2, the
            link, and the processor.
        latency: from exposure to position.
    """

    link: str
    sent: Cycles
    parts: dict[str, Cycles]
    latency: Cycles

    @property
    def period(self) -> Cycles:
        """Cycles from frame to frame of a pipelined rig."""
        return np.asarray(np.max(list(self.parts.values()), axis=0))

    @property
    def limit(self) -> str:
        """The part that limits the frame rate of a pipelined rig: slowest at its worst frame."""
        return max(self.parts, key=lambda name: int(self.parts[name].max(initial=0)))


def transfer_cycles(link: Link, kind: str, sent: Any) -> Any:
    """Find the cycles that the serial or parallel link takes for a number of bytes.

    Args:
        link: of a machine.
        kind: ``"serial"`` or ``"parallel"``.
        sent: bytes, a number or an integer array.
    """
    if kind == "serial":
        return sent * link.serial_byte * link.serial_bit
    return -(-8 * sent // link.parallel_bits) * link.parallel_word


def camera_to_camera(
    link: Link, kind: str, sent: Cycles, *, asked: Cycles, first: Cycles, second: Cycles
) -> Timing:
    """Time a rig whose camera 2 sends to camera 1.

    Args:
        link: of the machine.
        kind: ``"serial"`` or ``"parallel"``.
        sent: bytes of each frame.
        asked: cycles of camera 1 in each frame before it asks for them.
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
        link: of the machine.
        sent: bytes of each frame from the camera that sends more.
        first: cycles of camera 1 in each frame.
        second: cycles of camera 2 in each frame.
    """
    carried = np.asarray(transfer_cycles(link, "serial", sent))
    thinking = np.full_like(first, link.host_latency)
    latency = np.maximum(first, second) + carried + thinking
    parts = {"camera 1": first, "camera 2": second, "link": carried, "processor": thinking}
    return Timing("host", sent, parts, latency)
