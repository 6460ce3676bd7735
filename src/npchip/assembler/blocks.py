"""The lines of one file as a tree of blocks, such as those from ``.if`` to ``.endif``.

Blocks are found before anything is expanded, so that a missing ``.endm`` is reported in its place
and does not change the meaning of other lines.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Final

from npchip.assembler.diagnostics import Diagnostic, Note, Span, nearest, quoted
from npchip.assembler.lexer import COMMENT_HINT, COMMENT_SIGNS, Kind, Token, after_labels

CLOSERS: Final = {
    ".macro": ".endm",
    ".rept": ".endr",
    ".if": ".endif",
    ".ifdef": ".endif",
    ".ifndef": ".endif",
}
"""The directive that closes each block."""

SIMPLE: Final = (
    ".equ",
    ".reg",
    ".output",
    ".position",
    ".budget",
    ".loop",
    ".require",
    ".memory",
    ".include",
    ".error",
    ".word",
)
_BRANCHES: Final = (".elif", ".else")
DIRECTIVES: Final = (*SIMPLE, *CLOSERS, *_BRANCHES, *dict.fromkeys(CLOSERS.values()))

_OTHER_NAMES: Final = {
    ".endmacro": ".endm",
    ".mend": ".endm",
    ".repeat": ".rept",
    ".rep": ".rept",
    ".endrept": ".endr",
    ".endrep": ".endr",
    ".endrepeat": ".endr",
    ".elseif": ".elif",
    ".elsif": ".elif",
    ".fi": ".endif",
    ".set": ".equ",
    ".define": ".equ",
    ".def": ".equ",
    ".const": ".equ",
    ".incbin": ".include",
    ".inc": ".include",
}
_HINTS: Final = {
    **dict.fromkeys(
        (".org", ".text", ".data", ".section", ".code", ".global", ".globl", ".align"),
        "a program is one run of instructions from address 0: delete this line",
    ),
    **dict.fromkeys(
        (".byte", ".db", ".dw", ".ascii", ".asciz", ".space"),
        "the program ROM holds instructions only: tables go to the NPs' memory (--memory)",
    ),
    ".end": "a source needs no end mark; END without a dot closes a masked region",
}


_WITHOUT_DOT: Final = {"macro", "endm", "rept", "endr", "equ"}


@dataclass(eq=False, slots=True)
class Node:
    """A line, or a block with the line that opens it.

    Attributes:
        tokens: the line, labels included.
        word: the directive that opens the block, in lower case; empty for a plain line.
        branches: the branches, each as the line that opens it, without labels, and its nodes.
    """

    tokens: list[Token]
    word: str = ""
    branches: list[tuple[list[Token], list[Node]]] = field(default_factory=list)


def directive(tokens: list[Token]) -> tuple[int, str]:
    """Return the index after a line's labels, and the directive there in lower case, or ""."""
    at = after_labels(tokens)
    token = tokens[at]
    return at, token.text.lower() if token.kind is Kind.DOTTED else ""


def parse(
    lines: Iterable[list[Token]], report: Callable[[Diagnostic], None]
) -> tuple[list[Node], bool]:
    """Return the lines and blocks of the outermost level, without macros that have no end.

    The second value is True if an error may have lost definitions.

    Args:
        lines: the tokens of each line that has any.
        report: is called with each error: NP004 unknown directive, NP011 more on the line, NP013 a
            block lacks its begin or end.
    """
    every = list(lines)
    parser = _Parser(guesses=True)
    nodes = parser.parse(every)
    if parser.unbalanced:  # a guess may be wrong, as in the text of another assembler
        other = _Parser(guesses=False)
        others = other.parse(every)
        if other.unbalanced < parser.unbalanced:
            parser, nodes = other, others
    for item in parser.found:
        report(item)
    return nodes, parser.doubtful


