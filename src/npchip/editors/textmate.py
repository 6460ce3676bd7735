"""The TextMate grammar, which VS Code, Sublime Text, JetBrains IDEs and GitHub understand."""

from __future__ import annotations

from typing import Final

from npchip.base.json import indented
from npchip.editors.rules import KINDS, rules
from npchip.isa import Isa

REGENERATE: Final = "npchip isa --textmate > docs/editors/vscode/npchip.tmLanguage.json"


def grammar(isa: Isa) -> str:
    """Return the grammar of an instruction set as JSON."""
    document = {
        "information_for_contributors": [f"Generated: {REGENERATE}"],
        "name": "npchip assembly",
        "scopeName": "source.npchip",
        "fileTypes": [],
        "patterns": [
            {"name": f"{KINDS[rule.kind].scope}.npchip", "match": rule.pattern}
            for rule in rules(isa)
        ],
    }
    return indented(document)
