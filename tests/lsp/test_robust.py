"""The server among sources with mistakes, random edits, and clients that are broken."""

from __future__ import annotations

import asyncio
import json
import random
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import pytest
from lsprotocol import types

from npchip.assembler import AssemblyError, Diagnostic, assemble
from npchip.base.errors import InputError
from npchip.language.includes import Includes
from tests.lsp.client import editor
from tests.support.profiles import THOROUGH
from tests.support.programs import ASM

pytestmark = pytest.mark.long

ERRORS = Path(__file__).parents[1] / "asm" / "errors"
ROOT = Path(__file__).parents[2]


def found_by_asm(path: Path, text: str | None = None) -> list[tuple[object, ...]]:
    """Return what ``npchip asm`` says of a source, without the places of other files."""
    if text is not None:
        path.write_text(text, encoding="utf-8", newline="")
    found: list[Diagnostic] = []
    try:
        assemble(path, on_warning=found.append)
    except AssemblyError as error:
        found += error.diagnostics
    return sorted(
        (
            item.code,
            f"{item.message}\nhelp: {item.suggestion}" if item.suggestion else item.message,
            item.span.line.number,
            len(item.span.line.text[: item.span.column].encode("utf-16-le")) // 2 + 1,
            len(item.notes),
        )
        for item in found
        if Path(item.span.line.file).resolve() == path.resolve()
    )


def found_by_server(items: list[types.Diagnostic]) -> list[tuple[object, ...]]:
    return sorted(
        (
            item.code,
            item.message,
            item.range.start.line + 1,
            item.range.start.character + 1,
            len(item.related_information or ()),
        )
        for item in items
    )


def test_asm_opens_without_a_mistake() -> None:
    async def main() -> None:
        async with editor(ROOT) as client:
            opened = [client.open(path) for path in sorted(Path(ASM).rglob("*.s"))]
            assert len(opened) > 30
            for uri in opened:
                assert await client.mistakes(uri) == []

    asyncio.run(main())


@pytest.mark.parametrize("part", range(8))
def test_messages_are_those_of_asm(part: int) -> None:
    includes = Includes()
    sources = []
    for path in sorted(ERRORS.glob("*.s")):
        try:
            path.read_text(encoding="utf-8")
            if includes.programs(path.resolve(), ERRORS.resolve(), {}) == [path.resolve()]:
                found_by_asm(path)
                sources.append(path)
        except (UnicodeDecodeError, InputError):
            continue  # no editor opens it as a text, or asm says nothing of a line
    assert len(sources) > 100

    async def main() -> None:
        async with editor(ERRORS) as client:
            for path in sources[part::8]:
                uri = client.open(path, path.read_bytes().decode("utf-8-sig"))
                items = await client.mistakes(uri)
                assert found_by_server(items) == found_by_asm(path), path.name
                document = types.TextDocumentIdentifier(uri)
                client.text_document_did_close(types.DidCloseTextDocumentParams(document))

    asyncio.run(main())


STEPS = 334 if THOROUGH else 100
"""Edits of each file: a thousand in all where all is to be thorough."""

PIECES = (
    *('"', ";", "\n", "(", "\t", ":", ",", "\x0c", "\N{LINE SEPARATOR}", "\N{GRINNING FACE}"),
    *(".macro m\n", ".endm\n", ".rept 9\n", ".endr\n", ".if 0\n", ".endif\n", "WHERE HI\n"),
)


def edited(text: str, source: str, random_: random.Random) -> str:
    """Return a text with a piece cut, pasted or typed."""
    start = random_.randrange(len(text) + 1)
    match random_.randrange(3):
        case 0:
            return text[:start] + text[start + random_.randrange(1, 200) :]
        case 1:
            at = random_.randrange(len(source))
            return text[:start] + source[at : at + random_.randrange(1, 200)] + text[start:]
    return text[:start] + random_.choice(PIECES) + text[start:]


@pytest.mark.parametrize("name", ["trajectory", "median", "lib/moving_box"])
def test_random_edits(name: str, tmp_path: Path) -> None:
    random_ = random.Random(name)
    for path in Path(ASM).rglob("*.s"):
        copy = tmp_path / path.relative_to(ASM)
        copy.parent.mkdir(exist_ok=True)
        copy.write_bytes(path.read_bytes())
    path = tmp_path / f"{name}.s"
    source = text = path.read_text(encoding="utf-8")

    async def main() -> None:
        nonlocal text
        async with editor(tmp_path) as client:
            uri = client.open(path)
            document = types.TextDocumentIdentifier(uri)
            for step in range(STEPS):
                text = source if step % 25 == 24 else edited(text, source, random_)
                client.write(uri, text)
                at = types.Position(random_.randrange(250), random_.randrange(60))
                hover = types.HoverParams(document, at)
                complete = types.CompletionParams(document, at)
                tokens = types.SemanticTokensParams(document)
                context = types.ReferenceContext(include_declaration=True)
                references = types.ReferenceParams(context, document, at)
                await client.text_document_hover_async(hover)
                await client.text_document_completion_async(complete)
                await client.text_document_semantic_tokens_full_async(tokens)
                await client.text_document_references_async(references)
                if step % 5 == 0:
                    items = await client.mistakes(uri)
                    if "/" not in name:
                        assert found_by_server(items) == found_by_asm(path, text)
            client.write(uri, source)
            assert await client.mistakes(uri) == []

    asyncio.run(main())


