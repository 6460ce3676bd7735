"""``npchip export``: what stands in the page, and what is refused."""

from __future__ import annotations

import base64
import json
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from npchip import bundle
from npchip.cli.main import cli
from npchip.studio import export, places
from npchip.studio.player import fill

TEMPLATE = """\
<!doctype html><meta charset="utf-8"><title>@title@</title>
<script type="application/json" id="data">@data@</script>
<script>start()</script>
"""


@pytest.fixture(autouse=True)
def _place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An empty folder to work in, and a page whose template is short."""
    site = tmp_path / "site"
    site.mkdir()
    (site / "version.json").write_text("{}")
    (site / "player.html").write_text(TEMPLATE)
    monkeypatch.setattr(places, "SITE", site)
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")


def npchip(*arguments: object) -> Result:
    return CliRunner().invoke(cli, [str(item) for item in arguments])


def data_of(page: str) -> Any:
    """Return the data that a browser finds: it ends the element at the first end tag."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found
    return json.loads(found[1])


def unpacked(text: str) -> bytes:
    return zlib.decompress(base64.b64decode(text))


def test_a_page_has_the_program_and_its_clip() -> None:
    done = npchip("export", "trajectory", "-o", "page.html", "--frames", "coin_slide")
    assert (done.exit_code, done.stderr) == (0, "")
    assert re.fullmatch(r"page\.html: \d+ kB; open it in a browser\n", done.stdout)
    page = Path("page.html").read_text(encoding="utf-8")
    assert "<title>trajectory · coin_slide</title>" in page
    data = data_of(page)
    assert data["maxCycles"] == 50_000_000
    assert npchip("asm", "trajectory", "-o", "same.wasm").exit_code == 0
    assert unpacked(data["module"]) == Path("same.wasm").read_bytes()
    clip = data["clip"]
    wanted = np.load(bundle.find("clip", "coin_slide"))
    assert (clip["name"], clip["count"], clip["rows"], clip["cols"]) == ("coin_slide", 30, 64, 80)
    assert np.array_equal(np.frombuffer(unpacked(clip["data"]), np.uint8), wanted.ravel())
    program = data["program"]
    assert program["exposes"]
    assert [item["name"] for item in program["outputs"]][:2] == ["valid", "center_row"]
    assert len(program["words"]) == 174


def test_options_reach_the_module() -> None:
    np.save("m.npy", np.arange(80, dtype=np.uint8).reshape(1, 8, 10))
    options = ("--define", "THRESHOLD=9", "--machine", "conservative", "--memory", "200=m.npy")
    done = npchip(
        "export", "trajectory", "-o", "a.html", *options, "--max-cycles", "5k", "--title", "Mine"
    )
    assert done.exit_code == 0, done.output
    data = data_of(Path("a.html").read_text(encoding="utf-8"))
    assert npchip("asm", "trajectory", "-o", "same.wasm", *options).exit_code == 0
    assert unpacked(data["module"]) == Path("same.wasm").read_bytes()
    assert (data["title"], data["maxCycles"], data["clip"]) == ("Mine", 5000, None)
    assert data["program"]["machine"]["name"] == "conservative"
    assert data["program"]["symbols"]["THRESHOLD"] == 9


def test_a_guide_is_in_the_page() -> None:
    assert npchip("export", "edges", "-o", "a.html").exit_code == 0
    assert data_of(Path("a.html").read_text(encoding="utf-8"))["guide"] is None
    assert npchip("export", "edges", "-o", "a.html", "--guide", "56x48").exit_code == 0
    assert data_of(Path("a.html").read_text(encoding="utf-8"))["guide"] == [56, 48]


@pytest.mark.parametrize("text", ["65x8", "8x81", "0x8", "8", "8x", "ax8", "٣x8", "-1x8"])
def test_a_guide_is_within_the_frame(text: str) -> None:
    done = npchip("export", "edges", "-o", "a.html", f"--guide={text}")
    assert (done.exit_code, "[NP636]" in done.output) == (2, True)
    assert not Path("a.html").exists()


