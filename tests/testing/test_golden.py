"""Golden files: what they hold, what differs, and what they do with damage."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from npchip.base.errors import InputError
from npchip.run.result import RunError
from npchip.testing.compare import compare
from npchip.testing.golden import Entry, Plane, Row, golden_path, load, record, save, to_text
from tests.support.results import made

PICTURES = (np.arange(3 * 64 * 80) // 77).reshape(3, 64, 80).astype(np.uint8)
OUTPUTS = {
    "row": np.ma.array([0, 31, 33], mask=[True, False, False]),
    "points": [None, [], [5, 6]],
    "picture": PICTURES,
}
RESULT = made(OUTPUTS, [1692, 1693, 2021])
ENTRY = record(RESULT, 174)

cells = st.one_of(
    st.none(),
    st.integers(0, 65535),
    st.lists(st.integers(0, 255), max_size=5).map(tuple),
    st.builds(
        lambda rows, cols, seed: Plane(rows, cols, np.random.default_rng(seed).bytes(rows * cols)),
        st.integers(1, 9),
        st.integers(1, 9),
        st.integers(0, 3),
    ),
)


@st.composite
def entries(draw: st.DrawFn) -> Entry:
    names = draw(st.lists(st.sampled_from(["a", "b", "cycles", "é"]), unique=True))
    timed = draw(st.booleans())

    def row() -> Row:
        return Row(
            draw(st.integers(0, 10**9)) if timed else None, tuple(draw(cells) for _ in names)
        )

    return Entry(
        words=draw(st.integers(0, 512)) if timed else None,
        status=draw(st.sampled_from(["halted", "failed"])),
        error=draw(st.sampled_from([None, "NP310"])),
        instructions=draw(st.integers(0, 10**9)) if timed else None,
        names=tuple(names),
        setup=row(),
        frames=tuple(row() for _ in range(draw(st.integers(0, 30)))),
    )


@given(st.dictionaries(st.text(min_size=1, max_size=5), entries(), max_size=3))
def test_what_is_written_is_read_again(golden: dict[str, Entry]) -> None:
    text = to_text("made.s", golden)
    assert json.loads(text)["schema"] == 1
    with TemporaryDirectory() as folder:
        file = Path(folder) / "made.golden.json"
        save(file, "made.s", golden)
        assert load(file) == golden


def test_it_lies_beside_the_program() -> None:
    assert golden_path(Path("a/coin.s")) == Path("a/coin.golden.json")
    assert load(Path("nowhere.golden.json")) == {}


def test_a_frame_is_a_line_and_equal_pictures_are_kept_once() -> None:
    outputs = {"picture": np.stack([PICTURES[0], PICTURES[1], PICTURES[0]])}
    entry = record(made(outputs, [7, 8, 9]), 3)
    text = to_text("made.s", {"a": entry, "b": entry})
    document = json.loads(text)
    assert len(document["planes"]) == 2
    frames = document["runs"]["a"]["frames"]
    assert f"    {json.dumps(frames[1])},\n" in text
    assert frames[0][1] == frames[2][1]
    assert len(text) < 5000


def test_only_what_is_expected_is_recorded() -> None:
    cycles = record(RESULT, 174, outputs=False)
    assert cycles.names == ()
    assert [row.cycles for row in cycles.frames] == [1692, 1693, 2021]
    outputs = record(RESULT, 174, cycles=False)
    assert (outputs.words, outputs.instructions, outputs.frames[0].cycles) == (None, None, None)
    assert outputs.names == ("row", "points", "picture")


@pytest.mark.parametrize(
    "damage",
    [
        lambda _: "{",
        lambda _: "[]",
        lambda _: "\xff",
        lambda text: text.replace('"schema": 1', '"schema": 2'),
        lambda text: text.replace('"words"', '"wrods"'),
        lambda text: text.replace('"64x80 ', '"64x81 '),
        lambda text: text.replace('"64x80 ', '"64x80 !'),
        lambda text: text.replace("[1692, ", "[1692, 7, "),
        lambda text: text.replace("[1692, ", "[true, "),
        lambda text: text.replace('"columns": ["cycles", "row"', '"columns": ["cycles", 3'),
        lambda text: f"<<<<<<< HEAD\n{text}",
    ],
)
def test_damage_is_told(tmp_path: Path, damage: Any) -> None:
    path = tmp_path / "made.golden.json"
    whole = to_text("made.s", {"coin": ENTRY})
    damaged = damage(whole)
    assert damaged != whole
    path.write_text(damaged, encoding="latin-1")
    with pytest.raises(InputError, match=r"made\.golden\.json") as caught:
        load(path)
    assert caught.value.code == "NP276"


def differences(found: Any, **options: Any) -> list[tuple[str, ...]]:
    return [
        (item.where, item.what, item.expected, item.found, item.note)
        for item in compare(ENTRY, found, **options)
    ]


def test_nothing_differs() -> None:
    assert differences(record(RESULT, 174)) == []


def test_a_pixel_differs() -> None:
    pictures = PICTURES.copy()
    pictures[2, 12, 40] ^= 3
    changed = record(made({**OUTPUTS, "picture": pictures}, [1692, 1693, 2021]), 174)
    before = int(PICTURES[2, 12, 40])
    assert differences(changed) == [
        ("frame 2", "picture", str(before), str(before ^ 3), "at [12, 40]")
    ]
    pictures[2, 63, 79] ^= 1
    changed = record(made({**OUTPUTS, "picture": pictures}, [1692, 1693, 2021]), 174)
    assert differences(changed)[0][4] == "at [12, 40], the first of 2 that differ"


def test_values_and_cycles_differ() -> None:
    outputs = {**OUTPUTS, "row": np.array([0, 31, 34]), "points": [None, [7], None]}
    assert differences(record(made(outputs, [1692, 1705, 2021]), 176)) == [
        ("", "words", "174", "176", "+2, +1.1 %"),
        ("in total", "cycles", "5,411", "5,423", "+12, +0.2 %"),
        ("frame 0", "row", "null", "0", ""),
        ("frame 1", "points", "[]", "[7]", ""),
        ("frame 2", "row", "33", "34", ""),
        ("frame 2", "points", "[5, 6]", "null", ""),
        ("frame 1", "cycles", "1,693", "1,705", "+12, +0.7 %"),
    ]


def test_the_run_differs() -> None:
    failed = made(
        {"row": np.array([0])},
        [1692],
        status="failed",
        error=RunError("NP310", "no"),
        setup=RESULT.setup,
    )
    found = differences(replace(record(failed, 174), words=None))
    assert found[:5] == [
        ("", "status", "frames-exhausted", "failed", ""),
        ("", "error", "null", "NP310", ""),
        ("", "frames", "3", "1", "-2, -66.7 %"),
        ("frame 0", "row", "null", "0", ""),
        ("frame 0", "picture", "64 x 80 values", "null", ""),
    ]


def test_instructions_differ_where_cycles_do_not() -> None:
    entry = record(RESULT, 174)
    found = replace(entry, instructions=(entry.instructions or 0) + 1)
    assert [item[1] for item in differences(found)] == ["instructions"]


def test_an_output_comes_or_goes() -> None:
    more = made({**OUTPUTS, "new": np.array([1, 2, 3])}, [1692, 1693, 2021])
    assert differences(record(more, 174)) == [("", "new", "no such output", "an output", "")]
    assert differences(record(more, 174), extra=False) == []
    fewer = {name: OUTPUTS[name] for name in ("row", "picture")}
    setup = replace(RESULT.setup, outputs=dict.fromkeys(fewer))
    less = made(fewer, [1692, 1693, 2021], setup=setup)
    assert differences(record(less, 174)) == [("", "points", "an output", "no such output", "")]
