"""Split lines of a source, debugger commands and test lines into tokens."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, NamedTuple

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
    BROKEN = "unreadable rest"  # instead of END after a reported error


_ENDS = (Kind.END, Kind.BROKEN)


class Token(NamedTuple):
    """A word of the source.

    Attributes:
        value: the value of a NUMBER.
        scope: the scope of a local label. It is set when the statement is expanded, so that the
            labels of a macro differ from those in its arguments.
    """

    kind: Kind
    text: str
    line: Line
    column: int
    value: int = 0
    scope: Scope | None = None

    @property
    def span(self) -> Span:
        """The place in the source."""
        return Span(self.line, self.column, 1 if self.ends else len(self.text))

    @property
    def ends(self) -> bool:
        """True for the last token of a line."""
        return self.kind in _ENDS

    def shown(self) -> str:
        """Return the token as messages show it."""
        return "the end of the line" if self.ends else quoted(self.text)

    def in_scope(self, scope: Scope) -> Token:
        """Return the token with a scope, its own if it has one."""
        return self._replace(scope=scope) if self.scope is None else self


def in_scope(tokens: Sequence[Token], scope: Scope) -> list[Token]:
    """Return tokens with the local labels among them bound to a scope."""
    dotted = Kind.DOTTED
    return [token.in_scope(scope) if token.kind is dotted else token for token in tokens]


def after_labels(tokens: Sequence[Token]) -> int:
    """Return the index of the first token after the labels of a line."""
    at = 0
    while len(tokens) > at + 1 and tokens[at + 1].text == ":":
        if tokens[at].kind is not Kind.NAME and tokens[at].kind is not Kind.DOTTED:
            break
        at += 2
    return at


class Syntax(NamedTuple):
    """The words and signs of a language, and the codes of its errors.

    Attributes:
        pattern: one token; see `token_pattern`.
        stray: error code for a character without meaning.
        malformed: error code for a malformed number, character or string.
        hints: hint for each stray character.
        otherwise: hint for any other character.
    """

    pattern: re.Pattern[str]
    stray: str
    malformed: str
    hints: Mapping[str, str] = MappingProxyType({})
    otherwise: str | None = None


_NUMBER: Final = r"0[xX][0-9a-fA-F_]*|0[bB][01_]*|[0-9][0-9_]*"


def token_pattern(
    signs: str, name: str = r"[A-Za-z_]\w*", comment: str = ";", minus: str = ""
) -> re.Pattern[str]:
    """Return the pattern of a token with the blanks before it.

    Args:
        signs: pattern of a sign.
        name: pattern of a name.
        comment: characters that begin a comment.
        minus: pattern of the sign of a number.
    """
    return re.compile(
        rf"""\s*(?:
          (?P<name>{name})
        | (?P<foreign>//|/\*)
        | (?P<number>{minus}(?:{_NUMBER}))(?P<tail>\w*)
        | (?P<sign>{signs})
        | (?P<comment>[{comment}].*)
        | (?P<dotted>\.[A-Za-z_]\w*)
        | (?P<char>'(?:\\.|[^'\\])')
        | (?P<string>"[^"]*")
        )""",
        re.VERBOSE | re.ASCII,
    )


COMMENT_HINT: Final = "a comment begins with ;"
COMMENT_SIGNS: Final = frozenset("#/*-|")
"""Signs that begin a comment in other languages, where a line may have no more of its own."""
_HINTS = {
    "/": COMMENT_HINT,
    "@": COMMENT_HINT,
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

SOURCE: Final = Syntax(
    token_pattern(r"<<|>>|<=|>=|==|!=|[-+*/%&|^~<>()\[\],#:]"), "NP001", "NP002", _HINTS
)
"""The assembler's language."""

_PLAIN: Final = {"name": Kind.NAME, "sign": Kind.SIGN, "dotted": Kind.DOTTED}
_ESCAPES: Final = {"\\n": 10, "\\t": 9, "\\0": 0, "\\\\": 92, "\\'": 39}
_MAX_DIGITS: Final = 22


def tokenize(line: Line, report: Callable[[Diagnostic], None]) -> list[Token]:
    """Return the tokens of a source line, an END token last.

    An error ends the list with a BROKEN token, so that the tokens before it still count.

    Args:
        line: the line.
        report: is called with the error: NP001 a character without meaning, NP002 a malformed
            literal.
    """
    tokens: list[Token] = []
    try:
        read_tokens(line, SOURCE, 0, tokens)
    except SourceError as error:
        diagnostic = error.diagnostic
        before = Line(line.file, line.number, line.text[: diagnostic.span.column])
        if _has_comment_sign(before, 0):
            diagnostic = diagnostic._replace(suggestion=COMMENT_HINT)
        report(diagnostic)
        end = tokens[-1].column + len(tokens[-1].text) if tokens else 0
        tokens.append(Token(Kind.BROKEN, "", line, end))
    return tokens


