"""Executes the instructions of a block on values: the intermediate form becomes a value graph.

One execution serves every analysis: from the facts about variables at the beginning of a block it
gives those at its end, and the variables on which each value depends.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Final

from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.flags import needed
from npchip.engines.wasm.translate.memory import Memory, ZeroBytes
from npchip.engines.wasm.translate.regions import Regions
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.engines.wasm.translate.summary import DIRECTIONS, Facts, Item, Site, Summary
from npchip.engines.wasm.translate.values import Value
from npchip.isa import Isa, ir
from npchip.isa.ir import FLAGS
from npchip.isa.model import Form

_WAKING: Final = frozenset({"mask_invert", "mask_pop"})
"""Effects that activate other NPs, which may use names that were set before."""


class Executor(ir.Evaluator[Value]):
    """Executes blocks on values.

    Args:
        isa: defines the conditions.
        memory_bytes: size of an NP's memory.
        blank: whether all reset levels are 0.
        profile: whether to count the active NPs of every step; blocks have one step then.
    """

    def __init__(
        self, isa: Isa, memory_bytes: int, *, blank: bool = False, profile: bool = False
    ) -> None:
        super().__init__(isa.meanings)
        self.blank = blank
        self._profile = profile
        self._last_byte = memory_bytes - 1
        # By the identity of a block's steps, which are kept so that it stays unique.
        self._before: dict[int, tuple[list[Step], list[tuple[Facts, Summary]]]] = {}
        # A table is faster than ``match``: most of the time of a translation is spent here.
        self._statements: dict[type, Callable[[Any], None]] = {
            ir.SetRegister: self._set_register,
            ir.SetFlag: self._set_flag,
            ir.SetLocal: self._set_local,
            ir.Store: self._store,
            ir.Effect: self._effect,
        }
        values = self._values = ValueBuilder()
        self.number = values.constant
        self.operations = values.operations() | {
            "load": self._load,
            "neighbour": self._neighbour,
            "input": lambda _port: values.plane("received"),
            "any": self._any_of,
        }

    def execute(self, block: Block, begin: Facts, zeros: int = 0) -> Summary:
        """Execute a block. Results without `zeros` are cached.

        Args:
            block: the block; not one that leaves.
            begin: facts about every variable when it begins.
            zeros: bits of the bytes that are 0; see `ZeroBytes`.
        """
        if zeros:
            return self._execute(block, begin, zeros)
        _, before = self._before.setdefault(id(block.steps), (block.steps, []))
        for reads, done in before:
            if all(begin[variable] == fact for variable, fact in reads.items()):
                return done
        done = self._execute(block, begin, 0)
        before.append(({variable: begin[variable] for variable in done.reads}, done))
        return done

    def zeros(self, block: Block, bits: int) -> ZeroBytes:
        """Return the zero bytes at the beginning of a block."""
        return ZeroBytes(bits, block.bounds, blank=self.blank)

    def _execute(self, block: Block, begin: Facts, zeros: int) -> Summary:
        values = self._values
        values.clear()
        done = self._done = Summary(outs={})
        regions = self._regions = Regions(values, begin, done, block.first.place.depth)
        self._memory = Memory(values, self._last_byte)
        self._zeros = self.zeros(block, zeros)
        end = 0
        kept = needed(block.steps)
        for index, (step, statements) in enumerate(zip(block.steps, kept, strict=True)):
            if index == end:
                regions.end_guard()
            assert step.decoded is not None
            self.fields, self.locals = step.decoded.values, {}
            self._at = step.place
            if self._profile:
                self._count(0, regions)
            around = _reads_inactive(step.decoded.form)
            self.read = regions.everywhere if around else regions.active
            for statement in statements:
                self._statements[statement.__class__](statement)
                if values.deep:
                    done.items += [Item("compute", (value,)) for value in values.deep]
                    values.deep.clear()
            if self._profile and regions.depth > step.place.depth:
                self._count(1, regions)
            if step.guards:
                regions.begin_guard(index, when=step.when)
                end = index + 1 + step.guards
        regions.close()
        if len(block.after) < 2:  # the wire is that of a branch with one successor
            done.wire = None
        return done

    def _count(self, number: int, regions: Regions) -> None:
        mask = regions.mask()
        if mask is not None:
            self._done.items.append(Item("count", (mask,), number=number))

    # ---- statements

    def _set_register(self, statement: ir.SetRegister) -> None:
        self._regions.write(self.fields[statement.name], statement.value.evaluate(self))

    def _set_flag(self, statement: ir.SetFlag) -> None:
        self._regions.write(FLAGS[statement.name], statement.value.evaluate(self))

    def _set_local(self, statement: ir.SetLocal) -> None:
        self.locals[statement.name] = statement.value.evaluate(self)

    def _store(self, statement: ir.Store) -> None:
        address = self._wrapped(statement.address.evaluate(self))
        value, mask = statement.value.evaluate(self), self._regions.mask()
        item = Item("store", (address, value), mask)
        self._done.items.append(item)
        self._memory.store(address, value, mask)
        self._zeros.change(item)

    def _effect(self, statement: ir.Effect) -> None:
        guard = None if statement.guard is None else statement.guard.evaluate(self)
        args: list[Any] = [arg.evaluate(self) for arg in statement.args]
        match statement.name, args:
            case "mask_push", [bit]:
                self._regions.push(bit)
            case "mask_invert", _:
                self._regions.invert()
            case "mask_pop", _:
                self._regions.pop()
            case "output", [port, value]:
                site = Site(self._at.address, port)
                mask = self._regions.mask()
                self._done.items.append(Item("send", (value,), mask, site=site))
            case "sample", [level, bank]:
                mask, signal = self._regions.mask(), level == "signal"
                item = Item("sample", (), mask, bank=bank, signal=signal)
                item.needless = self._zeros.is_needless(item)
                self._done.items.append(item)
                if not item.needless:
                    self._memory.forget()
                self._zeros.change(item)
            case _:  # control flow: the graph has the successors
                self._done.wire = guard

    # ---- operations on the state

    def _load(self, where: Value) -> Value:
        address = self._wrapped(where)
        if self._zeros.known(address):
            return self._values.false
        byte, read = self._memory.load(address)
        if read:
            self._done.items.append(Item("load", (byte,)))
        return byte

    def _neighbour(self, value: Value, direction: str) -> Value:
        return self._values.neighbour(value, DIRECTIONS.index(direction))

    def _any_of(self, bit: Value) -> Value:
        mask = self._regions.mask()
        return self._values.any_of(bit if mask is None else self._values.both(mask, bit))

    def _wrapped(self, address: Value) -> Value:
        """Return an address that wraps at the end of the memory."""
        return self._values.and_(address, self._values.constant(self._last_byte))


@lru_cache(4096)
def _reads_inactive(form: Form) -> bool:
    """Return whether a form may use values of NPs that are inactive when it begins."""
    return not _WAKING.isdisjoint(form.effects) or any(form.operations("neighbour"))
