"""Completion in the editor, and its cards."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import pytest

from npchip.program.model import OUTPUT_KINDS
from tests.studio.editor.asking import (
    PROGRAMS,
    ask,
    ask_all,
    entries,
    project,
)
from tests.support.page_code import Answers

pytestmark = pytest.mark.long


NAMES = """.equ LIMIT, 3
.reg pixel, r0
.macro twice a
        ADD     a, a
.endm
loop:   NOP
.inner: twice pixel
"""
EVERYTHING = {"instruction", "register", "condition", "word", "constant", "label", "macro"}
OFFERED = {
    "": {"instruction", "directive", "macro"},
    "again:  AD": {"instruction", "directive", "macro"},
    "        JANY ": {"condition"},
    "        WHERE ": {"condition"},
    "        JMP ": {"label", "constant"},
    "        ADD ": {"register"},
    "        add     r0, #": {"constant"},
    "        LD      r0, [": {"register", "constant"},
    "        twice ": EVERYTHING,
    ".reg x, ": {"register"},
    ".equ x": set(),
    "        ADD     r0, r1 ; ad": set(),
    '.error "ad': set(),
}


def offered(harness: Answers, lines: Sequence[str], part: str) -> dict[str, set[str]]:
    """Return the kinds or labels that are offered at the end of lines."""
    files = {"main": "t.s", "files": {"t.s": NAMES}}
    questions = [{"line": line, "entries": entries(), "project": files} for line in lines]
    answers = ask_all(harness, "offers", questions)
    return {
        line: {offer[part] for offer in offers} for line, offers in zip(lines, answers, strict=True)
    }


def test_only_what_makes_sense_is_offered(harness: Answers) -> None:
    assert offered(harness, [*OFFERED], "kind") == OFFERED


def test_words_that_are_choices(harness: Answers) -> None:
    wanted = {
        "        NBR     r0, r1, ": {"north", "east", "south", "west"},
        "        SAMPLE  ": {"reset", "signal"},
        ".output a, 3, ": {*OUTPUT_KINDS},
    }
    assert offered(harness, [*wanted], "label") == wanted


def test_every_word_of_the_sources_is_offered_where_it_stands(harness: Answers) -> None:
    questions = [
        {"entries": entries(), "project": files, "words": [*words_to_offer(files)]}
        for files in map(project, PROGRAMS)
    ]
    assert min(len(question["words"]) for question in questions) > 20
    assert ask_all(harness, "unoffered", questions) == [[] for _ in PROGRAMS]


def words_to_offer(files: dict[str, Any]) -> Iterator[tuple[str, int, str]]:
    """Yield line, offset of its end, and text of each word that completion should know."""
    everything = "\n".join(files["files"].values())
    unknown = {"ROWS", "COLS", "NP_ROWS", "NP_COLS"}  # of the machine
    unknown |= {*re.findall(r"\.rept[^;\n]*, *(\w+)", everything)}
    unknown |= {*re.findall(r"\.ifn?def +(\w+)", everything)}
    parameters: set[str] = set()
    for line in everything.splitlines():
        code = re.sub(r'"[^"]*"', lambda match: " " * len(match[0]), line.partition(";")[0])
        if re.match(r"\s*\.macro", code):
            parameters = {*re.findall(r"\w+", code)}
        elif re.match(r"\s*\.endm", code):
            parameters = set()
        start = re.match(r"(?:\s*\.?\w+:)*", code)
        if start is None or re.match(r"\s*\.(?:macro|equ|reg|rept|budget|loop|out|err|if)", code):
            continue
        for match in re.finditer(r"(?<![\w.])\.?[A-Za-z_]\w*", code):
            if match.start() >= start.end() and match[0] not in parameters | unknown:
                yield line, match.end(), match[0]


def test_operands_are_fields_in_their_column(harness: Answers) -> None:
    offer = {"label": "LD", "operands": ["rd", "[rs + bank]"]}
    made = ask(harness, "template", offer=offer, column=8)
    assert made == "LD      ${rd}, [${rs} + ${bank}]"
    assert ask(harness, "template", offer={"label": "NOP", "operands": []}, column=8) == ""


def test_cards(harness: Answers) -> None:
    text = ".equ LIMIT, 3\n.reg north, r4\n"
    files = {"main": "t.s", "files": {"t.s": text}}
    definition = {
        "name": "LIMIT",
        "kind": "constant",
        "text": "LIMIT = 3",
        "place": {"file": "t.s", "line": 1, "column": 6, "length": 5},
    }
    word = {"origins": [], "text": "ADD r0, #3", "cycles": 1}
    program = {"definitions": [definition], "words": [word], "machine": {"name": "default"}}

    def card(line: str, part: str) -> Any:
        offset = line.index(part)
        question = {"entries": entries(), "project": files, "program": program}
        return ask(harness, "card", line=line, offset=offset, **question)

    found = card("  add r0, #LIMIT", "add")
    assert found["title"] == "ADD · instruction"
    assert found["syntax"] == ["ADD rd, rs", "ADD rd, #imm"]
    assert "1 cycle on default" in found["lines"]
    assert card("  add r0, #LIMIT", "LIMIT")["lines"][0] == "LIMIT = 3"
    assert card("  NBR r0, r1, north", "north")["title"] == "north · register"
    assert card("  NBR r0, r1, east", "east")["title"] == "east · word"
    assert card("  NOP ; add", "add") is None
