"""Names of a source: constants, labels, local labels, register names."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from npchip.assembler.diagnostics import (
    FollowUpError,
    Note,
    SourceError,
    Span,
    did_you_mean,
    quoted,
    short_name,
)
from npchip.assembler.expressions import evaluate
from npchip.assembler.lexer import Kind, Token

REGISTERS = {f"r{number}": number for number in range(16)}
Hint = Callable[[Token], str]
_MAX_CHAIN = 64  # constants that wait for later ones; stops a long chain from nesting Python calls


class Scope:
    """The local labels between two labels, or of one expansion of a macro or repetition.

    A macro's scope has no parent, so its labels cannot clash with those around its use.
    """

    def __init__(self, parent: Scope | None = None) -> None:
        self.parent = parent
        self.labels: dict[str, tuple[int, Span]] = {}
        self.used: set[str] = set()

    def find(self, name: str) -> int | None:
        """Return the address of a local label of this scope or one around it, or None."""
        if name in self.labels:
            self.used.add(name)
            return self.labels[name][0]
        return self.parent.find(name) if self.parent else None


class NotYetError(SourceError):
    """NP016: a value is needed at once, but names something that is not defined above."""

    def __init__(self, token: Token) -> None:
        self.name = token.text
        message = f"{quoted(self.name)} is not defined above this line, where its value is needed"
        super().__init__("NP016", message, token.span)


@dataclass(eq=False)
class _Constant:
    name: Token | None  # None: predefined
    value: int | None = None
    tokens: list[Token] = field(default_factory=list)
    end: Token | None = None
    busy: bool = False
    broken: bool = False  # reported already


class Symbols:
    """The names of one assembly.

    Args:
        predefined: constants that the assembler provides (the geometry).
        overrides: values from ``--define``; each replaces that of a constant of the source.

    Attributes:
        labels: address and place of each label.
        registers: number and place of each register name.
        complete: True once all labels are placed and an unknown name will stay unknown.
        doubtful: True if a reported error may have lost definitions, so that unknown names are
            not reported.
        used: names that were looked up, or that skipped lines mention.
    """

    def __init__(self, predefined: Mapping[str, int], overrides: Mapping[str, int]) -> None:
        self.predefined = predefined
        self.overrides = overrides
        self.labels: dict[str, tuple[int, Span]] = {}
        self.registers: dict[str, tuple[int, Span]] = {}
        self.complete = False
        self.doubtful = False
        self.used: set[str] = set()
        self._constants = {name: _Constant(None, value) for name, value in predefined.items()}
        self._near: dict[tuple[str, bool], str | None] = {}
        self._locals: dict[str, list[Span]] = {}  # all places of each local label
        self._depth = 0

    # ---- definitions

    def define_constant(self, name: Token, tokens: list[Token], end: Token) -> None:
        """Define the constant of an ``.equ``; one that names later things gets its value later."""
        self._check_free(name, ONCE)
        constant = _Constant(name, self.overrides.get(name.text), tokens, end)
        self._constants[name.text] = constant
        if constant.value is not None:  # the expression counts as a use all the same
            self.used.update(token.text for token in tokens)
        with suppress(NotYetError):
            self._evaluate(name, constant)

    def define_broken(self, name: Token) -> None:
        """Define a constant whose definition is a reported error; its uses are not reported."""
        if not self.knows(name.text):
            self._constants[name.text] = _Constant(name, broken=True)

    def define_register(self, name: Token, number: int) -> None:
        """Define another name for a register, as ``.reg`` does."""
        self._check_free(name, ONCE)
        self.registers[name.text] = (number, name.span)

    def define_label(self, name: Token, address: int) -> None:
        """Define a label, or a local label in the token's scope."""
        if name.kind is Kind.DOTTED:
            assert name.scope is not None
            self._locals.setdefault(name.text, []).append(name.span)
            if name.text in name.scope.labels:
                raise _twice(name, name.scope.labels[name.text][1], None)
            name.scope.labels[name.text] = (address, name.span)
        else:
            self._check_free(name, f"it is placed each time: make it a local label, .{name.text}")
            self.labels[name.text] = (address, name.span)

    def _check_free(self, name: Token, again: str) -> None:
        """Raise an error for a name that is taken; `again` helps if this line took it."""
        text = name.text
        if text.lower() in REGISTERS:
            message = f"{quoted(text)} is a register and cannot be defined"
            raise SourceError("NP017", message, name.span)
        first = self.definition(text)
        if first is not None:
            raise _twice(name, first, again)
        if text in self._constants:
            message = f"{quoted(text)} is predefined: the machine's geometry"
            raise SourceError("NP017", message, name.span)

    # ---- use

    def definition(self, name: str) -> Span | None:
        """Return the place where the source defines a name, or None."""
        for table in (self.labels, self.registers):
            if name in table:
                return table[name][1]
        constant = self._constants.get(name)
        return constant.name.span if constant and constant.name else None

    def knows(self, name: str) -> bool:
        """Return whether a name is defined so far, predefined names and registers included."""
        return (
            name in self._constants
            or self.definition(name) is not None
            or name.lower() in REGISTERS
        )

    def names(self) -> list[str]:
        """Return the names that an expression may use."""
        return [*self._constants, *self.labels]

    def other_than_register(self, token: Token) -> str | None:
        """Return what the name of a label or a constant stands for; None for any other token."""
        if token.kind is not Kind.NAME:
            return None
        return (
            "a label"
            if token.text in self.labels
            else "a constant"
            if token.text in self._constants
            else None
        )

    def unnamed(self, written: Collection[str]) -> list[str]:
        """Return the registers without a name, but for those that are `written` as they are."""
        taken = {number for number, _ in self.registers.values()}
        return [name for name, at in REGISTERS.items() if at not in taken and name not in written]

    def register(self, token: Token) -> int | None:
        """Return the number of the register that a token names, or None."""
        if token.kind is not Kind.NAME:
            return None
        number = REGISTERS.get(token.text.lower())
        if number is None and token.text in self.registers:
            self.used.add(token.text)
            number = self.registers[token.text][0]
        return number

    def value(self, token: Token, hint: Hint | None = None) -> int:
        """Return the value of a name in an expression.

        Args:
            token: the name.
            hint: as for `unknown`.

        Raises:
            SourceError: NP005 a register, NP007 unknown, NP015 defined by itself, NP016 not
                known yet where a value is needed at once.
            FollowUpError: the name's definition is a reported error.
        """
        name = token.text
        if token.kind is Kind.DOTTED:
            address = token.scope.find(name) if token.scope else None
            if address is None:
                raise self.unknown(token)
            return address
        if name in self._constants:
            self.used.add(name)
            return self._evaluate(token, self._constants[name])
        if name in self.labels:
            self.used.add(name)
            return self.labels[name][0]
        if self.register(token) is not None:
            message = f"expected a number, found the register {quoted(name)}"
            raise SourceError("NP005", message, token.span)
        raise self.unknown(token, hint or _constant_hint)

    def _evaluate(self, token: Token, constant: _Constant) -> int:
        if constant.value is not None:
            return constant.value
        if constant.broken:
            raise FollowUpError
        assert constant.end is not None
        assert constant.name is not None
        if constant.busy or self._depth > _MAX_CHAIN:
            what = "depends on itself" if constant.busy else "waits for too many later constants"
            note = Note(f"{quoted(token.text)} is defined here", constant.name.span)
            raise SourceError("NP015", f"{quoted(token.text)} {what}", token.span, note)
        constant.busy = True
        self._depth += 1
        try:
            constant.value = evaluate(constant.tokens, constant.end, self.value)
        except NotYetError:
            raise  # it has another chance when all labels are placed
        except (SourceError, FollowUpError):
            constant.broken = True
            raise
        finally:
            constant.busy = False
            self._depth -= 1
        return constant.value

    def unknown(
        self, token: Token, hint: Hint | None = None, *, register: bool = False
    ) -> SourceError | FollowUpError:
        """Return the error for a name that is defined nowhere.

        Args:
            token: the name.
            hint: returns how to define it, which helps where no other name is near.
            register: True if it must be the name of a register.
        """
        local = token.kind is Kind.DOTTED
        if not self.complete:
            return NotYetError(token)
        if self.doubtful:
            return FollowUpError()
        key = token.text, register
        if key not in self._near:  # to look for help takes time
            known = self.registers if register else self.names()
            near = did_you_mean(token.text, token.scope.labels if token.scope else known)
            self._near[key] = (self._out_of_reach(token) if local else None) or near
        text = self._near[key] or (hint or _local_hint)(token)
        what = "local label" if local else "name"
        message = f"unknown {what} {quoted(token.text)}"
        return SourceError("NP007", message, token.span, suggestion=text)

    def _out_of_reach(self, token: Token) -> str | None:
        """Return which label ends the reach of the nearest one of this name, if one does."""
        here = _place(token.span)
        places = [_place(span) for span in self._locals.get(token.text, []) if _same(span, token)]
        if not places:
            return None
        there = min(places, key=lambda place: abs(place[0] - here[0]))
        first, last = sorted((here, there))
        labels = [
            (_place(span), name)
            for name, (_, span) in self.labels.items()
            if _same(span, token) and first < _place(span) < last
        ]
        if not labels:
            return None
        _, label = min(labels)
        remedy = "drop the dot in both lines"
        if self.knows(token.text[1:]):
            remedy = "give it a name of its own, without a dot"
        name, label = short_name(token.text), short_name(label)
        return (
            f"line {there[0]} has {name}, but the label {label} lies between,"
            f" which no name with a dot crosses: {remedy}"
        )

    # ---- afterwards

    def constants(self) -> dict[str, int]:
        """Return the value of each constant of the source; none may be wrong."""
        return {name.text: self._evaluate(name, constant) for name, constant in self._own()}

    def known(self) -> dict[str, int]:
        """Return the value of each constant that has one, predefined ones included."""
        return {
            name: item.value for name, item in self._constants.items() if item.value is not None
        }

    def _own(self) -> Iterator[tuple[Token, _Constant]]:
        for constant in self._constants.values():
            if constant.name is not None:
                yield constant.name, constant

    def waiting(self) -> list[Token]:
        """Return the name of each constant that has no value so far, as it is defined."""
        return [name for name, item in self._own() if item.value is None and not item.broken]

    def evaluate_unused(self, name: Token) -> None:
        """Evaluate a constant that no instruction has used; raises what `value` does."""
        self._evaluate(name, self._constants[name.text])

    def unused(self) -> Iterator[tuple[str, Span]]:
        """Yield each constant and register name that nothing uses, with its place."""
        for name, _ in self._own():
            if name.text not in self.used:
                yield f"constant {quoted(name.text)}", name.span
        for register, (_, span) in self.registers.items():
            if register not in self.used:
                yield f"register name {quoted(register)}", span

    def unknown_overrides(self) -> list[tuple[str, str | None]]:
        """Return the names of ``--define`` that the source lacks, each with a suggestion."""
        own = [name.text for name, _ in self._own()]
        return [(n, did_you_mean(n, own)) for n in self.overrides if n not in own]


def _constant_hint(token: Token) -> str:
    return f".equ {short_name(token.text)}, NUMBER gives a number this name"


def _local_hint(_token: Token) -> str:
    return "a local label is known between two labels, and that of a macro only in it"


def _place(span: Span) -> tuple[int, int]:
    return span.line.number, span.column


def _same(span: Span, token: Token) -> bool:
    return span.line.file == token.line.file


ONCE = "it is defined each time: move this line out of the macro or repetition"


def _twice(name: Token, first: Span, again: str | None) -> SourceError:
    hint = again if name.span == first else None
    note = Note("first defined here", first)
    message = f"{quoted(name.text)} is defined twice"
    return SourceError("NP008", message, name.span, note, suggestion=hint)
