"""Numbers that become more: as a list of integers would."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from npchip.run.buffers import Growing

NUMBERS = st.integers(-(2**31), 2**31 - 1)


@given(st.lists(NUMBERS | st.lists(NUMBERS, max_size=200), max_size=30))
def test_what_is_added_stays(additions: list[int | list[int]]) -> None:
    growing = Growing(np.int32)
    expected: list[int] = []
    for numbers in additions:
        before = growing.numbers
        growing.add(numbers if isinstance(numbers, int) else np.array(numbers, np.int64))
        assert before.tolist() == expected
        expected += [numbers] if isinstance(numbers, int) else numbers
        assert len(growing) == len(expected)
        assert growing.numbers.tolist() == expected
    assert growing.numbers.dtype == np.int32


def test_many_numbers_are_kept_in_pages() -> None:
    growing = Growing(np.int64)
    numbers = np.arange(400_000)
    for part in np.array_split(numbers, 7):
        growing.add(part)
    np.testing.assert_array_equal(growing.numbers, numbers)
