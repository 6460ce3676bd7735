"""The parts of the compiled engine, each with the one thing to replace so that it does nothing.

The engine itself has no switches: `benchmarks.ablation` replaces a function, class or constant
while it translates. A part that is new or gone is one entry more or less in `PARTS`.
"""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final
from unittest import mock

_ENGINE: Final = "npchip.engines.wasm"
_ALWAYS: Final = 1 << 30


@dataclass
class Part:
    """A part of the engine.

    Attributes:
        name: its name.
        target: what is replaced, as a name below `npchip.engines.wasm`.
        instead: takes the original and returns what takes its place.
        serves: the code that only serves this part: names as in `target`.
    """

    name: str
    target: str
    instead: Callable[[Any], Any]
    serves: Sequence[str] = ()

    def without(self) -> AbstractContextManager[object]:
        """Give a time in which the engine translates without the part.

        Raises:
            AttributeError: the engine has nothing by the name of the target.
        """
        return mock.patch(f"{_ENGINE}.{self.target}", self.instead(found(self.target)))

    @cached_property
    def lines(self) -> int:
        """Number of lines that only serve it, without empty ones."""
        sources = [inspect.getsource(found(name)) for name in self.serves]
        return sum(bool(line.strip()) for source in sources for line in source.splitlines())


def found(name: str) -> Any:
    """Return a module of the compiled engine, or what is in one.

    Raises:
        AttributeError: there is nothing by that name.
    """
    module, rest = importlib.import_module(_ENGINE), name.split(".")
    while rest:
        try:
            module = importlib.import_module(f"{module.__name__}.{rest[0]}")
        except ModuleNotFoundError:
            break
        del rest[0]
    result: Any = module
    for attribute in rest:
        result = getattr(result, attribute)
    return result


# ---- what takes the place of a part


def _number(value: object) -> Callable[[Any], Any]:
    """Replace a constant."""
    return lambda _: value


def _weakest(facts: Callable[[int, int], int]) -> Callable[[Any], Any]:
    """Replace `analysis._join` by one that weakens facts more, given those of both sides."""
    summary = found("translate.summary")

    def join(now: dict[int, int], end: dict[int, int], depth: int) -> set[int]:
        if not now:
            variables = range(summary.MASKS + depth)
            now.update({variable: facts(end[variable], end[variable]) for variable in variables})
            return set()
        weaker = {variable: facts(fact, end[variable]) for variable, fact in now.items()}
        changed = {variable for variable, fact in weaker.items() if fact != now[variable]}
        now.update(weaker)
        return changed

    return lambda _: join


def _varying(a: int, b: int) -> int:
    """Know only what both the entry and all paths agree on, which is what block 0 begins with."""
    return a if a == b and a < 0 else int(found("translate.summary").ANY)


def _uniform(a: int, b: int) -> int:
    """Tell uniform from varying, but no number from another."""
    summary = found("translate.summary")
    return int(summary.ANY if summary.ANY in (a, b) else summary.SAME)


def _folding(builder: Any) -> Any:
    """Replace `ValueBuilder` by one that folds constants and simplifies nothing else."""

    def plain(name: str, op: str) -> Callable[..., Any]:
        original = getattr(builder, name)

        def make(self: Any, *args: Any) -> Any:
            if all(arg.kind == 0 for arg in args):
                return original(self, *args)
            return self._value(op, *args)

        return make

    def select(self: Any, bit: Any, a: Any, b: Any) -> Any:
        if bit.kind == 0:
            return a if bit.number else b
        return self._value("select", bit, a, b)

    def lower(self: Any, a: Any, b: Any) -> Any:
        if a.kind == b.kind == 0:
            return self.constant(int(a.number < b.number))
        return self.not_(self._value("ge", a, b))

    methods = {name: plain(name, op) for name, op in _OPERATIONS.items()}
    return type("Folding", (builder,), {**methods, "select": select, "lower": lower})


