"""Answers of the server: requests of the protocol to `npchip.language`, and back."""

from __future__ import annotations

import logging
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from lsprotocol import types

from npchip.language.cards import card, known_entries
from npchip.language.completion import completion
from npchip.language.folding import folds
from npchip.language.hints import hints
from npchip.language.layout import laid_out
from npchip.language.names import NameKind, Use
from npchip.language.rename import Place, everywhere, place_of
from npchip.lsp import changes, convert, tokens
from npchip.lsp.server import Server
from npchip.lsp.session import Here

_INCLUDED: Final = re.compile(r'^[^;"]*\.include\s+"(?P<path>[^"]*)', re.IGNORECASE)
_COMPLETED: Final = {
    "instruction": types.CompletionItemKind.Keyword,
    "directive": types.CompletionItemKind.Keyword,
    "condition": types.CompletionItemKind.EnumMember,
    "word": types.CompletionItemKind.EnumMember,
    "port": types.CompletionItemKind.Value,
    "label": types.CompletionItemKind.Function,
    "local": types.CompletionItemKind.Function,
    "constant": types.CompletionItemKind.Constant,
    "register": types.CompletionItemKind.Variable,
    "macro": types.CompletionItemKind.Snippet,
    "output": types.CompletionItemKind.Property,
    "parameter": types.CompletionItemKind.Variable,
}
_SYMBOLS: Final[dict[NameKind, types.SymbolKind]] = {
    "label": types.SymbolKind.Function,
    "local": types.SymbolKind.Key,
    "constant": types.SymbolKind.Constant,
    "register": types.SymbolKind.Variable,
    "macro": types.SymbolKind.Module,
    "output": types.SymbolKind.Property,
}


def serve() -> int:
    """Serve one editor on standard input and output until it ends.

    Returns:
        The exit code: 0 if the editor has said that it ends, as the protocol wants it.
    """
    logging.getLogger("pygls").setLevel(logging.CRITICAL)  # the editor is told instead
    server = Server()
    register(server)
    # What else might be printed must not come between messages.
    with os.fdopen(os.dup(1), "wb") as out, os.fdopen(os.dup(0), "rb") as source:
        os.dup2(2, 1)
        server.start_io(source, out)
    return 0 if server.ended else 1


def register(server: Server) -> None:
    """Give a server its answers."""
    _documents(server)
    for method, answer, options in (
        (types.TEXT_DOCUMENT_HOVER, hover, None),
        (
            types.TEXT_DOCUMENT_COMPLETION,
            complete,
            types.CompletionOptions(trigger_characters=[".", '"', "/"], resolve_provider=True),
        ),
        (types.COMPLETION_ITEM_RESOLVE, resolve, None),
        (types.TEXT_DOCUMENT_DEFINITION, definition, None),
        (types.TEXT_DOCUMENT_REFERENCES, references, None),
        (types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, highlight, None),
        (types.TEXT_DOCUMENT_DOCUMENT_SYMBOL, symbols, None),
        (types.WORKSPACE_SYMBOL, all_symbols, None),
        (types.TEXT_DOCUMENT_FOLDING_RANGE, folding, None),
        (types.TEXT_DOCUMENT_FORMATTING, formatting, None),
        (types.TEXT_DOCUMENT_INLAY_HINT, inlay, None),
        (types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, tokens.semantic, tokens.LEGEND),
        (
            types.TEXT_DOCUMENT_CODE_ACTION,
            changes.actions,
            types.CodeActionOptions([types.CodeActionKind.QuickFix]),
        ),
        (
            types.TEXT_DOCUMENT_PREPARE_RENAME,
            changes.prepare,
            None,
        ),
        (
            types.TEXT_DOCUMENT_RENAME,
            changes.rename,
            types.RenameOptions(prepare_provider=True),
        ),
    ):
        server.feature(method, options)(answer)


