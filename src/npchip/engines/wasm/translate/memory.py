"""Tracks a block's knowledge of the NPs' memory: bytes that it loaded or stored, and zero bytes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.summary import Item
from npchip.engines.wasm.translate.values import CONSTANT, NUMBERS, Value, split
from npchip.machine import PIXELS

_BANK: Final = (1 << PIXELS * PIXELS) - 1


class Memory:
    """Known bytes by their address, which may differ between NPs (store-to-load forwarding).

    Args:
        values: makes values.
        last_byte: last address of an NP's memory.
    """

    def __init__(self, values: ValueBuilder, last_byte: int) -> None:
        self._values = values
        self._last_byte = last_byte
        self._bytes: dict[Value, Value] = {}
        self._version = 0

    def load(self, address: Value) -> tuple[Value, bool]:
        """Return the byte at an address, and whether the memory must be read for it."""
        known = self._bytes.get(address)
        if known is not None:
            return known, False
        value = self._bytes[address] = self._values.load(address, self._version)
        return value, True

    def store(self, address: Value, value: Value, mask: Value | None) -> None:
        """Store a byte where `mask` is set."""
        before = self._bytes.get(address)
        self._version += 1
        self._bytes = {
            other: byte
            for other, byte in self._bytes.items()
            if apart(other, address, self._last_byte)
        }
        if mask is None:
            self._bytes[address] = value
        elif before is not None:
            self._bytes[address] = self._values.select(mask, value, before)

    def forget(self) -> None:
        """Forget all bytes, as any of them may have changed."""
        self._version += 1
        self._bytes.clear()


def apart(a: Value, b: Value, last_byte: int) -> bool:
    """Return whether two addresses always differ in a memory that ends at `last_byte`."""
    (base, offset), (other, more) = _base(a, last_byte), _base(b, last_byte)
    return base is other and (offset - more) & last_byte != 0


def _base(address: Value, last_byte: int) -> tuple[Value | None, int]:
    """Split an address; a constant has no base."""
    if address.op == "and":
        unwrapped, mask = address.args
        if mask.kind == CONSTANT and mask.number == last_byte:  # addresses wrap in any case
            address = unwrapped
    return (None, address.number) if address.kind == CONSTANT else split(address)


class ZeroBytes:
    """The bytes that are known to be 0 in all NPs at a point of a block.

    The reset level of a sensor without noise and fixed pattern is 0 everywhere. Where it has been
    converted on every path, loads from that bank return 0 and it need not be converted again.

    Args:
        bits: bit k is set if byte k is known to be 0 when the block begins.
        bounds: see `Block.bounds`.
        blank: whether all reset levels are 0.
    """

    def __init__(self, bits: int, bounds: Mapping[int, int], *, blank: bool) -> None:
        self.bits = bits
        self._bounds = bounds
        self._blank = blank

    def known(self, address: Value) -> bool:
        """Return whether the byte at an address is known to be 0."""
        reach = self._reach(address) if self.bits else None
        return reach is not None and reach & ~self.bits == 0

    def is_needless(self, item: Item) -> bool:
        """Return whether the bank already holds the result of a conversion."""
        return self._blank and not item.signal and _BANK << item.bank & ~self.bits == 0

    def change(self, item: Item) -> None:
        """Apply the effect of an item."""
        everywhere = item.mask is None
        reach: int | None
        if item.kind == "sample":
            reach, zero = _BANK << item.bank, self._blank and not item.signal
        elif item.kind == "store":
            address, value = item.values
            reach, zero = self._reach(address), value is NUMBERS[0]
            everywhere = everywhere and address.kind == CONSTANT
        else:
            return
        if not zero:
            self.bits &= 0 if reach is None else ~reach
        elif everywhere:
            assert reach is not None
            self.bits |= reach

    def _reach(self, address: Value) -> int | None:
        """Return a bit for each byte that an address may refer to; None for any byte."""
        if address.kind == CONSTANT:
            return 1 << address.number
        base, offset = split(address)
        most = self._bounds.get(base.number, 255) if base.op == "leaf" else 255
        return None if most + offset > 255 else (1 << most + 1) - 1 << offset
