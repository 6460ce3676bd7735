"""The intermediate form of a word to NumPy closures: clear before fast.

Each node becomes a function of no arguments that reads the live state; constants are folded
when the word is decoded. A byte is a uint8 array of shape (R, C), a bit a bool array. (An array
is used for a constant too: with a scalar, NumPy takes three times as long.)
"""

from __future__ import annotations

import operator
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from npchip.engines.base import Request, TrapError
from npchip.engines.state import ChipState, Write
from npchip.isa import Decoded, Isa, ir
from npchip.isa.ir import Type

Value = Any
"""An array of uint8 or bool, shape (R, C); a bool for a wire, an int or str for a constant."""

Evaluate = Callable[[], Value]
Execute = Callable[[], None]

_OPERATORS: Final[Mapping[str, Callable[[Value, Value], Value]]] = {
    "+": operator.add,
    "-": operator.sub,
    "&": operator.and_,
    "|": operator.or_,
    "^": operator.xor,
    "<<": operator.lshift,
    ">>": operator.rshift,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "and": operator.and_,
    "or": operator.or_,
}
_ALL: Final = slice(None)
# Where an NP reads from, as (destination, source) slices of the array.
_NEIGHBOURS: Final[Mapping[str, tuple[tuple[slice, slice], tuple[slice, slice]]]] = {
    "north": ((slice(1, None), _ALL), (slice(None, -1), _ALL)),
    "south": ((slice(None, -1), _ALL), (slice(1, None), _ALL)),
    "west": ((_ALL, slice(1, None)), (_ALL, slice(None, -1))),
    "east": ((_ALL, slice(None, -1)), (_ALL, slice(1, None))),
}


class Effects(ABC):
    """What an engine must provide for the effects on the GCU and the devices."""

    state: ChipState
    active: NDArray[np.bool_] | None  # None while all NPs are active
    written: list[Write] | None  # takes what is written, if somebody asks

    @abstractmethod
    def hear(self, request: Request) -> NDArray[np.uint8] | None:
        """What the partner has sent; None where there is none, or it has sent nothing."""

    @abstractmethod
    def perform(self, name: ir.EffectName, args: tuple[Value, ...]) -> None:
        """Carry out an effect with evaluated arguments."""


