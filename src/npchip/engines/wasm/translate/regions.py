"""What variables hold inside the masked regions of a block, and how many NPs are active there."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.summary import MASKS, SAME, Item, Known, Summary, Terms, is_bit
from npchip.engines.wasm.translate.values import Value
from npchip.program.graph import Place

_EVERY: Final[Terms] = ((-1, 1),)


class Regions:
    """The variables of a block that is being executed.

    What is written in a region is kept apart until the region ends, as its active NPs see it.
    What all NPs have is put together then: by then most of it has been written over.

    Args:
        values: makes nodes.
        begin: what is known of every variable when the block begins.
        done: what the block does; its outs, reads, guards, masks and counts are told here.
        depth: regions that are open when it begins.
        profile: how many masks one number has room for; see `Executor`.

    Attributes:
        depth: regions that are open.
    """

    def __init__(
        self, values: ValueBuilder, begin: Known, done: Summary, depth: int, profile: int
    ) -> None:
        self.depth = depth
        self._values = values
        self._begin = begin
        self._done = done
        self._profile = profile
        self._now = done.outs
        # For each open region what was written in it.
        self._inside: list[dict[int, Value]] = [{} for _ in range(depth)]
        # How many NPs are active in each, as far as it is known in this block.
        self._actives: list[Terms | None] = [_EVERY, *[None] * depth]
        self._counted: dict[tuple[Place, int], tuple[int, int]] = {}
        self._guard: Value | None = None  # the wire under which the steps at hand are done

    # ---- where regions begin and end

    def push(self, bit: Value) -> None:
        """Let only NPs be active that have a bit."""
        mask = self.mask()
        self._now[MASKS + self.depth] = bit if mask is None else self._values.both(mask, bit)
        self.depth += 1
        self._inside.append({})
        self._actives.append(None)

    def invert(self) -> None:
        """Let those be active in the innermost region that were not, of those around it."""
        variable = MASKS + self.depth - 1
        self._end(self.read(variable))
        self._inside.append({})
        others = self._values.not_(self.read(variable))
        if self.depth > 1:
            others = self._values.both(self.read(variable - 1), others)
        self._now[variable] = others
        outer, inner = self._actives[-2:]
        self._actives[-1] = (
            None
            if outer is None or inner is None
            else (*outer, *((number, -sign) for number, sign in inner))
        )

    def pop(self) -> None:
        """Leave the innermost region."""
        self.depth -= 1
        self._end(self.read(MASKS + self.depth))
        self._now.pop(MASKS + self.depth, None)
        self._actives.pop()

    def begin_guard(self, index: int, *, when: bool) -> None:
        """What follows step `index`, a branch, is only done where its wire is `when`."""
        wire = self._done.wire
        assert wire is not None
        self._guard = wire if when else self._values.not_(wire)
        self._done.guards[index] = self._guard
        self._inside.append({})
        self._actives.append(None)

    def end_guard(self) -> None:
        """What follows is done always."""
        if self._guard is not None:
            self._end(self._guard)
            self._guard = None
            self._actives.pop()

    def close(self) -> None:
        """The block ends, maybe within regions."""
        self.end_guard()
        for region in range(len(self._inside), 0, -1):
            self._end(self.read(MASKS + region - 1))

    def _end(self, mask: Value) -> None:
        """Let the region around see what was written in the innermost one."""
        written = self._inside.pop()
        around = self._inside[-1] if self._inside else self._now
        for variable, value in written.items():
            around[variable] = self._chosen(variable)(mask, value, self.active(variable))

    def _chosen(self, variable: int) -> Callable[[Value, Value, Value], Value]:
        return self._values.select_bit if is_bit(variable) else self._values.select

    # ---- variables and masks

    def read(self, variable: int) -> Value:
        """What a variable holds outside of all regions."""
        node = self._now.get(variable)
        if node is not None:
            return node
        what = self._begin[variable]
        self._done.reads.add(variable)
        if what < SAME:
            return self._values.constant(what)
        return self._values.leaf(variable, what - SAME + 1)

    def active(self, variable: int) -> Value:
        """What the active NPs have in a variable, which is less to compute than what all have."""
        for written in reversed(self._inside):
            node = written.get(variable)
            if node is not None:
                return node
        return self.read(variable)

    def everywhere(self, variable: int) -> Value:
        """What all NPs have in a variable."""
        assert self._guard is None  # its region has no plane; `convert` sees to that
        node = self.read(variable)
        for region, written in enumerate(self._inside):
            if variable in written:
                mask = self.read(MASKS + region)
                node = self._chosen(variable)(mask, written[variable], node)
        return node

    def write(self, variable: int, value: Value) -> None:
        """Let the active NPs have a value in a variable."""
        (self._inside[-1] if self._inside else self._now)[variable] = value

    def mask(self) -> Value | None:
        """Which NPs are active; None for all."""
        if not self.depth:
            return self._guard
        mask = self.read(MASKS + self.depth - 1)
        return mask if self._guard is None else self._values.both(mask, self._guard)

    def begin_pass(self, at: Place) -> None:
        """A pass of a loop begins, or what follows the last one: count all open regions anew.

        Their numbers may be those that regions of other passes, opened at the same steps, add to.

        Args:
            at: the first step.
        """
        for region in range(1, self.depth + 1):
            self._actives[region] = self._count((at, region), self.read(MASKS + region - 1))

    def reach(self, at: Place, *, behind: bool) -> Terms:
        """How many NPs are active; counted only where that does not follow from other counts.

        Args:
            at: the step for which it is asked.
            behind: whether the step has been executed.
        """
        found = self._actives[-1]
        if found is None:
            mask = self.mask()
            assert mask is not None
            found = self._actives[-1] = self._count((at, -1 if behind else 0), mask)
        return found

    def _count(self, key: tuple[Place, int], mask: Value) -> Terms:
        """Count a mask. Unrolled passes add to the number of the first, for which it is said."""
        number, times = self._counted.get(key, (-1, self._profile))
        found: Terms = ()
        if times == self._profile:
            number, times = self._done.masks, 0
            found = ((number, 1),)
            self._done.masks += 1
        self._counted[key] = number, times + 1
        self._done.items.append(Item("count", (mask,), number=number))
        return found
