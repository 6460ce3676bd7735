"""A line of source to tokens."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Sequence
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

from npchip.assembler.diagnostics import Diagnostic, Line, SourceError, Span, quoted

if TYPE_CHECKING:
    from npchip.assembler.symbols import Scope


class Kind(Enum):
    """Kind of a token."""

    NAME = "name"
    DOTTED = "dotted name"  # a directive or a local label
    NUMBER = "number"
    STRING = "string"
    SIGN = "sign"
    END = "end of line"  # the last token of every line; its text is the comment
    BROKEN = "unreadable rest"  # instead of END where a mistake has been reported


_ENDS = (Kind.END, Kind.BROKEN)


class Token(NamedTuple):
    """A word of the source.

    Attributes:
        value: the number that a NUMBER stands for.
        scope: of a local label: where it is looked up; set when its statement is reached, so
            that a macro's own labels and those of its arguments are kept apart.
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
        return Span(self.line, self.column, 1 if self.ends else len(self.text))

    @property
    def ends(self) -> bool:
        """Whether it is the last token of its line."""
        return self.kind in _ENDS

    def shown(self) -> str:
        """How a message calls it."""
        return "the end of the line" if self.ends else quoted(self.text)

    def in_scope(self, scope: Scope) -> Token:
        """The same token, bound to a scope unless it already is."""
        return self._replace(scope=scope) if self.scope is None else self


def in_scope(tokens: Sequence[Token], scope: Scope) -> list[Token]:
    """The tokens with their local labels bound to a scope."""
    dotted = Kind.DOTTED
    return [token.in_scope(scope) if token.kind is dotted else token for token in tokens]


def after_labels(tokens: Sequence[Token]) -> int:
    """Index of what follows the labels of a line."""
    at = 0
    while len(tokens) > at + 1 and tokens[at + 1].text == ":":
        if tokens[at].kind is not Kind.NAME and tokens[at].kind is not Kind.DOTTED:
            break
        at += 2
    return at


_TOKEN = re.compile(
    r"""\s*(?:
      (?P<name>[A-Za-z_]\w*)
    | (?P<foreign>//|/\*)
    | (?P<sign><<|>>|<=|>=|==|!=|[-+*/%&|^~<>()\[\],#:])
    | (?P<comment>;.*)
    | (?P<number>0[xX][0-9a-fA-F_]*|0[bB][01_]*|[0-9][0-9_]*)(?P<tail>\w*)
    | (?P<dotted>\.[A-Za-z_]\w*)
    | (?P<char>'(?:\\.|[^'\\])')
    | (?P<string>"[^"]*")
    )""",
    re.VERBOSE | re.ASCII,
)
_PLAIN = {"name": Kind.NAME, "sign": Kind.SIGN, "dotted": Kind.DOTTED}
_ESCAPES = {"\\n": 10, "\\t": 9, "\\0": 0, "\\\\": 92, "\\'": 39}
_MAX_DIGITS = 20


def tokenize(line: Line, report: Callable[[Diagnostic], None]) -> list[Token]:
    """Split a line into tokens, an END token last.

    A mistake ends the list with a BROKEN token, so that what stands before it still counts.

    Args:
        line: the line.
        report: takes the mistake: NP001 a character that has no meaning here, NP002 a malformed
            literal.
    """
    tokens: list[Token] = []
    text = line.text.rstrip()
    position = 0
    comment = ""
    try:
        while position < len(text):
            found = _TOKEN.match(text, position)
            if found is None:
                column = position + len(text[position:]) - len(text[position:].lstrip(" \t"))
                raise _unexpected(line, column)
            group = found.lastgroup or ""
            if group in _PLAIN:
                position = found.end()
                word = found[group]
                tokens.append(Token(_PLAIN[group], word, line, position - len(word)))
            elif group == "comment":
                comment = found[group]
                break
            else:
                tokens.append(_literal(line, found, group))
                position = found.end()
    except SourceError as error:
        report(error.diagnostic)
        tokens.append(Token(Kind.BROKEN, "", line, position))
        return tokens
    tokens.append(Token(Kind.END, comment, line, position))
    return tokens


def _literal(line: Line, found: re.Match[str], group: str) -> Token:
    if group == "tail":
        word, column = found["number"], found.start("number")
        value = _number(line, column, word, found["tail"])
        return Token(Kind.NUMBER, word, line, column, value)
    word, column = found[group], found.start(group)
    if group == "foreign":
        span = Span(line, column, len(word))
        raise SourceError("NP001", f"unexpected {quoted(word)}", span, suggestion=_HINTS["/"])
    if group == "char":
        return Token(Kind.NUMBER, word, line, column, _char(line, column, word))
    if not word.isprintable():
        span = Span(line, column, len(word))
        raise SourceError("NP002", "the string has a character that cannot be printed", span)
    return Token(Kind.STRING, word, line, column)


