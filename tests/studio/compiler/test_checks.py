"""The page's verdicts on a run are those of ``npchip test``."""

from __future__ import annotations

import base64
import contextlib
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from npchip.frames.memory import read_memory
from npchip.machine import load_machine, parse_machine
from npchip.report.jsonform import to_document
from npchip.studio.precompiled import bundled_tables
from npchip.studio.toolchain.facade import Toolchain
from npchip.studio.toolchain.tables import from_text, table_for, to_text
from npchip.testing import runner
from npchip.testing.cases import cases_of
from npchip.testing.golden import golden_path, load
from npchip.testing.report import outcome_lines
from npchip.testing.runner import Settings, execute, run_case
from npchip.testing.suite import parse_suite, read_suite
from tests.studio.compiler.calls import RefusedError, bundled, call, request
from tests.support.programs import ASM

if TYPE_CHECKING:
    from collections.abc import Iterator

    from npchip import Chip, RunResult
    from npchip.testing.cases import Case

PROGRAMS = sorted(path.stem for path in ASM.glob("*.s"))
QUICK = {"frame_difference", "imaging"}


@pytest.fixture
def toolchain(tmp_path: Path) -> Toolchain:
    return Toolchain(tmp_path / "project", bundled_tables())


@pytest.fixture(autouse=True)
def in_asm() -> Iterator[None]:
    """Names in messages are relative, as in the page; clips are found all the same."""
    with contextlib.chdir(ASM):
        yield


def document_of(chip: Chip, result: RunResult) -> Any:
    """A ``RunDocument``."""
    document = to_document(result, 1)
    document["setup"]["instructions"] = result.setup.instructions
    for frame, count in zip(document["frames"], result.frame_instructions, strict=True):
        frame["instructions"] = int(count)
    if result.status == "cycle-limit":
        at = {"address": chip.pc, "stack": chip.stack, "depth": chip.depth}
        document["stoppedAt"] = at
    return document


def check(toolchain: Toolchain, case: Case, golden: Any) -> list[Any]:
    """Compare the verdicts on a case with its outcome; return them."""
    chip, result = execute(case, Settings())
    document = document_of(chip, result)
    verdicts: list[Any] = call(toolchain, "judge", case.run.name, case.machine, document)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runner, "execute", lambda *_: (chip, result))  # runs take most of the time
        outcome = run_case(case, golden, Settings())
    failed = [item for item in verdicts if not item["holds"]]
    said = [
        item["found"]
        if item["claim"] == "a run that ends" or item["claim"].startswith((".", "golden"))
        else f"{item['place']['file']}:{item['place']['line']}: expected {item['claim']}; "
        + item["found"]
        for item in failed
    ]
    outcome.over = False  # the page shows cycles beside the lines
    assert "\n".join(said) == "\n".join(outcome_lines(outcome))
    assert bool(failed) == (outcome.state == "failed")
    held = {item["place"]["line"] for item in verdicts if item["holds"]}
    assert held == outcome.held
    assert all(item["run"] == case.run.name for item in verdicts)
    return verdicts


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=() if n in QUICK else pytest.mark.long) for n in PROGRAMS]
)
def test_programs(toolchain: Toolchain, name: str) -> None:
    path = Path(f"{name}.s")
    cases, golden = cases_of(read_suite(path)), load(golden_path(path))
    found = call(toolchain, "tests", request(bundled(name)))
    assert found["diagnostics"] == []
    assert [(run["name"], run["machine"]) for run in found["runs"]] == [
        (case.run.name, case.machine) for case in cases
    ]
    for run, case in zip(found["runs"], cases, strict=True):
        assert (run["frames"], run["first"], run["fit"]) == (
            case.run.frames,
            case.run.first,
            case.run.fit,
        )
        assert run["defines"] == case.run.defines
        assert run["maxCycles"] == case.run.max_cycles
        assert (run["refused"] is None) == (not case.run.partner and ".yaml" not in case.machine)
        assert [part["address"] for part in run["memory"]] == (
            [] if ".yaml" in case.machine else [at for at, _ in case.run.memory]
        )
        if ".yaml" not in case.machine:  # that file is not in the project
            assert check(toolchain, case, golden)


