"""Errors as text: one about a line of a file begins with its place, as editors expect."""

from __future__ import annotations

import pytest

from npchip.base.errors import InputError


@pytest.mark.parametrize(
    ("message", "shown"),
    [
        ("mine.yaml:3: unknown key 'x'", "mine.yaml:3: error: unknown key 'x' [NP203]"),
        ("a b/mine.yaml:12: memory: x: 3: y", "a b/mine.yaml:12: error: memory: x: 3: y [NP203]"),
        (r"C:\mine.yaml:3: unknown", r"C:\mine.yaml:3: error: unknown [NP203]"),
        ("clip.npy: frame 3: too bright", "error: clip.npy: frame 3: too bright [NP203]"),
        ("clip.npy: holds 3:4: no", "error: clip.npy: holds 3:4: no [NP203]"),
        ("cannot read mine.yaml", "error: cannot read mine.yaml [NP203]"),
    ],
)
def test_the_place_comes_first(message: str, shown: str) -> None:
    error = InputError("NP203", message)
    assert str(error) == shown
    assert error.message == message
    assert str(InputError("NP203", message, hint="look")) == f"{shown}\n  hint: look"
