"""Lowering of the intermediate form to NumPy closures.

Each node becomes a function without arguments that reads the current state. A byte is a uint8 array
of shape (R, C), a bit a bool array. Constants are arrays, too, as scalars are slower in NumPy.
"""

from __future__ import annotations

import operator
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from npchip.engines.base import Request, TrapError
from npchip.engines.state import ChipState, Write
from npchip.isa import Decoded, Isa, ir

Plane = Any
"""A uint8 or bool array, shape (R, C); for a wire a bool, for a constant an int or str."""

Evaluate = Callable[[], Plane]
Execute = Callable[[], None]

_ALL: Final = slice(None)
# The (destination, source) slices of the array, by the direction of the neighbour.
_NEIGHBOURS: Final[Mapping[str, tuple[tuple[slice, slice], tuple[slice, slice]]]] = {
    "north": ((slice(1, None), _ALL), (slice(None, -1), _ALL)),
    "south": ((slice(None, -1), _ALL), (slice(1, None), _ALL)),
    "west": ((_ALL, slice(1, None)), (_ALL, slice(None, -1))),
    "east": ((_ALL, slice(None, -1)), (_ALL, slice(1, None))),
}


class Environment(ABC):
    """The engine, as the closures use it.

    Attributes:
        state: state of the chip.
        active: active NPs: bool, shape (R, C); None while all are active.
        written: list to which writes are appended; None if they are not recorded.
        effects: functions of the evaluated arguments that execute the effects.
    """

    state: ChipState
    active: NDArray[np.bool_] | None
    written: list[Write] | None
    effects: Mapping[ir.EffectName, Callable[..., None]]

    @abstractmethod
    def hear(self, request: Request) -> NDArray[np.uint8] | None:
        """Return the bytes from the partner; None without a partner or if it has sent nothing."""


def _unary(function: Callable[[Plane], Plane], a: Evaluate) -> Evaluate:
    return lambda: function(a())


def _binary(function: Callable[[Plane, Plane], Plane], a: Evaluate, b: Evaluate) -> Evaluate:
    return lambda: function(a(), b())


def _select(condition: Evaluate, then: Evaluate, otherwise: Evaluate) -> Evaluate:
    return lambda: np.where(condition(), then(), otherwise())


def _carry(a: Evaluate, b: Evaluate, c: Evaluate | None = None) -> Evaluate:
    if c is None:
        return lambda: a() + (addend := b()) < addend

    def carry() -> Plane:
        total = a() + (addend := b())
        return (total < addend) | (total + c().view(np.uint8) < total)

    return carry


def _borrow(a: Evaluate, b: Evaluate, c: Evaluate | None = None) -> Evaluate:
    if c is None:
        return lambda: a() < b()
    return lambda: ((x := a()) < (y := b())) | ((x == y) & c())


OPERATIONS: Final[dict[str, Callable[..., Evaluate]]] = {
    "+": partial(_binary, operator.add),
    "-": partial(_binary, operator.sub),
    "&": partial(_binary, operator.and_),
    "|": partial(_binary, operator.or_),
    "^": partial(_binary, operator.xor),
    "==": partial(_binary, operator.eq),
    "!=": partial(_binary, operator.ne),
    "<": partial(_binary, operator.lt),
    "<=": partial(_binary, operator.le),
    ">": partial(_binary, operator.gt),
    ">=": partial(_binary, operator.ge),
    "and": partial(_binary, operator.and_),
    "or": partial(_binary, operator.or_),
    "not": partial(_unary, operator.invert),
    "~": partial(_unary, operator.invert),
    "not_wire": partial(_unary, operator.not_),
    "select": _select,
    "select_bit": _select,
    "byte": partial(_unary, lambda bit: bit.view(np.uint8)),
    "carry": _carry,
    "borrow": _borrow,
}
"""Operations that do not depend on the engine, by their names in `ir.OPERATIONS`."""


