"""Keys of mappings are checked, with places and suggestions."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from npchip.base.errors import InputError
from npchip.base.section import Codes, Section
from npchip.base.suggest import shown
from npchip.base.yaml import load_mapping

TEXT = "name: NO\nsize: 3\ninner: {a: 1}\n"


class Thing(Section):
    """A mapping of a test."""

    codes = Codes(unknown="NP901", missing="NP902", type="NP903")


def thing() -> Thing:
    return Thing(load_mapping(TEXT, "f.yaml", "NP900"), "f.yaml", "a thing")


def half(a: int) -> int:
    if a % 2:
        raise InputError("NP904", f"a: expected an even number, found {a}")
    return a // 2


@pytest.mark.parametrize(
    ("check", "code", "message", "hint"),
    [
        (
            lambda: thing().check_keys(("name", "inner"), ("sizes",)),
            "NP901",
            "f.yaml:2: a thing has no size: it takes name, inner, sizes",
            "did you mean 'sizes'?",
        ),
        (lambda: thing().need("shape"), "NP902", "f.yaml:1: a thing needs shape", None),
        (
            lambda: thing().get("size", str),
            "NP903",
            "f.yaml:2: size: expected a text, found 3",
            None,
        ),
        (
            lambda: thing().get("name", str),
            "NP903",
            "f.yaml:1: name: expected a text, found false",
            "YAML takes NO, YES, ON and OFF for true or false: write them in quotes",
        ),
        (
            lambda: thing().section("size"),
            "NP903",
            "f.yaml:2: size: expected a mapping (key: value), found 3",
            None,
        ),
        (
            lambda: thing().section("inner", prefix="inner.").make(half, {"a": 1}),
            "NP904",
            "f.yaml:3: inner.a: expected an even number, found 1",
            None,
        ),
        (
            lambda: Thing({"size": 3}, None, "a thing").check_keys(("length",)),
            "NP901",
            "a thing has no --size: it takes length",
            None,
        ),
        (
            lambda: Thing({}, None, "a thing").need("size"),
            "NP902",
            "a thing needs --size",
            None,
        ),
    ],
)
def test_mistakes(check: Callable[[], object], code: str, message: str, hint: str | None) -> None:
    with pytest.raises(InputError) as caught:
        check()
    assert (caught.value.code, caught.value.message, caught.value.hint) == (code, message, hint)


def test_what_is_right() -> None:
    top = thing()
    top.check_keys(("name",), ("size", "inner"))
    assert top.get("size", int) == 3
    assert top.get("more", bool, default=True) is True
    assert top.section("inner").make(dict, {"a": 2}) == {"a": 2}


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "nothing"),
        (True, "true"),
        ({"a": 1}, "a mapping"),
        ((1, 2), "[1, 2]"),
        (10**30, "a number of more than 20 digits"),
        ("x" * 100, f"'{'x' * 56}..."),
    ],
)
def test_shown(value: object, text: str) -> None:
    assert shown(value) == text
