"""Tracks variables and active NPs through the masked regions of a block."""

from __future__ import annotations

from collections.abc import Callable

from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.summary import MASKS, SAME, Facts, Summary, is_bit
from npchip.engines.wasm.translate.values import Value


class Regions:
    """The variables of a block that is being executed.

    Values written in a region are kept apart, as its active NPs see them. They are merged with
    those of the other NPs when the region ends, since most are overwritten before.

    Args:
        values: makes values.
        begin: facts about every variable when the block begins.
        done: the block's summary; gets its outs, reads and guards.
        depth: number of regions that are open when it begins.

    Attributes:
        depth: number of open regions.
    """

    def __init__(self, values: ValueBuilder, begin: Facts, done: Summary, depth: int) -> None:
        self.depth = depth
        self._values = values
        self._begin = begin
        self._done = done
        self._now = done.outs
        self._inside: list[dict[int, Value]] = [{} for _ in range(depth)]  # writes by region
        self._guard: Value | None = None  # the wire on which the current steps depend

    # ---- where regions begin and end

    def push(self, bit: Value) -> None:
        """Open a region of the active NPs that have a bit."""
        mask = self.mask()
        self._now[MASKS + self.depth] = bit if mask is None else self._values.both(mask, bit)
        self.depth += 1
        self._inside.append({})

    def invert(self) -> None:
        """Swap active and inactive NPs of the innermost region, within the one around it."""
        variable = MASKS + self.depth - 1
        self._end(self.read(variable))
        self._inside.append({})
        others = self._values.not_(self.read(variable))
        if self.depth > 1:
            others = self._values.both(self.read(variable - 1), others)
        self._now[variable] = others

    def pop(self) -> None:
        """Leave the innermost region."""
        self.depth -= 1
        self._end(self.read(MASKS + self.depth))
        self._now.pop(MASKS + self.depth, None)

    def begin_guard(self, index: int, *, when: bool) -> None:
        """Let the steps after branch `index` take effect only if its wire is `when`."""
        wire = self._done.wire
        assert wire is not None
        self._guard = wire if when else self._values.not_(wire)
        self._done.guards[index] = self._guard
        self._inside.append({})

    def end_guard(self) -> None:
        """End the effect of `begin_guard`, if any."""
        if self._guard is not None:
            self._end(self._guard)
            self._guard = None

    def close(self) -> None:
        """End the block, which may be within regions."""
        self.end_guard()
        for region in range(len(self._inside), 0, -1):
            self._end(self.read(MASKS + region - 1))

    def _end(self, mask: Value) -> None:
        """Merge the writes of the innermost region into the one around it."""
        written = self._inside.pop()
        around = self._inside[-1] if self._inside else self._now
        for variable, value in written.items():
            around[variable] = self._select(variable)(mask, value, self.active(variable))

    def _select(self, variable: int) -> Callable[[Value, Value, Value], Value]:
        return self._values.select_bit if is_bit(variable) else self._values.select

    # ---- variables and masks

    def read(self, variable: int) -> Value:
        """Return the value of a variable outside of all regions."""
        value = self._now.get(variable)
        if value is not None:
            return value
        fact = self._begin[variable]
        self._done.reads.add(variable)
        if fact < SAME:
            return self._values.constant(fact)
        return self._values.leaf(variable, fact - SAME + 1)

    def active(self, variable: int) -> Value:
        """Return the value of a variable in the active NPs. It costs less than `everywhere`."""
        for written in reversed(self._inside):
            value = written.get(variable)
            if value is not None:
                return value
        return self.read(variable)

    def everywhere(self, variable: int) -> Value:
        """Return the value of a variable in all NPs."""
        assert self._guard is None  # `convert` never guards such a step
        value = self.read(variable)
        for region, written in enumerate(self._inside):
            if variable in written:
                mask = self.read(MASKS + region)
                value = self._select(variable)(mask, written[variable], value)
        return value

    def write(self, variable: int, value: Value) -> None:
        """Set a variable in the active NPs."""
        (self._inside[-1] if self._inside else self._now)[variable] = value

    def mask(self) -> Value | None:
        """Return the bit of the active NPs; None if all are active."""
        if not self.depth:
            return self._guard
        mask = self.read(MASKS + self.depth - 1)
        return mask if self._guard is None else self._values.both(mask, self._guard)
