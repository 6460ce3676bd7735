"""The server of the page: what it sends, to whom, and what it never sends."""

from __future__ import annotations

import gzip
import http.client
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from npchip import InputError
from npchip.studio.serve import Server

PAGE = b"<!doctype html><title>studio</title>"
WASM = b"\0asm" + bytes(2000)
FILES = {
    "index.html": PAGE,
    "player.html": b"template",
    "version.json": b"{}",
    "studio.js": b"1",
    "pyodide/pyodide.mjs": b"2",
    "pyodide/pyodide.asm.wasm": WASM,
    "pyodide/pyodide.asm.wasm.gz": gzip.compress(WASM),
    "python/snapshot.bin": b"3",
    "clips/coin slide.npy": b"4",
}


@pytest.fixture
def site(tmp_path: Path) -> Path:
    (tmp_path / "secret.txt").write_text("nobody's business")
    for name, data in FILES.items():
        path = tmp_path / "site" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return tmp_path / "site"


@pytest.fixture
def server(site: Path) -> Iterator[Server]:
    with Server(site) as found:
        thread = threading.Thread(target=found.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield found
        found.shutdown()
        thread.join()


def ask(
    server: Server, path: str, method: str = "GET", **headers: str
) -> tuple[int, dict[str, str], bytes]:
    """Send a request whose path is not tidied up first."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=10)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, headers=named)
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, dict(answer.getheaders()), body


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("/", "text/html; charset=utf-8"),
        ("/index.html", "text/html; charset=utf-8"),
        ("/?from=mail", "text/html; charset=utf-8"),
        ("/studio.js", "text/javascript; charset=utf-8"),
        ("/pyodide/pyodide.mjs", "text/javascript; charset=utf-8"),
        ("/pyodide/pyodide.asm.wasm", "application/wasm"),
        ("/python/snapshot.bin", "application/octet-stream"),
        ("/clips/coin%20slide.npy", "application/octet-stream"),
    ],
)
def test_files_have_their_type(server: Server, path: str, kind: str) -> None:
    status, headers, body = ask(server, path)
    assert (status, headers["Content-Type"]) == (200, kind)
    name = path.partition("?")[0].removeprefix("/").replace("%20", " ") or "index.html"
    assert body == FILES[name]


@pytest.mark.parametrize(
    "path",
    [
        "/../secret.txt",
        "/%2e%2e/secret.txt",
        "/..%2fsecret.txt",
        "/pyodide/../../secret.txt",
        "//secret.txt",
        "/pyodide",
        "/pyodide/",
        "/player.html",
        "/pyodide/pyodide.asm.wasm.gz",
        "/%ff",
        "/index.html%00",
        "/nothing.js",
        "/C:/Windows/win.ini",
    ],
)
def test_nothing_else_is_sent(server: Server, path: str) -> None:
    status, _, body = ask(server, path)
    assert status == 404
    assert b"business" not in body


@pytest.mark.parametrize("host", ["example.org", "example.org:80", "127.0.0.1.example.org", ""])
def test_other_names_for_this_computer_are_refused(server: Server, host: str) -> None:
    status, _, body = ask(server, "/", Host=host)
    assert status == 421
    assert PAGE not in body


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost:9000"])
def test_a_forwarded_port_works(server: Server, host: str) -> None:
    assert ask(server, "/", Host=host)[0] == 200


def test_it_is_bound_to_this_computer_only(server: Server) -> None:
    assert server.socket.getsockname()[0] == "127.0.0.1"
    assert server.address == f"http://127.0.0.1:{server.server_port}/"


def test_a_compressed_copy_is_sent_to_those_who_take_it(server: Server) -> None:
    path = "/pyodide/pyodide.asm.wasm"
    _, plain, body = ask(server, path, Accept_Encoding="identity")
    assert body == WASM
    _, packed, body = ask(server, path, Accept_Encoding="br, gzip")
    assert gzip.decompress(body) == WASM
    assert packed["Content-Encoding"] == "gzip"
    assert packed["Content-Type"] == plain["Content-Type"] == "application/wasm"
    assert packed["Vary"] == plain["Vary"] == "Accept-Encoding"
    assert packed["ETag"] != plain["ETag"]
    assert ask(server, path, Accept_Encoding="gzip;q=0")[2] == WASM


def test_head_says_what_get_would(server: Server) -> None:
    status, headers, body = ask(server, "/pyodide/pyodide.asm.wasm", "HEAD")
    assert (status, headers["Content-Length"], body) == (200, str(len(WASM)), b"")
    assert ask(server, "/nothing", "HEAD")[0] == 404


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE"])
def test_nothing_can_be_written(server: Server, method: str) -> None:
    assert ask(server, "/index.html", method)[0] == 501


def test_a_browser_asks_again_and_gets_what_is_new(server: Server, site: Path) -> None:
    _, headers, _ = ask(server, "/")
    assert headers["Cache-Control"] == "no-cache"
    status, _, body = ask(server, "/", If_None_Match=headers["ETag"])
    assert (status, body) == (304, b"")
    (site / "index.html").write_bytes(b"new")
    (site / "more.js").write_bytes(b"5")
    (site / "version.json").write_bytes(b"{ }")
    status, _, body = ask(server, "/", If_None_Match=headers["ETag"])
    assert (status, body) == (200, b"new")
    assert ask(server, "/more.js")[0] == 200


def test_the_policy_allows_no_other_host(server: Server) -> None:
    for path in ("/", "/studio.js", "/nothing"):
        policy = ask(server, path)[1]["Content-Security-Policy"]
        assert policy.startswith("default-src 'none'")
        assert "frame-ancestors 'none'" in policy
        assert not {"http:", "https:", "*", "'unsafe-eval'"} & set(policy.replace(";", " ").split())
        assert "'unsafe-inline'" not in policy.split("style-src")[0]


def test_a_port_in_use_is_an_error(server: Server, site: Path) -> None:
    with pytest.raises(InputError, match=rf"port {server.server_port}: it is in use.*NP634"):
        Server(site, server.server_port)
