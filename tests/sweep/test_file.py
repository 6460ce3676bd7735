"""Sweep files: what they say, and what is refused with its line."""

from __future__ import annotations

from pathlib import Path

import pytest

from npchip.base.errors import InputError
from npchip.sweep import load
from npchip.sweep.axes import AxisError, values
from tests.support.sweeps import ROWS, folder_for, sweep_file


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1..4", (1, 2, 3, 4)),
        ("8..64..8", tuple(range(8, 65, 8))),
        ("8..63..8", tuple(range(8, 57, 8))),
        ("0..0.3..0.1", (0.0, 0.1, 0.2, 0.3)),
        ("-2..2..2", (-2, 0, 2)),
        ([3, 1], (3, 1)),
        (7, (7,)),
        ("default", ("default",)),
    ],
)
def test_values_of_an_axis(text: object, expected: tuple[object, ...]) -> None:
    assert values(text) == expected
    assert [*map(type, values(text))] == [*map(type, expected)]


@pytest.mark.parametrize("text", ["4..1", "1..9..0", "1..9..-1", "1..9999999", [], [1, 1]])
def test_what_is_no_axis(text: object) -> None:
    with pytest.raises(AxisError):
        values(text)


def test_the_order_of_the_rows(tmp_path: Path) -> None:
    runs = load(folder_for(tmp_path)).runs
    assert len(runs) == ROWS  # noise 0 is the default machine, so it is no row of its own
    assert [name for name, _ in runs[0].axes] == [
        *("program", "clip", "machine", "THRESHOLD", "noise_rms", "seed")
    ]
    shown = [tuple(dict(run.axes).values()) for run in runs]
    assert shown[:5] == [
        ("trajectory", "coin_slide", "default", 24, 0.0, None),
        ("trajectory", "coin_slide", "default", 40, 0.0, None),
        ("trajectory", "coin_slide", "default", 24, 4.0, None),
        ("trajectory", "coin_slide", "default", 40, 4.0, None),
        ("trajectory", "ball", "default", 24, 0.0, None),
    ]
    assert shown[-1] == ("tracking", "scene", "default", 40, 4.0, 3)


def test_a_pattern_is_a_clip_each_and_a_truth_is_none(tmp_path: Path) -> None:
    folder_for(tmp_path)
    file = sweep_file(tmp_path, 'programs: [count.s]\nclips: ["*a*.npy", "b*"]\n')
    labels = [dict(run.axes)["clip"] for run in load(file).runs]
    assert len(set(labels)) == 2  # ball.npy is named twice and computed once
    assert "dark" in labels


@pytest.mark.parametrize(
    ("text", "line", "code"),
    [
        ("programs: [count.s]\nclip: [dark.npy]\n", 2, "NP642"),
        ("clips: [dark.npy]\n", 1, "NP643"),
        ("programs: count.s\n", 1, "NP644"),
        ("programs: []\n", 1, "NP644"),
        ("programs: [nothing.s]\n", 1, "NP644"),
        ("programs: [count.s]\nclips: [7]\n", 2, "NP644"),
        ("programs: [count.s]\nclips: [nothing.npy]\n", 2, "NP644"),
        ('programs: [count.s]\nclips: ["no*.npy"]\n', 2, "NP644"),
        ("programs: [count.s]\nclips: [{scene: scene.yaml, seeds: [-1]}]\n", 2, "NP644"),
        ("programs: [count.s]\nclips: [{scene: scene.yaml, seed: 1}]\n", 2, "NP642"),
        ("programs: [count.s]\ndefine:\n  STEP: 4..1\n", 3, "NP645"),
        ("programs: [count.s]\ndefine:\n  STEP: [1.5]\n", 3, "NP644"),
        ("programs: [count.s]\nfirst: 0\n", 2, "NP644"),
        ("programs: [count.s]\nmachines: [{extends: default,\n sensor: {noise: 1}}]\n", 3, "NP203"),
        (
            "programs: [count.s]\nmachines: [{extends: default,\n sensor: {noise_rms: 9..1}}]\n",
            3,
            "NP645",
        ),
        ("experiment: math\n", 1, "NP644"),
        ("experiment: math:sqrt\nclips: [dark.npy]\n", 2, "NP642"),
        ("programs: [count.s\n", 2, "NP641"),
    ],
)
def test_mistakes_name_their_line(tmp_path: Path, text: str, line: int, code: str) -> None:
    folder_for(tmp_path)
    file = sweep_file(tmp_path, text)
    with pytest.raises(InputError) as caught:
        load(file)
    assert str(caught.value).startswith(f"{file}:{line}: error: ")
    assert caught.value.code == code


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("programs: [count.s]\ndefine: {STEP: 1..2000, LIMIT: 1..2000}\n", "NP645"),
        ("programs: [count.s]\ndefine: {status: [1]}\n", "NP646"),
        (
            "programs: [count.s]\nmachines: [default, {extends: default, sensor: {seed: 2}}]\n",
            "NP646",
        ),
        ("experiment: no.such:thing\n", "NP647"),
    ],
)
def test_sweeps_that_make_no_sense(tmp_path: Path, text: str, code: str) -> None:
    folder_for(tmp_path)
    sweep = load(sweep_file(tmp_path, text))
    with pytest.raises(InputError, match=code):
        _ = sweep.runs
