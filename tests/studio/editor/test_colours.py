"""Colours of the editor are those of Pygments."""

from __future__ import annotations

import pytest

from npchip.editors.pygments import NpchipLexer
from npchip.editors.rules import KINDS, rules
from tests.studio.editor.asking import (
    ISA,
    ask,
    ask_all,
)
from tests.support.page_code import Answers
from tests.support.programs import ASM, ODD

pytestmark = pytest.mark.long


COMMENT_IN_A_STRING = "        .include \"a;b.s\"        ; a string keeps its ';'\n"


def test_colours_are_those_of_pygments(harness: Answers) -> None:
    texts = [*(path.read_text() for path in sorted(ASM.rglob("*.s"))), ODD + COMMENT_IN_A_STRING]
    kinds = {kind.token: name for name, kind in KINDS.items()}
    wanted = [
        [
            [word, kinds[str(kind).removeprefix("Token.").replace("Literal.", "")]]
            for kind, word in NpchipLexer().get_tokens(text)
            if word.strip()
        ]
        for text in texts
    ]
    questions = [{"rules": colour_rules(), "text": text} for text in texts]
    assert ask_all(harness, "colours", questions) == wanted


def colour_rules() -> list[dict[str, str]]:
    return [{"kind": rule.kind, "pattern": rule.pattern} for rule in rules(ISA)]


def test_case_is_ignored_where_a_pattern_says_so_only(harness: Answers) -> None:
    patterns = [r"\b(?i:a[b-d]\.(?:x|\w)?)\b", r"(?i:z)q", r"[A-C]+"]
    found = [{"kind": str(number), "pattern": text} for number, text in enumerate(patterns)]
    text = "aB.X Ad.y zq ZQ Zq ABC abc"
    words = ask(harness, "colours", rules=found, text=text)
    assert words == [["aB.X", "0"], ["Ad.y", "0"], ["zq", "1"], ["Zq", "1"], ["ABC", "2"]]
