"""One block's instructions executed on values: the intermediate form to a graph of nodes.

The same execution serves every analysis: with what is known of the variables when a block begins,
its result tells what is known when it ends, and what each value depends on.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from npchip.engines.wasm.executed import (
    CARRY,
    DIRECTIONS,
    MASKS,
    SAME,
    ZERO,
    Executed,
    Item,
    Known,
    Site,
    Terms,
    is_bit,
)
from npchip.engines.wasm.graph import Block, Place, Step, constant
from npchip.engines.wasm.memory import Memory
from npchip.engines.wasm.nodes import Node
from npchip.engines.wasm.values import Values
from npchip.engines.wasm.zeros import Zeros
from npchip.isa import Isa, ir
from npchip.isa.ir import Type
from npchip.isa.model import Form

_FLAGS: Final = {"Z": ZERO, "C": CARRY}
_EVERY: Final[Terms] = ((-1, 1),)


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
        self._begin = begin
        self._now: dict[int, Node] = {}
        self._done = Executed(outs=self._now)
        self._memory = Memory(values, self._last_byte)
        self._zeros = self.zeros(block, zeros)
        # For each open region what was written in it, as its active NPs see it. What all NPs have
        # is put together where the region ends: by then most of it has been written over.
        self._inside: list[dict[int, Node]] = [{} for _ in range(block.first.place.depth)]
        # How many NPs are active in each open region, as far as it is known in this block.
        self._actives: list[Terms | None] = [_EVERY, *[None] * block.first.place.depth]
        self._counted: dict[tuple[Place, bool], tuple[int, int]] = {}
        self._guard: Node | None = None  # the wire under which the steps at hand are done
        end = 0
        for index, step in enumerate(block.steps):
            if index == end:
                self._end_guard()
            assert step.decoded is not None
            self._fields = step.decoded.values
            self._depth = step.place.depth
            self._at = step.place
            if self._profile:
                self._done.reach.append(self._reach(behind=False))
            self._locals: dict[str, Node] = {}
            self._everywhere = self._looks_around(step.decoded.form)
            for statement in step.decoded.form.statements:
                self._statements[statement.__class__](statement)
                if values.deep:
                    self._done.items += [Item("keep", (node,)) for node in values.deep]
                    values.deep.clear()
            if self._profile and self._depth > step.place.depth:
                self._done.entered[index] = self._reach(behind=True)
            if step.guards:
                self._begin_guard(index, when=step.when)
                end = index + 1 + step.guards
        self._end_guard()
        for region in range(len(self._inside), 0, -1):
            self._end_region(self._read(MASKS + region - 1))
        if len(block.after) < 2:  # the last branch was one whose wire is known
            self._done.wire = None
        return self._done

    def _begin_guard(self, index: int, *, when: bool) -> None:
        """What follows is only done where the wire is `when`."""
        wire = self._done.wire
        assert wire is not None
        self._guard = wire if when else self._values.not_(wire)
        self._done.guards[index] = self._guard
        self._inside.append({})
        self._actives.append(None)

    def _end_guard(self) -> None:
        if self._guard is not None:
            self._end_region(self._guard)
            self._guard = None
            self._actives.pop()

    def _end_region(self, mask: Node) -> None:
        """Let the region around see what was written in the innermost one."""
        written = self._inside.pop()
        around = self._inside[-1] if self._inside else self._now
        for variable, value in written.items():
            around[variable] = self._chosen(variable)(mask, value, self._active(variable))

    def _chosen(self, variable: int) -> Callable[[Node, Node, Node], Node]:
        return self._values.select_bit if is_bit(variable) else self._values.select

    def _looks_around(self, form: Form) -> bool:
        """Whether NPs see values of others, which may be inactive."""
        found = self._looking.get(id(form))
        if found is None:
            found = any(isinstance(node, ir.Neighbour) for node in form.nodes())
            self._looking[id(form)] = found
        return found

    def _reach(self, *, behind: bool) -> Terms:
        """How many NPs are active; counted only where that does not follow from other counts.

        Unrolled passes add to the number of the first one, for which it is said.

        Args:
            behind: whether the step has been executed.
        """
        found = self._actives[-1]
        if found is None:
            mask = self._mask()
            assert mask is not None
            key = self._at, behind
            number, times = self._counted.get(key, (-1, self._profile))
            if times < self._profile:
                found = ()
            else:
                number, times = self._done.masks, 0
                found = ((number, 1),)
                self._done.masks += 1
            self._counted[key] = number, times + 1
            self._done.items.append(Item("count", (mask,), number=number))
            self._actives[-1] = found
        return found

    # ---- variables

    def _read(self, variable: int) -> Node:
        """What a variable holds outside of all regions."""
        node = self._now.get(variable)
        if node is not None:
            return node
        what = self._begin[variable]
        self._done.reads.add(variable)
        if what < SAME:
            return self._values.constant(what)
        return self._values.leaf(variable, what - SAME + 1)

    def _mask(self) -> Node | None:
        if not self._depth:
            return self._guard
        mask = self._read(MASKS + self._depth - 1)
        return mask if self._guard is None else self._values.both(mask, self._guard)

    def _active(self, variable: int) -> Node:
        """What the active NPs have in a variable, which is less to compute than what all have."""
        for written in reversed(self._inside):
            node = written.get(variable)
            if node is not None:
                return node
        return self._read(variable)

    def _all(self, variable: int) -> Node:
        """What all NPs have in a variable."""
        assert self._guard is None  # its region has no plane; `convert` sees to that
        node = self._read(variable)
        for region, written in enumerate(self._inside):
            if variable in written:
                mask = self._read(MASKS + region)
                node = self._chosen(variable)(mask, written[variable], node)
        return node

    def _seen(self, variable: int) -> Node:
        return self._all(variable) if self._everywhere else self._active(variable)

    def _write(self, variable: int, value: Node) -> None:
        (self._inside[-1] if self._inside else self._now)[variable] = value

    # ---- statements

    def _set_register(self, node: ir.SetRegister) -> None:
        self._write(int(self._fields[node.name]), self._expr(node.value))

    def _set_flag(self, node: ir.SetFlag) -> None:
        self._write(_FLAGS[node.name], self._expr(node.value))

    def _set_local(self, node: ir.SetLocal) -> None:
        self._locals[node.name] = self._expr(node.value)

    def _store(self, node: ir.Store) -> None:
        address, value, mask = self._address_of(node.address), self._expr(node.value), self._mask()
        item = Item("store", (address, value), mask)
        self._done.items.append(item)
        self._memory.store(address, value, mask)
        self._zeros.change(item)

    def _effect(self, node: ir.Effect) -> None:
        values, args = self._fields, node.args
        guard = None if node.guard is None else self._expr(node.guard)
        match node.name:
            case "mask_push":
                bit = self._expr(args[0])
                mask = self._mask()
                self._now[MASKS + self._depth] = (
                    bit if mask is None else self._values.both(mask, bit)
                )
                self._depth += 1
                self._inside.append({})
                self._actives.append(None)
            case "mask_invert":
                self._end_region(self._read(MASKS + self._depth - 1))
                self._inside.append({})
                others = self._values.not_(self._read(MASKS + self._depth - 1))
                if self._depth > 1:
                    others = self._values.both(self._read(MASKS + self._depth - 2), others)
                self._now[MASKS + self._depth - 1] = others
                outer, inner = self._actives[-2:]
                self._actives[-1] = (
                    None
                    if outer is None or inner is None
                    else (*outer, *((number, -sign) for number, sign in inner))
                )
            case "mask_pop":
                self._depth -= 1
                self._end_region(self._read(MASKS + self._depth))
                self._now.pop(MASKS + self._depth, None)
                self._actives.pop()
            case "output":
                site = Site(self._at.address, constant(args[0], values))
                value = (self._expr(args[1]),)
                self._done.items.append(Item("send", value, self._mask(), guard, site=site))
            case "sample":
                signal = self._choice(args[0]) == "signal"
                bank = constant(args[1], values)
                item = Item("sample", (), self._mask(), guard, bank=bank, signal=signal)
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
            return self._values.constant(constant(node, self._fields) & 255)
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
        mask, bit = self._mask(), self._expr(node.value)
        return self._values.any_of(bit if mask is None else self._values.both(mask, bit))

    def _count(self, node: ir.Expr) -> int:
        return constant(node, self._fields) & 255

    def _optional(self, node: ir.Expr | None) -> Node | None:
        return None if node is None else self._expr(node)

    def _address_of(self, node: ir.Expr) -> Node:
        """An address that wraps at the end of the memory."""
        return self._values.and_(self._expr(node), self._values.constant(self._last_byte))
