"""Lines to statements: labels placed, directives obeyed, macros and repetitions expanded."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from typing import Final, cast, get_args

from npchip.assembler.diagnostics import Diagnostic, Note, SourceError, Span, did_you_mean
from npchip.assembler.expressions import OPERATORS, evaluate
from npchip.assembler.lexer import Kind, Token
from npchip.assembler.symbols import Scope, Symbols
from npchip.program import PORTS, Budget, Output, OutputKind

MAX_DEPTH: Final = 32  # macros within macros
MAX_LINES: Final = 50_000  # lines after expansion: a hundred times what the ROM could hold


@dataclass(frozen=True)
class Expansion:
    """Where a line came from when it was not written there: a macro's use or a repetition."""

    what: str
    at: Span
    outer: Expansion | None

    def notes(self) -> tuple[Note, ...]:
        """The way from the innermost use outwards."""
        own = Note(f"in {self.what} expanded here", self.at)
        return (own, *(self.outer.notes() if self.outer else ()))


@dataclass(frozen=True)
class Statement:
    """An instruction as written; its address is its index among the statements.

    Attributes:
        tokens: mnemonic and operands, an END token last.
        expansion: how it came to stand here, if not by being written here.
    """

    tokens: tuple[Token, ...]
    expansion: Expansion | None


@dataclass(frozen=True)
class _Macro:
    name: Token
    parameters: tuple[str, ...]
    body: tuple[list[Token], ...]


class Runaway(Exception):  # noqa: N818 - it ends the expansion, it is no error class
    """Expansion has gone beyond `MAX_LINES` and stops at once."""


