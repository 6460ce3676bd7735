"""The page of this clone: its types are right, and what is built of it is whole."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from npchip.studio import build as building
from npchip.studio import places
from npchip.studio.assets import PYODIDE_FILES
from npchip.studio.bundling import SOURCES
from npchip.studio.licences import write_licences
from npchip.studio.offline import digest
from tests.support.page_code import ROOT, TESTS, here, node, packages

pytestmark = pytest.mark.long

HOME = places.HOME


@pytest.fixture
def modules() -> Path:
    """The page's packages, and Node to use them."""
    here(node)
    return here(packages)


def test_licences_have_their_text(tmp_path: Path, modules: Path) -> None:
    write_licences(tmp_path, [modules / "preact"])
    parts = json.loads((tmp_path / "licences.json").read_text(encoding="utf-8"))
    assert [part["name"] for part in parts] == [
        "Libraries in Pyodide",
        "preact",
        "Pyodide",
        "Python",
        "PyYAML",
    ]
    page = (tmp_path / "licences.html").read_text(encoding="utf-8")
    for part in parts:
        assert len(part["text"]) > 500
        assert part["version"] in page
    assert "Mozilla Public License" in page
    assert "PYTHON SOFTWARE FOUNDATION LICENSE" in page


def test_help_names_the_line_to_change() -> None:
    text = (places.PAGE / "shell" / "help.tsx").read_text(encoding="utf-8")
    named = re.search(
        r"<b>trajectory</b>\.[^<]*In its line (\d+) change <code>([^<]+)</code>", text
    )
    assert named
    lines = (ROOT / "asm" / "trajectory.s").read_text(encoding="utf-8").splitlines()
    assert lines[int(named[1]) - 1] == named[2]


@pytest.mark.parametrize("project", [HOME, TESTS, TESTS / "browser"], ids=lambda path: path.name)
def test_types_are_right(modules: Path, project: Path) -> None:
    compiler = modules / "typescript" / "bin" / "tsc"
    done = subprocess.run(
        [here(node), compiler, "-p", project], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.usefixtures("modules")
def test_the_page_is_whole(tmp_path: Path) -> None:
    site = tmp_path / "site"
    if (places.SITE / "version.json").is_file():  # its slow parts, as far as they fit
        shutil.copytree(places.SITE, site)
        known = places.known_version(site)
        (site / "version.json").write_text(json.dumps(known | {"sources": "others"}))
    assert building.build(lambda _: None, site)
    names = {path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file()}
    wanted = {
        "index.html",
        "studio.css",
        "licences.html",
        "licences.json",
        "player.html",
        "service-worker.js",
        "version.json",
        "python/npchip.zip",
        "python/snapshot.bin",
        "clips/index.json",
        "clips/coin_slide.npy",
        "programs/index.json",
        *(f"{name}.js" for name, source in SOURCES if not source.endswith(".css")),
        *(f"pyodide/{name}" for name in PYODIDE_FILES),
    }
    assert wanted <= names
    # The worker keeps all that people open, with the digest that it has.
    worker = (site / "service-worker.js").read_text(encoding="utf-8")
    kept = names - {"player.html", "service-worker.js", "version.json"}
    for name in kept:
        if not name.endswith(".gz"):
            assert digest(site / name) in worker, name
    listed = json.loads((site / "licences.json").read_text(encoding="utf-8"))
    assert {"preact", "@codemirror/view", "Pyodide"} <= {part["name"] for part in listed}
    # No script asks another host for anything.
    for path in (*site.glob("*.js"), *site.glob("chunks/*.js")):
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"""(fetch|import)\(["'`]https?:""", text), path.name
    assert not building.build(lambda _: None, site)


def test_a_wheel_has_the_page_if_there_is_one_and_never_its_sources(tmp_path: Path) -> None:
    pytest.importorskip("hatchling")
    tree = tmp_path / "tree"
    ignored = shutil.ignore_patterns("__pycache__", "node_modules", "site", ".site-*")
    for name in ("src", "asm", "examples"):
        shutil.copytree(ROOT / name, tree / name, ignore=ignored)
    for name in ("pyproject.toml", "README.md", "LICENSE", ".gitignore"):
        shutil.copy(ROOT / name, tree)
    studio = tree / "src" / "npchip" / "studio"
    (studio / "node_modules" / "preact").mkdir(parents=True)
    (studio / "node_modules" / "preact" / "index.py").touch()

    assert {name for name in wheel(tree) if not name.endswith(".py")} == set()
    assert "npchip/studio/serve.py" in wheel(tree)
    for name in ("version.json", "pyodide/pyodide.asm.wasm", "studio.js", "studio.js.gz"):
        path = studio / "site" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    others = {name for name in wheel(tree) if not name.endswith(".py")}
    assert others == {
        f"npchip/studio/site/{name}"
        for name in ("version.json", "pyodide/pyodide.asm.wasm", "studio.js")
    }


def wheel(tree: Path) -> set[str]:
    """Names of the studio's files in a wheel of a tree."""
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", "made"],
        cwd=tree,
        check=True,
        capture_output=True,
    )
    (made,) = (tree / "made").glob("*.whl")
    with zipfile.ZipFile(made) as archive:
        names = archive.namelist()
    return {name for name in names if name.startswith("npchip/studio/")}