class Lowering(ir.Evaluator[Evaluate]):
    """Lowers decoded words for an engine."""

    def __init__(self, isa: Isa, engine: Environment) -> None:
        super().__init__(isa.meanings)
        self.number, self.read = self._full, self._variable
        self.operations = OPERATIONS | {
            "<<": lambda value, count: _binary(operator.lshift, value, self._full(count)),
            ">>": lambda value, count: _binary(operator.rshift, value, self._full(count)),
            "bit": self._bit,
            "row": lambda: self._position(0),
            "column": lambda: self._position(1),
            "load": self._load,
            "neighbour": self._neighbour,
            "input": self._input,
            "any": self._any,
        }
        self._engine = engine
        self._state = engine.state
        self._shape = self._state.zero.shape
        # A flat view of the memory, in which the bytes of an NP are adjacent.
        self._memory = self._state.memory.transpose(1, 2, 0).reshape(-1)
        size = len(self._state.memory)
        self._first = np.arange(0, self._memory.size, size).reshape(self._shape)

    def lower(self, decoded: Decoded) -> list[Execute]:
        """Return the closures that execute a word, in order.

        The first ones receive its input, so that a trap leaves the state unchanged.
        """
        self.fields, self.locals = decoded.values, {}
        self._inputs: list[Execute] = []
        self._guarded = decoded.form.guarded
        statements = [self._statement(node) for node in decoded.form.statements]
        return [*self._inputs, *statements]

    # ---- statements

    def _statement(self, node: ir.Statement) -> Execute:
        match node:
            case ir.SetRegister(name=name, value=value):
                number = self.fields[name]
                register = self._state.registers[number]
                return self._write(register, value.evaluate(self), "register", number)
            case ir.SetFlag(name=name, value=value):
                flag = self._state.zero if name == "Z" else self._state.carry
                return self._write(flag, value.evaluate(self), "flag", name)
            case ir.SetLocal(name=name, value=value):
                return self._set_local(name, value.evaluate(self))
            case ir.Store(address=address, value=value):
                return self._store(address, value.evaluate(self))
            case ir.Effect():
                return self._effect(node)

    def _write(
        self,
        target: Plane,
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
        found: list[Plane] = [None]

        def set_local() -> None:
            # A copy, as the value may be a view that a later statement writes to.
            found[0] = evaluate().copy()

        self.locals[name] = lambda: found[0]
        return set_local

    def _store(self, address: ir.Expr, evaluate: Evaluate) -> Execute:
        if isinstance(address, ir.Immediate):
            number = self._wrapped(address)
            return self._write(self._state.memory[number], evaluate, "memory", number)
        engine, memory = self._engine, self._memory
        index = self._index(address.evaluate(self))
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
        execute = self._engine.effects[node.name]
        args = [arg.evaluate(self) for arg in node.args]

        def effect() -> None:
            execute(*[arg() if callable(arg) else arg for arg in args])

        if node.guard is None:
            return effect
        guard: Any = node.guard.evaluate(self)

        def guarded() -> None:
            if guard():
                effect()

        return guarded

    # ---- expressions

    def operation(self, node: ir.Operation) -> Evaluate:
        """Return the closure that evaluates an operation."""
        if node.op == "load" and isinstance(node.args[0], ir.Immediate):
            cell = self._state.memory[self._wrapped(node.args[0])]
            return lambda: cell
        return super().operation(node)

    def _full(self, value: int) -> Evaluate:
        byte = np.full(self._shape, value & 255, np.uint8)
        return lambda: byte

    def _variable(self, number: int) -> Evaluate:
        state = self._state
        flags = {ir.ZERO: state.zero, ir.CARRY: state.carry}
        plane = flags[number] if number in flags else state.registers[number]
        return lambda: plane

    def _position(self, axis: int) -> Evaluate:
        numbers = np.indices(self._shape).astype(np.uint8)[axis]
        return lambda: numbers

    def _bit(self, value: Evaluate, index: int) -> Evaluate:
        bit = self._full(1 << (index & 7))()
        return lambda: (value() & bit) == bit

    def _load(self, address: Evaluate) -> Evaluate:
        memory, index = self._memory, self._index(address)
        return lambda: memory[index()]

    def _wrapped(self, address: ir.Immediate) -> int:
        """Return a constant address, which wraps at the end of the memory."""
        return ir.constant(address.value, self.fields) & (len(self._state.memory) - 1)

    def _index(self, where: Evaluate) -> Evaluate:
        """Return the index of each NP's address in the flat memory; addresses wrap."""
        first, size = self._first, len(self._state.memory)
        if size == 256:  # a byte cannot exceed it
            return lambda: first + where().astype(np.intp)
        last = self._full(size - 1)()
        return lambda: first + (where() & last).astype(np.intp)

    def _neighbour(self, value: Evaluate, direction: str) -> Evaluate:
        to, source = _NEIGHBOURS[direction]
        shape = self._shape

        def neighbour() -> Plane:
            result = np.zeros(shape, np.uint8)  # 0 outside the array (decision)
            result[to] = value()[source]
            return result

        return neighbour

    def _input(self, port: int) -> Evaluate:
        state, engine = self._state, self._engine

        def receive() -> Plane:
            before = state.received.get(port, 0)
            request = Request(port, state.frames_taken - 1, before, state.frame_cycles)
            data = engine.hear(request)
            if data is None:
                often = "anything" if before == 0 else f"more than {before} bytes in this frame"
                raise TrapError("NP306", f"no partner has sent {often} to port {port}", state.pc)
            state.received[port] = before + 1
            return data

        if self._guarded:  # earlier statements may decide whether anything is received
            return receive
        received: list[Plane] = []

        def take() -> None:
            received[:] = [receive()]

        self._inputs.append(take)
        return lambda: received[0]

    def _any(self, bit: Evaluate) -> Evaluate:
        engine = self._engine

        def any_of() -> bool:
            value = bit()
            return bool((value if engine.active is None else value & engine.active).any())

        return any_of
