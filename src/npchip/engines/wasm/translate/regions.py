"""Tracks variables and active NPs through the masked regions of a block."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.summary import MASKS, SAME, Facts, Item, Summary, Terms, is_bit
from npchip.engines.wasm.translate.values import Value
from npchip.program.graph import Place

_ALL: Final[Terms] = ((-1, 1),)


class Regions:
    """The variables of a block that is being executed.

    Values written in a region are kept apart, as its active NPs see them. They are merged with
    those of the other NPs when the region ends, since most are overwritten before.

    Args:
        values: makes values.
        begin: facts about every variable when the block begins.
        done: the block's summary; gets its outs, reads, guards, masks and counts.
        depth: number of regions that are open when it begins.
        profile: number of masks that may share a number; see `Executor`.

    Attributes:
        depth: number of open regions.
    """

    def __init__(
        self, values: ValueBuilder, begin: Facts, done: Summary, depth: int, profile: int
    ) -> None:
        self.depth = depth
        self._values = values
        self._begin = begin
        self._done = done
        self._profile = profile
        self._now = done.outs
        self._inside: list[dict[int, Value]] = [{} for _ in range(depth)]  # writes by region
        # Numbers of active NPs by region, as counted in this block.
        self._actives: list[Terms | None] = [_ALL, *[None] * depth]
        self._counted: dict[tuple[Place, int], tuple[int, int]] = {}
        self._guard: Value | None = None  # the wire on which the current steps depend

    # ---- where regions begin and end

    def push(self, bit: Value) -> None:
        """Open a region of the active NPs that have a bit."""
        mask = self.mask()
        self._now[MASKS + self.depth] = bit if mask is None else self._values.both(mask, bit)
        self.depth += 1
        self._inside.append({})
        self._actives.append(None)

    def invert(self) -> None:
        """Swap active and inactive NPs of the innermost region, within the one around it."""
        variable = MASKS + self.depth - 1
        self._end(self.read(variable))
        self._inside.append({})
        others = self._values.not_(self.read(variable))
        if self.depth > 1:
            others = self._values.both(self.read(variable - 1), others)
        self._now[variable] = others
        outer, inner = self._actives[-2:]
        self._actives[-1] = None
        if outer is not None and inner is not None:
            self._actives[-1] = (*outer, *((number, -sign) for number, sign in inner))

    def pop(self) -> None:
        """Leave the innermost region."""
        self.depth -= 1
        self._end(self.read(MASKS + self.depth))
        self._now.pop(MASKS + self.depth, None)
        self._actives.pop()

    def begin_guard(self, index: int, *, when: bool) -> None:
        """Let the steps after branch `index` take effect only if its wire is `when`."""
        wire = self._done.wire
        assert wire is not None
        self._guard = wire if when else self._values.not_(wire)
        self._done.guards[index] = self._guard
        self._inside.append({})
        self._actives.append(None)

    def end_guard(self) -> None:
        """End the effect of `begin_guard`, if any."""
        if self._guard is not None:
            self._end(self._guard)
            self._guard = None
            self._actives.pop()

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

    def begin_iteration(self, at: Place) -> None:
        """Count all open regions anew at an iteration of an unrolled loop, or after the last one.

        Their numbers may be shared with regions that other iterations open at the same steps.

        Args:
            at: place of the first step.
        """
        for region in range(1, self.depth + 1):
            self._actives[region] = self._count((at, region), self.read(MASKS + region - 1))

    def reach(self, at: Place, *, after: bool) -> Terms:
        """Return the number of active NPs. Count them unless it follows from other counts.

        Args:
            at: place of the step.
            after: whether the step has been executed.
        """
        found = self._actives[-1]
        if found is None:
            mask = self.mask()
            assert mask is not None
            found = self._actives[-1] = self._count((at, -1 if after else 0), mask)
        return found

    def _count(self, key: tuple[Place, int], mask: Value) -> Terms:
        """Count a mask. Unrolled iterations add to the number of the first, which reports it."""
        number, times = self._counted.get(key, (-1, self._profile))
        found: Terms = ()
        if times == self._profile:
            number, times = self._done.masks, 0
            found = ((number, 1),)
            self._done.masks += 1
        self._counted[key] = number, times + 1
        self._done.items.append(Item("count", (mask,), number=number))
        return found
