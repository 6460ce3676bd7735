"""The server: documents, diagnostics, and the table of what it answers."""

from __future__ import annotations

import asyncio
from collections.abc import Generator
from functools import partial
from pathlib import Path
from typing import Any, Final

from lsprotocol import types
from pygls import uris
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol, lsp_method

from npchip import __version__
from npchip.language.analysis import Analysis
from npchip.language.settings import FILE
from npchip.lsp import convert
from npchip.lsp.session import Here, Session, path_of

PAUSE: Final = 0.03
"""Seconds without a change after which mistakes are looked for."""
_WATCHED: Final = ("**/*.s", f"**/{FILE}", "**/*.yaml", "**/*.yml")


class _Protocol(LanguageServerProtocol):
    """The protocol as this server speaks it."""

    _server: Server

    @lsp_method(types.INITIALIZE)
    def lsp_initialize(
        self, params: types.InitializeParams
    ) -> Generator[Any, Any, types.InitializeResult]:
        # All editors must know UTF-16, so positions are counted in its units only.
        if params.capabilities.general is not None:
            params.capabilities.general.position_encodings = None
        return (yield from super().lsp_initialize(params))

    @lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)
    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> None:
        # pygls keeps a future for every change that its own method sees, for ever.
        self._server.changed(params)


class Server(LanguageServer):
    """A language server for one editor.

    Texts come whole with each change, so that both sides cannot disagree about what a line is.

    Attributes:
        session: the open files.
        ended: whether the editor has said that it ends.
    """

    def __init__(self) -> None:
        super().__init__(
            "npchip",
            __version__,
            text_document_sync_kind=types.TextDocumentSyncKind.Full,
            protocol_cls=_Protocol,
        )
        self.session = Session()
        self.ended = False
        self._addresses: dict[Path, str] = {}  # as the editor writes them
        self._versions: dict[Path, int | None] = {}
        self._sent: dict[Path, tuple[int | None, list[types.Diagnostic]]] = {}
        self._last: Path | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._task: asyncio.Task[None] | None = None

    def report_server_error(self, error: Exception, source: Any) -> None:
        """Tell the editor of a fault that is the server's, and go on."""
        if getattr(source, "__name__", "") == "FeatureRequestError":
            return  # the answer says it
        message = f"npchip: {type(error).__name__}: {error} [NP259]"
        self.window_log_message(types.LogMessageParams(types.MessageType.Error, message))

    # ---- files

    def path(self, uri: str) -> Path:
        """Return the path of an address; a text that is not saved is one in the first folder."""
        found = uris.to_fs_path(uri) if uri.startswith("file:") else None
        if found is None:
            folder = self.session.folders[0] if self.session.folders else Path.cwd()
            return folder / (Path(uri.rpartition(":")[2]).name or "untitled")
        return Path(found).resolve()

    def uri(self, path: Path) -> str:
        """Return the address of a file."""
        return self._addresses.get(path) or convert.address(path)

    def here(self, uri: str) -> Here | None:
        """Return the file of an address within its program."""
        return self.session.here(self.path(uri))

    def opened(self, item: types.TextDocumentItem) -> None:
        """A file has been opened."""
        path = self.path(item.uri)
        self._addresses[path] = item.uri
        self._versions[path] = item.version
        self._sent.pop(path, None)  # an editor may have forgotten what was sent before
        self.session.open(path, item.text)
        self.look(path)

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """A file has changed."""
        path = self.path(params.text_document.uri)
        if path not in self.session.analyst.texts:
            return  # never opened
        for change in params.content_changes:
            self.session.change(path, change.text)
        self._versions[path] = params.text_document.version
        self.look(path)

    def closed(self, uri: str) -> None:
        """A file has been closed."""
        path = self.path(uri)
        self.session.close(path)
        self._versions.pop(path, None)
        self.look(None)

    def refreshed(self) -> None:
        """Files on the disk have changed."""
        self.session.refresh()
        self.look(self._last)

    # ---- mistakes

    def look(self, path: Path | None) -> None:
        """Look for mistakes after a pause, first in the program of a file."""
        self._last = path
        if self._timer is not None:
            self._timer.cancel()
        if self._task is not None:  # what it has found so far is of an older text
            self._task.cancel()
        self._timer = asyncio.get_running_loop().call_later(PAUSE, self._start)

    def _start(self) -> None:
        self._task = asyncio.ensure_future(self._publish())
        self._task.add_done_callback(self._published)

    def _published(self, task: asyncio.Task[None]) -> None:
        error = None if task.cancelled() else task.exception()
        if isinstance(error, Exception):
            self.report_server_error(error, None)

    async def _publish(self) -> None:
        """Send the mistakes of all open programs, and take back those that are gone."""
        found: dict[Path, list[types.Diagnostic]] = {}
        text = self.client_capabilities.text_document
        wanted = text.publish_diagnostics if text else None
        related = bool(wanted and wanted.related_information)
        roots = self.session.roots(self._last)
        for root in roots:
            analysis = self.session.analysis(root)
            for path, fault in self.session.faults(root):
                item = convert.diagnostic(fault, partial(self._uri_in, analysis), related=related)
                items = found.setdefault(path, [])
                if item not in items:
                    items.append(item)
            if root == roots[0]:
                self._send(root, found)
            await asyncio.sleep(0)  # lets what the editor asks come first
        for path in {*found, *self._sent, *self._versions}:
            self._send(path, found)
        for path in self._sent.keys() - found.keys() - self._versions.keys():
            del self._sent[path]
            self._addresses.pop(path, None)

    def _uri_in(self, analysis: Analysis, file: str) -> str:
        return self.uri(path_of(file, analysis))

    def _send(self, path: Path, found: dict[Path, list[types.Diagnostic]]) -> None:
        version, items = self._versions.get(path), found.get(path, [])
        if self._sent.get(path) == (version, items):
            return
        if not items and path not in self._sent and path not in self._versions:
            return
        self._sent[path] = (version, list(items))
        self.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(self.uri(path), items, version)
        )

    def watch(self) -> None:
        """Ask the editor to tell of files that change on the disk, if it can."""
        workspace = self.client_capabilities.workspace
        watching = workspace.did_change_watched_files if workspace else None
        if watching is None or not watching.dynamic_registration:
            return
        options = types.DidChangeWatchedFilesRegistrationOptions(
            [types.FileSystemWatcher(pattern) for pattern in _WATCHED]
        )
        method = types.WORKSPACE_DID_CHANGE_WATCHED_FILES
        self.client_register_capability(
            types.RegistrationParams([types.Registration("npchip-files", method, options)])
        )
