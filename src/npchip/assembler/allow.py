"""``; npchip: allow NPW04 REASON``: a warning that the author has looked at."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

from npchip.assembler.codes import WARNINGS
from npchip.assembler.diagnostics import Diagnostic, Line, Span, did_you_mean, quoted
from npchip.assembler.lexer import Token

_COMMENT = re.compile(r";+\s*npchip:\s*(?P<word>\w*)\s*(?P<rest>.*)")
_CODE = re.compile(r"(?P<code>NPW?\w+)[\s,:]*", re.IGNORECASE)


class Allow(NamedTuple):
    """Codes that may not be warned of in a line."""

    line: Line
    span: Span
    codes: tuple[str, ...]


def parse_allow(comment: Token, report: Callable[[Diagnostic], None]) -> Allow | None:
    """Read a comment that speaks to the assembler.

    Args:
        comment: the last token of a line, whose text is the comment.
        report: takes the mistake, NP030.

    Returns:
        None where the comment is prose, or wrong.
    """
    text = comment.text
    start = len(comment.line.text.rstrip()) - len(text)
    found = _COMMENT.match(text)
    if found is None or (found["word"] != "allow" and "NPW" not in text):
        return None  # prose
    if found["word"] != "allow":
        span = Span(comment.line, start + found.start("word"), max(1, len(found["word"])))
        message = f"expected 'npchip: allow CODE REASON', found {quoted(found['word'])}"
        report(_error(message, span, did_you_mean(found["word"], ("allow",))))
        return None
    codes: list[str] = []
    position = found.start("rest")
    while code := _CODE.match(text, position):
        span = Span(comment.line, start + position, len(code["code"]))
        if code["code"] not in WARNINGS:
            near = did_you_mean(code["code"], WARNINGS)
            hint = "an error cannot be allowed" if not code["code"].startswith("NPW") else near
            report(_error(f"{quoted(code['code'])} is not the code of a warning", span, hint))
            return None
        codes.append(code["code"])
        position = code.end()
    span = Span(comment.line, start, len(text))
    if not codes:
        report(_error("expected the code of a warning after 'npchip: allow'", span, None))
        return None
    if not any(char.isalnum() for char in text[position:]):
        hint = f"say why, such as '; npchip: allow {codes[0]} called by the second version'"
        report(_error(f"{' '.join(codes)} is allowed without a reason", span, hint))
        return None
    return Allow(comment.line, span, tuple(codes))


def _error(message: str, span: Span, hint: str | None) -> Diagnostic:
    return Diagnostic("error", "NP030", message, span, suggestion=hint)
