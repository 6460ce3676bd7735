"""Records of complete frames and their sends."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

_CACHED: Final = 1 << 15
"""Bytes of planes that are folded at once."""


class Send(NamedTuple):
    """One execution of an output instruction.

    Attributes:
        port: port number.
        address: address of the instruction.
        data: uint8, shape (NP rows, NP columns); 0 where the NP was inactive.
        active: bool, same shape; None outside of masked regions.
    """

    port: int
    address: int
    data: NDArray[np.uint8]
    active: NDArray[np.bool_] | None


class Sites(NamedTuple):
    """Output instructions by number: int64 arrays of the same length.

    Attributes:
        address: address of the instruction.
        port: port number.
        planes: planes of a send: 0 if all NPs were active and sent the same byte, 1 for the
            bytes, 2 for the bytes and the active NPs (255, else 0).
    """

    address: NDArray[np.int64]
    port: NDArray[np.int64]
    planes: NDArray[np.int64]


class Folded(NamedTuple):
    """The single bytes of sends that have planes: arrays of shape (n,).

    Attributes:
        byte: uint8: the byte of the active NPs, if they agree.
        heard: bool: whether any NP was active.
        agreed: bool: whether all active NPs sent the same byte.
    """

    byte: NDArray[np.uint8]
    heard: NDArray[np.bool_]
    agreed: NDArray[np.bool_]


@dataclass(eq=False)
class SendLog:
    """Sends in the order they were made.

    Attributes:
        ends: int64, shape (frames,): number of sends up to the end of each frame.
        site: integers, shape (n,): number of the output instruction.
        value: uint8, shape (n,): the byte sent, if the site has no planes.
        planes: uint8, shape (m, NPs): planes of all sends.
        sites: output instructions.
        shape: (NP rows, NP columns).
        arrays: outputs that the engine has read already, by port; their sends are left out. uint8,
            shape (frames, rows, columns): the pixels of a picture, or the bytes of a plane.
    """

    ends: NDArray[np.int64]
    site: NDArray[np.integer[Any]]
    value: NDArray[np.uint8]
    planes: NDArray[np.uint8]
    sites: Sites
    shape: tuple[int, int]
    arrays: Mapping[int, NDArray[np.uint8]] = field(default_factory=dict)

    @classmethod
    def of(cls, sends: Sequence[Send], shape: tuple[int, int]) -> SendLog:
        """Return the sends of one frame as a log."""
        count, width = len(sends), shape[0] * shape[1]
        data = np.array([send.data for send in sends], np.uint8).reshape(count, width)
        kinds = np.array([1 if send.active is None else 2 for send in sends], np.int64)
        kinds[(kinds == 1) & (data == data[:, :1]).all(axis=1)] = 0
        first = np.cumsum(kinds) - kinds
        planes = np.empty((kinds.sum(), width), np.uint8)
        planes[first[kinds > 0]] = data[kinds > 0]
        for number, send in enumerate(sends):
            if send.active is not None:
                planes[first[number] + 1] = send.active.reshape(-1) * np.uint8(255)
        sites = Sites(
            np.array([send.address for send in sends], np.int64),
            np.array([send.port for send in sends], np.int64),
            kinds,
        )
        return cls(np.array([count]), np.arange(count), data[:, 0], planes, sites, shape)

    def preceded_by(self, sends: Sequence[Send]) -> SendLog:
        """Return the log with `sends` before those of its first frame."""
        before = SendLog.of(sends, self.shape)
        return replace(
            self,
            ends=self.ends + len(sends),
            site=np.concatenate([before.site, self.site + len(sends)]),
            value=np.concatenate([before.value, self.value]),
            planes=np.concatenate([before.planes, self.planes]),
            sites=Sites(*map(np.concatenate, zip(before.sites, self.sites, strict=True))),
        )

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
        """Return the bytes of some sends, 0 for inactive NPs: shape (len(sends), NPs)."""
        own = self.sites.planes[self.site[sends]] > 0
        if own.all():
            return self.planes[self.first_plane[sends]]
        data = np.repeat(self.value[sends, None], self.shape[0] * self.shape[1], axis=1)
        data[own] = self.planes[self.first_plane[sends[own]]]
        return data

    def active_of(self, sends: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return the active NPs of some sends: bool, shape (len(sends), NPs)."""
        counts = self.sites.planes[self.site[sends]]
        active = np.ones((len(sends), self.shape[0] * self.shape[1]), np.bool_)
        active[counts == 2] = self.planes[self.first_plane[sends[counts == 2]] + 1] != 0
        return active

    def folded(self, first: NDArray[np.int64], *, masked: bool) -> Folded:
        """Reduce planes of sends to single bytes.

        Args:
            first: numbers of the first planes, shape (n,).
            masked: whether the active NPs follow each of these.
        """
        count, step = len(first), max(1, _CACHED // self.planes.shape[1])
        folded = Folded(np.empty(count, np.uint8), np.ones(count, np.bool_), np.empty(count, bool))
        # Larger temporary arrays would cost page faults, which take longer than all the rest.
        for begin in range(0, count, step):
            part = slice(begin, begin + step)
            data = self.planes[first[part]]
            bytes_ = folded.byte[part] = _largest(data)
            if masked:
                masks = self.planes[first[part] + 1]
                folded.heard[part] = _largest(masks) != 0
                data ^= masks & bytes_[:, None]  # inactive NPs have 0 in both
            else:
                data ^= bytes_[:, None]
            folded.agreed[part] = _largest(data) == 0
        return folded

    @cached_property
    def _by_port(self) -> dict[int, tuple[list[int], int]]:
        """Places of each port's sends in a frame, and planes of each send.

        Empty if frames send in different ways; without the ports whose sends differ in planes.
        """
        count, each = len(self.ends), int(self.ends[0]) if len(self.ends) else 0
        if not each or not np.array_equal(self.ends, np.arange(1, count + 1) * each):
            return {}
        ways = self.sites.port << 2 | self.sites.planes
        found = ways.take(self.site).reshape(count, each)  # take: a quarter of the time of []
        first = found[0]
        if not (found == first).all():
            return {}
        places: dict[int, list[int]] = {}
        for place, way in enumerate(first.tolist()):
            places.setdefault(way, []).append(place)
        ports = Counter(way >> 2 for way in places)
        return {way >> 2: (of, way & 3) for way, of in places.items() if ports[way >> 2] == 1}

    def by_frame(self, port: int) -> NDArray[np.uint8] | None:
        """Return the bytes sent to a port, one for each send: uint8, shape (frames, sends of each).

        None if frames send in different ways, a send has no active NP, or active NPs disagree.
        """
        if port not in self._by_port:
            return None
        sends, planes = self._by_port[port]
        shape = len(self.ends), -1
        if not planes:
            values, (begin, end) = self.value.reshape(shape), (sends[0], sends[-1] + 1)
            return values[:, begin:end] if end - begin == len(sends) else values[:, sends]
        first = self.first_plane.reshape(shape)[:, sends].reshape(-1)
        folded = self.folded(first, masked=planes == 2)
        if folded.heard.all() and folded.agreed.all():
            return folded.byte.reshape(shape)
        return None

    def sends(self, begin: int, end: int) -> list[Send]:
        """Return the sends from number `begin` to `end`, exclusive, as objects."""
        numbers = np.arange(begin, end)
        data = self.bytes_of(numbers).reshape(-1, *self.shape)
        active = self.active_of(numbers).reshape(-1, *self.shape)
        return [
            Send(
                int(self.sites.port[site]),
                int(self.sites.address[site]),
                data[index].copy(),
                active[index].copy() if self.sites.planes[site] == 2 else None,
            )
            for index, site in enumerate(self.site[begin:end])
        ]

    def part(self, first: int, last: int) -> SendLog:
        """Return the sends of the frames from `first` to `last`, exclusive."""
        begin = int(self.ends[first - 1]) if first else 0
        end = int(self.ends[last - 1]) if last else 0
        return replace(
            self,
            ends=self.ends[first:last] - begin,
            site=self.site[begin:end],
            value=self.value[begin:end],
            planes=self.planes[self.sites.planes[self.site[:begin]].sum() :],
            arrays={port: array[first:last] for port, array in self.arrays.items()},
        )


class FrameBatch(NamedTuple):
    """Complete frames in order. A frame lies between two expose instructions.

    Attributes:
        cycles, instructions: int64, shape (n,).
        log: sends of the frames.
    """

    cycles: NDArray[np.int64]
    instructions: NDArray[np.int64]
    log: SendLog

    def part(self, first: int, last: int) -> FrameBatch:
        """Return the frames from `first` to `last`, exclusive."""
        if (first, last) == (0, len(self.cycles)):
            return self
        log = self.log.part(first, last)
        return FrameBatch(self.cycles[first:last], self.instructions[first:last], log)


def _largest(planes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the largest byte of each plane, in half the time that ``max(axis=1)`` takes."""
    starts = np.arange(0, planes.size, planes.shape[1])
    return np.maximum.reduceat(planes.reshape(-1), starts)
