"""The extension of VS Code: its types, its archive, and a reader with it in code-server."""

from __future__ import annotations

import json
import re
import subprocess
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from npchip.studio.node import packages_fit
from tests.editors import code_server
from tests.editors.recipes import recipe
from tests.support.page_code import (
    DRIVES,
    PUPPETEER,
    MissingError,
    browser,
    esbuild,
    here,
    node,
    run,
)
from tests.support.page_code import packages as page_packages

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[2]
EXTENSION = ROOT / "docs" / "editors" / "vscode"
FLOW = Path(__file__).with_name("vscode")


def packages() -> Path:
    """Return the folder of the extension's packages.

    Raises:
        MissingError: they are not those of the lock file.
    """
    if not packages_fit(EXTENSION):
        raise MissingError("the packages of the extension are missing: python -m docs.editors")
    return EXTENSION / "node_modules"


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Pack the extension as its command does."""
    here(packages)
    file = tmp_path_factory.mktemp("vsix") / "npchip.vsix"
    command: list[str | Path] = [here(lambda: node(DRIVES)), EXTENSION / "build.mjs", file]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    return file


@pytest.mark.parametrize("project", [EXTENSION, FLOW], ids=["extension", "flow"])
def test_types(project: Path) -> None:
    here(page_packages)  # the flow's driver is that of the page
    compiler = here(packages) / "typescript" / "bin" / "tsc"
    command: list[str | Path] = [here(node), compiler, "--project", project]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_the_archive_has_all_that_the_manifest_names(archive: Path) -> None:
    with zipfile.ZipFile(archive) as packed:
        names = {name.removeprefix("extension/") for name in packed.namelist()}
        manifest = json.loads(packed.read("extension/package.json"))
        text = packed.read("extension/extension.cjs").decode()
        licences = packed.read("extension/LICENSE.txt").decode()
    assert set(_files(manifest)) <= names
    assert {"panel.js", "panel-style.css"} <= names
    assert not any("node_modules" in name or name.endswith((".ts", ".map")) for name in names)
    assert "devDependencies" not in manifest
    asked = set(re.findall(r'require\("([^"]+)"\)', text))
    assert "vscode" in asked
    assert not any(name.startswith(("vscode-", ".")) for name in asked), asked
    for name in ("vscode-languageclient", "preact", "@preact/signals"):
        assert f"\n{name}\n" in licences
    assert "Permission is hereby granted" in licences


def _files(manifest: dict[str, Any]) -> Iterator[str]:
    """Yield every file that a manifest names."""
    own = manifest["contributes"]
    steps = [step for guide in own["walkthroughs"] for step in guide["steps"]]
    named = [
        *(manifest[key] for key in ("main", "icon")),
        *(item["configuration"] for item in own["languages"]),
        *(item["path"] for kind in ("grammars", "snippets") for item in own[kind]),
        *(step["media"]["markdown"] for step in steps),
    ]
    yield from (name.removeprefix("./") for name in named)


def test_memory_is_taken_apart_as_the_studio_puts_it_together(tmp_path: Path) -> None:
    script = tmp_path / "planes.mjs"
    here(lambda: esbuild(FLOW / "planes.ts", script, "--format=esm", "--platform=node"))
    run(script)


def test_a_reader_mends_a_mistake_and_steps_back(archive: Path, tmp_path: Path) -> None:
    """Open, a mistake, its fix, a breakpoint, a step back, the array panel."""
    command = here(code_server.find)
    chromium = here(lambda: browser("chromium"))
    script = here(lambda: _flow(tmp_path / "flow.mjs"))
    work, pictures = tmp_path / "work", tmp_path / "pictures"
    for folder in (work, pictures):
        folder.mkdir()
    source = re.search(
        r"PROGRAM = `(.*?)`", (EXTENSION / "src" / "new-program.ts").read_text(), re.DOTALL
    )
    assert source
    (work / "darker.s").write_text(source[1])
    (work / ".vscode").mkdir()
    (work / ".vscode" / "tasks.json").write_text(recipe("A task of your own", "json"))
    with code_server.served(command, archive, tmp_path / "served") as url:
        given = {"browser": chromium, "url": url, "work": work, "pictures": pictures}
        given["frames"] = "coin_slide"
        done = subprocess.run(
            [here(lambda: node(DRIVES)), script, json.dumps(given, default=str)],
            capture_output=True,
            text=True,
            timeout=400,
            check=False,
        )
    assert done.returncode == 0, f"{done.stderr}\nsee {pictures}"
    report = json.loads(done.stdout)
    assert "unknown instruction 'SHRR'" in report["mistake"]
    assert report["line"].startswith("        SHR     r1, #1")
    assert report["processors"] == 80
    assert report["halved"] == report["whole"] // 2
    assert "SHR" in report["who"] or "LD" in report["who"]
    assert report["notices"] == []
    assert {"install", "debug", "array"} <= {*report["done"]}
    assert (work / "darker.npo").exists()  # the task of the page


def _flow(script: Path) -> Path:
    """Bundle what drives the browser, as `tests/studio/browser` does."""
    alias = f"--alias:puppeteer-core={PUPPETEER.resolve().as_uri()}"
    options = ("--format=esm", "--platform=node", "--target=node22", "--external:file:*", alias)
    return esbuild(FLOW / "flow.ts", script, *options)
