"""Serves the page to browsers on this computer."""

from __future__ import annotations

import errno
import os
import re
import shutil
import socket
from email.utils import formatdate
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote, urlsplit

from npchip.base.errors import InputError
from npchip.studio.bundling import POLICY
from npchip.studio.offline import digest
from npchip.studio.places import COMPRESSED, VERSION_FILE, site_files

ADDRESS: Final = "127.0.0.1"
_NAMES: Final = {ADDRESS, "localhost"}
_TYPES: Final = {
    ".bin": "application/octet-stream",
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".mjs": "text/javascript; charset=utf-8",
    ".npy": "application/octet-stream",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".wasm": "application/wasm",
    ".webmanifest": "application/manifest+json",
    ".zip": "application/zip",
}
"""Types of files by suffix, since the registry of a PC may call a script plain text."""
_HEADERS: Final = {
    # The page has the policy too; a page in a frame, and workers, have it from here only.
    "Content-Security-Policy": f"{POLICY}; frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(self), microphone=(), geolocation=()",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-cache",  # to be asked for each time: a new build shows at once
}


class Server(ThreadingHTTPServer):
    """A server of the files of the site, also after it has been built again.

    Args:
        site: the folder of the page.
        port: the port; 0 for any free one.

    Raises:
        InputError: NP634, the port cannot be used.
    """

    daemon_threads = True
    allow_reuse_address = os.name != "nt"  # there it would share a port that is in use

    def __init__(self, site: Path, port: int = 0) -> None:
        self._site = site
        self._built = 0
        self._files: dict[str, Path] = {}
        self._tags: dict[str, str] = {}
        try:
            super().__init__((ADDRESS, port), _Handler)
        except OSError as error:
            used = error.errno == errno.EADDRINUSE
            reason = "it is in use" if used else error.strerror or str(error)
            raise InputError(
                "NP634",
                f"the studio cannot be served at port {port}: {reason}",
                hint="name another one, or leave out --port for a free one",
            ) from None

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"http://{ADDRESS}:{self.server_port}/"

    def server_bind(self) -> None:
        """Bind the socket; do not ask for the computer's name, which may take seconds."""
        self.socket.setsockopt(
            socket.SOL_SOCKET, socket.SO_REUSEADDR, int(self.allow_reuse_address)
        )
        self.socket.bind(self.server_address)
        self.server_address = self.socket.getsockname()
        self.server_name, self.server_port = ADDRESS, self.server_address[1]

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of a browser that went away."""

    def find(self, name: str) -> Path | None:
        """Return the file of the site that has a name; None if there is none."""
        self._look()
        return self._files.get(name)

    def tag(self, path: Path) -> str:
        """Return the ETag of a file; it is worked out once."""
        name = str(path)
        if name not in self._tags:
            self._tags[name] = f'"{digest(path)[:20]}"'
        return self._tags[name]

    def _look(self) -> None:
        """List the site's files unless they are known."""
        try:
            built = (self._site / VERSION_FILE).stat().st_mtime_ns
        except OSError:
            return  # it is being replaced
        if built != self._built:
            found = {
                path.relative_to(self._site).as_posix(): path for path in site_files(self._site)
            }
            self._built, self._files, self._tags = built, found, {}


class _Handler(BaseHTTPRequestHandler):
    server: Server
    protocol_version = "HTTP/1.1"
    timeout = 60

    def do_GET(self) -> None:
        """Send a file."""
        self._answer(with_body=True)

    def do_HEAD(self) -> None:
        """Send what a GET would say of a file."""
        self._answer(with_body=False)

    def version_string(self) -> str:
        """Name the server, but none of its versions."""
        return "npchip"

    def log_message(self, format: str, *args: Any) -> None:  # noqa: A002 - the name of the base
        """Say nothing: the console shows the address."""

    def _answer(self, *, with_body: bool) -> None:
        if not self._is_for_us():
            self.close_connection = True
            self._refuse(
                HTTPStatus.MISDIRECTED_REQUEST, "open the address that npchip studio shows"
            )
            return
        path = self._file()
        if path is None:
            self._refuse(HTTPStatus.NOT_FOUND, "the studio has no such file", with_body=with_body)
            return
        kind = _TYPES.get(path.suffix, "application/octet-stream")
        packed = path.with_name(path.name + COMPRESSED)
        zipped = packed.is_file()
        if zipped and self._takes_gzip():
            path = packed
        tag = self.server.tag(path)
        same = tag in re.findall(r'"[^"]*"', self.headers.get("If-None-Match", ""))
        self.send_response(HTTPStatus.NOT_MODIFIED if same else HTTPStatus.OK)
        self.send_header("ETag", tag)
        if zipped:
            self.send_header("Vary", "Accept-Encoding")
        if not same:
            self.send_header("Content-Type", kind)
            self.send_header("Last-Modified", formatdate(path.stat().st_mtime, usegmt=True))
            if path == packed:
                self.send_header("Content-Encoding", "gzip")
        self._send(path, with_body=with_body and not same, sized=not same)

    def _send(self, path: Path, *, with_body: bool, sized: bool) -> None:
        with path.open("rb") as file:
            if sized:
                self.send_header("Content-Length", str(os.fstat(file.fileno()).st_size))
            self.end_headers()
            if with_body:
                shutil.copyfileobj(file, self.wfile, 1 << 16)

    def _refuse(self, status: HTTPStatus, text: str, *, with_body: bool = True) -> None:
        body = f"{status.value} {status.phrase}: {text}\n".encode()
        self.send_response(status)
        self.send_header("Content-Type", "text/plain; charset=utf-8")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if with_body:
            self.wfile.write(body)

    def end_headers(self) -> None:
        """Add what every answer has."""
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def _is_for_us(self) -> bool:
        """Return whether the browser asked for this computer by a name of its own.

        A page elsewhere could let its own name stand for 127.0.0.1, and then read the answers.
        """
        name = self.headers.get("Host", "")
        host, _, port = name.partition(":")
        return host in _NAMES and (port.isdecimal() or not port)

    def _file(self) -> Path | None:
        """Return the file that is asked for: one of those that the server knows, or none."""
        try:
            name = unquote(urlsplit(self.path).path, errors="strict")
        except ValueError:
            return None
        return self.server.find(name.removeprefix("/") or "index.html")

    def _takes_gzip(self) -> bool:
        taken = self.headers.get("Accept-Encoding", "")
        return re.search(r"\bgzip\b(?!\s*;\s*q=0(\.0*)?\s*(,|$))", taken) is not None