_HINTS = {
    "/": "a comment begins with ;",
    "@": "a comment begins with ;",
    "'": "a character literal is one character between quotes, such as 'A'",
    '"': 'a string ends with " on the same line',
    "{": "lists and blocks in braces do not exist here",
    "}": "lists and blocks in braces do not exist here",
    "=": "a constant is defined by .equ NAME, VALUE; a comparison is ==",
    "!": "a comparison is !=; a bitwise complement is ~",
    "$": "hexadecimal is written 0x1F",
    "\\": "inside a macro a parameter is named without \\",
    ".": "a directive or a local label is a dot and a name; fractions do not exist",
    "?": "there is no conditional expression; see .if",
}
_LOOKALIKES = {
    **dict.fromkeys("\N{EN DASH}\N{EM DASH}\N{MINUS SIGN}\N{HYPHEN}\N{NON-BREAKING HYPHEN}", "-"),
    **dict.fromkeys("“”„«»", '"'),
    **dict.fromkeys("\N{RIGHT SINGLE QUOTATION MARK}\N{LEFT SINGLE QUOTATION MARK}`", "'"),
    "\N{ACUTE ACCENT}": "'",
    **dict.fromkeys("\N{MULTIPLICATION SIGN}\N{MIDDLE DOT}", "*"),
    **dict.fromkeys("\N{FULLWIDTH COMMA}\N{SINGLE LOW-9 QUOTATION MARK}", ","),
    "\N{DIVISION SIGN}": "/",
    "\N{FULLWIDTH COLON}": ":",
    "\N{FULLWIDTH SEMICOLON}": ";",
    "\N{FULLWIDTH NUMBER SIGN}": "#",
    "\N{FULLWIDTH LEFT PARENTHESIS}": "(",
    "\N{FULLWIDTH RIGHT PARENTHESIS}": ")",
}


def _unexpected(line: Line, column: int) -> SourceError:
    char = line.text[column]
    name = unicodedata.name(char, "a control character")
    shown = f"U+{ord(char):04X} ({name})"
    if char.isascii() and char.isprintable():
        shown = f'"{char}"' if char == "'" else f"'{char}'"
    hint = _HINTS.get(char)
    if char in _LOOKALIKES:
        hint = f"it looks like {_LOOKALIKES[char]} but is another character: type it anew"
    elif char.isspace() or unicodedata.category(char) in {"Cc", "Cf"}:
        hint = "it is invisible, or looks like a space: delete it and type a space if one belongs"
    elif char.isalpha():
        hint = "names consist of the letters A to Z, digits and _"
    return SourceError(
        "NP001", f"unexpected character {shown}", Span(line, column), suggestion=hint
    )


def _number(line: Line, column: int, word: str, tail: str) -> int:
    digits = word.replace("_", "")
    span = Span(line, column, len(word) + len(tail))
    if tail or digits.lower() in {"0x", "0b"}:
        raise SourceError(
            "NP002",
            f"{quoted(word + tail)} is not a number",
            span,
            suggestion=_number_hint(word + tail),
        )
    if len(digits) > _MAX_DIGITS + 2:
        raise SourceError("NP002", "the number is too long", span)
    return int(digits, 0) if digits[:2].lower() in {"0x", "0b"} else int(digits)


def _number_hint(word: str) -> str | None:
    lower = word.lower()
    if lower.startswith("0b"):
        return "a binary number has the digits 0 and 1, such as 0b0001_1111"
    if lower.startswith("0x"):
        return "a hexadecimal number has the digits 0 to 9 and A to F, such as 0x1F"
    if re.fullmatch(r"[0-9a-f]+h|[0-9][0-9a-f]*", lower):
        return f"write hexadecimal as 0x{lower.removesuffix('h').upper().lstrip('0') or '0'}"
    return "a name begins with a letter or _"


def _char(line: Line, column: int, word: str) -> int:
    body = word[1:-1]
    if body in _ESCAPES:
        return _ESCAPES[body]
    if len(body) == 1 and ord(body) < 256:
        return ord(body)
    span = Span(line, column, len(word))
    if body.startswith("\\"):
        hint = r"the escapes are \n \t \0 \\ and \'"
        raise SourceError("NP002", f"{quoted(word)[1:-1]} is no character", span, suggestion=hint)
    raise SourceError("NP002", f"{quoted(word)[1:-1]} is not a character of 8 bits", span)
