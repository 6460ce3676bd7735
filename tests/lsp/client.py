"""A client for tests: pygls's own, with what the server sends kept."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

from lsprotocol import types
from pygls.lsp.client import LanguageClient

TIMEOUT = 30.0


class Client(LanguageClient):
    """A client that writes like an editor and waits for the mistakes of a version."""

    def __init__(self) -> None:
        super().__init__("npchip-tests", "1")
        self.published: dict[str, types.PublishDiagnosticsParams] = {}
        self.logged: list[str] = []
        self.versions: dict[str, int] = {}
        self._news = asyncio.Event()

        def published(params: types.PublishDiagnosticsParams) -> None:
            self.published[params.uri] = params
            self._news.set()

        self.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(published)
        self.feature(types.WINDOW_LOG_MESSAGE)(lambda params: self.logged.append(params.message))
        self.feature(types.CLIENT_REGISTER_CAPABILITY)(lambda _params: None)

    def open(self, path: Path, text: str | None = None) -> str:
        """Open a file, and return its address."""
        uri = path.as_uri()
        self.versions[uri] = 1
        text = path.read_text(encoding="utf-8") if text is None else text
        item = types.TextDocumentItem(uri, "npchip", 1, text)
        self.text_document_did_open(types.DidOpenTextDocumentParams(item))
        return uri

    def write(self, uri: str, text: str) -> int:
        """Change a file as a whole, and return its version."""
        self.versions[uri] += 1
        change = types.TextDocumentContentChangeWholeDocument(text)
        item = types.VersionedTextDocumentIdentifier(self.versions[uri], uri)
        self.text_document_did_change(types.DidChangeTextDocumentParams(item, [change]))
        return self.versions[uri]

    async def mistakes(self, uri: str) -> list[types.Diagnostic]:
        """Wait for the mistakes of the present version of a file, and return them."""
        async with asyncio.timeout(TIMEOUT):
            while True:
                found = self.published.get(uri)
                if found is not None and found.version == self.versions.get(uri):
                    return list(found.diagnostics)
                self._news.clear()
                await self._news.wait()

    async def until(self, uri: str, codes: list[str]) -> list[types.Diagnostic]:
        """Wait until a file has mistakes of these codes, and return them."""
        async with asyncio.timeout(TIMEOUT):
            while True:
                found = self.published.get(uri)
                items = list(found.diagnostics) if found else []
                if found is not None and [item.code for item in items] == codes:
                    return items
                self._news.clear()
                await self._news.wait()


@asynccontextmanager
async def editor(folder: Path, *, related: bool = True) -> AsyncIterator[Client]:
    """Start a server for a folder, and end it as an editor does."""
    client = Client()
    await client.start_io(sys.executable, "-m", "npchip", "lsp", cwd=folder)
    publishing = types.PublishDiagnosticsClientCapabilities(related_information=related)
    params = types.InitializeParams(
        capabilities=types.ClientCapabilities(
            text_document=types.TextDocumentClientCapabilities(publish_diagnostics=publishing),
            general=types.GeneralClientCapabilities(position_encodings=["utf-8", "utf-16"]),
        ),
        process_id=None,
        root_uri=folder.as_uri(),
        workspace_folders=[types.WorkspaceFolder(folder.as_uri(), folder.name)],
    )
    result = await client.initialize_async(params)
    assert result.capabilities.position_encoding == "utf-16"
    client.initialized(types.InitializedParams())
    try:
        yield client
        async with asyncio.timeout(TIMEOUT):
            await client.shutdown_async(None)
            client.exit(None)
            server = client._server  # noqa: SLF001 - pygls has no other way to its exit code
            assert server is not None
            assert await server.wait() == 0
        assert client.logged == []
    finally:
        server = client._server  # noqa: SLF001
        if server is not None and server.returncode is None:  # a test has failed
            server.kill()
        await client.stop()  # type: ignore[no-untyped-call]