def read_tokens(line: Line, syntax: Syntax, start: int, tokens: list[Token]) -> None:
    """Add the tokens of a line from column `start` on to a list, an END token last.

    Raises:
        SourceError: a character without meaning, or a malformed literal; the tokens before it
            have been added.
    """
    text = line.text.rstrip()
    pattern = syntax.pattern
    position = start
    comment = ""
    while position < len(text):
        found = pattern.match(text, position)
        if found is None:
            column = position + len(text[position:]) - len(text[position:].lstrip(" \t"))
            raise _unexpected(line, column, syntax)
        group = found.lastgroup or ""
        if group in _PLAIN:
            position = found.end()
            word = found[group]
            tokens.append(Token(_PLAIN[group], word, line, position - len(word)))
        elif group == "comment":
            comment = found[group]
            break
        else:
            tokens.append(_literal(line, found, group, syntax))
            position = found.end()
    tokens.append(Token(Kind.END, comment, line, position))


def expected(code: str, what: str, token: Token, hint: str | None = None) -> SourceError:
    """Make the error for a token in a position where something else is expected."""
    if hint is None:
        ends = what.startswith("the end of the line") and token.text in COMMENT_SIGNS
        hint = COMMENT_HINT if ends or _has_comment_sign(token.line, token.column) else None
    return SourceError(code, f"expected {what}, found {token.shown()}", token.span, suggestion=hint)


def _has_comment_sign(line: Line, column: int) -> bool:
    """Return whether a # from a column on begins a comment: no operand does, behind no comma."""
    text = line.text.partition(";")[0]
    signs = (found.start() for found in re.finditer(r"(?:^|(?<=\s))#\s", text))
    return any(at >= column and not text[:at].rstrip().endswith((",", "[")) for at in signs)


def read_number(text: str) -> int | None:
    """Return the value of a decimal, ``0x`` or ``0b`` number, or None for any other text."""
    digits = text.replace("_", "")
    if not digits.isascii():  # int takes ٣ for 3
        return None
    try:
        return int(digits, 0) if digits.lstrip("-")[:2].lower() in {"0x", "0b"} else int(digits)
    except ValueError:
        return None


def _literal(line: Line, found: re.Match[str], group: str, syntax: Syntax) -> Token:
    number = group == "tail"
    word = found["number"] + found["tail"] if number else found[group]
    column = found.start("number" if number else group)

    def wrong(message: str, hint: str | None = None, code: str = syntax.malformed) -> SourceError:
        return SourceError(code, message, Span(line, column, len(word)), suggestion=hint)

    if group == "foreign":
        hint = syntax.hints.get("/", syntax.otherwise)
        raise wrong(f"unexpected {quoted(word)}", hint, syntax.stray)
    if group == "string":
        if not word.isprintable():
            raise wrong("the string has a character that cannot be printed")
        return Token(Kind.STRING, word, line, column)
    if number and len(word.replace("_", "")) > _MAX_DIGITS:
        raise wrong("the number is too long")
    value = read_number(word) if number else _char(word[1:-1])
    if value is not None:
        return Token(Kind.NUMBER, word, line, column, value)
    if number:
        raise wrong(f"{quoted(word)} is not a number", _number_hint(word))
    if word[1] == "\\":
        hint = r"the escapes are \n \t \0 \\ and \'"
        raise wrong(f"{quoted(word)[1:-1]} is no character", hint)
    raise wrong(f"{quoted(word)[1:-1]} is not a character of 8 bits")


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


def _unexpected(line: Line, column: int, syntax: Syntax) -> SourceError:
    char = line.text[column]
    name = unicodedata.name(char, "a control character")
    shown = f"U+{ord(char):04X} ({name})"
    if char.isascii() and char.isprintable():
        shown = f'"{char}"' if char == "'" else f"'{char}'"
    hint = syntax.hints.get(char, syntax.otherwise)
    if char in _LOOKALIKES:
        hint = f"it looks like {_LOOKALIKES[char]} but is another character: type it anew"
    elif char.isspace() or unicodedata.category(char) in {"Cc", "Cf"}:
        hint = "it is invisible, or looks like a space: delete it and type a space if one belongs"
    elif char.isalpha():
        hint = "names consist of the letters A to Z, digits and _"
    return SourceError(
        syntax.stray, f"unexpected character {shown}", Span(line, column), suggestion=hint
    )


def _number_hint(word: str) -> str | None:
    lower = word.lower()
    if lower.startswith("0b"):
        return "a binary number has the digits 0 and 1, such as 0b0001_1111"
    if lower.startswith("0x"):
        return "a hexadecimal number has the digits 0 to 9 and A to F, such as 0x1F"
    if re.fullmatch(r"[0-9a-f]+h|[0-9][0-9a-f]*", lower):
        return f"write hexadecimal as 0x{lower.removesuffix('h').upper().lstrip('0') or '0'}"
    return "a name begins with a letter or _"


def _char(body: str) -> int | None:
    if body in _ESCAPES:
        return _ESCAPES[body]
    return ord(body) if len(body) == 1 and ord(body) < 256 else None