class _Parser:
    """Reads lines as a tree.

    Args:
        guesses: take an unknown directive for the begin or end of a block if it resembles one.
    """

    def __init__(self, *, guesses: bool) -> None:
        self._guesses = guesses
        self.found: list[Diagnostic] = []
        self._top: list[Node] = []
        self._open: list[tuple[Node, Token]] = []
        self._closed_early: list[str] = []
        self.doubtful = False

    def parse(self, lines: Iterable[list[Token]]) -> list[Node]:
        for tokens in lines:
            at, word = directive(tokens)
            if tokens[at].text.lower() in _WITHOUT_DOT:
                tokens, word = self._without_dot(tokens, at)  # noqa: PLW2901 - as it is meant
            if word and word not in DIRECTIVES:
                tokens, word = self._unknown(tokens, at, word)  # noqa: PLW2901 - as it is meant
            if not word or word in SIMPLE:
                self._body().append(Node(tokens))
            elif word in CLOSERS:
                self._begin(tokens, word, at)
            elif word in _BRANCHES:
                self._branch(tokens, word, at)
            else:
                self._end(tokens, word, at)
        self._close_all()
        return self._top

    def _unknown(self, tokens: list[Token], at: int, word: str) -> tuple[list[Token], str]:
        """Report a directive and return the line as it is probably meant, with its directive."""
        token = tokens[at]
        known = CLOSERS.values() if word.startswith(".end") else DIRECTIVES
        meant = _OTHER_NAMES.get(word) or nearest(word, known) or ""
        hint = f"did you mean {meant}?" if meant else None
        if not self._open and meant not in SIMPLE and meant not in CLOSERS:
            meant = ""  # no block is open that it could end
        if word in _HINTS:
            meant, hint = "", _HINTS[word]
        if not self._guesses and (meant in CLOSERS or meant in CLOSERS.values()):
            meant = ""
        self._error("NP004", f"unknown directive {quoted(token.text)}", token.span, hint=hint)
        self.doubtful |= meant == ".include"
        instead = [*tokens[:at], token._replace(text=meant), *tokens[at + 1 :]]
        if meant and meant not in SIMPLE:
            return instead, meant
        rest = Token(Kind.BROKEN, "", token.line, token.column)
        if meant in {".equ", ".reg"}:  # the name must not be reported as unknown
            return [*instead[: at + 2], rest], meant
        return [*tokens[:at], rest], ""

    def _without_dot(self, tokens: list[Token], at: int) -> tuple[list[Token], str]:
        token = tokens[at]
        word = f".{token.text.lower()}"
        hint = f"directives begin with a dot: {word}"
        self._error("NP004", f"unknown directive {quoted(token.text)}", token.span, hint=hint)
        meant = token._replace(kind=Kind.DOTTED, text=word)
        return [*tokens[:at], meant, *tokens[at + 1 :]], word

    def _begin(self, tokens: list[Token], word: str, at: int) -> None:
        token = tokens[at]
        if word == ".macro" and any(node.word in {".macro", ".rept"} for node, _ in self._open):
            # Usually the end of the block above is missing.
            opener = next(o for node, o in self._open if node.word in {".macro", ".rept"})
            closer = CLOSERS[opener.text.lower()]
            self._error(
                "NP013",
                f".macro inside a {opener.text.lower()}: a macro stands outside other macros and "
                "repetitions",
                token.span,
                Note(f"this {opener.text} is still open", opener.span),
                hint=f"is {closer} missing above?",
            )
            while self._open and self._open[-1][1] is not opener:
                self._open.pop()
            self._open.pop()
        node = Node(tokens, word)
        node.branches.append((tokens[at:], []))
        self._body().append(node)
        self._open.append((node, token))

    def _branch(self, tokens: list[Token], word: str, at: int) -> None:
        token = tokens[at]
        self._labels(tokens, at)
        if not self._unwind(".endif", token):
            self._error("NP013", f"{word} without .if", token.span)
            return
        node, _ = self._open[-1]
        last = node.branches[-1][0][0]
        if last.text.lower() == ".else":
            note = Note(".else stands here", last.span)
            self._error("NP013", f"{word} after .else", token.span, note)
            return
        node.branches.append((tokens[at:], []))
        if word == ".else":
            self._check_rest(tokens[at:])

    def _end(self, tokens: list[Token], word: str, at: int) -> None:
        self._labels(tokens, at)
        if not self._unwind(word, tokens[at]):
            if word in self._closed_early:  # reported already
                self._closed_early.remove(word)
                return
            opener = next(key for key, value in CLOSERS.items() if value == word)
            self._error("NP013", f"{word} without {opener}", tokens[at].span)
            return
        self._open.pop()
        self._check_rest(tokens[at:])

    def _labels(self, tokens: list[Token], at: int) -> None:
        """Add the labels before the end of a branch to the branch."""
        if at:
            self._body().append(
                Node([*tokens[:at], Token(Kind.END, "", tokens[at].line, tokens[at].column)])
            )

    def _check_rest(self, tokens: list[Token]) -> None:
        word, rest = tokens[0].text, tokens[1]
        if not rest.ends:
            hint = "did you mean .elif?" if word.lower() == ".else" else None
            if rest.text in COMMENT_SIGNS:
                hint = COMMENT_HINT
            message = f"expected the end of the line after {word}, found {rest.shown()}"
            self._error("NP011", message, rest.span, hint=hint)

    def _unwind(self, closer: str, token: Token) -> bool:
        """Close the blocks inside the innermost one that `closer` ends; False if there is none."""
        if not any(CLOSERS[node.word] == closer for node, _ in self._open):
            return False
        while CLOSERS[self._open[-1][0].word] != closer:
            node, opener = self._open.pop()
            self._error(
                "NP013",
                f"{opener.text} without {CLOSERS[node.word]}",
                opener.span,
                Note(f"it must end before this {token.text}", token.span),
            )
            self._closed_early.append(CLOSERS[node.word])
        return True

    def _close_all(self) -> None:
        while self._open:
            node, opener = self._open.pop()
            closer = CLOSERS[node.word]
            hint = _meant_as(closer, node)
            self._error("NP013", f"{opener.text} without {closer}", opener.span, hint=hint)
            if node.word in {".macro", ".rept"}:
                self._body().pop()
            if node.word == ".rept":  # its lines count once, so that errors in them are found
                self._body().extend(node.branches[0][1])

    def _body(self) -> list[Node]:
        return self._open[-1][0].branches[-1][1] if self._open else self._top

    def _error(
        self, code: str, message: str, span: Span, *notes: Note, hint: str | None = None
    ) -> None:
        self.doubtful |= code == "NP013"
        self.found.append(Diagnostic("error", code, message, span, notes, hint))

    @property
    def unbalanced(self) -> int:
        """Number of blocks without begin or end."""
        return sum(item.code == "NP013" for item in self.found)


