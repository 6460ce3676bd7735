"""Changes that the server proposes: those of the help of mistakes, and other names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from npchip.base.errors import InputError
from npchip.language.fixes import fixes
from npchip.language.names import Use
from npchip.language.rename import Everywhere, Place, check_new, everywhere, in_tests, same_words
from npchip.lsp import convert
from npchip.lsp.server import Server
from npchip.lsp.session import Here, path_of

_REFUSED: Final = -32803  # RequestFailed of the protocol


def refuse(error: InputError) -> JsonRpcException:
    """Return an error as the editor shows it."""
    return JsonRpcException(f"{error.message} [{error.code}]", _REFUSED)


# ---- the help of mistakes


def actions(server: Server, params: types.CodeActionParams) -> list[types.CodeAction]:
    """Return the changes that the mistakes in a range ask for."""
    here = server.here(params.text_document.uri)
    if here is None:
        return []
    first, last = params.range.start.line, params.range.end.line
    found = []
    for fault in here.analysis.faults:
        place = fault["place"]
        if place is None or path_of(place["file"], here.analysis) != here.path:
            continue
        if first <= place["line"] - 1 <= last:
            found += [*_actions(here, params.text_document.uri, fault)]
    return found


def _actions(here: Here, uri: str, fault: Mapping[str, Any]) -> Iterator[types.CodeAction]:
    where = convert.placed(fault["place"])
    line = where.start.line
    if line >= len(here.lines):
        return
    text = here.lines[line]
    start, end = (convert.column_of(text, at.character) for at in (where.start, where.end))
    for fix in fixes(fault["code"], fault["help"], text, start, end - start):
        at = convert.stretch(here.lines, line + 1, fix.column, fix.length)
        yield types.CodeAction(
            fix.title,
            kind=types.CodeActionKind.QuickFix,
            diagnostics=[convert.diagnostic(fault, lambda _: uri, related=False)],
            is_preferred=True,
            edit=types.WorkspaceEdit(changes={uri: [types.TextEdit(at, fix.text)]}),
        )


# ---- another name


def _at(
    server: Server, params: types.PrepareRenameParams | types.RenameParams
) -> tuple[Here, Use] | None:
    here = server.here(params.text_document.uri)
    if here is None or not 0 <= params.position.line < len(here.lines):
        return None
    text = here.lines[params.position.line]
    column = convert.column_of(text, params.position.character)
    use = here.analysis.names.at(here.file, params.position.line + 1, column)
    if use is None or not here.analysis.names.definitions(use.name):
        return None
    return here, use


def prepare(server: Server, params: types.PrepareRenameParams) -> types.Range | None:
    """Return the range of a name that can be called otherwise; None for anything else."""
    found = _at(server, params)
    if found is None:
        return None
    here, use = found
    return convert.stretch(here.lines, use.span.line.number, *use.span[1:])


def rename(server: Server, params: types.RenameParams) -> types.WorkspaceEdit | None:
    """Return the changes that call a name otherwise, in every program that has it.

    Raises:
        JsonRpcException: it cannot be called so.
    """
    found = _at(server, params)
    if found is None:
        return None
    here, use = found
    session = server.session
    known = everywhere(use, here.analysis, session.analyses)
    programs = list({program.root: program for program, _ in known.programs}.values())
    try:
        check_new(params.new_name, use.name, programs)
        spots = {*known.places, *_tests(server, known)}
        edits = _edits(server, spots, params.new_name)
        same_words(edits, programs, session.analyst)
    except InputError as error:
        raise refuse(error) from None
    changes = {}
    for path in edits:
        lines = session.analyst.lines(path)
        changes[server.uri(path)] = [
            types.TextEdit(
                convert.stretch(lines, spot.line, spot.column, spot.length), params.new_name
            )
            for spot in sorted(spots)
            if spot.path == path
        ]
    return types.WorkspaceEdit(changes=changes)


def _tests(server: Server, known: Everywhere) -> Iterator[Place]:
    """Yield the places of a name in the test lines of the programs that have it."""
    for program, name in known.programs:
        path = program.root.resolve()
        for line, column in in_tests(name, server.session.analyst.lines(path)):
            yield Place(path, line, column, len(name.text), defines=False)


def _edits(server: Server, spots: set[Place], new: str) -> dict[Path, str]:
    """Return the texts of the files that change."""
    texts: dict[Path, list[str]] = {}
    for spot in sorted(spots, reverse=True):
        lines = texts.setdefault(spot.path, server.session.analyst.lines(spot.path))
        line = lines[spot.line - 1]
        lines[spot.line - 1] = line[: spot.column] + new + line[spot.column + spot.length :]
    return {path: "\n".join(lines) for path, lines in texts.items()}
