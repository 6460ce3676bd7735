"""The site: built by its command, whole, and opened from a plain file server in Chromium."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from docs.site import __main__ as command
from docs.site.check import faults
from docs.site.order import contents
from docs.site.sources import ROOT, DeadLinkError, Sources
from npchip.course.exercise import load_course
from npchip.studio import places
from tests.studio.browser.servers import serve_folder
from tests.support.page_code import DRIVES, PUPPETEER, browser, here, node, packages
from tests.support.page_code import site as page_of_the_studio

SCRIPT = Path(__file__).with_name("site.mjs")
PROGRAMS = {path.stem for path in (ROOT / "asm").glob("*.s")}
LIVE = sorted(PROGRAMS - {"fusion_lut"})  # that one needs a second camera


# ---- links of the sources


def linked(text: str, place: str = "page.md", folder: Path = Path("unused")) -> str:
    return Sources(folder).linked(text, ROOT / "docs", place)


@pytest.mark.parametrize(
    ("link", "there"),
    [
        ("isa.md#mov", "isa.md#mov"),
        ("#here", "#here"),
        ("https://semver.org", "https://semver.org"),
        ("../CHANGELOG.md", "changelog.md"),
        ("../asm", "gallery.md"),
        ("../asm/edges.s", "gallery/edges.md"),
        ("figures/figure-1.1.svg", "files/docs/figures/figure-1.1.svg"),
        ("../examples/rigs", "folders/examples/rigs.md"),
    ],
)
def test_links_lead_to_where_a_page_stands_on_the_site(link: str, there: str) -> None:
    assert linked(f"[it]({link})") == f"[it]({there})"
    below = there if link.startswith(("#", "https:")) else f"../{there}"
    assert linked(f"[it]({link})", "course/page.md") == f"[it]({below})"


def test_what_stands_in_a_fence_is_no_link() -> None:
    text = "```text\n[it](isa.md)\n```"
    assert linked(text, "course/page.md") == text


@pytest.mark.parametrize("link", ["nowhere.md", "../../elsewhere"])
def test_a_dead_link_is_named(link: str) -> None:
    with pytest.raises(DeadLinkError, match=r"page\.md: a link leads to .*, which is not there"):
        linked(f"[it]({link})")


def test_a_folder_gets_a_page_with_its_files(tmp_path: Path) -> None:
    sources = Sources(tmp_path)
    sources.add("page.md", "[rigs](../examples/rigs)", ROOT / "docs")
    sources.fetch()
    page = (tmp_path / "folders" / "examples" / "rigs.md").read_text(encoding="utf-8")
    assert "- [`chip.yaml`](../../files/examples/rigs/chip.yaml)" in page.splitlines()
    copied = tmp_path / "files" / "examples" / "rigs" / "chip.yaml"
    assert copied.read_bytes() == (ROOT / "examples" / "rigs" / "chip.yaml").read_bytes()


def test_the_side_has_the_order_of_the_index() -> None:
    index = (
        "# I\n\n[b](b.md)\n\n## All documents\n\n### Learn\n\n- [A](a.md), [C](c.md)\n- [B](b.md)\n"
    )
    assert contents(index).split() == [
        *("```{toctree}", ":caption:", "Learn", ":hidden:", "a", "b", "course", "```"),
    ]


# ---- what a site may not have


@pytest.mark.parametrize(
    ("body", "fault"),
    [
        ('<a href="other.html#there">it</a>', None),
        ('<a href="https://semver.org">it</a>', None),
        ('<a href="missing.html">it</a>', "leads nowhere"),
        ('<a href="../outside.html">it</a>', "leads nowhere"),
        ('<a href="other.html#gone">it</a>', "leads to no anchor of that page"),
        ('<a href="#gone">it</a>', "leads to no anchor of that page"),
        ('<img src="missing.png">', "leads nowhere"),
        ('<script src="https://cdn.example/x.js"></script>', "from another host"),
        ('<link rel="stylesheet" href="//fonts.example/x.css">', "from another host"),
    ],
)
def test_faults_of_a_site_are_found(tmp_path: Path, body: str, fault: str | None) -> None:
    site = tmp_path / "site"
    site.mkdir()
    (tmp_path / "outside.html").touch()
    (site / "index.html").write_text(body, encoding="utf-8")
    (site / "other.html").write_text('<p id="there">it</p>', encoding="utf-8")
    found = faults(site)
    assert [line.endswith(fault) for line in found] == [True] if fault else not found


def test_a_style_that_loads_from_another_host_is_found(tmp_path: Path) -> None:
    (tmp_path / "a.css").write_text("p { background: url(data:image/png;base64,) }")
    assert not faults(tmp_path)
    (tmp_path / "b.css").write_text("@import 'https://fonts.example/x.css'")
    assert faults(tmp_path) == ["b.css: loads from another host"]


# ---- the command


def test_nothing_but_a_site_is_replaced(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "NEEDED", ())
    (tmp_path / "mine.txt").write_text("mine")
    for target in (tmp_path, tmp_path / "mine.txt"):
        assert command.main([str(target)]) == 2
        assert "holds something else than a site; name another folder" in capsys.readouterr().err
    assert (tmp_path / "mine.txt").read_text() == "mine"


def test_what_is_missing_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "NEEDED", ("json", "no_such_library"))
    assert command.main([str(tmp_path / "site")]) == 2
    assert capsys.readouterr().err == (
        "error: no_such_library not installed: pip install --editable '.[site]'\n"
    )


# ---- the site itself


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, as its command builds it."""
    for library in command.NEEDED:
        pytest.importorskip(library)
    folder = tmp_path_factory.mktemp("made") / "site"
    made = [sys.executable, "-m", "docs.site", str(folder)]
    done = subprocess.run(made, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return folder


@pytest.mark.long
def test_the_site_has_all_pages(site: Path) -> None:
    names = {path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file()}
    documents = {f"{path.stem}.html" for path in (ROOT / "docs").glob("*.md")}
    exercises = [
        f"course/{number:02}-{name}.html"
        for number, name in enumerate(load_course().exercises, start=1)
    ]
    gallery = {f"gallery/{name}.html" for name in PROGRAMS}
    assert {*documents, *exercises, *gallery, "api/npchip.html", "search.html"} <= names
    reference = (site / "api" / "npchip.html").read_text(encoding="utf-8")
    for name in ("npchip.Chip.run_many", "npchip.assemble", "npchip.RunResult"):
        assert f'id="{name}"' in reference
    if (places.SITE / "version.json").is_file():
        assert {f"live/{name}.html" for name in LIVE} <= names


@pytest.mark.long
def test_the_site_is_sound(site: Path) -> None:
    """The command has looked too; here the check must find what is broken on purpose."""
    assert not faults(site)
    page = site / "isa.html"
    text = page.read_text(encoding="utf-8")
    page.write_text(text.replace('id="mov"', 'id="vom"'), encoding="utf-8")
    broken = faults(site)
    page.write_text(text, encoding="utf-8")
    assert "isa.html: #mov leads to no anchor of that page" in broken


@pytest.mark.long
def test_chromium_reads_searches_and_runs_programs(site: Path) -> None:
    here(page_of_the_studio)
    here(packages)
    opener, engine = here(lambda: browser("chromium")), here(lambda: node(DRIVES))
    with serve_folder(site) as url:
        done = subprocess.run(
            [engine, SCRIPT, opener, PUPPETEER, url, *LIVE],
            capture_output=True,
            text=True,
            check=False,
            timeout=240,
        )
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    assert found["complaints"] == []
    assert [address for address in found["requests"] if not address.startswith(url)] == []
    assert len(found["requests"]) > 20
    assert "npchip" in found["title"]
    assert "The course" in found["side"]
    assert any("isa.html" in address for address in found["hits"])
    assert found["exercise"] == "One pixel"
    assert found["picture"] > 0
    assert found["live"] == "trajectory"
    assert found["ran"] == LIVE