_OPERATIONS: Final = {
    "add": "add",
    "sub": "sub",
    "and_": "and",
    "or_": "or",
    "xor": "xor",
    "equal": "eq",
    "both": "both",
    "either": "either",
    "byte": "byte",
    "mask": "mask",
    "not_": "not",
}


def _select_at_once(_: Any) -> Any:
    """Replace `Regions.write`: merge with the inactive NPs at each write."""

    def write(self: Any, variable: int, value: Any) -> None:
        mask = self.mask()
        if mask is not None:
            value = self._select(variable)(mask, value, self.read(variable))
        self._now[variable] = value

    return write


def _read_again(_: Any) -> Any:
    """Replace `Memory.load`: read the memory each time."""

    def load(self: Any, address: Any) -> tuple[Any, bool]:
        self._version += 1
        return self._values.load(address, self._version), True

    return load


def _forgetful(original: Any) -> Any:
    """Replace `_value`: make equal values anew, but for loads and values without operands."""

    def value(self: Any, op: str, *args: Any, number: int = 0, kind: int = -1) -> Any:
        if args and op != "load":
            self._made.pop((op, args, number), None)
        return original(self, op, *args, number=number, kind=kind)

    return value


def _all_live(_: Any) -> Any:
    """Replace `liveness`: all variables live everywhere."""
    masks = found("translate.summary").MASKS
    return lambda blocks, *_: [(1 << masks + block.first.place.depth) - 1 for block in blocks]


PARTS: Final = (
    Part(
        "uniformity",
        "translate.analysis._join",
        _weakest(_varying),
        ("translate.analysis.uniformity", "translate.analysis._join"),
    ),
    Part("constants between blocks", "translate.analysis._join", _weakest(_uniform)),
    Part(
        "value simplification",
        "translate.block.ValueBuilder",
        _folding,
        [
            f"translate.builder.ValueBuilder.{name}"
            for name in (*_OPERATIONS, "select", "lower", "select_bit", "carry")
        ],
    ),
    Part(
        "unrolling",
        "translation.unroll",
        _number(lambda *_: None),
        ("translate.unroll", "translate.trip_count"),
    ),
    Part("unrolling budget", "translate.unroll._MOST", _number(_ALWAYS)),
    Part("liveness", "translation.liveness", _all_live, ("translate.analysis.liveness",)),
    Part(
        "masked regions",
        "translate.regions.Regions.write",
        _select_at_once,
        [
            f"translate.regions.Regions.{name}"
            for name in ("_end", "active", "everywhere", "close", "write")
        ],
    ),
    Part(
        "zero banks",
        "translation.use_zeros",
        _number(lambda *_: None),
        (
            *(f"translate.analysis.{name}" for name in ("use_zeros", "_keeps")),
            "translate.memory.ZeroBytes",
        ),
    ),
    Part(
        "store-to-load forwarding",
        "translate.memory.Memory.load",
        _read_again,
        ("translate.memory.Memory",),
    ),
    Part("code for each vector", "emit.vector_loop.LOOPED", _number(0)),
    Part(
        "rolled loops",
        "emit.vector_loop.LOOPED",
        _number(_ALWAYS),
        ("emit.vector_loop.LoopWriter._control",),
    ),
    Part(
        "if-conversion",
        "translation.convert",
        _number(lambda blocks, _: blocks),
        (
            "translate.if_conversion",
            "translate.regions.Regions.begin_guard",
            "translate.regions.Regions.end_guard",
            "emit.emitter.Emitter._count_guarded",
        ),
    ),
    Part(
        "dead flags",
        "translate.block.needed",
        _number(lambda steps: [step.decoded.form.statements for step in steps]),
        ("translate.flags",),
    ),
    Part("common subexpressions", "translate.values.ValueNumbering._value", _forgetful),
    Part(
        "ends of chains",
        "translate.values._LONGEST_CHAIN",
        _number(_ALWAYS),
        ("emit.effects.Effects._compute",),
    ),
    Part(
        "paused collector",
        "host.engine.translate",
        lambda original: original.__wrapped__,
        ("translation._uncollected",),
    ),
)
