"""``npchip fuse LEFT RIGHT --rig RIG.yaml`` as a user sees it."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from PIL import Image

from examples import rig_page
from npchip.base.errors import InputError
from npchip.cli import output
from npchip.cli.main import cli
from npchip.host.rig import watch
from npchip.host.vision.fusion import load_rig, locate, predict

ROOT = Path(__file__).parents[2]
RIGS = ROOT / "examples" / "rigs"
CHIP = RIGS / "chip.yaml"


def fuse(*arguments: str | int | Path) -> Result:
    return CliRunner().invoke(cli, ["fuse", *map(str, arguments)], prog_name="npchip")


@pytest.fixture
def clips(tmp_path: Path) -> tuple[Path, Path]:
    """Five frames: both see it, camera 1, camera 2, neither, both at a border."""
    one, two = np.zeros((2, 5, 64, 80), np.uint8)
    one[0, 20:23, 30:34] = two[0, 20:23, 40:44] = 200
    one[1, 5:8, 5:8] = two[2, 5:8, 5:8] = 200
    one[4, 0, 60], two[4, 0, 20] = 128, 255
    paths = tmp_path / "left.npy", tmp_path / "right.npy"
    for path, clip in zip(paths, (one, two), strict=True):
        np.save(path, clip)
    return paths


def test_a_table_with_a_mark_where_there_is_no_position(clips: tuple[Path, Path]) -> None:
    result = fuse(*clips, "--rig", CHIP)
    assert result.exit_code == 0, result.output
    lines = result.stdout.splitlines()
    table = [line.split() for line in lines if not line.startswith("#")]
    assert table[0] == ["frame", "row1", "col1", "row2", "col2", "x", "y", "z", "mark", "cycles"]
    seen = watch(load_rig(CHIP), *map(np.load, clips))
    assert [float(cell) for cell in table[1][1:5]] == [21, 31.5, 21, 41.5]
    for k, row in enumerate(table[1:]):
        place = [f"{value:.3f}" if value == value else "-" for value in seen.positions.points[k]]  # noqa: PLR0124 - NaN
        assert row[5:8] == place
        assert int(row[-1]) == seen.timings["serial"].latency[k]
    marks = [" ".join(row[8:-1]) for row in table[1:]]
    assert marks == ["ok", "unseen by 2", "unseen by 1", "unseen", "border"]
    assert (
        "# 2 positions in 5 frames; 1 at the border of a frame; none: 1 unseen by 2, 1"
        in "".join(lines)
    )
    assert [line.split()[1] for line in lines[-3:]] == ["serial", "parallel", "host"]
    assert lines[-3].split()[-2:] == ["camera", "1"]


@pytest.mark.long
def test_exchanged_clips_get_a_word_on_stderr() -> None:
    """Fails before: the run said nothing."""
    clips = [RIGS / f"ball.{number}.gif" for number in (1, 2)]
    right = fuse(*clips, "--rig", CHIP)
    assert (right.exit_code, right.stderr) == (0, "")
    wrong = fuse(*clips[::-1], "--rig", CHIP)
    assert wrong.exit_code == 0
    assert "are the clips exchanged" in wrong.stderr
    assert "with rays apart" in wrong.stdout
    assert " apart " in wrong.stdout


def test_json_and_csv_hold_the_same(clips: tuple[Path, Path], tmp_path: Path) -> None:
    file = tmp_path / "path.csv"
    result = fuse(
        *clips, "--rig", CHIP, "--json", "--csv", file, "--algorithm", "extra-step",
        "--machine", "conservative", "--clock", "1M", "--link", "parallel",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout, parse_constant=pytest.fail)
    assert list(document) == [
        "schema", "rig", "machine", "algorithm", "link", "clock_hz", "links", "frames",
    ]  # fmt: skip
    assert document["schema"] == 1
    assert (document["machine"], document["clock_hz"]) == ("conservative", 1_000_000)
    assert document["rig"]["camera1"]["position"] == [2.3, 0, 0]
    assert document["links"]["parallel"]["parts"]["link"] == 2 * 4
    rows = list(csv.reader(file.read_text().splitlines()))
    assert rows[0][8:] == ["mark", "cycles_serial", "cycles_parallel", "cycles_host"]
    for row, frame in zip(rows[1:], document["frames"], strict=True):
        assert int(row[0]) == frame["index"]
        places = [*(frame["camera1"] or 2 * [None]), *(frame["camera2"] or 2 * [None])]
        places += frame["position"] or 3 * [None]
        assert [float(cell) if cell else None for cell in row[1:8]] == places
        assert row[8] == frame["mark"]
        assert [int(cell) for cell in row[9:]] == list(frame["cycles"].values())
    assert document["frames"][3]["position"] is None
    assert document["frames"][3]["camera1"] is None


def test_a_processor_takes_other_algorithms(clips: tuple[Path, Path]) -> None:
    result = fuse(*clips, "--rig", CHIP, "--algorithm", "vector", "--link", "host", "--json")
    document = json.loads(result.stdout)
    assert list(document["links"]) == ["host"]
    assert document["links"]["host"]["bytes"] == 3


@pytest.mark.long
def test_a_picture(clips: tuple[Path, Path], tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    file = tmp_path / "path.png"
    assert fuse(*clips, "--rig", CHIP, "--plot", file).exit_code == 0
    with Image.open(file) as picture:
        colours = {colour for _, colour in picture.convert("RGB").getcolors(1 << 20) or []}
    assert {(0, 0x72, 0xB2), (0xD5, 0x5E, 0)} <= colours  # the cameras
    np.save(clips[0], np.zeros((5, 64, 80), np.uint8))
    assert fuse(*clips, "--rig", CHIP, "--plot", file).exit_code == 0  # no position at all


@pytest.mark.long
def test_a_picture_as_vectors_is_the_same_each_time(
    clips: tuple[Path, Path], tmp_path: Path
) -> None:
    pytest.importorskip("matplotlib")
    files = [tmp_path / "a.svg", tmp_path / "b.SVG"]
    for file in files:
        assert fuse(*clips, "--rig", CHIP, "--plot", file).exit_code == 0
    text = files[0].read_text(encoding="utf-8")
    assert text == files[1].read_text(encoding="utf-8")
    assert "<dc:date>" not in text


@pytest.mark.parametrize(
    ("arguments", "code", "part"),
    [
        (["L", "R"], "NP524", "two clips need --rig RIG.yaml"),
        (["L", "--rig", "RIG"], "NP524", "two clips need RIGHT"),
        (["L", "R", "--rig", "RIG", "--table"], "NP512", "found both"),
        ([], "NP512", "found neither"),
        (["L", "R", "--rig", "none.yaml"], "NP500", "none.yaml"),
        (["L", "none.npy", "--rig", "RIG"], "NP210", "none.npy"),
        (["L", "R", "--rig", "RIG", "--machine", "fast"], "NP202", "fast"),
        (["L", "R", "--rig", "RIG", "--algorithm", "vector"], "NP522", "--link host"),
        (["L", "R", "--rig", "RIG", "--algorithm", "x"], "NP505", "improved-2n"),
        (["L", "R", "--rig", "RIG", "--algorithm", "x", "--link", "host"], "NP505", "vector"),
        (["L", "R", "--rig", "RIG", "--plot", "a.pdf"], "NP525", ".svg"),
        (["L", "R", "--rig", "RIG", "--csv", "no/such/a.csv"], "NP250", "no/such"),
        (["L", "R", "--rig", "RIG", "--threshold", "0"], "", "1<=x<=255"),
        (["L", "R", "--rig", "RIG", "--follow"], "NP526", "take --link host"),
        (["L", "R", "--rig", "RIG", "--follow", "--link", "host", "--dark"], "NP526", "--dark"),
        (["L", "R", "--rig", "RIG", "--predict", "0"], "", "1<=x<=100"),
        (["L", "R", "--rig", "RIG", "-o", "a.yaml"], "NP512", "--output belongs to --calibrate"),
        (["L", "R", "--rig", "RIG", "--calibrate", "L"], "NP512", "found both"),
        (["--calibrate", "L"], "NP524", "--calibrate needs --rig"),
        (["--calibrate", "L", "--rig", "RIG"], "NP527", "not CSV in UTF-8"),
        (["--calibrate", "none.csv", "--rig", "RIG"], "NP527", "none.csv"),
        (["--calibrate", "RIG", "--rig", "RIG"], "NP527", "there is no column x"),
        (["L", "R", "--rig", "THESIS"], "NP523", "camera1 of the rig has 160 x 160 pixels"),
    ],
)
def test_mistakes(arguments: list[str], code: str, part: str, clips: tuple[Path, Path]) -> None:
    names = {"L": clips[0], "R": clips[1], "RIG": CHIP, "THESIS": RIGS / "thesis.yaml"}
    result = fuse(*(names.get(each, each) for each in arguments))
    assert result.exit_code == 2, result.output
    assert code in result.stderr
    assert part in result.stderr
    assert not result.stdout


def test_clips_of_different_length(clips: tuple[Path, Path]) -> None:
    np.save(clips[1], np.load(clips[1])[:3])
    result = fuse(*clips, "--rig", CHIP)
    assert result.exit_code == 2
    assert "camera 1 has 5 frames, that of camera 2 3 [NP520]" in result.stderr


def test_without_matplotlib_there_is_a_remedy(
    clips: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(output, "find_spec", lambda _name: None)
    result = fuse(*clips, "--rig", CHIP, "--plot", tmp_path / "a.png")
    assert result.exit_code == 2
    assert "npchip[plot]" in result.stderr


# ---- following, prediction and calibration


def test_the_prediction_is_that_of_the_library(clips: tuple[Path, Path], tmp_path: Path) -> None:
    one, two = np.zeros((2, 8, 64, 80), np.uint8)
    for k in range(8):
        one[k, 20:24, 20 + k : 24 + k] = two[k, 20:24, 50 - k : 54 - k] = 200
    for path, clip in zip(clips, (one, two), strict=True):
        np.save(path, clip)
    file = tmp_path / "path.csv"
    result = fuse(*clips, "--rig", CHIP, "--predict", "2", "--json", "--csv", file)
    document = json.loads(result.stdout, parse_constant=pytest.fail)
    assert document["predict"] == 2
    frames = document["frames"]
    places = np.array([frame["position"] for frame in frames])
    expected = predict(places, steps=2, window=4)
    assert frames[0]["predicted"] is None
    np.testing.assert_allclose([frame["predicted"] for frame in frames[1:]], expected[1:])
    rows = list(csv.DictReader(file.read_text().splitlines()))
    assert float(rows[5]["x_ahead"]) == frames[5]["predicted"][0]
    assert rows[0]["z_ahead"] == ""
    text = fuse(*clips, "--rig", CHIP, "--predict", "2").stdout.splitlines()
    assert text[0].split()[-3:] == ["x_ahead", "y_ahead", "z_ahead"]
    assert text[6].split()[-3:] == [f"{value:.3f}" for value in expected[5]]
    assert "predicted 2 frames ahead" in "".join(text)


def test_cameras_follow_what_moves(clips: tuple[Path, Path]) -> None:
    """Beside something brighter that does not move: its box would span both."""
    truth = []
    scenes = np.full((2, 30, 64, 80), 20, np.uint8)
    scenes[:, :, 50:60, 60:75] = 220
    for k in range(6, 30):
        scenes[0, k, 20:28, 10 + k : 18 + k] = scenes[1, k, 20:28, 60 - k : 68 - k] = 120
        truth.append(([23.5, 13.5 + k], [23.5, 63.5 - k]))
    for path, clip in zip(clips, scenes, strict=True):
        np.save(path, clip)
    result = fuse(*clips, "--rig", CHIP, "--follow", "--link", "host", "--json")
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document["follow"] is True
    assert document["links"]["host"]["bytes"] == 9
    seen = [frame for frame in document["frames"][6:] if frame["position"]]
    assert len(seen) > 15
    for frame, places in zip(document["frames"][6:], truth, strict=True):
        if frame["position"]:
            np.testing.assert_allclose([frame["camera1"], frame["camera2"]], places, atol=2)
            assert frame["mark"] == "ok"
    boxes = json.loads(fuse(*clips, "--rig", CHIP, "--json").stdout)["frames"]
    assert all(frame["camera1"] == [54.5, 67] for frame in boxes)


def test_a_turned_camera_is_found_from_known_points(tmp_path: Path) -> None:
    rig = load_rig(CHIP)
    turned = replace(rig.camera2, turned=(1.5, -0.5, 2.0))
    points = np.array([[0.8, 2.1, 0.3], [1.4, 1.8, -0.4], [2.2, 2.6, 0.1], [1.2, 2.9, 0.5]])
    one, two = rig.camera1.project(points)[0], turned.project(points)[0]
    file, out = tmp_path / "points.csv", tmp_path / "turned.yaml"
    lines = ["note,x,y,z,row1,col1,row2,col2"]
    lines += [",".join(map(str, ["a", *row])) for row in np.hstack([points, one, two]).tolist()]
    file.write_text("\n".join([*lines, "b,1,2,0,,,,", ""]))
    result = fuse("--calibrate", file, "--rig", CHIP, "-o", out)
    assert result.exit_code == 0, result.output
    rows = [line.split() for line in result.stdout.splitlines()]
    assert rows[1][1:5] == ["4", "0.00", "0.00", "0.00"]
    assert rows[2][1:5] == ["4", "1.50", "-0.50", "2.00"]
    assert rows[2][-1] == "0.00"
    assert float(rows[2][-2]) > 1
    assert load_rig(out) == replace(rig, camera2=turned)
    document = json.loads(fuse("--calibrate", file, "--rig", out, "--json").stdout)
    assert document["rig"]["camera2"]["turned"] == [1.5, -0.5, 2.0]
    assert document["before"] == document["after"]


@pytest.mark.parametrize(
    ("rows", "part"),
    [
        (["1,2,0,32,40,32,40"], "camera1 cannot be calibrated: it sees 1 of the points"),
        (["1,2,0,32,40,32,40", "1,2,0,32,40,32,40"], "too close together"),
        (["1,-2,0,32,40,32,40", "1,-1,0,32,30,32,40"], "behind it"),
        (["1,2,x,32,40,32,40"], "line 2: z: expected a number, found x"),
        (["1,2,inf,32,40,32,40"], "expected a number, found inf"),
    ],
)
def test_points_that_do_not_calibrate(rows: list[str], part: str, tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text("\n".join(["x,y,z,row1,col1,row2,col2", *rows]))
    result = fuse("--calibrate", file, "--rig", CHIP, "-o", tmp_path / "out.yaml")
    assert result.exit_code == 2, result.output
    assert part in result.stderr
    assert not (tmp_path / "out.yaml").exists()


def test_the_array_refuses_turned_cameras_and_a_processor_straightens_them(
    clips: tuple[Path, Path], tmp_path: Path
) -> None:
    rig = tmp_path / "rig.yaml"
    rig.write_text(CHIP.read_text().replace("+x,", "+x, turned: [0, 3, 0],"))
    result = fuse(*clips, "--rig", rig)
    assert result.exit_code == 2
    assert "camera2 is turned" in result.stderr
    place = json.loads(fuse(*clips, "--rig", rig, "--link", "host", "--json").stdout)["frames"][0]
    two = load_rig(rig).camera2
    seen = two.straight(place["camera2"])
    assert abs(seen - place["camera2"])[0] > 2
    expected = locate(load_rig(CHIP), place["camera1"], seen, "improved-2n").points
    np.testing.assert_allclose(place["position"], expected)


@pytest.mark.parametrize("value", ["[1, 2]", "[1, 2, 46]", "x", "[1, 2, a]", "[.nan, 0, 0]"])
def test_a_camera_is_not_turned_by_just_anything(value: str, tmp_path: Path) -> None:
    rig = tmp_path / "rig.yaml"
    rig.write_text(CHIP.read_text().replace("+x,", f"+x, turned: {value},"))
    with pytest.raises(InputError, match=r"turned: expected \[right, up, clockwise\] in degrees"):
        load_rig(rig)


# ---- docs/rig.md


@pytest.mark.long
def test_the_page_is_what_its_script_measures() -> None:
    pytest.importorskip("pandas")
    page = (ROOT / "docs" / "rig.md").read_text(encoding="utf-8")
    assert page == rig_page.document(), "python -m examples.rig_page writes it"


def test_the_python_of_the_page_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    page = (ROOT / "docs" / "rig.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    exec(compile(code, "docs/rig.md", "exec"), {})  # noqa: S102 - our own
    assert capsys.readouterr().out.endswith("camera 1\n")
