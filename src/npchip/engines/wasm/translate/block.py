"""One block's instructions executed on values: the intermediate form to a graph of nodes.

The same execution serves every analysis: with what is known of the variables when a block begins,
its result tells what is known when it ends, and what each value depends on.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from npchip.engines.wasm.translate.executed import (
    CARRY,
    DIRECTIONS,
    ZERO,
    Executed,
    Item,
    Known,
    Site,
)
from npchip.engines.wasm.translate.flags import Flags
from npchip.engines.wasm.translate.forwarding import Memory
from npchip.engines.wasm.translate.nodes import Node
from npchip.engines.wasm.translate.regions import Regions
from npchip.engines.wasm.translate.steps import Block, Step
from npchip.engines.wasm.translate.values import Values
from npchip.engines.wasm.translate.zeros import Zeros
from npchip.isa import Isa, ir
from npchip.isa.ir import Type
from npchip.isa.model import Form

_FLAGS: Final = {"Z": ZERO, "C": CARRY}
_WAKING: Final = frozenset({"mask_invert", "mask_pop"})
"""Effects behind which other NPs are active: names set before them may be used behind them."""


class Executor:
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
        self.blank = blank
        self._profile = profile
        self._conditions = isa.conditions
        self._last_byte = memory_bytes - 1
        self._looking: dict[int, bool] = {}  # by the form's identity
        self._flags = Flags()
        # By the identity of a block's steps, which are kept so that they have it alone.
        self._before: dict[int, tuple[list[Step], list[tuple[Known, Executed]]]] = {}
        # Tables rather than a long ``match``: most of the time of a translation is spent here.
        self._statements: dict[type, Callable[[Any], None]] = {
            ir.SetRegister: self._set_register,
            ir.SetFlag: self._set_flag,
            ir.SetLocal: self._set_local,
            ir.Store: self._store,
            ir.Effect: self._effect,
        }
        self._expressions: dict[type, Callable[[Any], Node]] = {
            ir.Register: self._register,
            ir.Flag: self._flag,
            ir.Condition: self._condition,
            ir.Local: self._local,
            ir.Place: self._place,
            ir.Binary: self._binary,
            ir.Not: self._not,
            ir.NotWire: self._not,
            ir.BitOf: self._bit_of,
            ir.Select: self._select,
            ir.Carry: self._carry,
            ir.Borrow: self._borrow,
            ir.ToByte: self._to_byte,
            ir.Load: self._load,
            ir.Neighbour: self._neighbour,
            ir.Input: self._input,
            ir.AnyOf: self._any_of,
        }

    def execute(self, block: Block, begin: Known, zeros: int = 0) -> Executed:
        """Execute a block, or without `zeros` remember what it does.

        Args:
            block: not one that leaves.
            begin: what is known of every variable when it begins.
            zeros: what is known of the memory: see `Zeros`.
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

    def zeros(self, block: Block, bits: int) -> Zeros:
        """What is known to be 0 when a block begins."""
        return Zeros(bits, block.most, blank=self.blank)

    def _execute(self, block: Block, begin: Known, zeros: int) -> Executed:
        values = self._values = Values()
        self._operators = values.operators()
        done = self._done = Executed(outs={})
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
            self._fields = step.decoded.values
            self._at = step.place
            if self._profile:
                if step.begins_loop or (index and block.steps[index - 1].ends_pass):
                    regions.begin_pass(step.place)
                done.reach.append(regions.reach(step.place, behind=False))
            self._locals: dict[str, Node] = {}
            around = self._looks_around(step.decoded.form)
            self._seen = regions.everywhere if around else regions.active
            for statement in statements:
                self._statements[statement.__class__](statement)
                if values.deep:
                    done.items += [Item("keep", (node,)) for node in values.deep]
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
            found = found or any(isinstance(node, ir.Neighbour) for node in form.nodes())
            self._looking[id(form)] = found
        return found

    # ---- statements

    def _set_register(self, node: ir.SetRegister) -> None:
        self._regions.write(int(self._fields[node.name]), self._expr(node.value))

    def _set_flag(self, node: ir.SetFlag) -> None:
        self._regions.write(_FLAGS[node.name], self._expr(node.value))

    def _set_local(self, node: ir.SetLocal) -> None:
        self._locals[node.name] = self._expr(node.value)

    def _store(self, node: ir.Store) -> None:
        address, value, mask = (
            self._address_of(node.address),
            self._expr(node.value),
            self._regions.mask(),
        )
        item = Item("store", (address, value), mask)
        self._done.items.append(item)
        self._memory.store(address, value, mask)
        self._zeros.change(item)

    def _effect(self, node: ir.Effect) -> None:
        values, args = self._fields, node.args
        guard = None if node.guard is None else self._expr(node.guard)
        match node.name:
            case "mask_push":
                self._regions.push(self._expr(args[0]))
            case "mask_invert":
                self._regions.invert()
            case "mask_pop":
                self._regions.pop()
            case "output":
                site = Site(self._at.address, ir.constant(args[0], values))
                value = (self._expr(args[1]),)
                self._done.items.append(Item("send", value, self._regions.mask(), guard, site=site))
            case "sample":
                signal = self._choice(args[0]) == "signal"
                bank = ir.constant(args[1], values)
                item = Item("sample", (), self._regions.mask(), guard, bank=bank, signal=signal)
                item.needless = self._zeros.is_needless(item)
                self._done.items.append(item)
                if not item.needless:
                    self._memory.forget()
                self._zeros.change(item)
            case _:  # the flow: the graph knows where it leads
                self._done.wire = guard

    def _choice(self, node: ir.Expr) -> str:
        assert isinstance(node, ir.Field)
        return str(self._fields[node.name])

    # ---- expressions

    def _expr(self, node: ir.Expr) -> Node:
        if node.type is Type.CONST:
            return self._values.constant(ir.constant(node, self._fields) & 255)
        return self._expressions[node.__class__](node)

    def _register(self, node: ir.Register) -> Node:
        return self._seen(int(self._fields[node.name]))

    def _flag(self, node: ir.Flag) -> Node:
        return self._seen(_FLAGS[node.name])

    def _local(self, node: ir.Local) -> Node:
        return self._locals[node.name]

    def _condition(self, node: ir.Condition) -> Node:
        return self._expr(self._conditions[str(self._fields[node.name])].when)

    def _place(self, node: ir.Place) -> Node:
        return self._values.place(node.axis)

    def _binary(self, node: ir.Binary) -> Node:
        left = self._expr(node.left)
        if node.op == "<<":
            return self._values.shift_left(left, self._count(node.right))
        if node.op == ">>":
            return self._values.shift_right(left, self._count(node.right))
        return self._operators[node.op](left, self._expr(node.right))

    def _not(self, node: ir.Not | ir.NotWire) -> Node:
        value = self._expr(node.value)
        return self._values.invert(value) if node.type is Type.BYTE else self._values.not_(value)

    def _bit_of(self, node: ir.BitOf) -> Node:
        return self._values.bit(self._expr(node.value), self._count(node.index))

    def _select(self, node: ir.Select) -> Node:
        select = self._values.select_bit if node.type is Type.BIT else self._values.select
        return select(self._expr(node.condition), self._expr(node.then), self._expr(node.otherwise))

    def _carry(self, node: ir.Carry) -> Node:
        left, right = self._expr(node.left), self._expr(node.right)
        return self._values.carry(left, right, self._optional(node.carry))

    def _borrow(self, node: ir.Borrow) -> Node:
        left, right = self._expr(node.left), self._expr(node.right)
        return self._values.borrow(left, right, self._optional(node.borrow))

    def _to_byte(self, node: ir.ToByte) -> Node:
        return self._values.byte(self._expr(node.value))

    def _load(self, node: ir.Load) -> Node:
        address = self._address_of(node.address)
        if self._zeros.known(address):
            return self._values.false
        byte, read = self._memory.load(address)
        if read:
            self._done.items.append(Item("load", (byte,)))
        return byte

    def _neighbour(self, node: ir.Neighbour) -> Node:
        number = DIRECTIONS.index(self._choice(node.direction))
        return self._values.neighbour(self._expr(node.value), number)

    def _input(self, _node: ir.Input) -> Node:
        return self._values.received()

    def _any_of(self, node: ir.AnyOf) -> Node:
        mask, bit = self._regions.mask(), self._expr(node.value)
        return self._values.any_of(bit if mask is None else self._values.both(mask, bit))

    def _count(self, node: ir.Expr) -> int:
        return ir.constant(node, self._fields) & 255

    def _optional(self, node: ir.Expr | None) -> Node | None:
        return None if node is None else self._expr(node)

    def _address_of(self, node: ir.Expr) -> Node:
        """An address that wraps at the end of the memory."""
        return self._values.and_(self._expr(node), self._values.constant(self._last_byte))