FAILING = """\
; expect: {claim}
; run: some frames=../examples/clips/coin_slide.npy first=3
"""
CLAIMS = (
    "difference[0] == 1",
    "difference[any][3, 4] == 300",
    "difference[2][0..9, 5..70] < 1",
    "difference[all][63, 79] >= 0",
    "difference[1] == null",
    "difference[7] == 0",
    "difference[0][64, 0] == 0",
    "sum(difference[1]) == 3",
    "max(difference[0..2]) != 0..255",
    "len(difference[1]) == 5120",
    "cycles[worst] == 1",
    "cycles[total] < 9",
    "cycles == 2372, 2372, 1",
    "instructions[setup] == 1",
    "frames == 4",
    "words < 3",
    "status == halted",
    "error == NP301",
)


@pytest.mark.parametrize("claim", CLAIMS)
def test_claims(toolchain: Toolchain, claim: str) -> None:
    text = with_claims(f"; expect: {claim}")
    (case,) = cases_of(parse_suite(text, Path("frame_difference.s")))
    project = bundled("frame_difference")
    project["files"]["frame_difference.s"] = text
    assert call(toolchain, "tests", request(project))["diagnostics"] == []
    check(toolchain, case, {})


def with_claims(lines: str) -> str:
    """The text of frame_difference.s with other test lines, which end on a run of three frames."""
    text = (ASM / "frame_difference.s").read_text("utf-8")
    kept = [each for each in text.split("\n") if not re.match(r"; (expect|run):", each)]
    run = "; run: some frames=../examples/clips/coin_slide.npy first=3"
    return "\n".join([lines, run, *kept])


@pytest.mark.parametrize("lines", ["; expect: golden", "; expect: golden cycles"])
def test_a_golden_that_lacks_the_run(toolchain: Toolchain, lines: str) -> None:
    text = with_claims(lines)
    project = {"main": "p.s", "files": {"p.s": text}}
    call(toolchain, "tests", request(project))
    (case,) = cases_of(parse_suite(text, Path("frame_difference.s")))
    document = document_of(*execute(case, Settings()))
    (verdict,) = call(toolchain, "judge", "some", "default", document)
    assert verdict["found"] == "nothing is recorded (npchip test --update records it)"


def test_a_golden_that_differs(toolchain: Toolchain) -> None:
    call(toolchain, "tests", request(bundled("frame_difference")))
    cases = {case.name: case for case in cases_of(read_suite(Path("frame_difference.s")))}
    coin = document_of(*execute(cases["coin"], Settings()))
    coin["frames"][3]["cycles"] += 7
    verdict, *_ = call(toolchain, "judge", "coin", "default", coin)[::-1]
    assert (verdict["claim"], verdict["holds"]) == ("golden cycles", False)
    total, frame = verdict["found"].split("\n")
    assert total.startswith("golden: in total  cycles")
    assert frame.startswith("golden: frame 3   cycles")
    assert frame.endswith("+7, +0.3 %")

    moving = document_of(*execute(cases["moving"], Settings()))
    moving["frames"][4]["outputs"]["difference"][5][6] ^= 1
    golden, *others = call(toolchain, "judge", "moving", "default", moving)[::-1]
    assert all(other["holds"] for other in others)
    assert (golden["claim"], golden["holds"]) == ("golden outputs", False)
    assert golden["found"].startswith("golden: frame 4  difference")
    assert golden["found"].endswith("at [5, 6]")


ENDINGS = {
    "a trap": "RET\n",
    "an endless loop": "wait: JMP wait\n",
    "an endless routine": "MOV r0, #1\nCALL f\nHALT\nf: CMP r0, #1\nJANY EQ, f\nRET\n",
    "over its budget": ".budget cycles 2\nframe: EXPOSE\nNOP\nNOP\nNOP\nJMP frame\n",
}


