"""Changes that make a run a different run, and changes that do not."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from npchip.sweep import content, load
from tests.support.sweeps import folder_for, sweep_file

TEXT = """
programs: [main.s]
clips: [ball.npy, shots, {scene: scene.yaml}]
machines: [own.yaml]
define: {STEP: [1, 2]}
"""


def keys(folder: Path, text: str = TEXT) -> list[str]:
    return [run.key for run in load(sweep_file(folder, text)).runs]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder_for(tmp_path)
    (tmp_path / "main.s").write_text('.include "lib/body.s"\n')
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "body.s").write_text((tmp_path / "count.s").read_text())
    np.save(tmp_path / "lib" / "table.npy", np.zeros((1, 8, 10), np.uint8))
    with (tmp_path / "lib" / "body.s").open("a") as body:
        body.write('.memory 9, "table.npy"\n')
    (tmp_path / "own.yaml").write_text("extends: default\nsummary: mine\n")
    (tmp_path / "shots").mkdir()
    (tmp_path / "shots" / "1.pgm").write_bytes(b"P5 80 64 255\n" + bytes(80 * 64))
    return tmp_path


def replaced(name: str, old: str, new: str) -> Callable[[Path], None]:
    def change(folder: Path) -> None:
        text = (folder / name).read_text()
        assert old in text
        (folder / name).write_text(text.replace(old, new))

    return change


def brighter(folder: Path) -> None:
    np.save(folder / "ball.npy", np.load(folder / "ball.npy") ^ 1)


def other_memory(folder: Path) -> None:
    np.save(folder / "lib" / "table.npy", np.ones((1, 8, 10), np.uint8))


def moved(folder: Path) -> None:
    truth = json.loads((folder / "ball.truth.json").read_text())
    truth["frames"][3]["objects"][0]["center"][0] += 1
    (folder / "ball.truth.json").write_text(json.dumps(truth))


def added(folder: Path) -> None:
    (folder / "shots" / "2.pgm").write_bytes((folder / "shots" / "1.pgm").read_bytes())


@pytest.mark.parametrize(
    ("change", "others"),
    [
        (replaced("lib/body.s", "#0", "#1"), 6),
        (replaced("own.yaml", "mine", "other"), 0),
        (replaced("own.yaml", "default\n", "conservative\n"), 6),
        (replaced("scene.yaml", "noise: 2", "noise: 3"), 2),
        (other_memory, 6),
        (brighter, 2),
        (moved, 2),
        (added, 2),
    ],
)
def test_what_decides_a_result_decides_its_hash(
    folder: Path, change: Callable[[Path], None], others: int
) -> None:
    before = keys(folder)
    assert len(set(before)) == 6
    change(folder)
    assert len(set(keys(folder)) - set(before)) == others


def test_another_version_makes_other_runs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = keys(folder)
    monkeypatch.setattr(content, "version", lambda: "9.9")
    assert not set(keys(folder)) & set(before)


@pytest.mark.parametrize("line", ["first: 3\n", "fit: crop\n"])
def test_what_is_taken_of_the_clips_decides_too(folder: Path, line: str) -> None:
    assert not set(keys(folder, TEXT + line)) & set(keys(folder))


def test_order_and_names_decide_nothing(folder: Path) -> None:
    (folder / "again.s").write_text((folder / "main.s").read_text())
    other = TEXT.replace("main.s", "again.s").replace("[1, 2]", "[2, 1]")
    assert set(keys(folder, other)) == set(keys(folder))
