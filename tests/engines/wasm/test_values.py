"""The simplifications of the compiled engine: random expressions against plain arithmetic."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np
import pytest

from npchip.engines.wasm.translate.builder import ValueBuilder
from npchip.engines.wasm.translate.values import CONSTANT, UNIFORM, VARYING, Value
from tests.support.profiles import THOROUGH

LANES = 256
EXPRESSIONS = 20_000 if THOROUGH else 250
BYTE_LEAVES, BIT_LEAVES = 3, 3

Lanes = Any
"""int64, shape (LANES,)."""


def meaning(node: Value, leaves: list[Lanes], seen: dict[Value, Lanes]) -> Lanes:
    """Compute a node; bits are 0 and 1."""
    if node not in seen:
        seen[node] = _meaning(node, [meaning(arg, leaves, seen) for arg in node.args], leaves)
    return seen[node]


def _meaning(node: Value, args: list[Lanes], leaves: list[Lanes]) -> Lanes:
    match node.op:
        case "const":
            return np.full(LANES, node.number)
        case "leaf":
            return leaves[node.number]
        case "add":
            return np.bitwise_and(args[0] + args[1], 255)
        case "sub":
            return args[0] - args[1] & 255
        case "sub_sat":
            return np.maximum(args[0] - args[1], 0)
        case "and" | "both":
            return args[0] & args[1]
        case "or" | "either":
            return args[0] | args[1]
        case "xor":
            return args[0] ^ args[1]
        case "shl":
            return np.bitwise_and(args[0] << node.number, 255)
        case "shr":
            return args[0] >> node.number
        case "byte":
            return args[0]
        case "mask":
            return args[0] * 255
        case "not":
            return 1 - args[0]
        case "eq":
            return (args[0] == args[1]).astype(np.int64)
        case "ge":
            return (args[0] >= args[1]).astype(np.int64)
        case "bit":
            return args[0] >> node.number & 1
        case "select":
            return np.where(args[0] == 1, args[1], args[2])
        case "any":
            return np.full(LANES, args[0].max())
    raise AssertionError(node.op)


class Expressions:
    """Draws random nodes together with what they must compute."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.values = ValueBuilder()
        rng = np.random.default_rng(random.randrange(1 << 30))
        self.leaves: list[Lanes] = []
        made: list[tuple[Value, Lanes]] = []
        for variable in range(BYTE_LEAVES + BIT_LEAVES):
            kind = random.choice([UNIFORM, VARYING, VARYING])
            top = 256 if variable < BYTE_LEAVES else 2
            lanes = rng.integers(0, top, LANES if kind == VARYING else 1)
            self.leaves.append(np.broadcast_to(lanes, LANES).copy())
            made.append((self.values.leaf(variable, kind), self.leaves[-1]))
        self.bytes = made[:BYTE_LEAVES]
        self.bits = made[BYTE_LEAVES:]
        for number in (0, 1, 127, 128, 255, random.randrange(256)):
            self.bytes.append((self.values.constant(number), np.full(LANES, number)))
        for number in (0, 1):
            self.bits.append((self.values.constant(number), np.full(LANES, number)))

    def grow(self) -> None:
        """Make one more node."""
        values, random = self.values, self.random
        (a, x), (b, y) = random.choice(self.bytes), random.choice(self.bytes)
        (p, s), (q, t) = random.choice(self.bits), random.choice(self.bits)
        (r, u), count = random.choice(self.bits), random.randrange(9)
        table: dict[str, list[Callable[[], tuple[Value, Any]]]] = {
            "byte": [
                lambda: (values.add(a, b), x + y & 255),
                lambda: (values.sub(a, b), x - y & 255),
                lambda: (values.and_(a, b), x & y),
                lambda: (values.or_(a, b), x | y),
                lambda: (values.xor(a, b), x ^ y),
                lambda: (values.invert(a), 255 - x),
                lambda: (values.shift_left(a, count), x << count & 255),
                lambda: (values.shift_right(a, count), x >> count),
                lambda: (values.byte(p), s),
                lambda: (values.mask(p), s * 255),
                lambda: (values.select(p, a, b), np.where(s == 1, x, y)),
                lambda: (
                    values.select(values.lower(a, b), values.false, values.sub(a, b)),
                    np.maximum(x - y, 0),
                ),
            ],
            "bit": [
                lambda: (values.not_(p), 1 - s),
                lambda: (values.both(p, q), s & t),
                lambda: (values.either(p, q), s | t),
                lambda: (values.select_bit(p, q, values.not_(q)), np.where(s == 1, t, 1 - t)),
                lambda: (values.select_bit(p, q, r), np.where(s == 1, t, u)),
                lambda: (values.equal(a, b), (x == y).astype(np.int64)),
                lambda: (values.lower(a, b), (x < y).astype(np.int64)),
                lambda: (values.bit(a, count), x >> (count & 7) & 1),
                lambda: (values.carry(a, b, None), (x + y) >> 8),
                lambda: (values.carry(a, b, p), (x + y + s) >> 8),
                lambda: (values.borrow(a, b, None), (x < y).astype(np.int64)),
                lambda: (values.borrow(a, b, p), (x - y - s < 0).astype(np.int64)),
                lambda: (values.any_of(p), np.full(LANES, s.max())),
            ],
        }
        kind = random.choice(["byte", "byte", "bit"])
        node, lanes = random.choice(table[kind])()
        (self.bytes if kind == "byte" else self.bits).append((node, lanes))


