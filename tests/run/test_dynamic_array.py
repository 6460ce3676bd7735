"""Numbers that become more: as a list of integers would."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from npchip.run import dynamic_array
from npchip.run.dynamic_array import DynamicArray

NUMBERS = st.integers(-(2**31), 2**31 - 1)


@given(st.lists(NUMBERS | st.lists(NUMBERS, max_size=200), max_size=30))
def test_what_is_added_stays(additions: list[int | list[int]]) -> None:
    array = DynamicArray(np.int32)
    expected: list[int] = []
    for numbers in additions:
        before = array.array
        array.extend(numbers if isinstance(numbers, int) else np.array(numbers, np.int64))
        assert before.tolist() == expected
        expected += [numbers] if isinstance(numbers, int) else numbers
        assert len(array) == len(expected)
        assert array.array.tolist() == expected
    assert array.array.dtype == np.int32


def test_many_numbers_are_kept_in_pages() -> None:
    array = DynamicArray(np.int64)
    numbers = np.arange(400_000)
    for part in np.array_split(numbers, 7):
        array.extend(part)
    np.testing.assert_array_equal(array.array, numbers)


def test_more_than_can_be_reserved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dynamic_array, "_RESERVED", 1 << 60)
    array = DynamicArray(np.uint8, (8, 8), expected=1 << 44)  # a PiB
    array.extend(np.full((100, 8, 8), 7, np.uint8))
    assert array.array.sum() == 100 * 64 * 7
