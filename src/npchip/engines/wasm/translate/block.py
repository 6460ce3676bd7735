"""One block's instructions executed on values: the intermediate form to a graph of nodes.

The same execution serves every analysis: with what is known of the variables when a block begins,
its result tells what is known when it ends, and what each value depends on.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.flags import Flags
from npchip.engines.wasm.translate.forwarding import Memory
from npchip.engines.wasm.translate.regions import Regions
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.engines.wasm.translate.summary import DIRECTIONS, Item, Known, Site, Summary
from npchip.engines.wasm.translate.values import Value
from npchip.engines.wasm.translate.zero_bytes import ZeroBytes
from npchip.isa import Isa, ir
from npchip.isa.ir import FLAGS
from npchip.isa.model import Form

_WAKING: Final = frozenset({"mask_invert", "mask_pop"})
"""Effects behind which other NPs are active: names set before them may be used behind them."""


class Executor(ir.Evaluator[Value]):
    """Executes blocks on values.

    Args:
        isa: for the meaning of conditions.
        memory_bytes: size of an NP's memory.
        blank: whether all reset levels are 0.
        profile: whether to count how many NPs each step reaches, and how many masks one number
            has room for; 0 for no profile.
    """

    def __init__(
        self, isa: Isa, memory_bytes: int, *, blank: bool = False, profile: int = 0
    ) -> None:
        super().__init__(isa.meanings)
        self.blank = blank
        self._profile = profile
        self._last_byte = memory_bytes - 1
        self._looking: dict[int, bool] = {}  # by the form's identity
        self._flags = Flags()
        # By the identity of a block's steps, which are kept so that they have it alone.
        self._before: dict[int, tuple[list[Step], list[tuple[Known, Summary]]]] = {}
        # Tables rather than a long ``match``: most of the time of a translation is spent here.
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
            "input": self._input,
            "any": self._any_of,
        }

    def execute(self, block: Block, begin: Known, zeros: int = 0) -> Summary:
        """Execute a block, or without `zeros` remember what it does.

        Args:
            block: not one that leaves.
            begin: what is known of every variable when it begins.
            zeros: what is known of the memory: see `ZeroBytes`.
        """
        if zeros:
            return self._execute(block, begin, zeros)
        _, before = self._before.setdefault(id(block.steps), (block.steps, []))
        for reads, done in before:
            if all(begin[variable] == claim for variable, claim in reads.items()):
                return done
        done = self._execute(block, begin, 0)
        before.append(({variable: begin[variable] for variable in done.reads}, done))
        return done

    def zeros(self, block: Block, bits: int) -> ZeroBytes:
        """What is known to be 0 when a block begins."""
        return ZeroBytes(bits, block.most, blank=self.blank)

    def _execute(self, block: Block, begin: Known, zeros: int) -> Summary:
        values = self._values
        values.clear()
        done = self._done = Summary(outs={})
        regions = self._regions = Regions(
            values, begin, done, block.first.place.depth, self._profile
        )
        self._memory = Memory(values, self._last_byte)
        self._zeros = self.zeros(block, zeros)
        end = 0
        needed = self._flags.needed(block.steps)
        for index, (step, statements) in enumerate(zip(block.steps, needed, strict=True)):
            if index == end:
                regions.end_guard()
            assert step.decoded is not None
            self.fields, self.locals = step.decoded.values, {}
            self._at = step.place
            if self._profile:
                if step.begins_loop or (index and block.steps[index - 1].ends_pass):
                    regions.begin_pass(step.place)
                done.reach.append(regions.reach(step.place, behind=False))
            around = self._looks_around(step.decoded.form)
            self.read = regions.everywhere if around else regions.active
            for statement in statements:
                self._statements[statement.__class__](statement)
                if values.deep:
                    done.items += [Item("compute", (node,)) for node in values.deep]
                    values.deep.clear()
            if self._profile and regions.depth > step.place.depth:
                done.entered[index] = regions.reach(step.place, behind=True)
            if step.guards:
                regions.begin_guard(index, when=step.when)
                end = index + 1 + step.guards
        regions.close()
        if len(block.after) < 2:  # the last branch was one whose wire is known
            done.wire = None
        return done

    def _looks_around(self, form: Form) -> bool:
        """Whether values are seen of NPs that are inactive: by others, or when they are active."""
        found = self._looking.get(id(form))
        if found is None:
            found = not _WAKING.isdisjoint(form.effects)
            found = self._looking[id(form)] = found or any(form.operations("neighbour"))
        return found

    # ---- statements

    def _set_register(self, node: ir.SetRegister) -> None:
        self._regions.write(self.fields[node.name], node.value.evaluate(self))

    def _set_flag(self, node: ir.SetFlag) -> None:
        self._regions.write(FLAGS[node.name], node.value.evaluate(self))

    def _set_local(self, node: ir.SetLocal) -> None:
        self.locals[node.name] = node.value.evaluate(self)

    def _store(self, node: ir.Store) -> None:
        address = self._wrapped(node.address.evaluate(self))
        value, mask = node.value.evaluate(self), self._regions.mask()
        item = Item("store", (address, value), mask)
        self._done.items.append(item)
        self._memory.store(address, value, mask)
        self._zeros.change(item)

    def _effect(self, node: ir.Effect) -> None:
        guard = None if node.guard is None else node.guard.evaluate(self)
        args: list[Any] = [arg.evaluate(self) for arg in node.args]
        match node.name, args:
            case "mask_push", [bit]:
                self._regions.push(bit)
            case "mask_invert", _:
                self._regions.invert()
            case "mask_pop", _:
                self._regions.pop()
            case "output", [port, value]:
                site = Site(self._at.address, port)
                mask = self._regions.mask()
                self._done.items.append(Item("send", (value,), mask, guard, site=site))
            case "sample", [level, bank]:
                mask, signal = self._regions.mask(), level == "signal"
                item = Item("sample", (), mask, guard, bank=bank, signal=signal)
                item.needless = self._zeros.is_needless(item)
                self._done.items.append(item)
                if not item.needless:
                    self._memory.forget()
                self._zeros.change(item)
            case _:  # the flow: the graph knows where it leads
                self._done.wire = guard

    # ---- operations that need more than values

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

    def _input(self, _port: int) -> Value:
        return self._values.received()

    def _any_of(self, bit: Value) -> Value:
        mask = self._regions.mask()
        return self._values.any_of(bit if mask is None else self._values.both(mask, bit))

    def _wrapped(self, address: Value) -> Value:
        """An address that wraps at the end of the memory."""
        return self._values.and_(address, self._values.constant(self._last_byte))