@pytest.mark.parametrize("source", ENDINGS.values(), ids=list(ENDINGS))
def test_endings(toolchain: Toolchain, tmp_path: Path, source: str) -> None:
    text = f"; run: r levels=1,2 max-cycles=900\n; expect: words < 99\n{source}"
    (tmp_path / "program.s").write_text(text)
    with contextlib.chdir(tmp_path):
        (case,) = cases_of(read_suite(Path("program.s")))
        assert call(toolchain, "tests", request(text))["diagnostics"] == []
        verdicts = check(toolchain, case, {})
    assert any(not item["holds"] for item in verdicts)


@pytest.mark.parametrize(
    ("text", "code", "line"),
    [
        ("; expect: nothing[", "NP270", 1),
        ("HALT\n; expect: total == 1", "NP273", 2),
        ("; expect: words == 1\n; run: a define=X=1\nHALT", "NP026", 2),
        ("; expect: words == 1\n; run: a machine=huge\nHALT", "NP202", 2),
        ("; run: a\nHALT", "NP275", 1),
        ("; expect: words == 1\nFOO", "NP003", 2),
    ],
)
def test_mistakes_in_test_lines(toolchain: Toolchain, text: str, code: str, line: int) -> None:
    found = call(toolchain, "tests", request(text))
    assert found["runs"] == []
    (mistake,) = found["diagnostics"]
    assert (mistake["code"], mistake["place"]["line"]) == (code, line)
    with pytest.raises(RefusedError):
        call(toolchain, "judge", "a", "default", {})


def test_memory(toolchain: Toolchain) -> None:
    """The memory of a run is that of the file."""
    runs = call(toolchain, "tests", request(bundled("correlate")))["runs"]
    (part,) = runs[0]["memory"]
    wanted = read_memory(128, ASM / "../examples/templates/disc.npy", load_machine("default"))
    assert (part["address"], part["planes"]) == (128, len(wanted))
    assert base64.b64decode(part["data"]) == wanted.tobytes()
    tables = bundled_tables()
    assert from_text(to_text(tables)) == tables
    small = parse_machine("extends: default\ngeometry: {np_rows: 2}\n", "small.yaml")
    named = "../examples/templates/disc.npy"
    assert table_for(tables, named, 0, load_machine("default"))
    assert table_for(tables, named, 0, small) is None
    assert table_for(tables, named, 255, load_machine("default")) is None


@pytest.mark.parametrize("file", ["disc.npy", "lib/disc.npy", "templates/disc.npy"])
def test_a_file_of_the_reader_is_not_taken_for_one_of_npchip(
    toolchain: Toolchain, file: str
) -> None:
    lines = f"; expect: words == 1\n; run: a memory=128={file}\nHALT"
    (run,) = call(toolchain, "tests", request(lines))["runs"]
    assert run["memory"] == []
    assert file in run["refused"]


def test_what_the_page_cannot_run(toolchain: Toolchain) -> None:
    lines = "; expect: words == 1\n; run: a memory=0=w.npy\n; run: b machine=mine.yaml\n"
    lines += "; run: c partner=x.s partner-frames=y.npy\n; run: d levels=1\nHALT"
    refused = [run["refused"] for run in call(toolchain, "tests", request(lines))["runs"]]
    for reason, word in zip(refused[:3], ("w.npy", "mine.yaml", "x.s"), strict=True):
        assert word in reason
    assert refused[3] is None
    with pytest.raises(RefusedError, match=r"mine\.yaml"):
        call(toolchain, "judge", "b", "mine.yaml", {"status": "halted"})
    with pytest.raises(RefusedError, match="no run 'e'"):
        call(toolchain, "judge", "e", "default", {"status": "halted"})


def test_a_run_without_frames_that_wants_some(toolchain: Toolchain) -> None:
    call(toolchain, "tests", request("; expect: words == 1\nEXPOSE\nHALT"))
    with pytest.raises(RefusedError, match=r"takes frames.*NP279"):
        call(toolchain, "judge", "main", "default", {"status": "frames-exhausted"})


def test_a_damaged_golden(toolchain: Toolchain) -> None:
    files = {"p.s": "; expect: golden\nHALT", "p.golden.json": "{"}
    found = call(toolchain, "tests", request({"main": "p.s", "files": files}))
    assert [item["code"] for item in found["diagnostics"]] == ["NP276"]
