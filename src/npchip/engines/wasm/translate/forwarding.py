"""What is known of the NPs' memory within a block: bytes that were loaded or stored in it."""

from __future__ import annotations

from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.values import CONSTANT, Value


class Memory:
    """Bytes by their address, which may be another one in each NP.

    Args:
        values: makes nodes.
        last_byte: of an NP's memory.
    """

    def __init__(self, values: ValueBuilder, last_byte: int) -> None:
        self._values = values
        self._last_byte = last_byte
        self._bytes: dict[Value, Value] = {}
        self._version = 0

    def load(self, address: Value) -> tuple[Value, bool]:
        """The byte at an address, and whether the memory must be read for it."""
        known = self._bytes.get(address)
        if known is not None:
            return known, False
        node = self._bytes[address] = self._values.load(address, self._version)
        return node, True

    def store(self, address: Value, value: Value, mask: Value | None) -> None:
        """Write a byte where `mask` is set."""
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
        """Any byte may have changed."""
        self._version += 1
        self._bytes.clear()


def apart(a: Value, b: Value, last_byte: int) -> bool:
    """Whether two addresses are certainly different bytes of a memory that ends at `last_byte`."""
    (base, offset), (other, more) = _base(a, last_byte), _base(b, last_byte)
    return base is other and (offset - more) & last_byte != 0


def _base(address: Value, last_byte: int) -> tuple[Value | None, int]:
    """What an address adds to what."""
    if address.op == "and":
        where, mask = address.args
        if mask.kind == CONSTANT and mask.value == last_byte:  # it wraps anyway
            address = where
    if address.kind == CONSTANT:
        return None, address.value
    if address.op == "add" and address.args[1].kind == CONSTANT:
        return address.args[0], address.args[1].value
    return address, 0
