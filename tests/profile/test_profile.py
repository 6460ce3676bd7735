"""``npchip profile``: what it reports, against counts made by other means."""

from __future__ import annotations

import json
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip import Chip, assemble, assemble_text
from npchip.cli.main import cli
from npchip.engines.rows import EXECUTED
from npchip.profile import Profile, profile_of
from npchip.profile.exports import lcov, speedscope
from npchip.profile.jsonform import to_document
from npchip.profile.tasks import cycles_by_task
from npchip.profile.text import percent, report
from tests.support.clips import CLIPS, bundled_clips

ASM = Path(__file__).parents[2] / "asm"
PROGRAMS = sorted(path.stem for path in ASM.glob("*.s") if path.stem != "fusion_lut")
"""Programs that need no partner."""
NESTED = """\
.macro twice label
        CALL    label
        CALL    label
.endm
        twice   outer
        MOV     r0, #1
        JANY    LO, dead
        HALT
dead:   NOP
        HALT
outer:  CALL    inner
        NOP
        RET
inner:  COL     r1
        CMP     r1, #0
        WHERE   EQ
          NOP
        END
        RET
"""


def invoke(*args: str | Path) -> Result:
    return CliRunner().invoke(cli, ["profile", *map(str, args)])


def profiled(source: str) -> Profile:
    chip = Chip(assemble_text(source, "nested.s"), profile=True)
    return profile_of(chip, chip.run())


def real(name: str, frames: int = 3) -> tuple[Chip, Profile]:
    chip = Chip(assemble(ASM / f"{name}.s"), profile=True)
    result = chip.run(bundled_clips()["coin_slide"][4 : 4 + frames], max_cycles=300_000)
    return chip, profile_of(chip, result)


def read_lcov(text: str) -> dict[str, dict[str, list[list[str]]]]:
    """Records of a tracefile by file and key, read as geninfo(1) describes them."""
    files: dict[str, dict[str, list[list[str]]]] = {}
    record: dict[str, list[list[str]]] = defaultdict(list)
    for line in text.splitlines():
        key, _, rest = line.partition(":")
        if key == "end_of_record":
            files[record["SF"][0][0]] = dict(record)
            record = defaultdict(list)
        else:
            record[key].append(rest.split(","))
    assert not record
    return files


def test_calls_are_told_apart_by_caller_and_added_up() -> None:
    root = profiled(NESTED).calls
    assert (root.name, root.calls, root.own) == ("program", 1, 2 + 3)
    (outer,) = root.children
    assert (outer.name, outer.calls, outer.own) == ("outer", 2, 2 * 3)
    (inner,) = outer.children
    assert (inner.name, inner.calls, inner.own) == ("inner", 2, 2 * 6)
    assert root.total == 5 + 6 + 12
    assert [depth for depth, _ in root.walk()] == [0, 1, 2]


def test_labels_and_outcomes() -> None:
    profile = profiled(NESTED)
    assert [(item.name, item.words, item.executions, item.cycles) for item in profile.labels] == [
        ("(start)", 5, 1, 5),
        ("dead", 2, 0, 0),
        ("outer", 3, 2, 6),
        ("inner", 6, 2, 12),
    ]
    branch, mask = profile.branches
    assert (branch.kind, branch.yes, branch.no, branch.covered) == ("branch", 0, 1, 1)
    assert (mask.kind, mask.yes, mask.no, mask.covered) == ("mask", 2 * 8, 2 * 72, 2)
    assert profile.words[13].active == 8 / 80
    assert profile.words[5].active is None
    text = report(profile)
    assert "nested.s:9: dead: NOP: never executed, nor the word after it" in text
    assert "nested.s:7: JANY LO, dead: never taken" in text
    assert "14 of 16 words, 1 of 2 outcomes of branches, 2 of 2 of masks" in text


@pytest.mark.long
@pytest.mark.parametrize("name", PROGRAMS)
def test_every_cycle_is_accounted_for(name: str) -> None:
    chip, profile = real(name)
    assert profile.cycles == chip.cycles == profile.calls.total
    assert sum(label.cycles for label in profile.labels) == chip.cycles
    assert sum(label.words for label in profile.labels) == len(chip.program.words)
    tasks = cycles_by_task(chip.program, chip.machine, chip.isa, chip.executions)
    assert sum(tasks.values()) == profile.cycles
    assert [word.executions for word in profile.words] == chip.executions.tolist()
    frames = profile.frames
    assert frames is not None
    assert frames.least <= frames.median <= frames.most


