"""Names, cycles, lines and files in the editor are those of the assembler."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import pytest

from npchip.program.model import Program, SourceLine
from tests.studio.editor.asking import (
    PROGRAMS,
    ask,
    ask_all,
    name_of,
    project,
    words_of,
)
from tests.support.page_code import Answers
from tests.support.programs import ASM, assembled

pytestmark = pytest.mark.long


def test_names_are_those_of_the_assembler(harness: Answers) -> None:
    answers = ask_all(harness, "names", [{"project": project(name)} for name in PROGRAMS])
    for name, answer in zip(PROGRAMS, answers, strict=True):
        found: dict[str, set[str]] = defaultdict(set)
        for item in answer:
            found[item["kind"]].add(item["name"])
            place = item["place"]
            line = project(name)["files"][place["file"]].splitlines()[place["line"] - 1]
            assert line[place["column"] - 1 :].startswith(item["name"])
        program = assembled(name)
        # Some of the page's names stand in conditions that do not hold.
        assert {label for label in found["label"] if label[0] != "."} >= {*program.labels}
        assert found["register"] >= {*program.registers}
        assert found["output"] == {output.name for output in program.outputs}
        assert found["constant"] >= {*program.symbols}


def test_jumps_find_local_labels_and_files(harness: Answers) -> None:
    text = 'a:\n.x: NOP\n        JMP .x\nb:\n.x: NOP\n        JMP .x\n.include "lib/c.s"\n'
    files = {"main": "t.s", "files": {"t.s": text, "lib/c.s": ".macro m\n.endm\n"}}

    def target(part: str, start: int = 0) -> Any:
        return ask(harness, "target", text=text, pos=text.index(part, start), project=files)

    first = text.index("JMP")
    assert target(".x", first) == {"file": "t.s", "line": 2, "column": 1}
    assert target(".x", text.rindex("JMP")) == {"file": "t.s", "line": 5, "column": 1}
    assert target("JMP .x\n.include") is None
    assert target(".include")["file"] == "lib/c.s"


def test_sums_are_those_of_the_source_lines(harness: Answers) -> None:
    questions: list[dict[str, Any]] = [
        {"words": words_of(assembled(name)), "project": project(name)} for name in PROGRAMS
    ]
    answers = ask_all(harness, "sums", questions)
    for name, question, answer in zip(PROGRAMS, questions, answers, strict=True):
        found = {
            (file, each["line"]): (each["least"], each["most"], each["copies"], each["words"])
            for file, sums in answer.items()
            for each in sums
        }
        assert found == sums_of(assembled(name), question["words"]), name


def sums_of(
    program: Program, words: Sequence[dict[str, Any]]
) -> dict[tuple[str, int], tuple[int, int, int, int]]:
    """Return the sums of lines. The assembler tells copies apart, the page has to find them."""
    copies: dict[SourceLine, list[int]] = defaultdict(list)
    for line, word in zip(program.source, words, strict=True):
        # An instruction that a macro got as an argument stands in the line of the use.
        outermost = {(origin.file, origin.line): origin for origin in line.origins}
        for origin in outermost.values():
            copies[origin].append(word["cycles"])
    lines: dict[tuple[str, int], list[list[int]]] = defaultdict(list)
    for origin, cycles in copies.items():
        lines[name_of(origin), origin.line].append(cycles)
    return {
        place: (min(map(sum, each)), max(map(sum, each)), len(each), max(map(len, each)))
        for place, each in lines.items()
    }


def test_an_address_stands_for_its_line_and_the_uses_around_it(harness: Answers) -> None:
    program = assembled("edges")
    words = words_of(program)
    address = next(at for at, word in enumerate(words) if len(word["origins"]) > 2)
    origins = words[address]["origins"]
    found = ask(harness, "linesAt", words=words, address=address, file=origins[0]["file"])
    assert found["here"] == origins[0]["line"]
    outer = ask(harness, "linesAt", words=words, address=address, file="edges.s")
    assert outer["uses"] == [each["line"] for each in origins[1:]]
    nowhere = ask(harness, "linesAt", words=words, address=len(words), file="edges.s")
    assert nowhere == {"here": None, "uses": []}


def test_words_left_and_cycles_of_a_frame(harness: Answers) -> None:
    info = {
        "words": [0] * 500,
        "machine": {"rom_words": 512},
        "budgets": {"words": 505, "cycles": 2000},
        "bounds": {"least": 1200, "most": 1900},
    }
    assert ask(harness, "texts", program=info) == [
        "500 of 512 words, 12 left, budget 505",
        "1,200–1,900 cycles a frame, budget 2,000",
    ]
    info |= {"budgets": {"words": None, "cycles": None}, "bounds": {"least": 7, "most": None}}
    assert ask(harness, "texts", program=info)[1] == "at least 7 cycles a frame"
    assert ask(harness, "texts", program=info | {"bounds": None})[1] == ""


def test_lines_are_indented_as_in_asm(harness: Answers) -> None:
    pairs = []
    for path in sorted(ASM.rglob("*.s")):
        lines = [line for line in path.read_text().splitlines() if line.partition(";")[0].strip()]
        pairs += [[above, line] for above, line in itertools.pairwise(lines) if line[0] == " "]
    found = ask(harness, "indentation", pairs=pairs)
    wrong = [
        pair
        for pair, columns in zip(pairs, found, strict=True)
        if len(pair[1]) - len(pair[1].lstrip()) != columns
    ]
    assert len(wrong) <= len(pairs) / 50, wrong


def test_breakpoints_and_program_lines_move_with_the_text(harness: Answers) -> None:
    text = "one\ntwo\nthree\nfour\n"
    found = ask(
        harness,
        "edits",
        text=text,
        breaks=[[2, ""], [3, "any r0 > 1"]],
        lines=[2, 4],
        changes=[
            {"from": 0, "insert": "; first\n"},  # above
            {"from": 12, "insert": "\n"},  # a line break before "two" pushes it down
            {"from": 13, "insert": "label: "},  # in the line
            {"from": 13, "to": 24},  # the whole line "two"
            None,
        ],
    )
    condition = ["any r0 > 1", True]  # and whether it is switched off
    assert found[0] == {"breaks": [[3, "", False], [4, *condition]], "marked": 2, "lines": [3, 5]}
    assert found[1]["breaks"] == [[4, "", False], [5, *condition]]
    assert found[2] == {**found[1], "lines": [4, 6]}
    assert found[3]["breaks"] == [[4, *condition]]
    assert found[4]["breaks"] == found[2]["breaks"]


def test_includes_follow_a_file_that_is_renamed(harness: Answers) -> None:
    files = {
        "main": "a.s",
        "files": {
            "a.s": '.include "lib/b.s"\n  .INCLUDE "lib/c.s" ; lib/b.s\n',
            "lib/b.s": '.include "c.s"\n',
            "lib/c.s": "",
        },
    }
    found = ask(harness, "renamed", project=files, **{"from": "lib/c.s", "to": "parts/d.s"})
    assert found["files"] == {
        "a.s": '.include "lib/b.s"\n  .INCLUDE "parts/d.s" ; lib/b.s\n',
        "lib/b.s": '.include "../parts/d.s"\n',
        "parts/d.s": "",
    }
    found = ask(harness, "renamed", project=files, **{"from": "a.s", "to": "z.s"})
    assert found["main"] == "z.s"
    assert [*found["files"]] == ["z.s", "lib/b.s", "lib/c.s"]


def test_tabs_and_names_of_files(harness: Answers) -> None:
    files = {"main": "b.s", "files": {"a.s": "", "b.s": "", "b.golden.json": ""}}
    assert ask(harness, "tabs", project=files, open="lib/x.s") == ["b.s", "a.s", "lib/x.s"]
    assert ask(harness, "nameFault", name="lib/x-1.s", taken=["a.s"]) == ""
    for name in ("", "../x.s", "/x.s", "a b.s", "a.s"):
        assert ask(harness, "nameFault", name=name, taken=["a.s"]), name


def test_places_of_mistakes_stay_in_the_text(harness: Answers) -> None:
    def marked(line: int, column: int, length: int) -> str:
        place = {"file": "t.s", "line": line, "column": column, "length": length}
        found = ask(harness, "range", text="ADD r0\nNOP", place=place)
        return "ADD r0\nNOP"[found["from"] : found["to"]]

    assert marked(1, 5, 2) == "r0"
    assert marked(1, 7, 1) == "0"
    assert marked(9, 1, 50) == "NOP"
