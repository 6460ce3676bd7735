"""Code of constant and uniform values: one number for all NPs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from npchip.engines.wasm.emit.encode import I32, V128, Function
from npchip.engines.wasm.translate.summary import is_bit
from npchip.engines.wasm.translate.values import CONSTANT, UNIFORM, Value

_BITS: Final = frozenset({"eq", "ge", "bit", "not", "both", "either", "any"})
_BYTE: Final = " i32.const 255 i32.and"
_SCALAR: Final = {
    "add": "i32.add" + _BYTE,
    "sub": "i32.sub" + _BYTE,
    "and": "i32.and",
    "or": "i32.or",
    "xor": "i32.xor",
    "shl": "i32.const {number} i32.shl" + _BYTE,
    "shr": "i32.const {number} i32.shr_u",
    "eq": "i32.eq",
    "ge": "i32.ge_u",
    "both": "i32.and",
    "either": "i32.or",
    "not": "i32.eqz",
    "bit": "i32.const {number} i32.shr_u i32.const 1 i32.and",
    "byte": "",
    "mask": "i32.sub" + _BYTE,  # from 0
    "select": "select",
}
"""Code of the operations, after that of their operands."""


class Scalars:
    """Writes constant and uniform values.

    Args:
        out: the function to write to.
        home: returns the local of a uniform variable.
    """

    def __init__(self, out: Function, home: Callable[[int], int]) -> None:
        self._out = out
        self._home = home
        self._pools: dict[int, list[int]] = {}
        self._taken: dict[int, int] = {}
        self._splats: dict[Value, int] = {}

    def free(self) -> None:
        """Free all temporaries, at the beginning of a block."""
        self._taken.clear()
        self._splats.clear()

    def temporary(self, kind: int) -> int:
        """Return a local that nothing else uses until the end of the block."""
        pool = self._pools.setdefault(kind, [])
        number = self._taken.get(kind, 0)
        self._taken[kind] = number + 1
        if number == len(pool):
            pool.append(self._out.local(kind))
        return pool[number]

    def scalar(self, value: Value) -> None:
        """Push the number of a constant or uniform value."""
        out = self._out
        if value.kind == CONSTANT:
            out.i32(value.number)
        elif value.op == "leaf":
            out.get(self._home(value.number))
        elif value.temp >= 0:
            out.get(value.temp)
        else:
            self._compute_scalar(value)
            if value.uses > 1:
                value.temp = self.temporary(I32)
                out.tee(value.temp)

    def materialize_scalar(self, value: Value) -> None:
        """Compute a uniform value now, into a local that `scalar` will push."""
        if value.kind == UNIFORM and value.op != "leaf" and value.temp < 0:
            self._compute_scalar(value)
            value.temp = self.temporary(I32)
            self._out.set(value.temp)

    def splat(self, value: Value, *, keep: bool = True) -> int:
        """Return a local with a constant or uniform value in all lanes, a bit as 0 or 255.

        With `keep`, later calls in the block return the same local.
        """
        local = self._splats.get(value)
        if local is None:
            local = self.temporary(V128)
            if keep:
                self._splats[value] = local
            self.scalar(value)
            if value.op in _BITS or (value.op == "leaf" and is_bit(value.number)):
                number = self.temporary(I32)
                self._out.write(f"local.set {number} i32.const 0 local.get {number} i32.sub")
            self._out.write(f"i8x16.splat local.set {local}")
        return local

    def _compute_scalar(self, value: Value) -> None:
        op, args = value.op, value.args
        if op == "mask":
            self._out.i32(0)
        if op == "select":
            args = (args[1], args[2], args[0])
        for arg in args:
            self.scalar(arg)
        self._out.write(_SCALAR[op].format(number=value.number))
