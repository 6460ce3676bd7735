"""Damage: bytes changed, cut, added or moved."""

from __future__ import annotations

import random

_HEAD = 96
"""Most of what decides how a file is read stands in its first bytes."""


def damage(data: bytes, draw: random.Random) -> bytes:
    """Return a file that differs from `data`."""
    while True:
        changed = bytearray(data)
        for _ in range(draw.choice([1, 1, 1, 2, 4])):
            draw.choice(_WAYS)(changed, draw)
        if changed != data:
            return bytes(changed)


def _place(data: bytearray, draw: random.Random) -> int:
    end = min(len(data), _HEAD) if draw.random() < 0.3 else len(data)
    return draw.randrange(end) if end else 0


def _flip(data: bytearray, draw: random.Random) -> None:
    if data:
        data[_place(data, draw)] ^= 1 << draw.randrange(8)


def _byte(data: bytearray, draw: random.Random) -> None:
    if data:
        data[_place(data, draw)] = draw.choice([0, 1, 0x7F, 0x80, 0xFF, draw.randrange(256)])


def _run(data: bytearray, draw: random.Random) -> None:
    start, size = _place(data, draw), draw.randrange(1, 64)
    data[start : start + size] = bytes([draw.choice([0, 0xFF])]) * len(data[start : start + size])


def _cut(data: bytearray, draw: random.Random) -> None:
    del data[_place(data, draw) :]


def _trim(data: bytearray, draw: random.Random) -> None:
    del data[max(0, len(data) - draw.randrange(1, 40)) :]


def _remove(data: bytearray, draw: random.Random) -> None:
    start = _place(data, draw)
    del data[start : start + draw.choice([1, 2, draw.randrange(1, 200)])]


def _insert(data: bytearray, draw: random.Random) -> None:
    start = _place(data, draw)
    data[start:start] = draw.randbytes(draw.choice([1, 2, draw.randrange(1, 200)]))


def _repeat(data: bytearray, draw: random.Random) -> None:
    start = _place(data, draw)
    data[start:start] = data[start : start + draw.randrange(1, 400)]


def _extend(data: bytearray, draw: random.Random) -> None:
    size = draw.randrange(1, 300)
    data += draw.choice([bytes(size), draw.randbytes(size), bytes(data[:size]), bytes(data)])


_WAYS = (_flip, _flip, _flip, _byte, _byte, _run, _cut, _trim, _remove, _insert, _repeat, _extend)