class Lowering:
    """Lowers the statements of one decoded word for an engine.

    Attributes:
        inputs: take what the statements receive, before any of them does anything: where nothing
            has been sent, the state is that before the instruction.
    """

    def __init__(self, decoded: Decoded, isa: Isa, engine: Effects) -> None:
        self._values = decoded.values
        self._isa = isa
        self._engine = engine
        self._state = engine.state
        self._locals: dict[str, Value] = {}
        self.inputs: list[Execute] = []
        self._guarded = decoded.form.guarded
        self._shape = self._state.zero.shape
        # Memory as one line of bytes, a view: that of an NP lies together.
        self._memory = self._state.memory.transpose(1, 2, 0).reshape(-1)
        first = np.arange(self._state.zero.size) * len(self._state.memory)
        self._first = first.reshape(self._shape)

    # ---- statements

    def statement(self, node: ir.Statement) -> Execute:
        """The closure that executes a statement."""
        match node:
            case ir.SetRegister(name=name, value=value):
                number = self._number(name)
                register = self._state.registers[number]
                return self._write(register, self._operand(value), "register", number)
            case ir.SetFlag(name=name, value=value):
                flag = self._state.zero if name == "Z" else self._state.carry
                return self._write(flag, self.expr(value), "flag", name)
            case ir.SetLocal(name=name, value=value):
                return self._set_local(name, self._operand(value))
            case ir.Store(address=address, value=value):
                return self._store(address, self._operand(value))
            case ir.Effect():
                return self._effect(node)

    def _write(
        self,
        target: Value,
        evaluate: Evaluate,
        kind: Literal["register", "flag", "memory"],
        index: int | str,
    ) -> Execute:
        engine = self._engine

        def write() -> None:
            if engine.active is None:
                target[...] = evaluate()
            else:
                np.copyto(target, evaluate(), where=engine.active)
            if engine.written is not None:
                engine.written.append(Write(kind, index, engine.active))

        return write

    def _set_local(self, name: str, evaluate: Evaluate) -> Execute:
        table = self._locals

        def set_local() -> None:
            # A copy: what was read is a view, and a later statement may write to it.
            table[name] = evaluate().copy()

        return set_local

    def _store(self, address: ir.Expr, evaluate: Evaluate) -> Execute:
        if address.type is Type.CONST:
            number = self._constant(address) & (len(self._state.memory) - 1)
            return self._write(self._cell(address), evaluate, "memory", number)
        engine, memory, index = self._engine, self._memory, self._index(address)
        first = self._first

        def store() -> None:
            active, where = engine.active, index()
            if active is None:
                memory[where] = evaluate()
            else:
                memory[where[active]] = evaluate()[active]
            if engine.written is not None:
                addresses = (where - first).astype(np.uint8)
                engine.written.append(Write("memory", addresses, active))

        return store

    def _effect(self, node: ir.Effect) -> Execute:
        engine, name = self._engine, node.name
        if name == "output":  # what is sent are bytes, constants too
            args = [self.expr(node.args[0]), self._operand(node.args[1])]
        else:
            args = [self.expr(arg) for arg in node.args]

        def effect() -> None:
            engine.perform(name, tuple(arg() for arg in args))

        if node.guard is None:
            return effect
        guard = self.expr(node.guard)

        def guarded() -> None:
            if guard():
                effect()

        return guarded

    # ---- expressions

    def expr(self, node: ir.Expr) -> Evaluate:
        """The closure that evaluates an expression."""
        if node.type is Type.CONST:
            constant = self._constant(node)
            return lambda: constant
        state = self._state
        match node:
            case ir.Field(name=name):
                choice = self._values[name]
                return lambda: choice
            case ir.Register(name=name):
                register = state.registers[self._number(name)]
                return lambda: register
            case ir.Flag(name=name):
                flag = state.zero if name == "Z" else state.carry
                return lambda: flag
            case ir.Condition(name=name):
                return self.expr(self._isa.conditions[str(self._values[name])].when)
            case ir.Local(name=name):
                table = self._locals
                return lambda: table[name]
            case ir.Place(axis=axis):
                rows, columns = np.indices(self._shape).astype(np.uint8)
                return lambda: rows if axis == "row" else columns
            case ir.Binary(op=op, left=left, right=right):
                function, a, b = _OPERATORS[op], self._operand(left), self._operand(right)
                return lambda: function(a(), b())
            case ir.Not(value=value):
                a = self._operand(value)
                return lambda: ~a()
            case ir.NotWire(value=value):
                wire = self.expr(value)
                return lambda: not wire()
            case ir.BitOf(value=value, index=index):
                a, bit = self._operand(value), self._full(1 << (self._constant(index) & 7))
                return lambda: (a() & bit) == bit
            case ir.Select(condition=condition, then=then, otherwise=otherwise):
                test, a, b = self.expr(condition), self._operand(then), self._operand(otherwise)
                return lambda: np.where(test(), a(), b())
            case ir.Carry(left=left, right=right, carry=extra):
                return self._carry(left, right, extra)
            case ir.Borrow(left=left, right=right, borrow=extra):
                return self._borrow(left, right, extra)
            case ir.ToByte(value=value):
                bits = self.expr(value)
                return lambda: bits().view(np.uint8)
            case ir.Load(address=address):
                return self._load(address)
            case ir.Neighbour(value=value, direction=direction):
                return self._neighbour(self._operand(value), str(self._values[direction.name]))
            case ir.Input(port=port):
                return self._input(self._constant(port))
            case ir.AnyOf(value=value):
                return self._any(self.expr(value))
            case _:
                raise AssertionError(node)

    def _operand(self, node: ir.Expr) -> Evaluate:
        """As `expr`, with a constant as the byte that it is among bytes."""
        if node.type is not Type.CONST:
            return self.expr(node)
        byte = self._full(self._constant(node))
        return lambda: byte

    def _carry(self, left: ir.Expr, right: ir.Expr, extra: ir.Expr | None) -> Evaluate:
        a, b = self._operand(left), self._operand(right)
        if extra is None:
            return lambda: a() + (addend := b()) < addend
        c = self.expr(extra)

        def carry() -> Value:
            total = a() + (addend := b())
            return (total < addend) | (total + c().view(np.uint8) < total)

        return carry

    def _borrow(self, left: ir.Expr, right: ir.Expr, extra: ir.Expr | None) -> Evaluate:
        a, b = self._operand(left), self._operand(right)
        if extra is None:
            return lambda: a() < b()
        c = self.expr(extra)
        return lambda: ((x := a()) < (y := b())) | ((x == y) & c())

    def _load(self, address: ir.Expr) -> Evaluate:
        if address.type is Type.CONST:
            cell = self._cell(address)
            return lambda: cell
        memory, index = self._memory, self._index(address)
        return lambda: memory[index()]

    def _cell(self, address: ir.Expr) -> Value:
        memory = self._state.memory
        return memory[self._constant(address) & (len(memory) - 1)]

    def _index(self, address: ir.Expr) -> Evaluate:
        """Where each NP's own address lies in the line of bytes; it wraps at the end."""
        where, first, size = self.expr(address), self._first, len(self._state.memory)
        if size == 256:  # a byte wraps by itself
            return lambda: first + where().astype(np.intp)
        last = self._full(size - 1)
        return lambda: first + (where() & last).astype(np.intp)

    def _neighbour(self, value: Evaluate, direction: str) -> Evaluate:
        to, source = _NEIGHBOURS[direction]
        shape = self._shape

        def neighbour() -> Value:
            result = np.zeros(shape, np.uint8)  # outside the array lies 0 (decision)
            result[to] = value()[source]
            return result

        return neighbour

    def _input(self, port: int) -> Evaluate:
        state, engine = self._state, self._engine

        def receive() -> Value:
            before = state.received.get(port, 0)
            request = Request(port, state.frames_taken - 1, before, state.frame_cycles)
            data = engine.hear(request)
            if data is None:
                often = "anything" if before == 0 else f"more than {before} bytes in this frame"
                raise TrapError("NP306", f"no partner has sent {often} to port {port}", state.pc)
            state.received[port] = before + 1
            return data

        if self._guarded:  # whether anything is received may depend on what comes before
            return receive
        received: list[Value] = []

        def take() -> None:
            received[:] = [receive()]

        self.inputs.append(take)
        return lambda: received[0]

    def _any(self, bit: Evaluate) -> Evaluate:
        engine = self._engine

        def any_of() -> bool:
            value = bit()
            return bool((value if engine.active is None else value & engine.active).any())

        return any_of

    # ---- constants

    def _number(self, name: str) -> int:
        return int(self._values[name])

    def _constant(self, node: ir.Expr) -> int:
        match node:
            case ir.Const(value=value):
                return value
            case ir.Field(name=name):
                return self._number(name)
            case ir.Binary(op=op, left=left, right=right):
                return int(_OPERATORS[op](self._constant(left), self._constant(right)))
        raise AssertionError(node)

    def _full(self, value: int) -> Value:
        return np.full(self._shape, value & 0xFF, np.uint8)
