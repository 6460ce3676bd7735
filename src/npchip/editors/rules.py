"""Highlighting rules, from the instruction set and the assembler's tables.

The patterns mean the same in Python's `re`, in Oniguruma, which editors use, and in the regular
expressions of browsers: `(?i:…)` is young in those, so a letter of either case is a class.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final, NamedTuple

from npchip.assembler.blocks import DIRECTIVES
from npchip.assembler.expressions import OPERATORS
from npchip.assembler.symbols import REGISTERS
from npchip.isa import Isa
from npchip.program.model import OUTPUT_KINDS


class Kind(NamedTuple):
    """A kind of word: the names of its Pygments token and of its TextMate scope."""

    token: str
    scope: str


KINDS: Final = {
    "comment": Kind("Comment.Single", "comment.line.semicolon"),
    "string": Kind("String.Double", "string.quoted.double"),
    "character": Kind("String.Char", "constant.character"),
    "number": Kind("Number", "constant.numeric"),
    "label": Kind("Name.Label", "entity.name.function.label"),
    "directive": Kind("Keyword.Declaration", "keyword.control.directive"),
    "mnemonic": Kind("Keyword", "keyword.mnemonic"),
    "condition": Kind("Name.Builtin", "support.constant.condition"),
    "choice": Kind("Name.Constant", "constant.language"),
    "register": Kind("Name.Variable", "variable.language.register"),
    "name": Kind("Name", "variable.other"),
    "operator": Kind("Operator", "keyword.operator"),
    "punctuation": Kind("Punctuation", "punctuation.separator"),
}

_NAME: Final = r"[A-Za-z_]\w*"


class Rule(NamedTuple):
    """A pattern and the kind of word that it matches. The first rule that matches wins."""

    kind: str
    pattern: str


def rules(isa: Isa) -> tuple[Rule, ...]:
    """Return the rules of an instruction set. White space matches none of them."""
    choices = {name for operand in isa.operands.values() for name in operand.choices}
    return (
        Rule("comment", r";.*$"),
        Rule("string", r'"[^"]*"'),
        Rule("character", r"'(?:\\.|[^'\\])'"),
        Rule("number", r"\b(?:0[xX][0-9a-fA-F_]+|0[bB][01_]+|[0-9][0-9_]*)\b"),
        Rule("label", rf"\.?{_NAME}(?=\s*:)"),
        Rule("directive", rf"{_any_case(DIRECTIVES)}\b"),
        Rule("label", rf"\.{_NAME}"),
        Rule("mnemonic", rf"\b{_any_case(isa.forms)}\b"),
        Rule("condition", rf"\b{_any_case(isa.condition_names)}\b"),
        # Case matters: in capitals these are often constants (SAMPLE signal, SIGNAL).
        Rule("choice", rf"\b{_any(choices)}\b"),
        Rule("choice", rf"\b{_any(OUTPUT_KINDS)}\b(?=\s*(?:;|$))"),
        Rule("register", rf"\b{_any_case(REGISTERS)}\b"),
        Rule("name", rf"\b{_NAME}\b"),
        Rule("operator", _any(OPERATORS)),
        Rule("punctuation", r"[\[\](),#:]"),
    )


def _any(words: Iterable[str]) -> str:
    """Return a pattern that matches any of `words`, the longest first."""
    return f"(?:{'|'.join(map(re.escape, _longest_first(words)))})"


def _any_case(words: Iterable[str]) -> str:
    """Return a pattern that matches any of `words`, in capitals or not, the longest first."""
    return f"(?:{'|'.join(''.join(map(_letter, word)) for word in _longest_first(words))})"


def _letter(character: str) -> str:
    lower, upper = character.lower(), character.upper()
    return re.escape(character) if lower == upper else f"[{lower}{upper}]"


def _longest_first(words: Iterable[str]) -> list[str]:
    return sorted(words, key=lambda word: (-len(word), word))
