"""``; expect:`` and ``; run:`` lines: how they are read, and when they hold."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from npchip.assembler import AssemblyError
from npchip.assembler.diagnostics import Line, SourceError
from npchip.program.model import Output, Program
from npchip.run.result import FrameRecord, RunError
from npchip.testing.claims import Claim, GoldenClaim, Range, parse_claim
from npchip.testing.evaluate import check_claim, fault
from npchip.testing.suite import MAX_CYCLES, Suite, parse_suite
from tests.support.results import made

PROGRAM = Program(
    "made",
    words=(0,) * 7,
    outputs=(
        Output("row", 0, "scalar"),
        Output("points", 1, "list"),
        Output("mask", 2, "plane"),
        Output("picture", 3, "picture"),
    ),
)
ROWS = np.ma.array([0, 31, 33, 40], mask=[True, False, False, False])
PICTURE = np.arange(4 * 64 * 80).reshape(4, 64, 80).astype(np.uint8)
RESULT = made(
    {
        "row": ROWS,
        "points": [None, [], [5, 6, 7], [1]],
        "mask": np.stack([np.eye(8, 10, dtype=np.uint8) * k for k in range(4)]),
        "picture": PICTURE,
    },
    [1692, 1700, 2021, 1693],
)
NO_FRAMES = made(
    {},
    [],
    setup=FrameRecord(12, 9, {"row": 7, "points": None, "mask": None, "picture": None}),
    status="halted",
)


def claim_of(text: str) -> Claim:
    claim = parse_claim(Line("t.s", 1, text), 0)
    assert isinstance(claim, Claim)
    return claim


def said(text: str, result: Any = RESULT) -> str | None:
    claim = claim_of(text)
    check_claim(claim, PROGRAM)
    return fault(claim, result, PROGRAM)


@pytest.mark.parametrize(
    "text",
    [
        "row[1] == 31",
        "row[0] == null",
        "row[0] != 31",
        "row[1..] != null",
        "row[1..3] == 31, 33, 40",
        "row == null, 31, 32..34, 0x28",
        "row[-1] == 40",
        "row[-2..] > 32",
        "row[-3..-2] == 31, 33",
        "row[1..2] == 30..35",
        "row[3] != 30..35",
        "row[any] == 40",
        "points[0] == null",
        "points[1] == []",
        "points[2] == [5, 6, 7]",
        "points[1..3] == [], [5, 6, 7], [1]",
        "points[2] != [5, 6]",
        "points[2][1] == 6",
        "points[2][0..2] >= 5",
        "len(points[1..]) == 0, 3, 1",
        "max(points[2]) == 7",
        "mask[0] == 0",
        "mask[3][2, 2] == 3",
        "sum(mask) == 0, 8, 16, 24",
        "mask[3][0..1, 2..9] == 0",
        "max(mask[2][0.., 9]) == 0",
        "picture[0][0, 0..3] <= 3",
        "len(picture[1]) == 5120",
        "min(picture) == 0",
        "cycles[0] == 1692",
        "cycles <= 2021",
        "cycles[worst] == 2021",
        "cycles[total] == 7111",
        "cycles[setup] == 5",
        "instructions[2] == 2021",
        "words == 7",
        "words < 8",
        "frames == 4",
        "status == frames-exhausted",
        "status != halted",
        "error == null",
        "port9 == null",
        "row[setup] == null",
    ],
)
def test_claims_that_hold(text: str) -> None:
    assert said(text) is None


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("row[1] == 30", "found 31"),
        ("row[0] == 3", "found null"),
        ("row[0] < 3", "found null"),
        ("row >= 33", "found null in frame 0 (and 1 more frame)"),
        ("row[1..] == 31", "found 33 in frame 2 (and 1 more frame)"),
        ("row[1..] == 31, 33, 41", "found 40 in frame 3, not 41"),
        ("row[1..] == 31, 33", "2 values for 3 frames"),
        ("row[any] == 32", "in no frame; found null, 31, 33, 40"),
        ("row[4] == 1", "there is no frame 4: the run has 4 frames"),
        ("row[2..9] == 1", "there is no frame 2..9: the run has 4 frames"),
        ("row[-5] == 1", "there is no frame -5: the run has 4 frames"),
        ("points[2] == [5, 6]", "found [5, 6, 7]"),
        ("points[2][3] == 5", "found no [3], as it has 3 items"),
        ("max(points[1]) == 0", "found an empty list"),
        ("max(points[0]) == 0", "found null"),
        ("mask[3][2, 2] == 4", "found 3"),
        ("mask[1] == 0", "found 1 at [0, 0]"),
        ("mask[1][1..7, 0..9] == 0", "found 1 at [1, 1]"),
        ("mask[1][8, 0] == 0", "found no [8, 0], as it has 8 x 10 pixels"),
        ("mask[1] == null", "found 8 x 10 values"),
        ("cycles <= 1700", "found 2,021 in frame 2"),
        ("cycles[worst] == 2020", "found 2,021 in frame 2"),
        ("cycles[total] == 7", "found 7,111"),
        ("words <= 6", "found 7"),
        ("frames == 5", "found 4"),
        ("status == halted", "found frames-exhausted"),
        ("error == NP310", "found null"),
        ("port9 == 0", "found null in frame 0 (and 3 more frames)"),
    ],
)
def test_claims_that_do_not_hold(text: str, expected: str) -> None:
    assert said(text) == expected


def test_without_frames_a_name_means_what_was_sent_before_the_first() -> None:
    assert said("row == 7", NO_FRAMES) is None
    assert said("row == 8", NO_FRAMES) == "found 7"
    assert said("cycles <= 12", NO_FRAMES) is None
    assert said("row[all] == 7", NO_FRAMES) == "the run has no frames"
    assert said("row[any] == 7", NO_FRAMES) == "the run has no frames"
    assert said("cycles[worst] == 7", NO_FRAMES) == "the run has no frames"


def test_a_failed_run_tells_why() -> None:
    failed = made({}, [], status="failed", error=RunError("NP310", "NPs disagree"))
    assert said("error == NP310", failed) is None
    assert said("status == halted", failed) == "found failed: NPs disagree"


@pytest.mark.parametrize(
    ("text", "code", "message", "help_"),
    [
        ("rwo == 1", "NP273", "made has no output 'rwo'", "did you mean row?"),
        (
            "zzz == 1",
            "NP273",
            "made has no output 'zzz'",
            "its outputs: row, points, mask, picture",
        ),
        ("cycle == 1", "NP273", "made has no output 'cycle'", "did you mean cycles?"),
        ("row == [1]", "NP274", "only a whole list output", None),
        ("row[1][2] == 1", "NP274", "'row' is a scalar", None),
        ("points == 1", "NP274", "'points' is a list", "one item"),
        ("mask[1][2] == 1", "NP274", "expected [row, column]", None),
        ("max(row) == 1", "NP274", "max() is for lists", None),
        ("sum(points[1][0]) == 1", "NP274", "sum() is for lists", None),
        ("row[total] == 1", "NP274", "[total] is for cycles", None),
        ("words[1] == 1", "NP274", "one value for the whole run", None),
        ("status == haltd", "NP274", "a status is one of", "did you mean halted?"),
        ("status < halted", "NP274", "'status' is a word", "such as status == halted"),
        ("row == nul", "NP274", "expected a number, found 'nul'", "did you mean null?"),
        ("row < 3..4", "NP274", "3..4 is compared with", None),
        ("row < null", "NP274", "null is compared with", None),
        ("row[1] == 1, 2", "NP274", "2 values for one frame", "lists: [1, 2, 3]"),
        ("row[any] == 1, 2", "NP274", "2 values for one frame", None),
    ],
)
def test_claims_that_make_no_sense(text: str, code: str, message: str, help_: str | None) -> None:
    with pytest.raises(SourceError) as caught:
        check_claim(claim_of(text), PROGRAM)
    diagnostic = caught.value.diagnostic
    assert diagnostic.code == code
    assert message in diagnostic.message
    assert help_ is None or help_ in (diagnostic.suggestion or "")


def test_an_output_must_not_be_called_as_a_measure() -> None:
    program = Program("made", (0,), outputs=(Output("words", 0, "scalar"),))
    with pytest.raises(SourceError, match="'words' is a measure"):
        check_claim(claim_of("words == 1"), program)


# ---- syntax


@pytest.mark.parametrize(
    ("text", "column", "message"),
    [
        ("row = 1", 4, "expected one of == != < <= > >=, found '='"),
        ("row", 3, "expected one of == != < <= > >=, found the end of the line"),
        ("", 0, "expected the name of an output"),
        ("row ==", 6, "expected a number"),
        ("row[ == 1", 5, "expected a frame number"),
        ("row[3 == 1", 6, "expected ']', found '=='"),
        ("row[3..1] == 1", 4, "the range 3..1 is empty"),
        ("row == 9..3", 7, "the range 9..3 is empty"),
        ("row[frst] == 1", 4, "expected frame numbers or all, any"),
        ("mask[1][-1, 2] == 1", 8, "expected a row or an item"),
        ("mask[1][1][2] == 1", 10, "expected one of =="),
        ("mx(mask) == 1", 0, "expected one of min, max, sum, len before '('"),
        ("max(mask == 1", 9, "expected ')'"),
        ("row == 1x", 7, "'1x' is not a number"),
        ("row == [1", 9, "expected ']'"),
        ("row == 1 2", 9, "expected the end of the line, found '2'"),
        ("row == 1 as planned", 9, "expected the end of the line, found 'as'"),
        ("golden outputs 3", 15, "expected the end of the line, found '3'"),
        ("row == 0x", 7, "'0x' is not a number"),
        ("row == 1 + 1", 9, "unexpected character '+'"),
        ("golden outptus", 7, "expected golden, golden outputs or golden cycles"),
        ("golden cycles outputs", 14, "expected the end of the line"),
        ("__import__('os') == 1", 11, "unexpected character"),
    ],
)
def test_malformed_claims(text: str, column: int, message: str) -> None:
    with pytest.raises(SourceError) as caught:
        parse_claim(Line("t.s", 1, text), 0)
    assert caught.value.diagnostic.code == "NP270"
    assert message in caught.value.diagnostic.message
    assert caught.value.diagnostic.span.column == column


def test_the_text_of_a_claim_is_without_its_remark() -> None:
    assert claim_of("  row[1 .. 2]  == 3 ; a remark").text == "row[1 .. 2]  == 3"
    claim = claim_of("mask[1..][2, 3..] == 0b11")
    assert claim.frames == Range(1, None)
    assert claim.element == (Range(2, 2), Range(3, None))
    assert claim.values == (3,)


@given(st.text(alphabet="row[]().,=<>!-0129 ;max\"'golden\t:é", max_size=30))
def test_no_text_breaks_the_reader(text: str) -> None:
    try:
        claim = parse_claim(Line("t.s", 1, text), 0)
    except SourceError:
        return
    if isinstance(claim, Claim):
        try:
            check_claim(claim, PROGRAM)
        except SourceError:
            return
        fault(claim, RESULT, PROGRAM)
        fault(claim, NO_FRAMES, PROGRAM)


@given(st.text(alphabet="; run:expect=frameslevels0,1\"'\n", max_size=60))
def test_no_source_breaks_the_reader(text: str) -> None:
    with suppress(AssemblyError):
        parse_suite(text, Path("t.s"))


def suite_of(text: str) -> Suite:
    return parse_suite(text, Path("t.s"))


def test_a_run_line() -> None:
    (run,) = suite_of(
        '; run: coin-1 frames="my clips/coin.npy" first=9 fit=crop define=A=3 define=B=0x10'
        " memory=0xC0=w.npy memory=0=v.npy machine=default,mine.yaml max-cycles=99 ; a remark\n"
        "; expect: row == 1\n"
    ).runs
    assert run.name == "coin-1"
    assert (run.frames, run.first, run.fit) == ("my clips/coin.npy", 9, "crop")
    assert run.defines == {"A": 3, "B": 16}
    assert run.memory == [(0xC0, "w.npy"), (0, "v.npy")]
    assert run.machines == ("default", "mine.yaml")
    assert run.max_cycles == 99


def test_expectations_belong_to_the_run_above_them_or_to_all() -> None:
    suite = suite_of(
        "; expect: words < 9\n; run: a levels=1\n;; expect: frames == 1\n"
        "  NOP ; expect: frames != 2\n; run: b levels=0,255\n; expect: golden\n"
    )
    texts = {run.name: [claim.text for claim in run.claims] for run in suite.runs}
    assert texts == {
        "a": ["words < 9", "frames == 1", "frames != 2"],
        "b": ["words < 9", "golden"],
    }
    assert suite.runs[1].levels == (0, 255)


def test_without_a_run_line_there_is_one_run() -> None:
    (run,) = suite_of("; expect: row == 1\n").runs
    assert (run.name, run.frames, run.machines) == ("main", None, ("default",))
    assert run.max_cycles == MAX_CYCLES
    assert suite_of("; a remark\n  HALT\n").runs == ()


@pytest.mark.parametrize(
    "line",
    [
        '.ascii "; expect: row"',
        "MOV r0, #';' ; ordinary",
        "; expects r0 < 64",
        "; running: fast",
        "; the run: of it",
        "; we expect: nothing",
    ],
)
def test_other_lines_are_left_alone(line: str) -> None:
    assert suite_of(line).runs == ()


@pytest.mark.parametrize(
    ("line", "code", "message"),
    [
        ("; expects: row == 1", "NP270", "'expects:' begins neither"),
        ("; Expect: row == 1", "NP270", "did you mean 'expect:'?"),
        ("; expect row == 1", "NP270", "did you mean 'expect:'?"),
        ("; runs: a frames=x.npy", "NP270", "did you mean 'run:'?"),
        ("; run a levels=1", "NP270", "did you mean 'run:'?"),
        ("; run:", "NP271", "expected a name for the run, found the end of the line"),
        ("; run: frames=x.npy", "NP271", "expected a name for the run, found 'frames=x.npy'"),
        ("; run: a frmes=x.npy", "NP271", "did you mean frames?"),
        ("; run: a frames=", "NP271", "frames: expected a clip such as coin.npy, found nothing"),
        ("; run: a frames=x.npy levels=1", "NP271", "exclude each other"),
        ("; run: a frames=my clip.npy", "NP271", "found 'clip.npy'"),
        ("; run: a levels=0,256", "NP271", "grey levels from 0 to 255"),
        ("; run: a first=0", "NP271", "a whole number from 1 on"),
        ("; run: a max-cycles=1M", "NP271", "a whole number from 1 on"),
        ("; run: a fit=cut", "NP271", "crop or resize"),
        ("; run: a machine=default,default", "NP271", "different machines"),
        ("; run: a define=3", "NP271", "NAME=NUMBER"),
        ("; run: a define=A=1 define=A=2", "NP271", "A is defined twice"),
        ("; run: a memory=w.npy", "NP271", "ADDRESS=FILE"),
        ("; run: a first=1 first=2", "NP271", "'first' is given twice"),
        ("; run: a\n; run: a", "NP272", "a run named 'a' is already there"),
    ],
)
def test_mistakes_in_test_lines(line: str, code: str, message: str) -> None:
    with pytest.raises(AssemblyError) as caught:
        suite_of(line)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == code
    assert message in str(diagnostic)
    assert str(diagnostic).startswith("t.s:")


def test_all_mistakes_are_told_in_one_go() -> None:
    with pytest.raises(AssemblyError) as caught:
        suite_of("; run: a x=1\n; expect: row\n; expect: row = 2\n")
    assert [item.span.line.number for item in caught.value.diagnostics] == [1, 2, 3]


def test_what_a_golden_expectation_asks_for() -> None:
    claims = [parse_claim(Line("t.s", 1, text), 0) for text in ("golden", "golden cycles")]
    assert all(isinstance(claim, GoldenClaim) for claim in claims)
    run = suite_of("; run: a\n; expect: golden outputs\n").runs[0]
    assert (run.golden_outputs, run.golden_cycles) == (True, False)
