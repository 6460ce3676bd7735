"""The editor of the studio's page, asked in Node: what it makes of the sources in ``asm/``."""

from __future__ import annotations

import itertools
import json
import os
import re
import shutil
import subprocess
from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from npchip.assembler import assemble
from npchip.editors.pygments import NpchipLexer
from npchip.editors.rules import KINDS, rules
from npchip.isa import load_isa
from npchip.machine import load_machine
from npchip.program.model import OUTPUT_KINDS, Program, SourceLine
from npchip.studio.toolchain.language import language

ROOT = Path(__file__).parents[2]
ASM = ROOT / "asm"
STUDIO = ROOT / "src" / "npchip" / "studio"
PAGE = STUDIO / "page"
PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
ISA = load_isa()

ODD = """; expect: odd
.macro  twice, rx
        ADD     rx, rx
.endm
.EQU    A, 'x' + '\\'' + 0x1_F / 0b1010_0101 % ~3
start:  .local: mov R15, #-1    ; comment ; more
        twice   r3
        SAMPLE  signal, SIGNAL
        JALL    cs, .local
        NBR     r1, r2, north
        .output picture, 3, picture
        .output words, 4, scalar16;
        .word   (1 << 3) | 4
        .include "a;b.s"        ; a string keeps its ';'
"""


