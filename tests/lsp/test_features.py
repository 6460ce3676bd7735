"""Every feature of the server, in a small project, with a real client."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from npchip import assemble
from tests.lsp.client import Client, editor

pytestmark = pytest.mark.long

MAIN = """\
; main.s - a program
; expect: total[0] == 3
; run: define=LIMIT=7
.include "lib/add.s"
.equ LIMIT, 5                   ; the most
.reg sum, r3                    ; what is added up
.output total, 2, scalar
.budget words 40
start:  ROW     r0
        MOV     sum, #LIMIT
        add_up  sum, 2
        CMP     sum, #LIMIT
        WHERE   HI
          MOV   sum, #0
        ELSE
          MOV   sum, #1
        END
.again: OUT     2, sum
        JANY    EQ, .again
        JMP     start
"""
LIBRARY = """\
; add.s - adds
.macro add_up register, number
        ADD     register, #number
        ADD     register, #LIMIT
.endm
"""
OTHER = """\
.include "lib/add.s"
.equ LIMIT, 1
        MOV     r0, #1
        add_up  r0, 1
        HALT
"""


class Project:
    """The project, its client, and what tests ask."""

    def __init__(self, client: Client, folder: Path) -> None:
        self.client = client
        self.folder = folder
        self.uri = client.open(folder / "main.s")
        self.document = types.TextDocumentIdentifier(self.uri)

    def at(self, text: str, word: str) -> types.Position:
        """Return where a word begins in the first line that holds a text."""
        lines = (self.folder / "main.s").read_text().split("\n")
        number, line = next(item for item in enumerate(lines) if text in item[1])
        return types.Position(number, line.index(word, line.index(text)))


def run(folder: Path, test: Callable[[Project], Awaitable[None]]) -> None:
    """Run a test in a project."""
    (folder / "lib").mkdir()
    (folder / "main.s").write_text(MAIN)
    (folder / "other.s").write_text(OTHER)
    (folder / "lib" / "add.s").write_text(LIBRARY)

    async def main() -> None:
        async with editor(folder) as client:
            project = Project(client, folder)
            assert await client.mistakes(project.uri) == []
            await test(project)

    asyncio.run(main())


def words(folder: Path) -> list[tuple[int, ...]]:
    return [assemble(folder / name).words for name in ("main.s", "other.s")]


def applied(text: str, edits: list[types.TextEdit]) -> str:
    """Return a text with edits that stay within their lines."""
    lines = text.split("\n")
    for edit in sorted(edits, key=lambda e: (e.range.start.line, e.range.start.character))[::-1]:
        start, end = edit.range.start, edit.range.end
        line = lines[start.line]
        lines[start.line] = line[: start.character] + edit.new_text + line[end.character :]
    return "\n".join(lines)


def test_hover(tmp_path: Path) -> None:
    async def ask(project: Project) -> None:
        async def card(text: str, word: str) -> str:
            place = types.HoverParams(project.document, project.at(text, word))
            found = await project.client.text_document_hover_async(place)
            if found is None:
                return ""
            assert isinstance(found.contents, types.MarkupContent)
            return found.contents.value

        constant = await card("#LIMIT", "LIMIT")
        assert "LIMIT = 5" in constant
        assert "main.s:5" in constant
        assert "the most" in constant
        register = await card("OUT     2", "sum")
        assert "sum: register r3" in register
        assert "used in 6 lines" in register
        instruction = await card("CMP     sum", "CMP")
        assert "CMP rd, rs" in instruction
        assert "1 cycle on default" in instruction
        assert "This line: 1 word, 1 cycle" in instruction
        macro = await card("add_up  sum", "add_up")
        assert ".macro add_up register, number" in macro
        assert "add.s:2" in macro
        assert "This line: 2 words, 2 cycles" in macro
        assert "address 0" in await card("JMP     start", "start")
        assert ".output total, 2, scalar" in await card(".output total", "total")
        assert "higher" in await card("WHERE   HI", "HI")
        assert ".budget words N" in await card(".budget", ".budget")
        assert "named sum (main.s:6)" in await card(".reg sum", "r3")
        assert await card("; main.s", "program") == ""

    run(tmp_path, ask)


def test_completion(tmp_path: Path) -> None:
    async def ask(project: Project) -> None:
        async def offers(before: str) -> dict[str, types.CompletionItem]:
            text = MAIN + before
            project.client.write(project.uri, text)
            place = types.Position(text.count("\n"), len(before))
            params = types.CompletionParams(project.document, place)
            found = await project.client.text_document_completion_async(params)
            assert isinstance(found, types.CompletionList)
            return {item.label: item for item in found.items}

        statements = await offers("        AD")
        assert {"ADD", "ADC", ".macro", "add_up", "HALT"} <= statements.keys()
        resolved = await project.client.completion_item_resolve_async(statements["ADD"])
        assert isinstance(resolved.documentation, types.MarkupContent)
        assert "Flags written" in resolved.documentation.value
        assert {*await offers("        JANY ")} >= {"EQ", "HI"}
        assert {*await offers("        JANY EQ, ")} >= {"start", ".again"}
        registers = await offers("        MOV ")
        assert registers.keys() >= {"sum", "r0"}
        assert "LIMIT" not in registers
        assert (await offers("        OUT "))["2"].detail == "output total, scalar"
        assert "2" not in await offers(".output more, ")
        assert {*await offers(".output more, 3, ")} == {
            "scalar",
            "scalar16",
            "list",
            "plane",
            "picture",
        }
        assert {*await offers("        NBR r1, r2, ")} == {"north", "east", "south", "west"}
        assert {*await offers('.include "lib/')} == {"add.s"}
        assert await offers("; a comm") == {}
        edit = (await offers("        ADD r1, #LI"))["LIMIT"].text_edit
        assert isinstance(edit, types.TextEdit)
        assert (edit.range.start.character, edit.range.end.character) == (17, 19)

    run(tmp_path, ask)


def test_definition_and_references(tmp_path: Path) -> None:
    async def ask(project: Project) -> None:
        async def defined(text: str, word: str) -> list[tuple[str, int]]:
            params = types.DefinitionParams(project.document, project.at(text, word))
            found = await project.client.text_document_definition_async(params)
            assert isinstance(found, tuple | list)
            return [
                (item.uri.rpartition("/")[2], item.range.start.line)
                for item in found
                if isinstance(item, types.Location)
            ]

        assert await defined("add_up  sum", "add_up") == [("add.s", 1)]
        assert await defined("#LIMIT", "LIMIT") == [("main.s", 4)]
        assert await defined("JANY", ".again") == [("main.s", 17)]
        assert await defined(".include", "lib") == [("add.s", 0)]

        async def used(text: str, word: str) -> set[tuple[str, int]]:
            context = types.ReferenceContext(include_declaration=False)
            at = project.at(text, word)
            params = types.ReferenceParams(context, project.document, at)
            found = await project.client.text_document_references_async(params)
            assert found is not None
            return {(item.uri.rpartition("/")[2], item.range.start.line) for item in found}

        assert await used("add_up  sum", "add_up") == {("main.s", 10), ("other.s", 3)}
        assert await used("#LIMIT", "LIMIT") == {("main.s", 9), ("main.s", 11), ("add.s", 3)}

    run(tmp_path, ask)


def test_rename(tmp_path: Path) -> None:
    async def ask(project: Project) -> None:
        async def rename(text: str, word: str, new: str) -> None:
            params = types.RenameParams(project.document, project.at(text, word), new)
            found = await project.client.text_document_rename_async(params)
            assert found is not None
            assert found.changes
            for uri, edits in found.changes.items():
                path = Path(uri.removeprefix("file://"))
                changed = applied(
                    path.read_text(), [e for e in edits if isinstance(e, types.TextEdit)]
                )
                path.write_text(changed)
                if uri == project.uri:
                    project.client.write(uri, changed)
            watched = types.DidChangeWatchedFilesParams([])
            project.client.workspace_did_change_watched_files(watched)

        before = words(tmp_path)
        await rename("#LIMIT", "LIMIT", "BOUND")
        main = (tmp_path / "main.s").read_text()
        assert "define=BOUND=7" in main
        assert "LIMIT" not in main + (tmp_path / "lib/add.s").read_text()
        assert ".equ BOUND, 1" in (tmp_path / "other.s").read_text()
        await rename("add_up  sum", "add_up", "plus")
        await rename("JANY", ".again", ".once_more")
        await rename(".output total", "total", "all_of_it")
        assert "; expect: all_of_it[0] == 3" in (tmp_path / "main.s").read_text()
        assert words(tmp_path) == before
        for new in ("ADD", "r3", "1st", "start", "a b", ".local"):
            with pytest.raises(JsonRpcException, match="NP671"):
                await rename("OUT     2", "sum", new)
        prepared = types.PrepareRenameParams(project.document, project.at("OUT     2", "OUT"))
        assert await project.client.text_document_prepare_rename_async(prepared) is None

    run(tmp_path, ask)


def test_mistakes_in_an_included_file(tmp_path: Path) -> None:
    async def ask(project: Project) -> None:
        client = project.client
        library = (tmp_path / "lib" / "add.s").as_uri()
        client.open(tmp_path / "lib" / "add.s")
        assert await client.mistakes(library) == []  # it is no program: LIMIT is its user's
        client.write(library, LIBRARY.replace("#number", "#numbr"))
        (found,) = await client.mistakes(library)
        assert found.code == "NP007"
        assert found.range.start == types.Position(2, 27)
        (related,) = found.related_information or ()
        assert related.location.uri == project.uri
        assert related.location.range.start.line == 10
        assert related.message == "in macro 'add_up', expanded here"
        client.write(library, LIBRARY)
        assert await client.mistakes(library) == []
        params = types.DidCloseTextDocumentParams(types.TextDocumentIdentifier(library))
        client.text_document_did_close(params)
        client.write(project.uri, MAIN.replace("#0", "#NO"))
        assert [item.code for item in await client.mistakes(project.uri)] == ["NP007"]

    run(tmp_path, ask)


def test_symbols_and_folding(tmp_path: Path) -> None:
    async def ask(project: Project) -> None:
        client, document = project.client, project.document
        params = types.DocumentSymbolParams(document)
        found = await client.text_document_document_symbol_async(params)
        assert found is not None
        assert [item.name for item in found] == ["LIMIT", "sum", "total", "start", ".again"]
        everywhere = await client.workspace_symbol_async(types.WorkspaceSymbolParams("add"))
        assert everywhere is not None
        assert [item.name for item in everywhere] == ["add_up"]
        folds = await client.text_document_folding_range_async(types.FoldingRangeParams(document))
        assert folds is not None
        assert {(fold.start_line, fold.end_line) for fold in folds} == {(0, 2), (12, 13), (14, 16)}
        at = project.at("JANY", ".again")
        marks = types.DocumentHighlightParams(document, at)
        assert len(await client.text_document_document_highlight_async(marks) or ()) == 2

    run(tmp_path, ask)


def test_formatting_and_actions(tmp_path: Path) -> None:
    async def ask(project: Project) -> None:
        client = project.client
        client.write(project.uri, MAIN.replace("        CMP     sum", "  CPM  sum"))
        (found,) = await client.mistakes(project.uri)
        assert found.message == "unknown instruction 'CPM'\nhelp: did you mean CMP?"
        context = types.CodeActionContext([found])
        asked = types.CodeActionParams(project.document, found.range, context)
        actions = await client.text_document_code_action_async(asked)
        assert actions is not None
        (action,) = actions
        assert isinstance(action, types.CodeAction)
        assert action.edit is not None
        assert action.edit.changes is not None
        (edit,) = action.edit.changes[project.uri]
        assert isinstance(edit, types.TextEdit)
        assert edit.new_text == "CMP"
        client.write(project.uri, MAIN.replace("        CMP     sum", "  CMP  sum"))
        options = types.FormattingOptions(tab_size=8, insert_spaces=True)
        params = types.DocumentFormattingParams(project.document, options)
        edits = await client.text_document_formatting_async(params)
        assert edits is not None
        assert [edit.new_text for edit in edits] == ["        CMP     sum, #LIMIT"]

    run(tmp_path, ask)


def test_hints_and_tokens(tmp_path: Path) -> None:
    async def ask(project: Project) -> None:
        client = project.client
        whole = types.Range(types.Position(0, 0), types.Position(99, 0))
        params = types.InlayHintParams(project.document, whole)
        found = await client.text_document_inlay_hint_async(params)
        assert found is not None
        labels = {hint.position.line: hint.label for hint in found}
        assert labels[9] == "1 cycle"
        assert labels[10] == "2 words, 2 cycles"
        assert labels[17] == "8 cycles"
        count = len(assemble(tmp_path / "main.s").words)
        assert labels[7] == f"{40 - count} left, {512 - count} in the ROM"
        asked = types.SemanticTokensParams(project.document)
        tokens = await client.text_document_semantic_tokens_full_async(asked)
        assert tokens is not None
        assert [line for line, *_ in grouped(tokens.data)][-1] == 19
        kinds = {(line, column): kind for line, column, _, kind in grouped(tokens.data)}
        start = project.at("MOV     sum", "MOV")
        assert kinds[start.line, start.character] == "keyword"
        assert kinds[start.line, 16] == "variable"
        assert kinds[10, 8] == "macro"

    run(tmp_path, ask)


LEGEND = (
    *("comment", "enumMember", "function", "keyword", "macro", "modifier", "number", "operator"),
    *("parameter", "property", "string", "variable"),
)


def grouped(data: Sequence[int]) -> list[tuple[int, int, int, str]]:
    """Return line, column, length and kind of tokens."""
    found = []
    line = column = 0
    for down, right, length, kind, _ in zip(*[iter(data)] * 5, strict=True):
        column = right if down else column + right
        line += down
        found.append((line, column, length, LEGEND[kind]))
    return found