def _meant_as(closer: str, block: Node) -> str | None:
    """Return a hint on the first line in a block that may have been meant as its end."""
    for node in (node for _, body in block.branches for node in body):
        line = node.tokens[0].line
        word = line.text.split()[0]
        bare = word.lower().lstrip(".#")
        if bare == closer[1:] or (word[0] in ".#" and (bare == "end" or nearest(bare, [closer]))):
            return f"is {quoted(word)} in line {line.number} meant as {closer}?"
    return None


def walk(nodes: Iterable[Node]) -> Iterator[Node]:
    """Yield every node of a tree."""
    stack = list(nodes)
    while stack:
        node = stack.pop()
        yield node
        stack += [inner for _, body in node.branches for inner in body]


def defines(nodes: Iterable[Node]) -> bool:
    """Return whether a tree may define names that other lines use."""
    for node in walk(nodes):
        at, word = directive(node.tokens)
        if word in {".equ", ".reg", ".include", ".macro"}:
            return True
        if any(token.kind is Kind.NAME for token in node.tokens[:at]):
            return True
    return False


def all_tokens(nodes: Iterable[Node]) -> Iterator[Token]:
    """Yield every token of a tree."""
    for node in walk(nodes):
        yield from node.tokens
        for opening, _ in node.branches:
            yield from opening


def names(nodes: Iterable[Node]) -> Iterator[str]:
    """Return every name in a tree."""
    return (token.text for token in all_tokens(nodes) if token.kind in (Kind.NAME, Kind.DOTTED))