@pytest.fixture(scope="module")
def harness(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The editor's code for Node."""
    esbuild = STUDIO / "node_modules" / ".bin" / "esbuild"
    if not esbuild.exists():
        pytest.skip(f"no {esbuild}: run npm ci in {STUDIO}")
    if shutil.which("node") is None:
        pytest.skip("no node here")
    made = tmp_path_factory.mktemp("editor") / "harness.mjs"
    source = Path(__file__).parent / "editor" / "harness.ts"
    options = ["--bundle", "--platform=node", "--format=esm", f"--outfile={made}"]
    # The harness stands beside the tests, and the packages beside the page.
    surroundings = os.environ | {"NODE_PATH": str(STUDIO / "node_modules")}
    subprocess.run([esbuild, source, *options, "--log-level=warning"], check=True, env=surroundings)
    return made


def ask_all(harness: Path, what: str, questions: Sequence[dict[str, Any]]) -> list[Any]:
    """Return the editor's answers to questions of one kind."""
    text = json.dumps({"ask": what, "many": questions})
    done = subprocess.run(
        ["node", harness], input=text, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    answers = json.loads(done.stdout)
    assert isinstance(answers, list)
    return answers


def ask(harness: Path, what: str, **question: Any) -> Any:
    """Return the editor's answer to a question."""
    [answer] = ask_all(harness, what, [question])
    return answer


@cache
def project(name: str) -> dict[str, Any]:
    """A program of ``asm/`` with its includes, as the page holds it."""
    files: dict[str, str] = {}

    def add(path: Path) -> None:
        files[path.relative_to(ASM).as_posix()] = text = path.read_text()
        for wanted in re.findall(r'^\s*\.include\s+"([^"]+)"', text, re.MULTILINE):
            add((path.parent / wanted).resolve())

    add(ASM / f"{name}.s")
    return {"main": f"{name}.s", "files": files}


@cache
def entries() -> list[dict[str, Any]]:
    """What the page knows of the language."""
    found: list[dict[str, Any]] = language(ISA)["entries"]
    return found


@cache
def assembled(name: str) -> Program:
    return assemble(ASM / f"{name}.s")


def words_of(program: Program) -> list[dict[str, Any]]:
    cycles = program.cycles(load_machine("default"), ISA)
    return [
        {
            "origins": [{"file": name_of(at), "line": at.line} for at in line.origins],
            "text": line.code,
            "cycles": cycles[address],
        }
        for address, line in enumerate(program.source)
    ]


def name_of(line: SourceLine) -> str:
    return Path(line.file).resolve().relative_to(ASM).as_posix()


# ---- colours


def test_colours_are_those_of_pygments(harness: Path) -> None:
    texts = [*(path.read_text() for path in sorted(ASM.rglob("*.s"))), ODD]
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


def test_case_is_ignored_where_a_pattern_says_so_only(harness: Path) -> None:
    patterns = [r"\b(?i:a[b-d]\.(?:x|\w)?)\b", r"(?i:z)q", r"[A-C]+"]
    found = [{"kind": str(number), "pattern": text} for number, text in enumerate(patterns)]
    text = "aB.X Ad.y zq ZQ Zq ABC abc"
    words = ask(harness, "colours", rules=found, text=text)
    assert words == [["aB.X", "0"], ["Ad.y", "0"], ["zq", "1"], ["Zq", "1"], ["ABC", "2"]]


# ---- completion


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


def offered(harness: Path, lines: Sequence[str], part: str) -> dict[str, set[str]]:
    """Return the kinds or labels that are offered at the end of lines."""
    files = {"main": "t.s", "files": {"t.s": NAMES}}
    questions = [{"line": line, "entries": entries(), "project": files} for line in lines]
    answers = ask_all(harness, "offers", questions)
    return {
        line: {offer[part] for offer in offers} for line, offers in zip(lines, answers, strict=True)
    }


def test_only_what_makes_sense_is_offered(harness: Path) -> None:
    assert offered(harness, [*OFFERED], "kind") == OFFERED


def test_words_that_are_choices(harness: Path) -> None:
    wanted = {
        "        NBR     r0, r1, ": {"north", "east", "south", "west"},
        "        SAMPLE  ": {"reset", "signal"},
        ".output a, 3, ": {*OUTPUT_KINDS},
    }
    assert offered(harness, [*wanted], "label") == wanted


def test_every_word_of_the_sources_is_offered_where_it_stands(harness: Path) -> None:
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


def test_operands_are_fields_in_their_column(harness: Path) -> None:
    offer = {"label": "LD", "operands": ["rd", "[rs + bank]"]}
    made = ask(harness, "template", offer=offer, column=8)
    assert made == "LD      ${rd}, [${rs} + ${bank}]"
    assert ask(harness, "template", offer={"label": "NOP", "operands": []}, column=8) == ""


# ---- names


def test_names_are_those_of_the_assembler(harness: Path) -> None:
    answers = ask_all(harness, "names", [{"project": project(name)} for name in PROGRAMS])
    for name, answer in zip(PROGRAMS, answers, strict=True):
        found: dict[str, set[str]] = defaultdict(set)
        for item in answer:
            found[item["kind"]].add(item["name"])
            place = item["place"]
            line = project(name)["files"][place["file"]].splitlines()[place["line"] - 1]
            assert line[place["column"] - 1 :].startswith(item["name"])
        program = assembled(name)
        assert {label for label in found["label"] if label[0] != "."} == {*program.labels}
        assert found["register"] == {*program.registers}
        assert found["output"] == {output.name for output in program.outputs}
        assert found["constant"] >= {*program.symbols}


def test_jumps_find_local_labels_and_files(harness: Path) -> None:
    text = 'a:\n.x: NOP\n        JMP .x\nb:\n.x: NOP\n        JMP .x\n.include "lib/c.s"\n'
    files = {"main": "t.s", "files": {"t.s": text, "lib/c.s": ".macro m\n.endm\n"}}

    def target(part: str, start: int = 0) -> Any:
        return ask(harness, "target", text=text, pos=text.index(part, start), project=files)

    first = text.index("JMP")
    assert target(".x", first) == {"file": "t.s", "line": 2, "column": 1}
    assert target(".x", text.rindex("JMP")) == {"file": "t.s", "line": 5, "column": 1}
    assert target("JMP .x\n.include") is None
    assert target(".include")["file"] == "lib/c.s"


# ---- cycles


def test_sums_are_those_of_the_source_lines(harness: Path) -> None:
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


def test_an_address_stands_for_its_line_and_the_uses_around_it(harness: Path) -> None:
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


def test_words_left_and_cycles_of_a_frame(harness: Path) -> None:
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


# ---- lines and files


def test_lines_are_indented_as_in_asm(harness: Path) -> None:
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


def test_breakpoints_and_program_lines_move_with_the_text(harness: Path) -> None:
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


def test_includes_follow_a_file_that_is_renamed(harness: Path) -> None:
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


def test_tabs_and_names_of_files(harness: Path) -> None:
    files = {"main": "b.s", "files": {"a.s": "", "b.s": "", "b.golden.json": ""}}
    assert ask(harness, "tabs", project=files, open="lib/x.s") == ["b.s", "a.s", "lib/x.s"]
    assert ask(harness, "nameFault", name="lib/x-1.s", taken=["a.s"]) == ""
    for name in ("", "../x.s", "/x.s", "a b.s", "a.s"):
        assert ask(harness, "nameFault", name=name, taken=["a.s"]), name


def test_places_of_mistakes_stay_in_the_text(harness: Path) -> None:
    def marked(line: int, column: int, length: int) -> str:
        place = {"file": "t.s", "line": line, "column": column, "length": length}
        found = ask(harness, "range", text="ADD r0\nNOP", place=place)
        return "ADD r0\nNOP"[found["from"] : found["to"]]

    assert marked(1, 5, 2) == "r0"
    assert marked(1, 7, 1) == "0"
    assert marked(9, 1, 50) == "NOP"


def test_cards(harness: Path) -> None:
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


# ---- contrast


def test_colours_have_contrast_in_both_themes() -> None:
    theme = (PAGE / "shell" / "theme.css").read_text()
    own = (PAGE / "editor" / "colours.css").read_text()
    for mark in (r":root \{", r':root\[data-theme="dark"\] \{'):
        panel = values(theme, mark)
        colours = values(
            own,
            r"\.editor \{\n  --editor-comment"
            if "dark" not in mark
            else mark[:-3] + r" \.editor \{",
        )
        assert len(colours) == 8
        for name, colour in colours.items():
            for share, tint in ((0, "--panel"), (0.55, "--raised"), (0.22, "--good")):
                ground = mixed(panel[tint], panel["--panel"], share)
                assert contrast(rgb(colour), ground) >= 4.5, (mark, name, tint)


def values(css: str, start: str) -> dict[str, str]:
    match = re.search(start, css)
    assert match, start
    block = css[css.index("{", match.start()) : css.index("}", match.end())]
    return dict(re.findall(r"(--[\w-]+): (#[0-9a-f]{6});", block))


def rgb(colour: str) -> tuple[float, ...]:
    return tuple(int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))


def mixed(over: str, under: str, share: float) -> tuple[float, ...]:
    return tuple(a * share + b * (1 - share) for a, b in zip(rgb(over), rgb(under), strict=True))


def contrast(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    dark, light = sorted(map(luminance, (one, other)))
    return (light + 0.05) / (dark + 0.05)


def luminance(colour: tuple[float, ...]) -> float:
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour]
    return sum(c * weight for c, weight in zip(linear, (0.2126, 0.7152, 0.0722), strict=True))
