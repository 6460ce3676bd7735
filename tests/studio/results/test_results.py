"""The results in the studio's page against npchip's own files, pictures and profiles."""

from __future__ import annotations

import csv
import io
import json
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest

from npchip.profile.text import percent
from npchip.report.drawing import Mark
from npchip.report.picture import _scene
from tests.studio.results.runs import Run
from tests.support.page_code import Answers, Bundles

pytestmark = pytest.mark.long

RUNS = [
    ("trajectory", "coin_slide"),
    ("trajectory_nonlinear", "mouse_run"),
    ("keypoints", "shapes_drawn"),
    ("statistics", "shapes_photo"),
    ("edges", "shapes_drawn"),
    ("correlate", "shapes_drawn"),
    ("orientation", "shapes_drawn"),
]
TRACKING = [
    ("trajectory", "coin_slide"),
    ("trajectory", "mouse_run"),
    ("trajectory_nonlinear", "ball_fall_30000fps"),
    ("tracking", "city_night"),
    ("edges", "shapes_drawn"),
    ("follow", "mouse_run"),
]


@cache
def run(program: str, clip: str) -> Run:
    return Run(program, clip, 16)


@pytest.fixture(scope="module")
def page(bundles: Bundles) -> Iterator[Answers]:
    """The page's results in a process of Node."""
    with Answers(bundles.for_node("results/harness.ts")) as answers:
        yield answers


@pytest.mark.parametrize(("program", "clip"), RUNS)
@pytest.mark.parametrize("size", [1, 5, 100])
def test_json_is_what_run_prints(page: Answers, program: str, clip: str, size: int) -> None:
    made = run(program, clip)
    saved = page.ask({"ask": "saved", "run": made.for_page, "size": size})
    assert saved["json"] == made.json


def test_json_of_a_run_that_can_go_on_has_no_status(page: Answers) -> None:
    made = run("trajectory", "coin_slide")
    saved = page.ask({"ask": "saved", "run": made.for_page, "size": 5})
    assert json.loads(saved["running"]) == json.loads(made.json) | {"status": None}


def test_json_without_a_known_setup_says_so(page: Answers) -> None:
    made = run("trajectory", "coin_slide")
    saved = page.ask({"ask": "saved", "run": made.for_page, "size": 5})
    assert json.loads(saved["unknown"]) == json.loads(made.json) | {"setup": None}


@pytest.mark.parametrize(("program", "clip"), RUNS)
def test_csv_reads_as_the_document(page: Answers, program: str, clip: str) -> None:
    made = run(program, clip)
    text = page.ask({"ask": "saved", "run": made.for_page, "size": 5})["csv"]
    assert text.count("\r\n") == text.count("\n") == 2 + len(made.clip)
    rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    images = ("plane", "picture")
    names = [item.name for item in made.program.outputs if item.kind not in images]
    assert rows[0] == ["frame", *names, "cycles"]
    document = json.loads(made.json)
    entries = [document["setup"] | {"index": "setup"}, *document["frames"]]
    for row, entry in zip(rows[1:], entries, strict=True):
        cells = [written(entry["outputs"].get(name)) for name in names]
        assert row == [str(entry["index"]), *cells, str(entry["cycles"])]


def written(value: Any) -> str:
    if value is None:
        return ""
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)


@pytest.mark.parametrize(("program", "clip"), TRACKING)
@pytest.mark.parametrize("live", [True, False])
def test_marks_are_those_of_render(page: Answers, program: str, clip: str, *, live: bool) -> None:
    made = run(program, clip)
    answer = page.ask({"ask": "marks", "run": made.for_page, "size": 5, "live": live})
    kinds = answer["kinds"]
    path = []
    for k, marks in enumerate(answer["frames"]):
        scene = _scene(made.result, made.program, list(made.clip), k)
        (mark,) = scene.marks or (Mark([], None, None),)
        if marks["path"]:
            path.append(point(marks["path"]))
        assert (kinds["place"] is not None) == scene.shows_path
        assert kinds["box"] == scene.shows_box
        assert path == mark.path
        assert point(marks["center"]) == mark.center
        assert point(marks["predicted"]) == mark.predicted
        assert box(marks["box"]) == scene.box
        if kinds["place"]:
            assert kinds["prediction"] == (scene.ahead > 0)
            assert not scene.ahead or kinds["ahead"] == scene.ahead