def test_frames_are_numbered_since_reset_and_one_cut_short_is_left_out() -> None:
    chip = Chip(assemble(ASM / "trajectory.s"), profile=True)
    clip = bundled_clips()["coin_slide"]
    chip.run(clip[:4])
    frames = profile_of(chip, chip.run(clip[4:8])).frames
    assert frames is not None
    assert (frames.count, frames.least_at, frames.most_at) == (4, 4, 5)
    chip.reset()
    cut = profile_of(chip, chip.run(clip[:9], max_cycles=1_800)).frames
    assert cut is not None
    assert (cut.count, cut.most) == (5, 1693)


def test_a_chip_that_does_not_count_has_no_profile() -> None:
    chip = Chip(assemble_text("HALT\n"))
    with pytest.raises(ValueError, match="profile=True"):
        profile_of(chip, chip.run())


@pytest.mark.parametrize("name", ["trajectory", "dct", "edges"])
def test_a_tracefile_agrees_with_the_counts(name: str) -> None:
    chip, profile = real(name)
    files = read_lcov(lcov(profile))
    executions = chip.executions.tolist()
    lines: dict[tuple[str, int], int] = defaultdict(int)
    for address, place in enumerate(chip.program.source):
        lines[place.file, place.line] += executions[address]
    for file, record in files.items():
        found = {int(number): int(count) for number, count in record["DA"]}
        assert int(record["LF"][0][0]) == len(found)
        assert int(record["LH"][0][0]) == sum(count > 0 for count in found.values())
        for (own, number), count in lines.items():
            if own == file:
                assert found[number] == count
        outcomes = record.get("BRDA", [])
        assert int(record["BRF"][0][0]) == len(outcomes)
        assert int(record["BRH"][0][0]) == sum(count not in {"0", "-"} for *_, count in outcomes)
    assert {file for file, _ in lines} <= set(files)


def test_a_tracefile_names_routines_and_what_was_never_reached() -> None:
    (record,) = read_lcov(lcov(profiled(NESTED))).values()
    assert record["FN"] == [["11", "outer"], ["14", "inner"]]
    assert record["FNDA"] == [["2", "outer"], ["2", "inner"]]
    assert ["5", "1"] in record["DA"]  # the line that used the macro
    assert ["2", "1"] in record["DA"]
    assert ["9", "0"] in record["DA"]
    never = "JANY EQ, a\nHALT\na: HALT\n".replace("JANY EQ, a\n", "JMP b\nb: HALT\nJANY EQ, a\n")
    (record,) = read_lcov(lcov(profiled(never))).values()
    assert [item[-1] for item in record["BRDA"]] == ["-", "-"]


LOOPS = """\
.macro five
        MOV     r0, #5
.again: SUB     r0, #1
        CALL    leaf
        JANY    NE, .again
.endm
.macro from_its_top
.again: ADD     r1, #1
        CMP     r1, #5
        JANY    NE, .again
.endm
        from_its_top
        five
        five
        JMP     on
        five
on:     .rept 2
        from_its_top
        .endr
        CALL    routine
        CALL    routine
        HALT
leaf:   RET
routine: five
        RET
"""


def test_a_line_that_uses_a_macro_counts_how_often_it_was_entered() -> None:
    (record,) = read_lcov(lcov(profiled(LOOPS))).values()
    found = {int(line): int(count) for line, count in record["DA"]}
    assert {line: found[line] for line in (12, 13, 14, 16, 17, 18, 24)} == {
        12: 1,
        13: 1,
        14: 1,
        16: 0,
        17: 1,
        18: 2,
        24: 2,
    }
    assert (found[2], found[3], found[8]) == (4, 20, 5 + 256 + 256)
    assert record["FN"] == [["23", "leaf"], ["24", "routine"]]
    frames = ".macro loop\na: EXPOSE\n JMP a\n.endm\n.macro one\n EXPOSE\n.endm\n"
    for use, count in (("loop", 1), ("b: one\n JMP b", 3)):
        chip = Chip(assemble_text(f"{frames} {use}\n", "x.s"), profile=True)
        profile = profile_of(chip, chip.run(np.zeros((3, 64, 80), np.uint8)))
        (record,) = read_lcov(lcov(profile)).values()
        assert ["8", str(count)] in record["DA"]


@pytest.mark.parametrize("name", ["trajectory", "keypoints"])
def test_a_flame_graph_has_all_cycles_under_their_callers(name: str) -> None:
    chip, profile = real(name)
    document = json.loads(speedscope(profile))
    (graph,) = document["profiles"]
    frames = document["shared"]["frames"]
    assert graph["endValue"] == sum(graph["weights"]) == chip.cycles
    assert all(0 <= item < len(frames) for sample in graph["samples"] for item in sample)
    by_path: dict[tuple[str, ...], int] = defaultdict(int)
    for sample, weight in zip(graph["samples"], graph["weights"], strict=True):
        assert frames[sample[-1]]["line"]
        by_path[tuple(frames[item]["name"] for item in sample[:2])] += weight
    for call in profile.calls.children:
        assert by_path[profile.calls.name, call.name] == call.total


