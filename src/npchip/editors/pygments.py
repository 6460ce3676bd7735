"""The Pygments lexer: ``pygmentize -l npchip``, Sphinx, MkDocs, JupyterLab and rich use it."""

from __future__ import annotations

import re
from typing import Any, ClassVar

from pygments.lexer import RegexLexer
from pygments.token import Whitespace, string_to_tokentype

from npchip.editors.rules import KINDS, rules
from npchip.isa import load_isa

_OWN = re.compile(
    r"^\s*(?:[\w.]+:\s*)?(?:EXPOSE|SAMPLE|JNONE|JANY|WHERE)\b|^\s*\.output\s", re.MULTILINE
)
"""Statements that no other assembly language has, for `NpchipLexer.analyse_text`."""


class NpchipLexer(RegexLexer):
    """Lexer of npchip assembly.

    Many assemblers use ``*.s``, so Pygments recognises a file by its text only.
    """

    name = "npchip assembly"
    aliases: ClassVar = ["npchip"]
    filenames: ClassVar = []
    alias_filenames: ClassVar = ["*.s"]
    mimetypes: ClassVar = ["text/x-npchip"]
    version_added = ""
    flags = re.MULTILINE | re.ASCII

    @classmethod
    def get_tokendefs(cls) -> dict[str, list[tuple[str, Any]]]:
        """Return the rules of the built-in instruction set. Called when the lexer is first used."""
        return {
            "root": [
                (r"\s+", Whitespace),
                *(
                    (rule.pattern, string_to_tokentype(KINDS[rule.kind].token))
                    for rule in rules(load_isa())
                ),
            ]
        }

    @staticmethod
    def analyse_text(text: str) -> Any:
        """Return how likely `text` is npchip assembly, from 0 to 1."""
        return min(1.0, len(_OWN.findall(text[:100_000])) / 3)