def test_the_files_of_memory_lines_are_in_the_module() -> None:
    planes = np.arange(80, dtype=np.uint8).reshape(1, 8, 10)
    np.save("table.npy", planes)
    np.save("other.npy", planes + 100)
    Path("own.s").write_text('.memory 7, "table.npy"\n LD r0, [7]\n OUT 0, r0\n HALT\n')
    for option, wanted in (([], planes), (["--memory", "7=other.npy"], planes + 100)):
        done = npchip("export", "own.s", "-o", "a.html", *option)
        assert done.exit_code == 0, done.output
        module = unpacked(data_of(Path("a.html").read_text(encoding="utf-8"))["module"])
        assert wanted.tobytes() in module
    Path("table.npy").unlink()
    refused = npchip("export", "own.s", "-o", "b.html")
    assert (refused.exit_code, Path("b.html").exists()) == (2, False)
    assert "[NP243]" in refused.output


def test_frames_of_another_size_are_fitted() -> None:
    np.save("large.npy", np.full((2, 128, 160), 7, np.uint8))
    refused = npchip("export", "edges", "-o", "a.html", "--frames", "large.npy")
    assert (refused.exit_code, Path("a.html").exists()) == (2, False)
    done = npchip("export", "edges", "-o", "a.html", "--frames", "large.npy", "--fit", "resize")
    assert done.exit_code == 0, done.output
    clip = data_of(Path("a.html").read_text(encoding="utf-8"))["clip"]
    assert unpacked(clip["data"]) == bytes([7]) * (2 * 64 * 80)
    assert clip["name"] == "large.npy"


def test_a_page_tells_nothing_of_the_disk() -> None:
    folder = Path("private/notes")
    folder.mkdir(parents=True)
    source = folder / "mine.s"
    source.write_text("; my thoughts\nx: EXPOSE\nJMP x\n")
    np.save(folder / "clip.npy", np.zeros((1, 64, 80), np.uint8))
    for given in (source, source.absolute()):
        done = npchip("export", given, "-o", "a.html", "--frames", folder / "clip.npy")
        assert done.exit_code == 0, done.output
        page = Path("a.html").read_text(encoding="utf-8")
        assert "mine.s" in page
        assert "private" not in page
        assert "thoughts" not in page


@pytest.mark.parametrize("title", ["</script><script>alert(1)</script>", "<!--", "a & b", "@data@"])
def test_a_title_cannot_change_the_page(title: str) -> None:
    page = fill(TEMPLATE, title, {"title": title})
    assert data_of(page) == {"title": title}
    assert page.count("<script") == 2
    assert page.count("</script>") == 2
    assert "<!--" not in page


def test_a_clip_that_is_too_long_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(export, "MOST_BYTES", 10 * 64 * 80)
    done = npchip("export", "trajectory", "-o", "a.html", "--frames", "coin_slide")
    assert done.exit_code == 2
    assert re.search(r"(?s)more than 10 frames.*NP636.*export without --frames", done.output)
    assert not Path("a.html").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("trajectory", "-o", "page.txt"), "NP636"),
        (("trajectory", "-o", "nowhere/page.html"), "NP250"),
        (("trajectroy", "-o", "page.html"), "did you mean trajectory"),
        (("trajectory",), "Missing option '-o'"),
    ],
)
def test_mistakes_are_told(arguments: tuple[str, ...], said: str) -> None:
    done = npchip("export", *arguments)
    assert done.exit_code == 2
    assert said in done.output


def test_without_a_page_nothing_is_exported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(places, "SITE", Path("none"))
    done = npchip("export", "trajectory", "-o", "page.html")
    assert (done.exit_code, "NP630" in done.output) == (2, True)
    assert not Path("page.html").exists()