def _documents(server: Server) -> None:
    @server.feature(types.INITIALIZED)
    def initialized(ls: Server, _params: Any) -> None:
        ls.session.folders = [ls.path(uri) for uri in ls.workspace.folders]
        if not ls.session.folders and ls.workspace.root_uri:
            ls.session.folders = [ls.path(ls.workspace.root_uri)]
        ls.watch()

    @server.feature(types.SHUTDOWN)
    def ended(ls: Server, _params: Any) -> None:
        ls.ended = True

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def opened(ls: Server, params: types.DidOpenTextDocumentParams) -> None:
        ls.opened(params.text_document)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(ls: Server, params: types.DidCloseTextDocumentParams) -> None:
        ls.closed(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def saved(ls: Server, _params: types.DidSaveTextDocumentParams) -> None:
        ls.refreshed()

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def watched(ls: Server, _params: types.DidChangeWatchedFilesParams) -> None:
        ls.refreshed()

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def folders(ls: Server, _params: types.DidChangeWorkspaceFoldersParams) -> None:
        ls.session.folders = [ls.path(uri) for uri in ls.workspace.folders]
        ls.refreshed()


def spot(here: Here, position: types.Position) -> tuple[int, int, str] | None:
    """Return line from 1, column from 0, and the line; None for a line that is not there."""
    if not 0 <= position.line < len(here.lines):
        return None
    text = here.lines[position.line]
    return position.line + 1, convert.column_of(text, position.character), text


def use_at(here: Here, position: types.Position) -> Use | None:
    """Return the name at a position."""
    at = spot(here, position)
    return here.analysis.names.at(here.file, at[0], at[1]) if at else None


def location(server: Server, place: Place) -> types.Location:
    """Return a place as the protocol has it."""
    lines = server.session.analyst.lines(place.path)
    return types.Location(
        server.uri(place.path), convert.stretch(lines, place.line, place.column, place.length)
    )


# ---- what stands there


def hover(server: Server, params: types.HoverParams) -> types.Hover | None:
    """Return the card of a word."""
    here = server.here(params.text_document.uri)
    at = spot(here, params.position) if here else None
    if here is None or at is None:
        return None
    line, column, text = at
    found = card(here.analysis, here.file, line, column, text)
    if found is None:
        return None
    content = types.MarkupContent(types.MarkupKind.Markdown, found.text)
    return types.Hover(content, convert.stretch(here.lines, line, found.column, found.length))


def complete(server: Server, params: types.CompletionParams) -> types.CompletionList:
    """Return what may stand at a position."""
    here = server.here(params.text_document.uri)
    at = spot(here, params.position) if here else None
    if here is None or at is None:
        return types.CompletionList(is_incomplete=False, items=[])
    line, column, text = at
    before = text[:column]
    path = _INCLUDED.match(before)
    if path:
        names = [*_files(here, path["path"])]
        start = column - len(path["path"].rpartition("/")[2])
        where = convert.stretch(here.lines, line, start, column - start)
        items = [
            types.CompletionItem(
                name, kind=types.CompletionItemKind.File, text_edit=types.TextEdit(where, name)
            )
            for name in names
        ]
        return types.CompletionList(is_incomplete=False, items=items)
    found = completion(here.analysis, here.file, line, before)
    where = convert.stretch(here.lines, line, found.column, column - found.column)
    return types.CompletionList(
        is_incomplete=False,
        items=[
            types.CompletionItem(
                offer.text,
                kind=_COMPLETED[offer.kind],
                detail=offer.detail or None,
                text_edit=types.TextEdit(where, offer.text),
                data=params.text_document.uri if offer.page else None,
            )
            for offer in found.offers
        ],
    )


def _files(here: Here, typed: str) -> Iterator[str]:
    """Yield files and folders that an ``.include`` may go on with."""
    for base in (here.path.parent, *here.analysis.settings.include):
        folder = base / typed.rpartition("/")[0]
        try:
            found = sorted(folder.iterdir())
        except OSError:
            continue
        for item in found:
            if item.is_dir() and not item.name.startswith("."):
                yield f"{item.name}/"
            elif item.suffix == ".s" and item != here.path:
                yield item.name


def resolve(server: Server, item: types.CompletionItem) -> types.CompletionItem:
    """Add the page of an offered word."""
    here = server.here(str(item.data)) if item.data else None
    if here is not None:
        for entry in known_entries(here.analysis.isa):
            if entry.name == item.label:
                page = f"```text\n{entry.page}\n```"
                item.documentation = types.MarkupContent(types.MarkupKind.Markdown, page)
                break
    return item


# ---- where it stands


def definition(server: Server, params: types.DefinitionParams) -> list[types.Location]:
    """Return where a name is defined, or the file that an ``.include`` names."""
    here = server.here(params.text_document.uri)
    at = spot(here, params.position) if here else None
    path = _INCLUDED.match(at[2]) if at else None
    if here is not None and path:
        start = types.Position(0, 0)
        for base in (here.path.parent, *here.analysis.settings.include):
            file = (base / path["path"]).resolve()
            if file.is_file():
                return [types.Location(server.uri(file), types.Range(start, start))]
        return []
    use = use_at(here, params.position) if here else None
    if here is None or use is None:
        return []
    found = here.analysis.names.definitions(use.name)
    return [location(server, place_of(item, here.analysis)) for item in found]


def references(server: Server, params: types.ReferenceParams) -> list[types.Location]:
    """Return where a name is used, in every program that has it."""
    here = server.here(params.text_document.uri)
    use = use_at(here, params.position) if here else None
    if here is None or use is None:
        return []
    defines = params.context.include_declaration
    found = everywhere(use, here.analysis, server.session.analyses).places
    return [location(server, item) for item in found if defines or not item.defines]


def highlight(
    server: Server, params: types.DocumentHighlightParams
) -> list[types.DocumentHighlight]:
    """Return the places of a name in the file."""
    here = server.here(params.text_document.uri)
    use = use_at(here, params.position) if here else None
    if here is None or use is None:
        return []
    kinds = types.DocumentHighlightKind
    return [
        types.DocumentHighlight(
            convert.stretch(here.lines, item.span.line.number, *item.span[1:]),
            kinds.Write if item.kind else kinds.Read,
        )
        for item in here.analysis.names.all(use.name)
        if item.span.line.file == here.file
    ]


def symbols(server: Server, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
    """Return the names that a file defines."""
    here = server.here(params.text_document.uri)
    if here is None:
        return []
    found = []
    for use in here.analysis.names.defined(here.file):
        kind = _SYMBOLS.get(use.kind) if use.kind else None
        if kind is not None:
            where = convert.stretch(here.lines, use.span.line.number, *use.span[1:])
            found.append(types.DocumentSymbol(use.name.text, kind, where, where, detail=use.kind))
    return found


def all_symbols(server: Server, params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
    """Return the names of the open programs that have a text in them."""
    found: dict[tuple[Path, int, int], types.WorkspaceSymbol] = {}
    for root in server.session.roots():
        analysis = server.session.analysis(root)
        for use in analysis.names.defined():
            kind = _SYMBOLS.get(use.kind) if use.kind else None
            if kind is None or params.query.lower() not in use.name.text.lower():
                continue
            place = place_of(use, analysis)
            found[place[:3]] = types.WorkspaceSymbol(
                location(server, place), use.name.text, kind, container_name=place.path.name
            )
    return list(found.values())


# ---- the file


def folding(server: Server, params: types.FoldingRangeParams) -> list[types.FoldingRange]:
    """Return what can be folded."""
    here = server.here(params.text_document.uri)
    found = folds(here.lines, here.analysis.isa) if here else []
    kinds = {"region": types.FoldingRangeKind.Region, "comment": types.FoldingRangeKind.Comment}
    return [
        types.FoldingRange(item.first - 1, item.last - 1, kind=kinds[item.kind]) for item in found
    ]


def formatting(server: Server, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    """Return the lines that have another layout."""
    here = server.here(params.text_document.uri)
    if here is None:
        return []
    after = laid_out(here.lines, here.analysis.isa)
    return [
        types.TextEdit(convert.stretch(here.lines, number, 0, len(line)), new)
        for number, (line, new) in enumerate(zip(here.lines, after, strict=True), 1)
        if line != new
    ]


def inlay(server: Server, params: types.InlayHintParams) -> list[types.InlayHint]:
    """Return the cycles of lines, and the words left."""
    here = server.here(params.text_document.uri)
    if here is None:
        return []
    first, last = params.range.start.line, params.range.end.line
    return [
        types.InlayHint(
            convert.stretch(here.lines, hint.line, hint.column, 0).start,
            hint.text,
            tooltip=hint.more,
            padding_left=True,
        )
        for hint in hints(here.analysis, here.file, here.lines)
        if first <= hint.line - 1 <= last
    ]
