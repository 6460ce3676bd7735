"""Bundled programs, clips, rigs and scenes are found by name, wherever npchip is installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip import InputError, assemble, bundle
from npchip.bundle.files import EXAMPLES
from npchip.cli.main import cli

ROOT = Path(__file__).parents[2]
IDLE = "HALT\n"


def npchip(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(item) for item in arguments])


@pytest.fixture(autouse=True)
def _empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "imaging", "--frames", "shapes_photo"),
        ("asm", "trajectory"),
        ("disasm", "trajectory"),
        ("compare", "imaging", "--frames", "shapes_photo"),
        ("profile", "imaging", "--frames", "shapes_photo"),
        ("trace", "imaging", "--frames", "shapes_photo", "--limit", "3"),
        ("test", "imaging", "-k", "levels"),
        ("scene", "three", "-o", "three.npy"),
    ],
    ids=lambda arguments: arguments[0],
)
def test_names_work_in_an_empty_folder(arguments: tuple[str, ...]) -> None:
    done = npchip(*arguments)
    assert done.exit_code == 0, done.output


def test_the_debugger_takes_names() -> None:
    Path("x.dbg").write_text("frame\n")
    done = npchip("debug", "imaging", "--frames", "shapes_photo", "--script", "x.dbg")
    assert done.exit_code == 0, done.output


def test_rigs_and_their_clips_have_names() -> None:
    from npchip.host.vision.fusion import load_rig

    assert load_rig("chip").camera1.ratio == 64
    with pytest.raises(InputError, match="did you mean chip"):
        load_rig("chpi")
    assert bundle.find("clip", "ball.1").name == "ball.1.gif"


def test_a_path_that_exists_wins() -> None:
    Path("trajectory").write_text(IDLE)
    assert "trajectory: 1 words" in npchip("asm", "trajectory").output
    Path("coin_slide").mkdir()
    assert "holds no images" in npchip("run", "imaging", "--frames", "coin_slide").output
    Path("imaging").symlink_to("nowhere")
    assert "cannot read imaging" in npchip("asm", "imaging").output


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (("run", "trajectroy"), "did you mean trajectory"),
        (("run", "trajectory.s"), "trajectory, without folder and ending"),
        (("run", "asm/trajectory.s"), "trajectory, without folder and ending"),
        (("run", "imaging", "--frames", "coin_slid"), "did you mean coin_slide"),
        (("run", "imaging", "--frames", "coin_slide.npy"), "coin_slide, without folder"),
        (("asm", "zzz"), "npchip examples lists"),
        (("test", "imagin"), "did you mean imaging"),
        (("test", "imaging", "--program", "imagin"), "did you mean imaging"),
        (("scene", "thre", "-o", "x.npy"), "did you mean three"),
    ],
)
def test_a_wrong_name_suggests_near_ones(arguments: tuple[str, ...], hint: str) -> None:
    done = npchip(*arguments)
    assert done.exit_code == 2
    assert hint in done.output


def test_the_golden_of_a_bundled_program_is_not_recorded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CI", raising=False)
    done = npchip("test", "imaging", "--update")
    assert done.exit_code == 2
    assert "NP278" in done.output


def test_python_takes_names_and_test_lines_do() -> None:
    assert assemble("imaging").name == "imaging"
    source = (
        "; run: a frames=shapes_photo\n; expect: frames == 2\nframe: EXPOSE\nSAMPLE signal, 0\n"
    )
    Path("t.s").write_text(f"{source}JMP frame\n")
    done = npchip("test", "t.s")
    assert done.exit_code == 0, done.output


def test_the_shell_completes_names() -> None:
    from npchip.cli.options import bundled

    found = bundled("program")(None, None, "trajectory_r")  # type: ignore[arg-type]
    assert [(item.value, item.type) for item in found] == [
        ("trajectory_robust", "plain"),
        ("trajectory_robust_large", "plain"),
        ("trajectory_r", "file"),
    ]


# --- npchip examples


def test_the_list_has_a_line_for_each() -> None:
    lines = npchip("examples").output.splitlines()
    shown = {line.split()[0]: line.split(maxsplit=1)[1] for line in lines if line.startswith("  ")}
    assert {path.stem for path in (ROOT / "asm").glob("*.s")} <= set(shown)
    assert {path.stem for path in (ROOT / "examples" / "clips").glob("*.npy")} <= set(shown)
    assert all(len(text) > 10 for text in shown.values())


def test_frames_of_the_list_are_those_of_the_clips() -> None:
    for name, item in bundle.bundled("clip").items():
        if item.path.suffix == ".npy":
            count = int(item.summary.split()[0])
            assert len(np.load(item.path, mmap_mode="r")) == count, name


def test_copies_work_and_overwrite_nothing() -> None:
    Path("mine/examples/clips").mkdir(parents=True)
    kept = Path("mine/examples/clips/coin_slide.npy")
    kept.write_text("mine")
    done = npchip("examples", "--copy", "mine")
    assert (done.exit_code, "NP256" in done.output) == (2, True)
    assert kept.read_text() == "mine"
    assert [path.name for path in Path("mine").iterdir()] == ["examples"]
    kept.unlink()
    assert npchip("examples", "--copy", "mine").exit_code == 0
    assert npchip("test", "mine/asm/imaging.s", "-k", "levels").exit_code == 0
    assert npchip("asm", "mine/asm/digits.s", "-o", "digits.npo").exit_code == 0  # with its weights
    copy, original = (
        Path("mine/asm/trajectory.s"),
        ROOT / "asm" / "trajectory.s",
    )
    assert copy.read_bytes() == original.read_bytes()
    assert npchip("examples", "--copy", "mine").exit_code == 2


# --- an installed wheel


def included() -> dict[str, str]:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    wheel = tomllib.loads(text)["tool"]["hatch"]["build"]["targets"]["wheel"]
    found: dict[str, str] = wheel["force-include"]
    return found


def test_a_wheel_has_what_is_bundled() -> None:
    wanted = {"asm", *(f"examples/{name}" for name in EXAMPLES)}
    assert {source: f"npchip/{source}" for source in wanted} == included()


@pytest.fixture
def site(tmp_path: Path) -> Path:
    """A folder as a wheel fills it."""
    site = tmp_path / "site"
    shutil.copytree(ROOT / "src", site, ignore=shutil.ignore_patterns("__pycache__"))
    for source, target in included().items():
        copy = shutil.copytree if (ROOT / source).is_dir() else shutil.copy
        (site / target).parent.mkdir(exist_ok=True)
        copy(ROOT / source, site / target)
    return site


@pytest.mark.long
@pytest.mark.parametrize("kind", ["wheel", "archive"])
def test_an_installed_npchip_finds_its_programs_in_an_empty_folder(
    kind: str, site: Path, tmp_path: Path
) -> None:
    if kind == "archive":
        site = Path(shutil.make_archive(str(tmp_path / "npchip"), "zip", site))
    empty, temporary = tmp_path / "empty", tmp_path / "tmp"
    empty.mkdir()
    temporary.mkdir()
    for command in (
        ("run", "trajectory", "--frames", "coin_slide"),
        ("test", "imaging", "-k", "levels"),
        ("fuse", "ball.1", "ball.2", "--rig", "chip"),
        ("examples",),
        ("examples", "--copy", "mine"),
        ("learn",),
        ("learn", "start", "pixel"),
        ("learn", "copy", "class"),
    ):
        done = subprocess.run(
            [sys.executable, "-m", "npchip", *command],
            cwd=empty,
            env=os.environ | {"PYTHONPATH": str(site), "TMPDIR": str(temporary)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert (done.returncode, done.stderr) == (0, "")
    assert not list(temporary.iterdir())
    assert (empty / "mine" / "asm" / "trajectory.s").exists()
    assert (empty / "class" / "24-budget" / "wrong" / "long.s").exists()
