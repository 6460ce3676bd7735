"""Scene files, options and what is written of them."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from npchip import InputError
from npchip.frames import open_frames
from npchip.host.scenes import Disc, Dot, Linear, Object, Scene, read_scene, render
from npchip.host.scenes.files import scene_as_data
from tests.support.commands import invoke

ROOT = Path(__file__).parents[3]
EXAMPLE = ROOT / "examples" / "scenes" / "three.yaml"


def test_a_file_and_what_is_written_of_it(tmp_path: Path) -> None:
    for name in ("clip.npy", "clip.gif"):
        result = invoke("scene", EXAMPLE, "-o", tmp_path / name)
        assert result.exit_code == 0, result.output
        assert "60 frames of 64 x 80 pixels" in result.output
    clip, truth = render(read_scene(EXAMPLE))
    for name in ("clip.npy", "clip.gif"):
        frames = np.stack(list(open_frames(str(tmp_path / name), 64, 80)))
        assert (frames == clip).all()
    document = json.loads((tmp_path / "clip.truth.json").read_text())
    assert document["schema"] == 1
    assert len(document["frames"]) == 60
    for k, frame in enumerate(document["frames"]):
        for n, item in enumerate(frame["objects"]):
            np.testing.assert_allclose(item["center"], truth.centers[k, n], atol=1e-6)
            assert item["visible"] == bool(truth.visible[k, n]) == (item["box"] is not None)
            assert ("corners" in item) == (n > 0)
    again = tmp_path / "again.yaml"
    again.write_text(json.dumps(document["scene"]))
    assert read_scene(again) == read_scene(EXAMPLE)


def test_a_gif_keeps_frames_in_which_nothing_moves(tmp_path: Path) -> None:
    options = ("--shape", "dot", "--start", "5,5", "--frames", "7")
    assert invoke("scene", *options, "-o", tmp_path / "still.gif").exit_code == 0
    assert len(list(open_frames(str(tmp_path / "still.gif"), 64, 80))) == 7


def test_options_say_what_a_file_says(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(
        "frames: 12\nnoise: 1.5\nseed: 9\nbackground: {kind: gradient, first: 3, last: 9}\n"
        "objects:\n- {shape: polygon, vertices: [[0, 0], [0, 5], [5, 0]], angle: 20,"
        " motion: bouncing, start: [20, 30], velocity: [-1, 2.5], gravity: 0.25, brightness: 99}\n"
    )
    options = [
        "--shape",
        "polygon",
        "--angle",
        "20",
        "--motion",
        "bouncing",
        "--start",
        "20,30",
        "--velocity",
        "-1,2.5",
        "--gravity",
        "0.25",
        "--brightness",
        "99",
        "--frames",
        "12",
        "--noise",
        "1.5",
        "--seed",
        "9",
    ]
    options += ["--vertices", "0,0 0,5 5,0", "--background", "{kind: gradient, first: 3, last: 9}"]
    assert invoke("scene", file, "-o", tmp_path / "a.npy").exit_code == 0
    assert invoke("scene", *options, "-o", tmp_path / "b.npy").exit_code == 0
    assert (tmp_path / "a.npy").read_bytes() == (tmp_path / "b.npy").read_bytes()
    assert (tmp_path / "a.truth.json").read_bytes() == (tmp_path / "b.truth.json").read_bytes()


def test_options_change_what_a_file_says(tmp_path: Path) -> None:
    machine = tmp_path / "small.yaml"
    machine.write_text("extends: default\ngeometry: {np_rows: 2, np_cols: 3}\n")
    options = ("--frames", "4", "--background", "7", "--machine", machine, "--noise", "0")
    result = invoke("scene", EXAMPLE, *options, "-o", tmp_path / "clip.npy")
    assert result.exit_code == 2  # the ball does not start in so small a frame
    assert "NP287" in result.output
    file = tmp_path / "scene.yaml"
    file.write_text("objects: []\nframes: 99\n")
    assert invoke("scene", file, *options, "-o", tmp_path / "clip.npy").exit_code == 0
    clip = np.load(tmp_path / "clip.npy")
    assert clip.shape == (4, 16, 24)
    assert (clip == 7).all()


def test_defaults() -> None:
    scene = Scene(objects=())
    assert scene_as_data(scene)["frames"] == 30
    assert scene.size == (64, 80)


DISC = "- {shape: disc, radius: 3, start: [9, 9]}\n"


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        ("- 1", "NP280", "expected a mapping"),
        ("objects: [", "NP280", "bad.yaml:"),
        ("frames: 3", "NP282", "bad.yaml:1: error: a scene needs objects"),
        (
            "objects:\n- {shape: disc, start: [1, 1]}",
            "NP282",
            "bad.yaml:2: error: a disc in linear",
        ),
        ("objects:\n- {radius: 3}", "NP282", "needs shape"),
        (f"frame: 3\nobjects:\n{DISC}", "NP281", "did you mean 'frames'?"),
        (
            "objects:\n- shape: disc\n  radus: 3",
            "NP281",
            "bad.yaml:3: error: a disc in linear motion has no radus",
        ),
        ("objects:\n- {shape: dot, radius: 3, start: [1, 1]}", "NP281", "a dot in linear motion"),
        (
            f"objects:\n{DISC}frames: yes",
            "NP283",
            "bad.yaml:3: error: frames: expected a whole number",
        ),
        (f"objects:\n{DISC}frames: 2.5", "NP283", "found 2.5"),
        ("objects: 3", "NP283", "expected a list of objects, found 3"),
        ("objects: [3]", "NP283", "expected an object"),
        ("objects:\n- {shape: dot, start: 3}", "NP283", "start: expected [row, column]"),
        ("objects:\n- {shape: dot, start: [1, 2, 3]}", "NP283", "found [1, 2, 3]"),
        ("objects:\n- {shape: dot, start: [.nan, 2]}", "NP284", "found [nan, 2]"),
        (f"objects:\n{DISC}noise: 33", "NP284", "expected a number from 0 to 32, found 33"),
        (f"objects:\n{DISC}size: [60, 80]", "NP284", "in multiples of 8"),
        (f"objects:\n{DISC}size: [4096, 80]", "NP284", "from 8 to 2048"),
        ("objects:\n- {shape: polygon, vertices: [[0, 0], [1, 1]]}", "NP284", "found 2 of them"),
        ("objects:\n- {shape: disk, radius: 3}", "NP285", "did you mean 'disc'?"),
        ("objects:\n- {shape: dot, motion: liner}", "NP285", "did you mean 'linear'?"),
        (f"objects:\n{DISC}background: {{kind: plaid}}", "NP285", "flat, gradient, texture"),
        (f"objects:\n{DISC}background: {{kind: flat, lvel: 3}}", "NP281", "did you mean 'level'?"),
        (f"objects:\n{DISC}frames: 100000", "NP286", "at most 52428 of this size"),
        ("objects:\n" + 65 * DISC, "NP286", "at most 64 objects"),
        (
            "objects:\n- {shape: polygon, vertices: [[0, 0], [1, 1], [2, 2]], start: [1, 1]}",
            "NP287",
            "bad.yaml:2: error: polygon: the vertices enclose",
        ),
        (
            "objects:\n- {shape: disc, radius: 5, motion: bouncing, start: [3, 9]}",
            "NP287",
            "between rows 4.5 and 58.5",
        ),
        (
            "objects:\n- {shape: disc, radius: 32, motion: bouncing, start: [32, 40]}",
            "NP287",
            "no room",
        ),
        (
            "objects:\n- {shape: dot, motion: circular, center: [1, 1], orbit: 3, period: 0}",
            "NP284",
            "other than 0",
        ),
    ],
)
def test_mistakes_in_a_file(tmp_path: Path, text: str, code: str, message: str) -> None:
    file = tmp_path / "bad.yaml"
    file.write_text(text)
    result = invoke("scene", file, "-o", tmp_path / "clip.npy")
    assert result.exit_code == 2
    assert f"[{code}]" in result.stderr
    assert message in result.stderr
    assert not list(tmp_path.glob("clip*"))


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        ("", "NP289", "expected FILE.yaml or --shape"),
        ("scene.yaml --shape dot", "NP289", "--shape describes an object"),
        ("--shape disc --start 3,3", "NP282", "needs --radius"),
        ("--shape dot --start 3", "NP283", "--start: expected [row, column]"),
        ("--shape dot --start 3,x", "NP283", "found [3, 'x']"),
        ("--shape dot --start 3,3 --radius 3", "NP281", "a dot in linear motion has no --radius"),
        ("--shape dot --start 3,3 --seed -1", "NP284", "--seed: expected a whole number"),
        ("--shape dot --start 3,3 --background [", "NP283", "--background"),
        ("--shape dot --start 3,3 --machine nosuch", "NP202", "unknown machine"),
    ],
)
def test_mistakes_in_options(tmp_path: Path, options: str, code: str, message: str) -> None:
    result = invoke("scene", *options.split(), "-o", tmp_path / "clip.npy")
    assert result.exit_code == 2
    assert f"[{code}]" in result.stderr
    assert message in result.stderr


def test_other_suffixes_and_places_are_refused(tmp_path: Path) -> None:
    for place, code in (("clip.mp4", "NP288"), ("no/clip.npy", "NP250")):
        result = invoke("scene", "--shape", "dot", "--start", "3,3", "-o", tmp_path / place)
        assert result.exit_code == 2
        assert f"[{code}]" in result.stderr


@pytest.mark.parametrize(
    "make",
    [
        lambda: Disc(radius=math.nan),
        lambda: Disc(radius=0),
        lambda: Linear(start=(1, math.inf)),
        lambda: Scene(objects=(), frames=0),
        lambda: Object(shape=Dot(), motion=Linear(start=(1, 1)), brightness=256),
    ],
)
def test_classes_check_their_settings(make: Callable[[], Any]) -> None:
    with pytest.raises(InputError):
        make()


def test_python_in_the_document_runs() -> None:
    text = (ROOT / "docs" / "scenes.md").read_text(encoding="utf-8")
    found = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert found
    for code in found:
        exec(code, {})  # noqa: S102 - our own document


def test_the_document_shows_the_example() -> None:
    text = (ROOT / "docs" / "scenes.md").read_text(encoding="utf-8")
    assert f"```yaml\n{EXAMPLE.read_text(encoding='utf-8')}```" in text
