"""Semantic tokens: the kinds of `npchip.language.colours` in the words that themes know."""

from __future__ import annotations

from typing import Final

from lsprotocol import types

from npchip.language.colours import coloured
from npchip.lsp import convert
from npchip.lsp.server import Server

_TYPES: Final = {
    "comment": "comment",
    "string": "string",
    "character": "string",
    "number": "number",
    "mnemonic": "keyword",
    "directive": "modifier",
    "condition": "enumMember",
    "choice": "enumMember",
    "label": "function",
    "register": "variable",
    "constant": "variable",
    "macro": "macro",
    "output": "property",
    "parameter": "parameter",
    "operator": "operator",
}
_NAMES: Final = sorted(set(_TYPES.values()))
_MODIFIERS: Final = ["declaration", "readonly"]
LEGEND: Final = types.SemanticTokensLegend(_NAMES, _MODIFIERS)


def semantic(server: Server, params: types.SemanticTokensParams) -> types.SemanticTokens:
    """Return the words of a file, each relative to the one before, as the protocol wants it."""
    here = server.here(params.text_document.uri)
    data: list[int] = []
    line = start = 0
    analysis = here.analysis if here else None
    if here is None or analysis is None:
        return types.SemanticTokens([])
    for item in coloured(here.lines, here.file, analysis.names, analysis.isa):
        where = convert.stretch(here.lines, item.line + 1, item.column, item.length)
        column = where.start.character
        if item.line != line:
            start = 0
        bits = item.defines + 2 * (item.kind == "constant")
        kind = _NAMES.index(_TYPES[item.kind])
        data += [item.line - line, column - start, where.end.character - column, kind, bits]
        line, start = item.line, column
    return types.SemanticTokens(data)
