"""Many complete frames at once, as columns: what a fast engine hands over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from npchip.engines.state import RawFrame, Send


class Sites(NamedTuple):
    """Output instructions by number: int64 arrays of the same length.

    Attributes:
        address: of the instruction.
        port: port number.
        planes: of a send: 0 where all NPs were active and sent the same byte, 1 with the bytes,
            2 with the bytes and which NPs were active (255, else 0).
    """

    address: NDArray[np.int64]
    port: NDArray[np.int64]
    planes: NDArray[np.int64]


@dataclass(eq=False)
class SendLog:
    """Sends in the order they were made.

    Attributes:
        ends: int64, shape (frames,): how many sends were made when each frame ended.
        site: integers, shape (n,): number of the output instruction.
        value: uint8, shape (n,): the byte sent, where the site has no planes.
        planes: uint8, shape (m, NPs): the planes of all sends.
        sites: the output instructions.
        shape: (NP rows, NP columns).
    """

    ends: NDArray[np.int64]
    site: NDArray[np.integer[Any]]
    value: NDArray[np.uint8]
    planes: NDArray[np.uint8]
    sites: Sites
    shape: tuple[int, int]

    @cached_property
    def frame(self) -> NDArray[np.int64]:
        """Number of the frame of each send within the batch: int64, shape (n,), never falling."""
        counts = np.diff(self.ends, prepend=0)
        return np.repeat(np.arange(len(self.ends)), counts)

    @cached_property
    def port(self) -> NDArray[np.int64]:
        """Port of each send: int64, shape (n,)."""
        ports: NDArray[np.int64] = self.sites.port[self.site]
        return ports

    @cached_property
    def first_plane(self) -> NDArray[np.int64]:
        """Number of the first plane of each send: int64, shape (n,)."""
        counts: NDArray[np.int64] = self.sites.planes[self.site]
        return np.cumsum(counts) - counts

    def bytes_of(self, sends: NDArray[np.int64]) -> NDArray[np.uint8]:
        """The bytes of some sends, 0 where the NP was inactive: shape (len(sends), NPs)."""
        own = self.sites.planes[self.site[sends]] > 0
        if own.all():
            return self.planes[self.first_plane[sends]]
        data = np.repeat(self.value[sends, None], self.shape[0] * self.shape[1], axis=1)
        data[own] = self.planes[self.first_plane[sends[own]]]
        return data

    def active_of(self, sends: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which NPs were active in some sends: shape (len(sends), NPs)."""
        counts = self.sites.planes[self.site[sends]]
        active = np.ones((len(sends), self.shape[0] * self.shape[1]), np.bool_)
        active[counts == 2] = self.planes[self.first_plane[sends[counts == 2]] + 1] != 0
        return active

    def of_frame(self, number: int) -> list[Send]:
        """The sends of one frame, each as an object."""
        sends = np.arange(self.ends[number - 1] if number else 0, self.ends[number])
        data = self.bytes_of(sends).reshape(-1, *self.shape)
        active = self.active_of(sends).reshape(-1, *self.shape)
        return [
            Send(
                int(self.sites.port[site]),
                int(self.sites.address[site]),
                data[index].copy(),
                active[index].copy() if self.sites.planes[site] == 2 else None,
            )
            for index, site in enumerate(self.site[sends])
        ]

    def part(self, first: int, last: int) -> SendLog:
        """The sends of the frames from `first` on and before `last`."""
        begin = int(self.ends[first - 1]) if first else 0
        end = int(self.ends[last - 1]) if last else 0
        return replace(
            self,
            ends=self.ends[first:last] - begin,
            site=self.site[begin:end],
            value=self.value[begin:end],
            planes=self.planes[self.sites.planes[self.site[:begin]].sum() :],
        )


class FrameBatch(NamedTuple):
    """Complete frames in their order.

    Attributes:
        cycles, instructions: int64, shape (n,).
        log: what they sent.
        prefix: sends of the first frame that come before those of the log.
    """

    cycles: NDArray[np.int64]
    instructions: NDArray[np.int64]
    log: SendLog
    prefix: Sequence[Send]

    def since(self, number: int) -> FrameBatch:
        """The frames from `number` on."""
        if number == 0:
            return self
        log = self.log.part(number, len(self.cycles))
        return FrameBatch(self.cycles[number:], self.instructions[number:], log, ())

    def until(self, number: int) -> FrameBatch:
        """The frames before `number`."""
        if number == len(self.cycles):
            return self
        log = self.log.part(0, number)
        return FrameBatch(self.cycles[:number], self.instructions[:number], log, self.prefix)

    def frame(self, number: int) -> RawFrame:
        """One frame as an object."""
        sends = [*(self.prefix if number == 0 else ()), *self.log.of_frame(number)]
        return RawFrame(int(self.cycles[number]), int(self.instructions[number]), sends)