def test_some_frames_have_marks_and_some_have_none(page: Answers) -> None:
    made = run("trajectory", "coin_slide")
    frames = page.ask({"ask": "marks", "run": made.for_page, "size": 5})["frames"]
    for mark in ("center", "predicted", "box"):
        assert {frame[mark] is None for frame in frames} == {True, False}


def point(found: dict[str, int] | None) -> tuple[int, int] | None:
    return (found["row"], found["column"]) if found else None


def box(found: dict[str, int] | None) -> tuple[int, ...] | None:
    return tuple(found[side] for side in ("top", "left", "bottom", "right")) if found else None


@pytest.mark.parametrize("program", ["edges", "correlate"])
def test_ranges_are_those_of_the_run(page: Answers, program: str) -> None:
    made = run(program, "shapes_drawn")
    ranges = page.ask({"ask": "ranges", "run": made.for_page, "size": 5})
    assert ranges == [
        [int(made.result.outputs[output.name].min()), int(made.result.outputs[output.name].max())]
        for output in made.program.outputs
    ]


@pytest.mark.parametrize(("program", "clip"), RUNS)
def test_cycles_are_grouped_as_in_a_profile(page: Answers, program: str, clip: str) -> None:
    made = run(program, clip)
    parts = page.ask({"ask": "parts", "run": made.for_page})
    keys = ("name", "address", "words", "cycles")
    assert [{key: part[key] for key in keys} for part in parts["labels"]] == [
        {key: label[key] for key in keys} for label in made.profile["labels"]
    ]
    lines: dict[str, int] = defaultdict(int)
    for word in made.profile["words"]:
        lines[f"{word['file']}:{word['line']}"] += word["cycles"]
    assert {part["name"]: part["cycles"] for part in parts["lines"]} == lines
    dearest = [part["cycles"] for part in parts["ranked"]]
    assert dearest == sorted((count for count in lines.values() if count), reverse=True)


def test_shares_read_as_in_a_profile(page: Answers) -> None:
    shares = [0, 1, 0.5, 0.0004, 0.0006, 0.9996, 0.99949, 1e-9, 1 / 3]
    assert page.ask({"ask": "percents", "shares": shares}) == [percent(part) for part in shares]


@pytest.mark.parametrize("program", ["edges", "trajectory", "keypoints"])
@pytest.mark.parametrize("size", [1, 3, 100])
def test_trimming_keeps_the_newest(page: Answers, program: str, size: int) -> None:
    made = run(program, "coin_slide")
    keep = {"frames": 8, "images": 4, "block": 3}
    question = {"ask": "trimmed", "run": made.for_page, "size": size, "keep": keep}
    seen = page.ask(question)
    document = json.loads(made.json)
    count = len(document["frames"])
    assert seen["gaps"] == 0
    assert seen["setup"]["cycles"] == document["setup"]["cycles"]
    assert keep["frames"] <= sum(seen["lengths"]) <= max(size, keep["frames"] + 2 * keep["block"])
    with_input = [k for k, frame in enumerate(seen["frames"]) if frame["input"]]
    assert with_input == list(range(count - len(with_input), count))
    assert keep["images"] <= len(with_input) <= keep["images"] * 1.25
    kinds = {output.name: output.kind for output in made.program.outputs}
    for k, frame in enumerate(seen["frames"]):
        expected = document["frames"][k]
        assert frame["cycles"] == (expected["cycles"] if k >= seen["first"] else None)
        for name, value in frame["outputs"].items():
            is_image = kinds[name] in ("plane", "picture")
            if k < seen["first"] or (is_image and k not in with_input):
                assert value == "gone"
            elif is_image:
                assert value == np.ravel(expected["outputs"][name]).tolist()
            else:
                assert value == expected["outputs"][name]
    if program == "edges":
        assert seen["images"] == with_input[0]


