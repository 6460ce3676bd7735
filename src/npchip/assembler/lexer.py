"""A line of source to tokens."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

from npchip.assembler.diagnostics import Line, SourceError, Span

if TYPE_CHECKING:
    from npchip.assembler.symbols import Scope


class Kind(Enum):
    """Kind of a token."""

    NAME = "name"
    DOTTED = "dotted name"  # a directive or a local label
    NUMBER = "number"
    STRING = "string"
    SIGN = "sign"
    END = "end of line"


@dataclass(frozen=True, slots=True)
class Token:
    """A word of the source.

    Attributes:
        value: the number that a NUMBER stands for.
        scope: where its local labels are looked up; set when its statement is reached, so that
            a macro's own labels and those of its arguments are kept apart.
    """

    kind: Kind
    text: str
    line: Line
    column: int
    value: int = 0
    scope: Scope | None = None

    @property
    def span(self) -> Span:
        """Place in the source."""
        return Span(self.line, self.column, max(1, len(self.text)))

    def shown(self) -> str:
        """How a message calls it."""
        return "the end of the line" if self.kind is Kind.END else f"'{self.text}'"

    def in_scope(self, scope: Scope) -> Token:
        """The same token, bound to a scope unless it already is."""
        return self if self.scope is not None else replace(self, scope=scope)


_TOKEN = re.compile(
    r"""\s*(?:
      (?P<comment>;.*)
    | (?P<number>0[xX][0-9a-fA-F_]*|0[bB][01_]*|[0-9][0-9_]*)(?P<tail>\w*)
    | (?P<char>'(?:\\.|[^'\\])')
    | (?P<string>"[^"]*")
    | (?P<name>[A-Za-z_]\w*)
    | (?P<dotted>\.[A-Za-z_]\w*)
    | (?P<sign><<|>>|<=|>=|==|!=|[-+*/%&|^~<>()\[\],#:])
    )""",
    re.VERBOSE | re.ASCII,
)
_ESCAPES = {"\\n": 10, "\\t": 9, "\\0": 0, "\\\\": 92, "\\'": 39}
_MAX_DIGITS = 20


def tokenize(line: Line) -> list[Token]:
    """Split a line into tokens, an END token last.

    Raises:
        SourceError: NP001 a character that has no meaning here, NP002 a malformed literal.
    """
    tokens: list[Token] = []
    text = line.text.rstrip()
    position = 0
    while position < len(text):
        found = _TOKEN.match(text, position)
        if found is None:
            column = position + len(text[position:]) - len(text[position:].lstrip())
            raise _unexpected(line, column)
        position = found.end()
        group = found.lastgroup if found.lastgroup != "tail" else "number"
        assert group is not None
        word, column = found[group], found.start(group)
        match group:
            case "comment":
                break
            case "number":
                value = _number(line, column, word, found["tail"])
                tokens.append(Token(Kind.NUMBER, word, line, column, value))
            case "char":
                tokens.append(Token(Kind.NUMBER, word, line, column, _char(line, column, word)))
            case "string":
                tokens.append(Token(Kind.STRING, word, line, column))
            case "name":
                tokens.append(Token(Kind.NAME, word, line, column))
            case "dotted":
                tokens.append(Token(Kind.DOTTED, word, line, column))
            case _:
                tokens.append(Token(Kind.SIGN, word, line, column))
    tokens.append(Token(Kind.END, "", line, len(text)))
    return tokens


def _unexpected(line: Line, column: int) -> SourceError:
    char = line.text[column]
    suggestion = {
        "/": "comments begin with ;",
        "@": "comments begin with ;",
        "'": "a character literal is one character between quotes, such as 'A'",
        '"': 'a string ends with " on the same line',
        "{": "register lists and blocks do not exist here",
    }.get(char)
    shown = char if char.isprintable() else f"U+{ord(char):04X}"
    return SourceError(
        "NP001", f"unexpected character '{shown}'", Span(line, column), suggestion=suggestion
    )


def _number(line: Line, column: int, word: str, tail: str) -> int:
    digits = word.replace("_", "")
    span = Span(line, column, len(word) + len(tail))
    if tail or (len(digits) in {0, 2} and digits[1:].lower() in {"x", "b"}):
        hexadecimal = re.fullmatch(r"[0-9]\w*[hH]|[0-9a-fA-F]+", word + tail)
        raise SourceError(
            "NP002",
            f"'{word}{tail}' is not a number",
            span,
            suggestion="write hexadecimal as 0x1F and binary as 0b0001_1111"
            if hexadecimal
            else None,
        )
    if len(digits) > _MAX_DIGITS + 2:
        raise SourceError("NP002", "the number is too long", span)
    return int(digits, 0) if digits[:2].lower() in {"0x", "0b"} else int(digits)


def _char(line: Line, column: int, word: str) -> int:
    body = word[1:-1]
    if body in _ESCAPES:
        return _ESCAPES[body]
    if len(body) == 1 and ord(body) < 256:
        return ord(body)
    raise SourceError(
        "NP002",
        f"{word} is not a character of 8 bits",
        Span(line, column, len(word)),
        suggestion=r"the escapes are \n \t \0 \\ and \'",
    )