def test_mistakes_come_soon_and_memory_is_flat() -> None:
    path = Path(ASM) / "median.s"  # 485 of 512 words, with an included file
    text = path.read_text(encoding="utf-8")

    async def main() -> None:
        async with editor(ROOT) as client:
            uri = client.open(path)
            await client.mistakes(uri)
            server = client._server  # noqa: SLF001
            assert server is not None
            times, sizes = [], []
            for step in range(400):
                word = ("MOV", "MVO", "MOVE", "MO")[step % 4]
                begin = time.perf_counter()
                client.write(uri, text.replace("MOV", word, 1))
                codes = Counter(item.code for item in await client.mistakes(uri))
                times.append(time.perf_counter() - begin)
                assert codes == ({} if word == "MOV" else {"NP003": 1})
                sizes.append(memory(server.pid))
            # 0.05 s on a quiet machine, a pause of 0.03 s included; a busy one has more time.
            assert sorted(times)[len(times) // 2] < 0.3
            # After 200 edits the oldest generation of garbage has been as large as it gets.
            assert sizes[-1] - sizes[200] < 4_000

    asyncio.run(main())


def memory(process: int) -> int:
    """Return the resident memory of a process in KiB."""
    status = Path(f"/proc/{process}/status").read_text(encoding="ascii")
    return int(next(line for line in status.splitlines() if line.startswith("VmRSS")).split()[1])


def test_broken_clients(tmp_path: Path) -> None:
    uri = (tmp_path / "a.s").as_uri()
    text = "        MOV     r1, #300\n"
    document = {"uri": uri}

    def request(number: int, method: str, **params: object) -> dict[str, object]:
        return {"jsonrpc": "2.0", "id": number, "method": method, "params": params}

    def note(method: str, **params: object) -> dict[str, object]:
        return {"jsonrpc": "2.0", "method": method, "params": params}

    def position(line: int, character: int) -> dict[str, object]:
        return {"textDocument": document, "position": {"line": line, "character": character}}

    item = {"uri": uri, "languageId": "npchip", "version": 1, "text": text}
    messages: list[object] = [
        request(1, "initialize", capabilities={}, processId=None, rootUri=None),
        note("initialized"),
        note("textDocument/didChange", textDocument={"uri": uri, "version": 9}, contentChanges=[]),
        note("textDocument/didClose", textDocument=document),
        note("textDocument/didOpen", textDocument=item),
        request(2, "textDocument/hover", **position(99, 99)),
        request(3, "textDocument/hover", **position(-1, -5)),
        request(4, "textDocument/hover", nonsense=True),
        request(5, "textDocument/nonsense"),
        request(6, "textDocument/rename", **position(0, 9), newName=""),
        request(7, "textDocument/formatting", textDocument={"uri": "untitled:x"}, options={}),
        note("textDocument/didOpen", textDocument={**item, "uri": "nonsense:"}),
        {"jsonrpc": "2.0"},
        [1, 2],
        request(8, "textDocument/hover", **position(0, 9)),
        request(9, "shutdown"),
        note("exit"),
    ]
    sent = b""
    for message in messages:
        body = json.dumps(message).encode()
        sent += b"Content-Length: %d\r\n\r\n" % len(body) + body
        if message is messages[4]:
            sent += b"Content-Length: 5\r\n\r\n{oops"
    done = subprocess.run(
        [sys.executable, "-m", "npchip", "lsp"],
        input=sent,
        capture_output=True,
        timeout=60,
        check=False,
    )
    assert b"Traceback" not in done.stderr
    assert done.returncode == 0
    answers = [
        json.loads(b"{" + part.partition(b"{")[2])
        for part in done.stdout.split(b"Content-Length")[1:]
    ]
    results = {answer["id"]: answer for answer in answers if "id" in answer}
    assert results[2]["result"] is None
    assert "error" in results[5]
    assert "MOV" in results[8]["result"]["contents"]["value"]
    assert results[9]["result"] is None


def test_the_end_of_the_input_ends_the_server() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "npchip", "lsp"],
        input=b"",
        capture_output=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (1, b"", b"")