def test_long_lists_and_large_planes_stay_within_bounds(page: Answers) -> None:
    seen = page.ask({"ask": "large"})
    lists, planes = (1 << 20) // (32 + 8 * 128 + 16), (1 << 18) // (64 * 64)
    assert lists / 2 < seen["left"] <= seen["numbers"] <= lists * 1.25 + 10
    assert planes <= seen["images"] <= planes * 1.25 + 10
    assert seen["last"] == 2_000


def test_a_long_run_stays_within_bounds(page: Answers) -> None:
    seen = page.ask({"ask": "long"})
    assert 200_000 <= seen["most"] <= 210_000
    assert seen["longest"] <= 3_000
    assert seen["right"]


def test_few_rows_of_a_long_table_are_drawn(page: Answers) -> None:
    rows = page.ask({"ask": "rows"})
    assert rows["few"] == {"start": 0, "end": 200, "above": 0}
    assert rows["top"]["start"] == 0
    middle = rows["middle"]
    assert middle["start"] <= 49_990
    assert middle["end"] >= 50_020
    assert middle["above"] == 28 * middle["start"]
    assert rows["end"]["end"] == 100_000
    assert all(part["end"] - part["start"] <= 40 for part in (rows["top"], middle, rows["end"]))
    assert rows["keys"] == [0, 1, 8, 0, 99, None]


@pytest.mark.parametrize("count", [1, 5, 16])
def test_chart_shows_all_numbers(page: Answers, count: int) -> None:
    made = run("trajectory", "coin_slide")
    question = {"ask": "series", "run": made.for_page, "size": 5, "bins": count}
    series = {item["name"]: item for item in page.ask(question)}
    columns = {"cycles": made.result.frame_cycles, **made.result.outputs}
    assert list(series) == list(columns)
    for name, column in columns.items():
        values = np.asarray(column)
        assert series[name]["summary"] == {
            "count": len(values),
            "least": values.min(),
            "leastAt": values.argmin(),
            "most": values.max(),
            "mostAt": values.argmax(),
            "newest": values[-1],
        }
        parts = [np.flatnonzero(np.arange(16) * count // 16 == part) for part in range(count)]
        assert series[name]["low"] == [values[part].min() for part in parts]
        assert series[name]["high"] == [values[part].max() for part in parts]


def test_chart_leaves_out_what_is_no_number(page: Answers) -> None:
    made = run("edges", "shapes_drawn")
    question = {"ask": "series", "run": made.for_page, "size": 5, "bins": 2}
    cycles, edges = page.ask(question)
    assert cycles["summary"]["count"] == len(made.clip)
    assert edges == {"name": "edges", "summary": None, "low": [None] * 2, "high": [None] * 2}


def test_verdicts_are_grouped_by_run_and_machine(page: Answers) -> None:
    judged = [
        ("coin", "default", True),
        ("coin", "conservative", False),
        ("coin", "default", False),
        ("faint", "default", True),
    ]
    verdicts = [
        {"run": name, "machine": machine, "holds": holds, "claim": str(at)}
        for at, (name, machine, holds) in enumerate(judged)
    ]
    seen = page.ask({"ask": "verdicts", "verdicts": verdicts})
    assert [(group["name"], len(group["verdicts"])) for group in seen["groups"]] == [
        ("coin on default", 2),
        ("coin on conservative", 1),
        ("faint on default", 1),
    ]
    assert seen["all"] == "✗ 2 of 4 expectations fail."
    assert seen["rest"] == "✓ All 1 expectations hold. – 2 runs need npchip test."
    assert seen["held"] == "✓ All 2 expectations hold."
    assert len(set(seen["none"])) == 3
