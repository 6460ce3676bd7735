"""Releases: both archives pass the checks and run where nothing else is installed."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tarfile
import venv
import zipfile
from collections import defaultdict
from importlib.util import find_spec
from pathlib import Path

import pytest
import yaml

from npchip import __version__
from npchip.studio import places

ROOT = Path(__file__).parents[1]
CITATION = ROOT / "docs" / "CITATION.cff"
BUILT = (places.SITE / "version.json").is_file()
"""True if the page of the studio is built and can go into the archives."""
HOLDERS = ("examples", "studio/site")
"""Parts of a wheel that have the clips."""


# ---- quick


def test_the_version_stands_in_one_place() -> None:
    home = ROOT / "src" / "npchip" / "__init__.py"
    assert home.read_text(encoding="utf-8").count(f'__version__ = "{__version__}"') == 1
    others = [*ROOT.glob("*.toml"), CITATION, *(ROOT / "src").rglob("*.py")]
    others += (ROOT / "docs" / "site").glob("*.py")
    assert home in others
    named = [path for path in others if f'"{__version__}"' in path.read_text(encoding="utf-8")]
    assert named == [home]


def test_the_changelog_begins_with_the_version() -> None:
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    heading = re.search(r"^## (\S+) – (unreleased|\d{4}-\d\d-\d\d)$", text, re.MULTILINE)
    assert heading
    assert heading[1] == __version__.removesuffix(".dev0")


def test_the_citation_has_what_its_format_wants() -> None:
    """The required keys of the Citation File Format 1.2.0; its ``version`` is optional."""
    cited = yaml.safe_load(CITATION.read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors"} <= {*cited}
    assert (cited["cff-version"], cited["type"]) == ("1.2.0", "software")
    assert (cited["title"], cited["license"]) == ("npchip", "MIT")
    assert "version" not in cited
    (thesis,) = cited["references"]
    assert {"type", "title", "authors"} <= {*thesis}
    assert (thesis["year"], thesis["authors"][0]["family-names"]) == (2018, "Hong")


# ---- the archives


@pytest.fixture(scope="module")
def archives(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The wheel and the source archive, made as docs/contributing.md says."""
    for tool in ("build", "twine", "check_wheel_contents", "hatchling"):
        if find_spec(tool) is None:
            pytest.skip(f"{tool} is not installed")
    folder = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT, where=folder)
    (wheel,), (source,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
    return {"wheel": wheel, "source": source}


def run(*command: object, where: Path) -> str:
    """Run a command without the surroundings of the tests and return what it prints."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run(
        [str(part) for part in command],
        cwd=where,
        env=kept | {"NO_COLOR": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.long
def test_archives_pass_the_checks(archives: dict[str, Path]) -> None:
    said = run(sys.executable, "-m", "twine", "check", "--strict", *archives.values(), where=ROOT)
    assert said.count("PASSED") == 2
    said = run(sys.executable, "-m", "check_wheel_contents", archives["wheel"], where=ROOT)
    assert said.rstrip().endswith("OK")


@pytest.mark.long
def test_a_wheel_has_all_that_users_need(archives: dict[str, Path]) -> None:
    with zipfile.ZipFile(archives["wheel"]) as wheel:
        files = wheel.infolist()
    names = {file.filename for file in files}
    wanted = {
        "npchip/asm/trajectory.s",
        "npchip/asm/lib",
        "npchip/course/exercises/01-pixel/checks.s",
        "npchip/course/exercises/24-budget/picture.png",
        "npchip/examples/clips/coin_slide.npy",
        "npchip/isa/npchip.yaml",
        "npchip/py.typed",
        *(["npchip/studio/site/index.html", "npchip/studio/site/player.html"] * BUILT),
    }
    assert {name for name in wanted if not any(each.startswith(name) for each in names)} == set()
    assert not [name for name in names if re.search(r"/(tests|docs|node_modules)/|\.pyc$", name)]
    # Nothing is in it twice but the clips, for `check-wheel-contents` does not look.
    same = defaultdict(list)
    for file in files:
        if file.file_size > 1:
            same[file.CRC, file.file_size].append(file.filename)
    twice = [group for group in same.values() if len(group) > 1]
    clips = [{f"npchip/{of}/clips/{Path(group[0]).name}" for of in HOLDERS} for group in twice]
    assert [{*group} for group in twice] == clips


@pytest.mark.long
def test_a_source_archive_is_a_clone(archives: dict[str, Path]) -> None:
    with tarfile.open(archives["source"]) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    tracked = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False
    ).stdout.splitlines()
    if not tracked:
        pytest.skip("not a clone")
    there = [name for name in tracked if (ROOT / name).exists()]
    assert {*there} - names == set()


@pytest.mark.long
@pytest.mark.parametrize("kind", ["wheel", "source"])
def test_an_archive_runs_in_an_empty_environment(
    archives: dict[str, Path], tmp_path: Path, kind: str
) -> None:
    home = tmp_path / "venv"
    venv.create(home, with_pip=True)
    run(home / "bin" / "pip", "install", "--quiet", archives[kind], where=tmp_path)
    npchip = home / "bin" / "npchip"
    assert run(npchip, "--version", where=tmp_path) == f"npchip {__version__}\n"
    said = run(npchip, "run", "trajectory", "--frames", "coin_slide", where=tmp_path)
    assert said.startswith("frame  valid  center_row")
    assert "passed" in run(npchip, "test", "imaging", where=tmp_path)
    assert "24 exercises" in run(npchip, "learn", where=tmp_path)
    run(npchip, "learn", "start", "pixel", where=tmp_path)
    assert (tmp_path / "pixel" / "pixel.s").is_file()
    code = "import npchip; print(npchip.Chip(npchip.assemble('edges')).machine.name)"
    assert run(home / "bin" / "python", "-c", code, where=tmp_path) == "default\n"
    if BUILT:
        run(npchip, "studio", "--export", "page", where=tmp_path)
        assert (tmp_path / "page" / "index.html").is_file()
        run(npchip, "export", "edges", "-o", "edges.html", where=tmp_path)
