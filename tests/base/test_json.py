"""Strict JSON: layout, NumPy, numbers that are not finite."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from npchip.base.json import in_rows, indented, one_line


def test_numpy_is_written_as_plain_numbers() -> None:
    value = {"a": np.arange(3, dtype=np.uint8), "b": np.float64(0.5), "c": np.bool_(True)}
    assert one_line(value) == '{"a": [0, 1, 2], "b": 0.5, "c": true}'


@pytest.mark.parametrize("value", [math.nan, math.inf, np.float64("nan"), np.array([-np.inf])])
def test_numbers_that_are_not_finite_are_refused(value: object) -> None:
    for write in (one_line, indented, lambda item: in_rows({"a": [item]}, ("a",))):
        with pytest.raises(ValueError, match="not JSON compliant"):
            write(value)


def test_what_json_lacks_is_refused() -> None:
    with pytest.raises(TypeError, match="set cannot be written as JSON"):
        one_line({"a": {1}})


def test_layouts() -> None:
    document = {"schema": 1, "rows": [{"a": 1}, {"a": 2}], "none": []}
    text = in_rows(document, ("rows", "none"))
    assert text == ('{\n "schema": 1,\n "rows": [\n  {"a": 1},\n  {"a": 2}\n ],\n "none": []\n}\n')
    assert json.loads(text) == document
    assert in_rows({"r": [1]}, ("r",), margin="  ") == '{\n  "r": [\n    1\n  ]\n}\n'
    assert indented({"é": [1]}) == '{\n "\\u00e9": [\n  1\n ]\n}\n'
    assert indented({"é": [1]}, ascii_only=False) == '{\n "é": [\n  1\n ]\n}\n'
