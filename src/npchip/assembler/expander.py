"""Source lines to statements: place labels, execute directives, expand blocks and files."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Final, NamedTuple

from npchip.assembler.blocks import SIMPLE, Node, defines, names
from npchip.assembler.diagnostics import (
    Diagnostic,
    Expansion,
    FollowUpError,
    Note,
    SourceError,
    Span,
    did_you_mean,
    quoted,
    with_backtrace,
)
from npchip.assembler.directives import Declarations, string, usage
from npchip.assembler.expressions import evaluate
from npchip.assembler.left_out import LeftOut
from npchip.assembler.lexer import (
    COMMENT_HINT,
    COMMENT_SIGNS,
    Kind,
    Token,
    after_labels,
    expected,
    in_scope,
)
from npchip.assembler.macros import Macro, number, read_macro, single_name, split, substitute
from npchip.assembler.sources import SourceFile, Sources
from npchip.assembler.suggestions import is_bare_label, unknown_instruction
from npchip.assembler.symbols import NotYetError, Scope, Symbols

MAX_DEPTH: Final = 64  # blocks, macros and files within each other
MAX_LINES: Final = 10_000  # lines after expansion: twenty times what the ROM holds
MAX_TOKENS: Final = 200_000  # arguments could double at every use of a macro


class Statement(NamedTuple):
    """An instruction or ``.word`` as written; its address is its index among the statements.

    Attributes:
        tokens: mnemonic and operands; an END or BROKEN token last.
        expansion: the expansion that it came from, if any.
    """

    tokens: tuple[Token, ...]
    expansion: Expansion | None


class _Context(NamedTuple):
    files: tuple[SourceFile, ...]  # being included, outermost first
    expansion: Expansion | None = None
    table: Mapping[str, list[Token]] = MappingProxyType({})  # values of parameters and counters
    depth: int = 0
    generated: bool = False  # by a macro or repetition, whose labels open no scope


class _Stop(Exception):  # noqa: N818 - it ends the expansion, it is no error class
    """The expansion exceeds a limit, which has been reported."""


class Expander:
    """Expands a source.

    Args:
        symbols: the table of names.
        sources: the files of the assembly.
        mnemonics: names of instructions, in capitals.
        report: is called with each error; expansion continues with the next line.

    Attributes:
        statements: the instructions, in the order of their addresses.
        declarations: outputs, budgets and loop bounds.
        macros: the macros by name.
        local_scopes: scopes of the local labels outside macros and repetitions.
        left_out: the lines that were left out, and the macros that were used.
        intact: False once an error has lost statements.
    """

    def __init__(
        self,
        symbols: Symbols,
        sources: Sources,
        mnemonics: Collection[str],
        report: Callable[[Diagnostic], None],
    ) -> None:
        self.symbols = symbols
        self.sources = sources
        self.mnemonics = mnemonics
        self.report = report
        self.statements: list[Statement] = []
        self.declarations = Declarations(symbols, sources.data)
        self.macros: dict[str, Macro] = {}
        self.local_scopes: list[Scope] = []
        self.left_out = LeftOut(self.macros)
        self.intact = True
        self._lines = 0
        self._tokens = 0
        self._reported: set[Span] = set()
        self._broken_macros: set[str] = set()

    def expand(self, file: SourceFile) -> None:
        """Expand a file into the attributes."""
        self.symbols.doubtful |= file.doubtful
        self.intact &= not file.doubtful
        try:
            self._walk(file.nodes, self._local_scope(), _Context((file,)))
        except _Stop:
            self.symbols.doubtful = True
            self.intact = False

    def _local_scope(self) -> Scope:
        self.local_scopes.append(Scope())
        return self.local_scopes[-1]

    def _walk(self, nodes: Sequence[Node], scope: Scope, context: _Context) -> Scope:
        """Expand lines and return the scope after them."""
        for node in nodes:
            tokens = substitute(node.tokens, context.table) if context.table else node.tokens
            self._count(tokens, context)
            try:
                tokens, scope = self._labels(tokens, scope, context)
                scope = self._line(node, tokens, scope, context)
            except SourceError as error:
                self._fail(error, tokens, context)
                self._give_up(node, tokens)
            except FollowUpError:
                self._give_up(node, tokens)
        return scope

    def _fail(self, error: SourceError, tokens: list[Token], context: _Context) -> None:
        diagnostic = error.diagnostic
        if isinstance(error, NotYetError) and self.symbols.doubtful:
            return
        if isinstance(error, NotYetError) and diagnostic.span not in self._reported:
            self._reported.add(diagnostic.span)  # the search for a near name is slow
            near = did_you_mean(error.name, self.symbols.names())
            diagnostic = diagnostic._replace(suggestion=near)
            if diagnostic.span.line is not tokens[0].line:
                diagnostic = diagnostic.with_notes([Note("this line needs it", tokens[0].span)])
        self.report(with_backtrace(diagnostic, tokens[0].span, context.expansion))

    def _give_up(self, node: Node, tokens: list[Token]) -> None:
        """Skip a line with a reported error; uses of names that it defines are not reported."""
        first = tokens[0]
        if first.text.lower() in _PLAIN:
            self.declarations.define_wrong(tokens)
            return
        self.intact = False
        if node.word == ".macro" and tokens[1].text not in self.macros:
            self._broken_macros.add(tokens[1].text)
        bodies = [body for _, body in node.branches]
        if first.text in self.macros:
            bodies.append(self.macros[first.text].body)
        is_include = first.text.lower() == ".include"
        self.symbols.doubtful |= is_include or any(map(defines, bodies))

    def _count(self, tokens: list[Token], context: _Context) -> None:
        self._lines += 1
        self._tokens += len(tokens)
        if self._lines > MAX_LINES or self._tokens > MAX_TOKENS:
            lines, words = f"{MAX_LINES:,} lines", f"{MAX_TOKENS:,} words and signs"
            limit = lines if self._lines > MAX_LINES else words
            self._stop(f"the source expands to more than {limit}", tokens[0], context)

    def _deeper(self, context: _Context, token: Token) -> _Context:
        if context.depth >= MAX_DEPTH:
            hint = f"does {quoted(token.text)} use itself without end?"
            message = f"macros, blocks and files nested more than {MAX_DEPTH} deep"
            self._stop(message, token, context, hint)
        return context._replace(depth=context.depth + 1)

    def _stop(self, message: str, token: Token, context: _Context, hint: str | None = None) -> None:
        diagnostic = Diagnostic("error", "NP014", message, token.span, suggestion=hint)
        self.report(with_backtrace(diagnostic, token.span, context.expansion))
        raise _Stop

    # ---- a line

    def _labels(
        self, tokens: list[Token], scope: Scope, context: _Context
    ) -> tuple[list[Token], Scope]:
        """Place the labels of a line; return the rest of it, local labels bound, and the scope."""
        after = after_labels(tokens)
        for name in tokens[:after:2]:
            scope = self._place(name, scope, context)
        return in_scope(tokens[after:] if after else tokens, scope), scope

    def _place(self, name: Token, scope: Scope, context: _Context) -> Scope:
        """Define a label and return the scope after it."""
        try:
            self.symbols.define_label(name.in_scope(scope), len(self.statements))
        except SourceError as error:
            self.intact = False
            self.report(with_backtrace(error.diagnostic, name.span, context.expansion))
        if name.kind is Kind.NAME and not context.generated:
            return self._local_scope()
        return scope

    def _line(self, node: Node, tokens: list[Token], scope: Scope, context: _Context) -> Scope:
        first = tokens[0]
        if node.word:
            return self._block(node, tokens, scope, context)
        if first.kind is Kind.NAME:
            if first.text in self.macros:
                self._use_macro(tokens, context)
                return scope
            self.statements.append(Statement(tuple(tokens), context.expansion))
            if first.text.upper() not in self.mnemonics:
                return self._unknown(tokens, scope, context)
        elif tokens[-1].kind is Kind.BROKEN:
            raise FollowUpError
        elif first.kind is Kind.DOTTED:
            word = first.text.lower()
            if word == ".include":
                self._include(tokens, context)
            elif word == ".word":
                self.statements.append(Statement(tuple(tokens), context.expansion))
            elif word in _PLAIN:
                self.declarations.execute(word, tokens, len(self.statements))
            else:
                message = f"the directive {quoted(first.text)} cannot come from an argument"
                raise SourceError("NP004", message, first.span)
        elif not first.ends:
            hint = COMMENT_HINT if first.text in COMMENT_SIGNS else None
            raise expected("NP003", "an instruction", first, hint)
        return scope

    def _unknown(self, tokens: list[Token], scope: Scope, context: _Context) -> Scope:
        self.intact = False
        name = tokens[0]
        if tokens[-1].kind is Kind.BROKEN:
            self.symbols.define_broken(name)  # perhaps NAME = VALUE
            return scope
        known = self.symbols.doubtful or name.text in self._broken_macros
        if known or name.span in self._reported:
            return scope
        self._reported.add(name.span)
        bare = is_bare_label(tokens, self.mnemonics) and not self._is_register(name)
        below = {item for file in self.sources.files.values() for item in file.macros}
        skipped = self.left_out.skipped_macros() if name.text in below else set()
        error = unknown_instruction(tokens, self.mnemonics, self.macros, below, skipped)
        self.report(with_backtrace(error.diagnostic, name.span, context.expansion))
        # The name that the line should define must not be reported where it is used.
        if bare and not self.symbols.knows(name.text):
            return self._place(name, scope, context)
        if tokens[1].text.upper() == "EQU":
            self.symbols.define_broken(name)
        return scope

    # ---- blocks

    def _block(self, node: Node, tokens: list[Token], scope: Scope, context: _Context) -> Scope:
        if tokens[-1].kind is Kind.BROKEN:
            raise FollowUpError
        if node.word == ".macro":
            self._define_macro(tokens, node.branches[0][1])
        elif node.word == ".rept":
            self._repeat(tokens, node.branches[0][1], scope, context)
        else:
            return self._choose(node, tokens, scope, context)
        return scope

    def _define_macro(self, tokens: list[Token], body: list[Node]) -> None:
        macro = read_macro(tokens, body, self.mnemonics)
        name = macro.name
        if name.text in self.macros:
            first = Note("first defined here", self.macros[name.text].name.span)
            raise SourceError("NP008", f"{quoted(name.text)} is defined twice", name.span, first)
        self.macros[name.text] = macro

    def _use_macro(self, tokens: list[Token], context: _Context) -> None:
        name = tokens[0]
        macro = self.macros[name.text]
        self.left_out.used_macros.add(name.text)
        if tokens[-1].kind is Kind.BROKEN:
            raise FollowUpError
        inner = self._deeper(context, name)._replace(
            expansion=Expansion(f"macro {quoted(name.text)}", name.span, context.expansion),
            table=macro.bind(tokens, self._is_register),
            generated=True,
        )
        self._walk(macro.body, Scope(), inner)

    def _is_register(self, token: Token) -> bool:
        return self.symbols.register(token) is not None

    def _repeat(
        self, tokens: list[Token], body: list[Node], scope: Scope, context: _Context
    ) -> None:
        arguments = split(tokens[1:])
        if not 1 <= len(arguments) <= 2:
            raise usage(tokens, ".rept COUNT or .rept COUNT, NAME")
        count = number(arguments[0], tokens, self.symbols.value)
        counter = single_name(arguments[1], "a name for the counter") if arguments[1:] else None
        if not 0 <= count <= MAX_LINES:
            message = f"expected a count from 0 to {MAX_LINES}, found {count}"
            raise SourceError("NP006", message, arguments[0][0].span)
        inner = self._deeper(context, tokens[0])._replace(generated=True)
        if count == 0:
            self.left_out.skip(body)
        for index in range(count):
            table = context.table
            if counter:
                value = Token(Kind.NUMBER, str(index), counter.line, counter.column, index)
                table = {**table, counter.text: [value]}
            expansion = Expansion(f"repetition {index}", tokens[0].span, context.expansion)
            self._walk(body, Scope(scope), inner._replace(expansion=expansion, table=table))
            self._count([tokens[0]], context)  # an empty body counts too

    def _choose(self, node: Node, tokens: list[Token], scope: Scope, context: _Context) -> Scope:
        """Expand the first branch whose condition holds."""
        inner = self._deeper(context, tokens[0])
        chosen: list[Node] | None = None
        for index, (opening, body) in enumerate(node.branches):
            if chosen is None and self._holds(opening if index else tokens, scope, context):
                chosen = body
            else:
                self.left_out.skip(body)
                self.symbols.used.update(names([Node(opening)]))
        if chosen is None:
            return scope
        self.left_out.choose(chosen)
        return self._walk(chosen, scope, inner)

    def _holds(self, opening: list[Token], scope: Scope, context: _Context) -> bool:
        tokens = opening
        if opening[0].text.lower() == ".elif":
            tokens = in_scope(substitute(opening, context.table), scope)
            if tokens[-1].kind is Kind.BROKEN:
                raise FollowUpError
        match tokens[0].text.lower():
            case ".else":
                return True
            case ".if" | ".elif":
                return evaluate(tokens[1:-1], tokens[-1], self.symbols.value) != 0
        name = single_name(tokens[1:-1] or [tokens[-1]])
        known = self.symbols.knows(name.text) or name.text in self.macros
        self.symbols.used.add(name.text)
        return known == (tokens[0].text.lower() == ".ifdef")

    # ---- included files

    def _include(self, tokens: list[Token], context: _Context) -> None:
        path = string(tokens, '.include "FILE"')
        token = tokens[1]
        what = f"file {quoted(path)}"
        expansion = Expansion(what, token.span, context.expansion, generates=False)
        depth = self._deeper(context, token).depth
        file = self.sources.include(
            path, token, lambda found: self.report(with_backtrace(found, None, expansion))
        )
        self.symbols.doubtful |= file.doubtful
        if any(file.path == outer.path for outer in context.files):
            raise SourceError("NP029", f"{quoted(path)} includes itself", token.span)
        inner = _Context((*context.files, file), expansion, depth=depth)
        self._walk(file.nodes, self._local_scope(), inner)


_PLAIN: Final = frozenset(SIMPLE) - {".include", ".word"}
