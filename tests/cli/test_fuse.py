"""``npchip fuse LEFT RIGHT --rig RIG.yaml`` as a user sees it."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from PIL import Image

from examples import rig_page
from npchip.cli import output
from npchip.cli.main import cli
from npchip.host.rig import watch
from npchip.host.vision.fusion import load_rig

ROOT = Path(__file__).parents[2]
RIGS = ROOT / "examples" / "rigs"
CHIP = RIGS / "chip.yaml"


def fuse(*arguments: str | Path) -> Result:
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


# ---- docs/rig.md


@pytest.mark.long
def test_the_page_is_what_its_script_measures() -> None:

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