@dataclass
class Expander:
    """Expands one source.

    Args:
        symbols: takes the definitions.
        mnemonics: names that a macro may not have.
        report: takes each mistake; expansion goes on with the next line.
    """

    symbols: Symbols
    mnemonics: Collection[str]
    report: Callable[[Diagnostic], None]
    statements: list[Statement] = field(default_factory=list)
    outputs: list[Output] = field(default_factory=list)
    budget: Budget = field(default_factory=Budget)
    budget_span: Span | None = None
    _macros: dict[str, _Macro] = field(default_factory=dict)
    _output_spans: dict[str | int, Span] = field(default_factory=dict)
    _lines: int = 0

    def expand(self, lines: Sequence[list[Token]]) -> None:
        """Expand the lines of a file; the results are in the attributes."""
        try:
            self._block(lines, Scope(), None, 0)
        except Runaway as stop:
            cause = stop.__cause__
            assert isinstance(cause, SourceError)
            self.report(cause.diagnostic)

    def _block(
        self, lines: Sequence[list[Token]], scope: Scope, expansion: Expansion | None, depth: int
    ) -> None:
        index = 0
        while index < len(lines):
            tokens = [token.in_scope(scope) for token in lines[index]]
            index += 1
            self._lines += 1
            try:
                self._check_lines(tokens[0])
                tokens, scope = self._labels(tokens, scope, expansion)
                first = tokens[0]
                word = first.text.lower() if first.kind is Kind.DOTTED else ""
                if word in _BLOCKS:
                    start = index
                    index = _find_end(lines, index, first)
                    body = lines[start : index - 1]
                    if word == ".macro":
                        self._define_macro(tokens, body)
                    else:
                        self._repeat(tokens, body, scope, expansion, depth)
                elif word == ".word":
                    self.statements.append(Statement(tuple(tokens), expansion))
                elif word:
                    self._directive(word, tokens)
                elif first.kind is Kind.NAME and first.text in self._macros:
                    self._use_macro(tokens, expansion, depth)
                elif first.kind is Kind.NAME:
                    self.statements.append(Statement(tuple(tokens), expansion))
                elif first.kind is not Kind.END:
                    raise SourceError(
                        "NP003",
                        f"expected a label, an instruction or a directive, found {first.shown()}",
                        first.span,
                    )
            except SourceError as error:
                self.report(with_backtrace(error.diagnostic, expansion))

    def _check_lines(self, token: Token) -> None:
        if self._lines > MAX_LINES:
            message = f"the source expands to more than {MAX_LINES} lines"
            raise Runaway from SourceError("NP014", message, token.span)

    def _labels(
        self, tokens: list[Token], scope: Scope, expansion: Expansion | None
    ) -> tuple[list[Token], Scope]:
        while tokens[0].kind in {Kind.NAME, Kind.DOTTED} and tokens[1].text == ":":
            name = tokens[0]
            self.symbols.define_label(name, len(self.statements))
            tokens = tokens[2:]
            if name.kind is Kind.NAME and expansion is None:
                scope = Scope()
                tokens = [Token(t.kind, t.text, t.line, t.column, t.value, scope) for t in tokens]
        return tokens, scope

    # ---- macros and repetitions

    def _define_macro(self, tokens: list[Token], body: Sequence[list[Token]]) -> None:
        name = tokens[1]
        if name.kind is not Kind.NAME:
            raise _expected("a name for the macro", name)
        if name.text.upper() in self.mnemonics:
            raise SourceError("NP017", f"'{name.text}' is an instruction", name.span)
        if name.text in self._macros:
            first = Note("first defined here", self._macros[name.text].name.span)
            raise SourceError("NP008", f"'{name.text}' is defined twice", name.span, first)
        parameters: list[str] = []
        for item in split(tokens[2:]):
            if len(item) != 1 or item[0].kind is not Kind.NAME:
                raise _expected("the name of a parameter", item[0])
            if item[0].text in parameters:
                raise SourceError("NP008", f"two parameters '{item[0].text}'", item[0].span)
            parameters.append(item[0].text)
        self._macros[name.text] = _Macro(name, tuple(parameters), tuple(body))

    def _use_macro(self, tokens: list[Token], expansion: Expansion | None, depth: int) -> None:
        name = tokens[0]
        macro = self._macros[name.text]
        arguments = split(tokens[1:])
        if len(arguments) != len(macro.parameters):
            raise SourceError(
                "NP012",
                f"macro '{name.text}' takes {len(macro.parameters)} arguments "
                f"({', '.join(macro.parameters) or 'none'}), found {len(arguments)}",
                name.span,
                Note(f"'{name.text}' is defined here", macro.name.span),
            )
        if depth >= MAX_DEPTH:
            raise SourceError(
                "NP014",
                f"macros are nested more than {MAX_DEPTH} deep: does '{name.text}' use itself?",
                name.span,
            )
        table = {
            parameter: _grouped(argument)
            for parameter, argument in zip(macro.parameters, arguments, strict=True)
        }
        body = [_substitute(line, table) for line in macro.body]
        inner = Expansion(f"macro '{name.text}'", name.span, expansion)
        self._block(body, Scope(), inner, depth + 1)

    def _repeat(
        self,
        tokens: list[Token],
        body: Sequence[list[Token]],
        scope: Scope,
        expansion: Expansion | None,
        depth: int,
    ) -> None:
        arguments = split(tokens[1:])
        if not 1 <= len(arguments) <= 2:
            raise SourceError("NP011", "expected .rept COUNT or .rept COUNT, NAME", tokens[0].span)
        count = self._number(arguments[0], tokens)
        counter = arguments[1] if len(arguments) == 2 else None
        if counter and (len(counter) != 1 or counter[0].kind is not Kind.NAME):
            raise _expected("a name for the counter", counter[0])
        if not 0 <= count <= MAX_LINES:
            span = arguments[0][0].span
            raise SourceError(
                "NP006", f"expected a count from 0 to {MAX_LINES}, found {count}", span
            )
        if depth >= MAX_DEPTH:
            raise SourceError(
                "NP014", f"repetitions are nested more than {MAX_DEPTH} deep", tokens[0].span
            )
        for number in range(count):
            table: dict[str, list[Token]] = {}
            if counter:
                at = counter[0]
                table[at.text] = [Token(Kind.NUMBER, str(number), at.line, at.column, number)]
            lines = [_substitute(line, table) for line in body]
            inner = Expansion(f"repetition {number}", tokens[0].span, expansion)
            self._block(lines, Scope(scope), inner, depth + 1)
            self._lines += 1  # an empty body counts too, or a large count would take for ever

    # ---- directives

    def _directive(self, word: str, tokens: list[Token]) -> None:
        match word:
            case ".equ":
                name, value = self._two(tokens, ".equ NAME, VALUE")
                self.symbols.define_constant(_single_name(name), value, tokens[-1])
            case ".reg":
                name, value = self._two(tokens, ".reg NAME, REGISTER")
                number = self.symbols.register(value[0]) if len(value) == 1 else None
                if number is None:
                    raise _expected("a register, r0 to r15", value[0])
                self.symbols.define_register(_single_name(name), number)
            case ".output":
                self._output(tokens)
            case ".budget":
                self._budget(tokens)
            case ".endm" | ".endr":
                opener = ".macro" if word == ".endm" else ".rept"
                raise SourceError("NP013", f"{word} without {opener}", tokens[0].span)
            case _:
                raise SourceError(
                    "NP004",
                    f"unknown directive '{tokens[0].text}'",
                    tokens[0].span,
                    suggestion=did_you_mean(word, DIRECTIVES),
                )

    def _output(self, tokens: list[Token]) -> None:
        arguments = split(tokens[1:])
        if len(arguments) != 3:
            raise SourceError("NP011", "expected .output NAME, PORT, KIND", tokens[0].span)
        name = _single_name(arguments[0])
        port = self._number(arguments[1], tokens)
        if not 0 <= port < PORTS:
            message = f"expected a port from 0 to {PORTS - 1}, found {port}"
            raise SourceError("NP006", message, arguments[1][0].span)
        kind = arguments[2][0]
        if kind.text not in get_args(OutputKind) or len(arguments[2]) != 1:
            kinds = ", ".join(get_args(OutputKind))
            raise SourceError(
                "NP011",
                f"expected one of {kinds}, found {kind.shown()}",
                kind.span,
                suggestion=did_you_mean(kind.text, get_args(OutputKind)),
            )
        for key in (name.text, port):
            if key in self._output_spans:
                what = f"the output '{key}'" if isinstance(key, str) else f"port {key}"
                note = Note("first declared here", self._output_spans[key])
                raise SourceError("NP008", f"{what} is declared twice", name.span, note)
            self._output_spans[key] = name.span
        self.outputs.append(Output(name.text, port, cast("OutputKind", kind.text)))

    def _budget(self, tokens: list[Token]) -> None:
        what = tokens[1].text
        if what not in {"words", "cycles"}:
            raise SourceError(
                "NP011",
                f"expected .budget words N or .budget cycles N, found {tokens[1].shown()}",
                tokens[1].span,
                suggestion=did_you_mean(what, ("words", "cycles")),
            )
        limit = self._number(tokens[2:-1] or [tokens[-1]], tokens)
        if limit < 0:
            raise SourceError("NP006", f"expected a limit from 0, found {limit}", tokens[2].span)
        if getattr(self.budget, what) is not None:
            raise SourceError("NP008", f"the budget of {what} is given twice", tokens[1].span)
        if what == "words":
            self.budget = Budget(limit, self.budget.cycles)
            self.budget_span = tokens[1].span
        else:
            self.budget = Budget(self.budget.words, limit)

    def _two(self, tokens: list[Token], usage: str) -> tuple[list[Token], list[Token]]:
        arguments = split(tokens[1:])
        if len(arguments) != 2:
            raise SourceError("NP011", f"expected {usage}", tokens[0].span)
        return arguments[0], arguments[1]

    def _number(self, tokens: list[Token], line: list[Token]) -> int:
        last = tokens[-1]
        position = next(i for i, token in enumerate(line) if token is last)
        end = line[min(position + 1, len(line) - 1)]
        return evaluate([t for t in tokens if t.kind is not Kind.END], end, self.symbols.value)


