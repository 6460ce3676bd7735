"""The TextMate grammar, which VS Code, Sublime Text, JetBrains IDEs and GitHub understand."""

from __future__ import annotations

from typing import Final

from npchip.base.json import indented
from npchip.editors.rules import Kind, rules
from npchip.isa import Isa

REGENERATE: Final = "npchip isa --textmate > docs/editors/vscode/npchip.tmLanguage.json"

_SCOPES: Final[dict[Kind, str]] = {
    "comment": "comment.line.semicolon",
    "string": "string.quoted.double",
    "character": "constant.character",
    "number": "constant.numeric",
    "label": "entity.name.function.label",
    "directive": "keyword.control.directive",
    "mnemonic": "keyword.mnemonic",
    "condition": "support.constant.condition",
    "choice": "constant.language",
    "register": "variable.language.register",
    "name": "variable.other",
    "operator": "keyword.operator",
    "punctuation": "punctuation.separator",
}


def grammar(isa: Isa) -> str:
    """Return the grammar of an instruction set as JSON."""
    document = {
        "information_for_contributors": [f"Generated: {REGENERATE}"],
        "name": "npchip assembly",
        "scopeName": "source.npchip",
        "fileTypes": [],
        "patterns": [
            {"name": f"{_SCOPES[rule.kind]}.npchip", "match": rule.pattern} for rule in rules(isa)
        ],
    }
    return indented(document)