def test_json_is_the_profile() -> None:
    profile = profiled(NESTED)
    document: dict[str, Any] = to_document(profile)
    done = json.loads(json.dumps(document))
    assert done["schema"] == 1
    assert done["cycles"] == 23
    assert [word["executions"] for word in done["words"]] == [w.executions for w in profile.words]
    assert done["calls"]["children"][0]["children"][0]["cycles"] == 12
    assert done["branches"][1] == {"kind": "mask", "address": 12, "yes": 16, "no": 144}
    assert done["cycles_per_frame"] is None


@pytest.mark.parametrize(
    ("part", "shown"),
    [(0, "0.0%"), (0.0004, "<0.1%"), (0.5, "50.0%"), (0.9999, ">99.9%"), (1, "100.0%")],
)
def test_a_share_is_neither_nothing_nor_all_if_it_is_only_near(part: float, shown: str) -> None:
    assert percent(part) == shown


# ---- the command


def test_the_command_writes_everything(tmp_path: Path) -> None:
    files = {name: tmp_path / f"x.{name}" for name in ("info", "json", "png", "svg")}
    for chart in ("png", "svg"):
        done = invoke(
            *(ASM / "trajectory.s", "--frames", CLIPS / "coin_slide.npy"),
            *("--lcov", files["info"], "--speedscope", files["json"], "--plot", files[chart]),
        )
        assert done.exit_code == 0, done.output
    assert "174 of 174 words" in done.stdout
    assert "maximum 1,997 (frame 5)" in done.stdout
    assert files["png"].read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in files["svg"].read_bytes()
    assert "end_of_record" in files["info"].read_text()
    assert json.loads(files["json"].read_text())["exporter"] == "npchip"
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "x.info",
        "x.json",
        "x.png",
        "x.svg",
    ]


def test_the_listing_has_each_word_once() -> None:
    done = invoke(ASM / "trajectory.s", "--frames", CLIPS / "coin_slide.npy", "--listing")
    assert done.exit_code == 0
    rows = [line for line in done.stdout.splitlines() if line[:3].strip() and line[3:6] == "   "]
    assert len(rows) == 174
    assert "00F        7       7  <0.1%   14.3%     61            MOV   last_row, row" in rows


def test_json_of_both_engines_is_the_same() -> None:
    documents = []
    for engine in ("wasm", "reference"):
        done = invoke(
            ASM / "imaging.s", "--frames", CLIPS / "coin_slide.npy", "--json", "--engine", engine
        )
        documents.append(json.loads(done.stdout))
        assert documents[-1].pop("engine") == engine
    assert documents[0] == documents[1]


def test_an_image_without_source_has_addresses(tmp_path: Path) -> None:
    image = tmp_path / "x.hex"
    image.write_text("002A\n")  # HALT
    done = invoke(image, "--listing")
    assert done.exit_code == 0
    assert done.stdout.splitlines()[1].split() == ["000", "1", "1", "100.0%", "100.0%", "HALT"]
    refused = invoke(image, "--lcov", tmp_path / "x.info")
    assert refused.exit_code == 2
    assert "[NP600]" in refused.stderr


@pytest.mark.parametrize(
    ("options", "code"),
    [
        (["--json", "--listing"], "NP601"),
        (["--plot", "x.pdf"], "NP602"),
        (["--lcov", "missing/x.info"], "NP250"),
        ([], "NP246"),
    ],
)
def test_what_cannot_be_done_is_refused(options: list[str], code: str) -> None:
    done = invoke(ASM / "imaging.s", *options)
    assert done.exit_code == 2
    assert f"[{code}]" in done.stderr
    assert done.stdout == ""


def test_a_failed_run_is_profiled_and_fails(tmp_path: Path) -> None:
    source = tmp_path / "x.s"
    source.write_text("a: CALL a\n")
    done = invoke(source)
    assert done.exit_code == 1
    assert "[NP301]" in done.stderr
    assert "FAILED" in done.stdout
    endless = invoke(source.with_name("x.s"), "--max-cycles", "2")
    assert endless.exit_code == 3
    assert "[NP321]" in endless.stderr


def test_tables_of_a_call_stack_are_those_of_the_chip() -> None:
    chip, profile = real("trajectory")
    counts = chip.counts
    assert counts is not None
    assert set(profile.stacks) == {stack for stack, _ in counts.used()}
    total = sum(table[EXECUTED] for table in profile.stacks.values())
    np.testing.assert_array_equal(total, chip.executions)
