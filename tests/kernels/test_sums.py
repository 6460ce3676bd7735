"""Signed digits and what sums share."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from npchip.kernels.sums import Sums, Term, formula, share, signed_digits

WEIGHTS = st.dictionaries(
    st.tuples(st.sampled_from("pq"), st.integers(-2, 2)), st.integers(-40, 40), min_size=1
)


def expanded(terms: Sequence[Term], sums: Sums, place: int = 0) -> Counter[tuple[str, int]]:
    """Weights of the signals that are no sums."""
    weights: Counter[tuple[str, int]] = Counter()
    for term in terms:
        factor, at = term.sign << term.shift, place + term.at
        if term.signal in sums.shared:
            for key, weight in expanded(sums.shared[term.signal], sums, at).items():
                weights[key] += factor * weight
        else:
            weights[term.signal, at] += factor
    return weights


@given(st.integers(-40_000, 40_000))
def test_signed_digits_make_the_number_and_none_has_a_neighbour(number: int) -> None:
    digits = list(signed_digits(number))
    assert sum(sign << shift for shift, sign in digits) == number
    shifts = [shift for shift, _ in digits]
    assert all(later - earlier > 1 for earlier, later in pairwise(shifts))


@given(st.lists(WEIGHTS, min_size=1, max_size=3), st.booleans())
def test_sharing_leaves_every_sum_what_it_was(
    weights: list[dict[tuple[str, int], int]], split: bool
) -> None:
    sums = share({f"k{number}": one for number, one in enumerate(weights)}, "s", split=split)
    for number, one in enumerate(weights):
        found = expanded(sums.results[f"k{number}"], sums)
        assert {key: w for key, w in found.items() if w} == {key: w for key, w in one.items() if w}


def test_1_2_1_is_1_1_twice() -> None:
    sums = share({"k": {("p", -1): 1, ("p", 0): 2, ("p", 1): 1}}, "s")
    assert {name: formula(terms, "x") for name, terms in sums.named} == {
        "s1": "p(x) + p(x + 1)",
        "k": "s1(x - 1) + s1(x)",
    }


def test_two_kernels_share_a_pair_at_another_place_and_power() -> None:
    one = {("p", -1): 1, ("q", 0): -1}
    other = {("p", 0): 4, ("q", 1): -4, ("p", 2): 1}
    sums = share({"one": one, "other": other}, "s")
    assert formula(sums.shared["s1"], "x") == "p(x) - q(x + 1)"
    assert formula(sums.results["other"], "x") == "4 s1(x) + p(x + 2)"


@pytest.mark.parametrize(("number", "count"), [(7, 2), (15, 2), (-9, 2), (85, 4), (0, 0)])
def test_how_many_digits(number: int, count: int) -> None:
    assert len(list(signed_digits(number))) == count
