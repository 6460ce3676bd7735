"""Bytes that are partly known: what is said of their bits is true, and all of it is said."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from npchip.program import bits

BYTES = st.integers(0, 255)


@given(st.tuples(BYTES, BYTES), st.tuples(BYTES, BYTES), st.booleans(), st.sampled_from([0, 1]))
def test_what_is_said_of_bits_is_true(
    one: tuple[int, int], other: tuple[int, int], carry: bool, known_carry: int
) -> None:
    (a, known_a), (b, known_b) = one, other
    x: bits.Bits = known_a, a & known_a
    y: bits.Bits = known_b, b & known_b
    c: bits.Bits = known_carry, int(carry) & known_carry

    def check(said: bits.Bits, truth: int) -> None:
        assert (said[1] ^ truth) & said[0] == 0
        assert said[1] & ~said[0] == 0
        assert 0 <= said[0] <= 255

    for said, total in (
        (bits.add(x, y, c), a + b + carry),
        (bits.subtract(x, y, c), a - b - carry),
    ):
        check(said[0], total & 255)
        check(said[1], int(not 0 <= total < 256))
    check(bits.both(x, y), a & b)
    check(bits.either(x, y), a | b)
    check(bits.differ(x, y), a ^ b)
    check(bits.complement(x), ~a & 255)
    check(bits.equal(x, y), int(a == b))
    check(bits.lower(x, y), int(a < b))
    for count in (*range(10), b, 256 + b % 10):  # a shift takes its count modulo 256
        check(bits.shift_left(x, count), a << (count & 255) & 255)
        check(bits.shift_right(x, count), a >> (count & 255))
    for value in (a, b):
        check(bits.join(bits.constant(a), bits.constant(b)), value)
    assert bits.least(x) <= a <= bits.most(x)


@given(BYTES, BYTES, st.booleans())
def test_of_what_is_known_all_is_said(a: int, b: int, carry: bool) -> None:
    total, out = bits.add(bits.constant(a), bits.constant(b), bits.bit(carry))
    assert (total, out) == (bits.constant(a + b + carry), bits.bit(a + b + carry > 255))
    left, borrow = bits.subtract(bits.constant(a), bits.constant(b), bits.bit(carry))
    assert (left, borrow) == (bits.constant(a - b - carry), bits.bit(a - b - carry < 0))
    assert bits.shift_left(bits.constant(a), b) == bits.constant(a << b)
    assert bits.shift_right(bits.constant(a), b) == bits.constant(a >> b)
    assert bits.truth(bits.lower(bits.constant(a), bits.constant(b))) is (a < b)
    assert bits.truth(bits.equal(bits.constant(a), bits.constant(b))) is (a == b)
