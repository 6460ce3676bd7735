"""``npchip studio``: served, built, written as files; and what it says where it cannot be."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from npchip.cli import studio
from npchip.cli.main import cli
from npchip.studio import build, places

START = """\
import sys
from pathlib import Path
from npchip.studio import places
places.SITE = Path(sys.argv.pop(1))
from npchip.__main__ import main
main()
"""


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "site"
    (folder / "chunks").mkdir(parents=True)
    for name in ("index.html", "version.json", "player.html", "chunks/a.js", "chunks/a.js.gz"):
        (folder / name).write_text("{}")
    monkeypatch.setattr(places, "SITE", folder)
    monkeypatch.setattr(places, "is_clone", lambda: False)
    return folder


def npchip(*arguments: object) -> Result:
    return CliRunner().invoke(cli, ["studio", *map(str, arguments)])


# ---- served


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize(("name", "code"), [("SIGINT", 130), ("SIGTERM", 143)])
def test_it_serves_until_a_signal_ends_it(name: str, code: int, site: Path) -> None:
    command = [sys.executable, "-c", START, str(site), "studio", "--port", "0", "--no-browser"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout
        line = process.stdout.readline()
        match = re.fullmatch(r"npchip studio: (http://127\.0\.0\.1:\d+/)\n", line)
        assert match, line
        with urllib.request.urlopen(match[1], timeout=10) as answer:  # noqa: S310 - ours
            assert answer.read() == b"{}"
        process.send_signal(getattr(signal, name))
        _, errors = process.communicate(timeout=10)
    assert process.returncode == code
    assert errors.endswith("interrupted\n")
    assert "Traceback" not in errors


def test_a_port_in_use_is_an_error_if_it_was_asked_for(site: Path) -> None:
    assert site.exists()
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        done = npchip("--port", other.getsockname()[1], "--no-browser")
    assert done.exit_code == 2
    assert re.search(r"(?s)it is in use.*NP634.*hint", done.output)


def test_the_usual_port_in_use_is_a_note(
    site: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        used = other.getsockname()[1]
        monkeypatch.setattr(studio, "PORT", used)
        with studio.start_server(site, None) as server:
            assert server.server_port != used
    assert f"port {used} is in use" in capsys.readouterr().err


@pytest.mark.parametrize("port", ["-1", "65536", "x", "٣"])
def test_a_port_is_a_number(port: str, site: Path) -> None:
    assert site.exists()
    assert npchip("--port", port).exit_code == 2


@pytest.mark.skipif(sys.platform in {"win32", "darwin"}, reason="these always have a window")
def test_no_browser_is_opened_where_there_is_no_window(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    studio.open_browser("http://127.0.0.1:1/")
    assert not opened


# ---- not there


def test_a_clone_without_a_page_says_how_to_build_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(places, "SITE", tmp_path / "site")
    monkeypatch.setattr(places, "is_clone", lambda: True)
    done = npchip("--no-browser")
    assert done.exit_code == 2
    assert re.search(r"(?s)not been built yet \[NP630\].*npchip studio --build", done.output)


def test_an_installed_npchip_without_a_page_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(places, "SITE", tmp_path / "site")
    monkeypatch.setattr(places, "is_clone", lambda: False)
    done = npchip("--no-browser")
    assert done.exit_code == 2
    assert re.search(r"(?s)without the page.*NP630.*release wheel.*clone", done.output)


def test_half_a_page_is_none(site: Path) -> None:
    (site / "version.json").unlink()
    assert "NP630" in npchip("--no-browser").output


# ---- built


def test_build_says_what_it_does(
    site: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert site.exists()

    def built(say: build.Say) -> bool:
        say("scripts bundled")
        return True

    monkeypatch.setattr(build, "build", built)
    done = npchip("--build", "--export", tmp_path / "out")
    assert done.exit_code == 0
    assert done.stderr == "scripts bundled\n"
    monkeypatch.setattr(build, "build", lambda _: False)
    done = npchip("--build", "--export", tmp_path / "more")
    assert done.stderr == "the page is up to date\n"


def test_a_page_older_than_its_sources_is_told(
    site: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(places, "is_clone", lambda: True)
    monkeypatch.setattr(build, "sources", lambda: "now")
    (site / "version.json").write_text('{"sources": "now"}')
    studio.note_age(site)
    assert capsys.readouterr().err == ""
    (site / "version.json").write_text('{"sources": "before"}')
    studio.note_age(site)
    assert "npchip studio --build" in capsys.readouterr().err


# ---- written as files


@pytest.mark.parametrize("there", [False, True])
def test_export_writes_the_page(there: bool, site: Path, tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    if there:
        out.mkdir(parents=True)
    done = npchip("--export", out)
    assert (done.exit_code, done.stderr) == (0, "")
    assert f"http.server --bind 127.0.0.1 --directory {out}" in done.stdout
    names = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()}
    assert names == {"index.html", "version.json", "chunks/a.js"}
    assert [path.name for path in out.parent.iterdir()] == ["out"]
    assert (site / "player.html").exists()


def test_export_overwrites_nothing(site: Path, tmp_path: Path) -> None:
    assert site.exists()
    out = tmp_path / "out"
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    done = npchip("--export", out)
    assert done.exit_code == 2
    assert "it is not empty, nothing is written [NP635]" in done.output
    assert [path.name for path in out.iterdir()] == ["mine.txt"]
    assert "it is a file" in npchip("--export", out / "mine.txt").output


@pytest.mark.skipif(os.name == "nt", reason="links")
def test_export_leaves_nothing_if_a_file_cannot_be_read(site: Path, tmp_path: Path) -> None:
    (site / "more.js").write_text("1")
    target = tmp_path / "out"

    def broken(*_: object) -> None:
        raise OSError(5, "Input/output error")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("shutil.copyfile", broken)
        done = npchip("--export", target)
    assert (done.exit_code, "NP250" in done.output) == (2, True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["site"]


def test_export_serves_nothing(site: Path, tmp_path: Path) -> None:
    assert site.exists()
    done = npchip("--export", tmp_path / "out", "--port", 80)
    assert (done.exit_code, "NP244" in done.output) == (2, True)
