"""Which bytes of the NPs' memory are known to be 0 in all NPs.

The reset level of a sensor without noise and fixed pattern is 0 everywhere, so that programs for
real sensors take away what is nothing here. Where every way to a block has converted it, its loads
from that bank are a known number, and it need not be converted again.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from npchip.engines.wasm.translate.summary import Item
from npchip.engines.wasm.translate.values import CONSTANT, NUMBERS, Value
from npchip.machine import PIXELS

_BANK: Final = (1 << PIXELS * PIXELS) - 1


class ZeroBytes:
    """The bytes that are known to be 0, while a block goes on.

    Args:
        bits: bit k is set where byte k is known to be 0 when it begins.
        most: see `Block.most`.
        blank: whether all reset levels are 0.
    """

    def __init__(self, bits: int, most: Mapping[int, int], *, blank: bool) -> None:
        self.bits = bits
        self._most = most
        self._blank = blank

    def known(self, address: Value) -> bool:
        """Whether the byte at an address is known to be 0."""
        span = self._span(address) if self.bits else None
        return span is not None and span & ~self.bits == 0

    def is_needless(self, item: Item) -> bool:
        """Whether the bank holds already what a conversion would give."""
        return self._blank and not item.signal and _BANK << item.bank & ~self.bits == 0

    def change(self, item: Item) -> None:
        """Take an item into account."""
        everywhere = item.mask is None and item.guard is None
        span: int | None
        if item.kind == "sample":
            span, zero = _BANK << item.bank, self._blank and not item.signal
        elif item.kind == "store":
            address, value = item.nodes
            span, zero = self._span(address), value is NUMBERS[0]
            everywhere = everywhere and address.kind == CONSTANT
        else:
            return
        if not zero:
            self.bits &= 0 if span is None else ~span
        elif everywhere:
            assert span is not None
            self.bits |= span

    def _span(self, address: Value) -> int | None:
        """A bit for each byte that an address may be; None where it may be any."""
        if address.kind == CONSTANT:
            return 1 << address.value
        offset = 0
        if address.op == "add" and address.args[1].kind == CONSTANT:
            address, offset = address.args[0], address.args[1].value
        most = self._most.get(address.value, 255) if address.op == "leaf" else 255
        return None if most + offset > 255 else (1 << most + 1) - 1 << offset
