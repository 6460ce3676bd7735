"""Names of a source: constants, labels, local labels, register names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from npchip.assembler.diagnostics import Note, SourceError, Span, did_you_mean
from npchip.assembler.expressions import evaluate
from npchip.assembler.lexer import Kind, Token

REGISTERS = tuple(f"r{number}" for number in range(16))
_MAX_CHAIN = 64  # constants defined by constants; stops a long chain from nesting Python calls


class Scope:
    """Local labels between two labels, or of one expansion of a macro or repetition.

    A macro's scope has no parent: its labels cannot clash with those around its use.
    """

    def __init__(self, parent: Scope | None = None) -> None:
        self.parent = parent
        self.labels: dict[str, tuple[int, Span]] = {}

    def find(self, name: str) -> int | None:
        """Address of a local label, looked up outwards."""
        scope: Scope | None = self
        while scope is not None:
            if name in scope.labels:
                return scope.labels[name][0]
            scope = scope.parent
        return None


@dataclass
class _Constant:
    tokens: list[Token]
    end: Token | None
    span: Span | None
    value: int | None = None
    busy: bool = False


@dataclass
class Symbols:
    """All names of one assembly.

    Args:
        predefined: constants that the assembler provides (the geometry).
        overrides: values from ``--define``; each takes the place of a constant of the source.
    """

    predefined: Mapping[str, int]
    overrides: Mapping[str, int]
    labels: dict[str, tuple[int, Span]] = field(default_factory=dict)
    registers: dict[str, tuple[int, Span]] = field(default_factory=dict)
    _constants: dict[str, _Constant] = field(default_factory=dict)
    _depth: int = 0
    complete: bool = False  # all labels are placed

    def __post_init__(self) -> None:
        for name, value in self.predefined.items():
            self._constants[name] = _Constant([], None, None, value)

    # ---- definitions

    def define_constant(self, name: Token, tokens: list[Token], end: Token) -> None:
        """``.equ``: evaluated when it is first used, so that it may name later labels."""
        self._check_free(name)
        value = self.overrides.get(name.text)
        self._constants[name.text] = _Constant(tokens, end, name.span, value)

    def define_register(self, name: Token, number: int) -> None:
        """``.reg``: another name for a register."""
        self._check_free(name)
        self.registers[name.text] = (number, name.span)

    def define_label(self, name: Token, address: int) -> None:
        """A label, or a local label in the token's scope."""
        if name.kind is Kind.DOTTED:
            assert name.scope is not None
            if name.text in name.scope.labels:
                raise _twice(name, name.scope.labels[name.text][1])
            name.scope.labels[name.text] = (address, name.span)
        else:
            self._check_free(name)
            self.labels[name.text] = (address, name.span)

    def _check_free(self, name: Token) -> None:
        text = name.text
        if text.lower() in REGISTERS:
            raise SourceError("NP017", f"'{text}' is a register and cannot be defined", name.span)
        first: Span | None = None
        if text in self.labels:
            first = self.labels[text][1]
        elif text in self.registers:
            first = self.registers[text][1]
        elif text in self._constants:
            first = self._constants[text].span
            if first is None:
                raise SourceError("NP017", f"'{text}' is predefined by the machine", name.span)
        if first is not None:
            raise _twice(name, first)

    # ---- use

    def register(self, token: Token) -> int | None:
        """Number of the register that a token names, or None."""
        if token.kind is not Kind.NAME:
            return None
        if token.text in self.registers:
            return self.registers[token.text][0]
        lower = token.text.lower()
        return int(lower[1:]) if lower in REGISTERS else None

    def value(self, token: Token) -> int:
        """Value of a name in an expression.

        Raises:
            SourceError: NP005 a register, NP007 unknown, NP015 defined by itself, NP016 a label
                where its address is not known yet.
        """
        name = token.text
        if token.kind is Kind.DOTTED:
            address = token.scope.find(name) if token.scope else None
            if address is None:
                raise self._unknown(token, "local label")
            return address
        if name in self._constants:
            return self._constant(token, self._constants[name])
        if name in self.labels:
            return self.labels[name][0]
        if self.register(token) is not None:
            raise SourceError(
                "NP005", f"expected a number, found the register '{name}'", token.span
            )
        raise self._unknown(token, "name")

    def _constant(self, token: Token, constant: _Constant) -> int:
        if constant.value is None:
            assert constant.end is not None
            assert constant.span is not None
            note = Note(f"'{token.text}' is defined here", constant.span)
            if constant.busy:
                raise SourceError("NP015", f"'{token.text}' is defined by itself", token.span, note)
            if self._depth > _MAX_CHAIN:
                raise SourceError("NP015", "too many constants defined by others", token.span, note)
            constant.busy = True
            self._depth += 1
            try:
                constant.value = evaluate(constant.tokens, constant.end, self.value)
            finally:
                constant.busy = False
                self._depth -= 1
        return constant.value

    def _unknown(self, token: Token, what: str) -> SourceError:
        if what == "local label":
            known: Iterable[str] = token.scope.labels if token.scope else ()
        else:
            known = [*self._constants, *self.labels]
        near = did_you_mean(token.text, known)
        if self.complete:
            return SourceError(
                "NP007", f"unknown {what} '{token.text}'", token.span, suggestion=near
            )
        message = f"'{token.text}' is not known yet: this value must follow from the lines above"
        return SourceError("NP016", message, token.span, suggestion=near)

    def constants(self) -> list[Token]:
        """The constants of the source, each as a token at its definition."""
        return [
            Token(Kind.NAME, name, item.span.line, item.span.column)
            for name, item in self._constants.items()
            if item.span is not None
        ]

    def unknown_overrides(self) -> list[tuple[str, str | None]]:
        """Names given with ``--define`` that the source does not define, with a suggestion."""
        own = [name for name, constant in self._constants.items() if constant.span is not None]
        return [(n, did_you_mean(n, own)) for n in self.overrides if n not in own]


def _twice(name: Token, first: Span) -> SourceError:
    return SourceError(
        "NP008", f"'{name.text}' is defined twice", name.span, Note("first defined here", first)
    )