_BLOCKS: Final = {".macro": ".endm", ".rept": ".endr"}
DIRECTIVES: Final = (
    ".equ",
    ".reg",
    ".macro",
    ".endm",
    ".rept",
    ".endr",
    ".output",
    ".budget",
    ".word",
)


def with_backtrace(diagnostic: Diagnostic, expansion: Expansion | None) -> Diagnostic:
    """The diagnostic with notes that lead from an expanded line to where it was asked for."""
    if expansion is None:
        return diagnostic
    return Diagnostic(
        diagnostic.severity,
        diagnostic.code,
        diagnostic.message,
        diagnostic.span,
        (*diagnostic.notes, *expansion.notes()),
        diagnostic.suggestion,
    )


def split(tokens: Sequence[Token]) -> list[list[Token]]:
    """Split at the commas outside parentheses and brackets; an END token ends the list.

    An empty argument is given as the token that stands in its place, so that a message can
    point there.
    """
    if tokens[0].kind is Kind.END:
        return []
    parts: list[list[Token]] = [[]]
    depth = 0
    for token in tokens:
        if token.kind is Kind.END or (token.text == "," and depth == 0):
            if not parts[-1]:
                parts[-1].append(token)
            if token.kind is Kind.END:
                break
            parts.append([])
            continue
        if token.kind is Kind.SIGN:
            depth += (token.text in "([") - (token.text in ")]")
        parts[-1].append(token)
    return parts


def _find_end(lines: Sequence[list[Token]], index: int, opener: Token) -> int:
    """Index after the line that closes the block that `opener` has opened."""
    stack = [_BLOCKS[opener.text.lower()]]
    while index < len(lines):
        word = lines[index][0].text.lower()
        index += 1
        if word in _BLOCKS:
            stack.append(_BLOCKS[word])
        elif word == stack[-1]:
            stack.pop()
            if not stack:
                return index
    raise SourceError("NP013", f"{opener.text} without {stack[0]}", opener.span)


def _substitute(line: list[Token], table: dict[str, list[Token]]) -> list[Token]:
    if not table:
        return line
    result: list[Token] = []
    for token in line:
        replacement = table.get(token.text) if token.kind is Kind.NAME else None
        result.extend([token] if replacement is None else replacement)
    return result


def _grouped(argument: list[Token]) -> list[Token]:
    """An argument that is a sum or the like keeps together inside a larger expression."""
    if not any(t.kind is Kind.SIGN and t.text in OPERATORS for t in argument):
        return argument
    if argument[0].text in {"#", "[", "("}:
        return argument
    first, last = argument[0], argument[-1]
    opening = Token(Kind.SIGN, "(", first.line, first.column, 0, first.scope)
    closing = Token(Kind.SIGN, ")", last.line, last.column, 0, last.scope)
    return [opening, *argument, closing]


def _single_name(tokens: list[Token]) -> Token:
    if len(tokens) != 1 or tokens[0].kind is not Kind.NAME:
        raise _expected("a name", tokens[0] if tokens[0].kind is not Kind.NAME else tokens[1])
    return tokens[0]


def _expected(what: str, token: Token) -> SourceError:
    return SourceError("NP011", f"expected {what}, found {token.shown()}", token.span)