@pytest.mark.parametrize("share", range(4))
def test_simplified_expressions_mean_the_same(share: int) -> None:
    for seed in range(share * EXPRESSIONS, (share + 1) * EXPRESSIONS):
        made = Expressions(Random(seed))
        for _ in range(12):
            made.grow()
        seen: dict[Value, Lanes] = {}
        for node, lanes in made.bytes + made.bits:
            found = meaning(node, made.leaves, seen)
            np.testing.assert_array_equal(found, lanes, err_msg=f"seed {seed}: {node.op}")
            if node.kind != VARYING:
                assert (lanes == lanes[0]).all()
            if node.kind == CONSTANT:
                assert node.number == lanes[0]


def test_equal_expressions_are_one_node() -> None:
    values = ValueBuilder()
    a, b = values.leaf(0, VARYING), values.leaf(1, VARYING)
    assert values.add(a, b) is values.add(a, b)
    assert values.sub(values.add(a, values.constant(3)), values.constant(3)) is a
    assert values.carry(a, a, values.leaf(17, VARYING)) is values.bit(a, 7)
    assert values.borrow(a, a, None) is values.false
    lower = values.lower(a, b)
    assert values.select(lower, values.false, values.sub(a, b)).op == "sub_sat"


@pytest.mark.parametrize("bits", [False, True])
def test_a_choice_between_values_is_made_once(bits: bool) -> None:
    values = ValueBuilder()
    a, b, c, p, q = (values.leaf(number, VARYING) for number in range(5))
    select = values.select_bit if bits else values.select
    assert select(p, a, a) is a
    assert select(values.true, a, b) is select(values.false, b, a) is a
    assert select(p, a, select(q, b, c)) is not select(p, a, c)
    if not bits:
        assert select(p, a, select(p, b, c)) is select(p, a, c)
        assert select(values.not_(p), a, b) is select(p, b, a)
        nothing = values.false
        assert select(p, a, nothing) is values.and_(a, values.mask(p))
        assert select(p, nothing, a) is values.and_(a, values.mask(values.not_(p)))
        assert select(p, a, select(values.not_(p), b, nothing)).args[2] is b


def test_a_comparison_with_a_constant_is_one_of_the_byte_itself() -> None:
    values = ValueBuilder()
    a, b, p = values.leaf(0, VARYING), values.leaf(1, VARYING), values.leaf(17, VARYING)
    number = values.constant
    assert values.equal(number(5), a) is values.equal(a, number(5))
    assert values.equal(values.add(a, number(3)), number(1)) is values.equal(a, number(254))
    assert values.equal(values.sub(a, b), number(0)) is values.equal(a, b)
    assert values.equal(values.byte(p), number(1)) is values.equal(values.mask(p), number(255)) is p
    assert values.equal(values.byte(p), number(0)) is values.not_(p)


@pytest.mark.parametrize("operation", ["lower", "equal", "add", "sub", "and_", "or_", "xor"])
def test_operations_with_each_constant(operation: str) -> None:
    """Some constants have code of their own."""
    bytes_ = np.arange(256)
    truth: dict[str, Callable[[Any, Any], Any]] = {
        "lower": lambda x, y: x < y,
        "equal": lambda x, y: x == y,
        "add": lambda x, y: x + y & 255,
        "sub": lambda x, y: x - y & 255,
        "and_": lambda x, y: x & y,
        "or_": lambda x, y: x | y,
        "xor": lambda x, y: x ^ y,
    }
    values = ValueBuilder()
    a, apply = values.leaf(0, VARYING), getattr(values, operation)
    for number in range(256):
        constant = values.constant(number)
        for left, right in ((a, constant), (constant, a)):
            x, y = (bytes_ if value is a else number for value in (left, right))
            found = meaning(apply(left, right), [bytes_], {})
            assert np.array_equal(found, truth[operation](x, y)), number
