"""Numbers in YAML files are read as people mean them, or refused."""

from __future__ import annotations

import math
import time
from typing import Any

import pytest

from npchip.base.errors import InputError
from npchip.base.yaml import load_mapping


def value(text: str) -> Any:
    return load_mapping(f"a: {text}", "f.yaml", "NP201")["a"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1e1", 10.0),
        ("-.02", -0.02),
        (".5", 0.5),
        ("5.", 5.0),
        ("1.5E-3", 0.0015),
        ("+.5e+1", 5.0),
        ("0.5", 0.5),
        ("1_000", 1000),
        ("-12", -12),
        ("0", 0),
        ("0x1F", 31),
        ("0b101", 5),
        ("0o17", 15),
        ("-.inf", -math.inf),
        ("1:30", "1:30"),
        ("1:30.5", "1:30.5"),
        ("2020-13-45", "2020-13-45"),
        ("2020-01-01", "2020-01-01"),
        ("=", "="),
        ("'010'", "010"),
        ("1.2.3", "1.2.3"),
        ("e1", "e1"),
        ("1e", "1e"),
        ("[1, 2e0]", [1, 2.0]),
        ("yes", True),
        ("~", None),
    ],
)
def test_numbers_are_what_they_look_like(text: str, expected: object) -> None:
    """Read as YAML 1.1, 1:30 was 90 and 1e1 a text."""
    found = value(text)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.parametrize("text", ["010", "-010", "+08", "[012, 10]", "0_7", "00"])
def test_a_leading_zero_is_refused(text: str) -> None:
    """010 was 8."""
    with pytest.raises(InputError) as caught:
        value(text)
    assert caught.value.message.startswith("f.yaml:1: '")
    assert "begins with 0" in caught.value.message
    assert "0o" in caught.value.message


@pytest.mark.parametrize("text", ["!!int '1:30'", "!!float 1:30", "!x 1", "!!set {b}", "! 1"])
def test_tags_are_refused(text: str) -> None:
    """They brought back the numbers of YAML 1.1."""
    with pytest.raises(InputError, match=r"f\.yaml:1: error: tags \("):
        value(text)


@pytest.mark.parametrize("text", ["59:" * 300_000 + "59", "9" * 900_000, "1." + "1" * 900_000])
def test_a_long_number_takes_no_time(text: str) -> None:
    """One of 300,000 parts took 14 seconds."""
    before = time.process_time()
    try:
        value(text)
    except InputError as error:
        assert "too long" in error.message  # noqa: PT017 - a text is right as well
    assert time.process_time() - before < 2
