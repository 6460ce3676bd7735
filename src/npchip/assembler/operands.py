"""Match an instruction's tokens with one of its forms, and evaluate its operands."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from npchip.assembler.diagnostics import FollowUpError, SourceError, short_name
from npchip.assembler.expressions import evaluate
from npchip.assembler.lexer import Kind, Token, expected
from npchip.assembler.suggestions import looks_like_register, offset_hint, operand_hint
from npchip.assembler.symbols import Symbols
from npchip.isa import FieldValue, Form, Isa, Operand, Slot

MAX_WORD = 0xFFFF


class _Pending(NamedTuple):
    """An operand whose tokens are not yet evaluated."""

    slot: Slot
    tokens: Sequence[Token]
    end: Token


class Matched(NamedTuple):
    """A form that fits a statement, and the operands that `Matcher.value` evaluates."""

    form: Form
    fixed: Mapping[str, FieldValue]
    pending: tuple[_Pending, ...]


def raw_word(tokens: Sequence[Token], symbols: Symbols) -> int:
    """Return the word that a ``.word`` states as a number.

    Raises:
        SourceError: an expression without a value, or more than 16 bits.
        FollowUpError: a name whose definition is a reported error.
    """
    number = evaluate(tokens[1:-1], tokens[-1], symbols.value)
    if not 0 <= number <= MAX_WORD:
        at = tokens[1].span
        raise SourceError("NP006", f"expected a word from 0 to 0xFFFF, found {number}", at)
    return number


class _MismatchError(Exception):
    def __init__(self, position: int, expected: str) -> None:
        super().__init__(expected)
        self.position = position
        self.expected = expected


class Matcher:
    """Finds the forms of statements.

    Args:
        isa: the instruction set.
        symbols: the names of the source.
        lines: the tokens of all statements.
        ports: the port of each declared output, by its name.
    """

    def __init__(
        self,
        isa: Isa,
        symbols: Symbols,
        lines: Collection[Sequence[Token]] = (),
        ports: Mapping[str, int] | None = None,
    ) -> None:
        self._isa = isa
        self._symbols = symbols
        self._lines = lines
        self._ports = ports or {}
        self._named: dict[str, str] = {}
        self._free = self._unused()  # begins to look once it is asked

    def value(self, item: _Pending) -> int:
        """Return the value of one operand.

        Raises:
            SourceError: an expression without a value, or a value that does not fit.
            FollowUpError: a name whose definition is a reported error.
        """
        operand = item.slot.operand
        lookup = partial(self._symbols.value, hint=partial(self._definition, operand))
        number = evaluate(item.tokens, item.end, lookup)
        if not (operand.least <= number <= operand.most) or number % operand.step:
            _check_range(item, number, self._isa)
        return number

    def _definition(self, operand: Operand, token: Token) -> str:
        """Return how to define a name that an operand needs and nothing defines."""
        name = short_name(token.text)
        if operand.kind == "register":
            return f"no register is called {name}: {self._naming(token)} names one"
        if operand.kind == "label":
            return f"no label is called {name}: it stands as {name}: before an instruction"
        port = self._ports.get(token.text)
        if operand.name == "port" and port is not None:
            return f"{name} is the output at port {port}: write {port}"
        number = f".equ {name}, NUMBER gives a number this name"
        if token.line.text[: token.column].rstrip().endswith("["):
            return f"{self._naming(token)} gives a register this name; {number}"
        return number

    def _is_new_name(self, token: Token) -> bool:
        """Return whether a token is a name that neither the source nor the language has."""
        if token.kind is not Kind.NAME or self._symbols.knows(token.text):
            return False
        operands = self._isa.operands.values()
        choices = {name for operand in operands for name in operand.choices}
        words = {*self._isa.forms, *self._isa.condition_names, *map(str.upper, choices)}
        return token.text.upper() not in words and not looks_like_register(token)

    def _unused(self) -> Iterator[str]:
        written = {item.text.lower() for line in self._lines for item in line}
        yield from self._symbols.unnamed(written)

    def _naming(self, token: Token) -> str:
        """Return the directive that gives a free register a name, for each name another one."""
        if token.text not in self._named:
            self._named[token.text] = next(self._free, "REGISTER")
        return f".reg {short_name(token.text)}, {self._named[token.text]}"

    def match(self, tokens: Sequence[Token], forms: Sequence[Form]) -> Matched:
        """Return the form that a statement's operands fit.

        Args:
            tokens: mnemonic, operands, and an END token.
            forms: the forms of the mnemonic.

        Raises:
            SourceError: NP005 no form has these operands; NP007 a register with a name that
                nothing defines.
            FollowUpError: a reported error may have lost its definition.
        """
        mismatches: list[_MismatchError] = []
        for form in forms:
            try:
                return self._match_form(form, tokens)
            except _MismatchError as mismatch:
                mismatches.append(mismatch)
        furthest = max(item.position for item in mismatches)
        wanted = [item.expected for item in mismatches if item.position == furthest]
        raise self._blame(tokens[furthest], list(dict.fromkeys(wanted)), tokens)

    def _match_form(self, form: Form, tokens: Sequence[Token]) -> Matched:
        position = 1
        fixed: dict[str, FieldValue] = {}
        pending: list[_Pending] = []
        parts = form.tokens
        for index, part in enumerate(parts):
            token = tokens[position]
            if isinstance(part, str):
                if token.text != part:
                    raise _MismatchError(position, f"'{part}'")
                position += 1
            elif part.operand.kind in _SINGLE:
                value = self._single(part.operand, token)
                if value is None:
                    raise _MismatchError(position, describe(part.operand, self._isa))
                fixed[part.name] = value
                position += 1
            else:
                after = str(parts[index + 1]) if index + 1 < len(parts) else None
                end = self._expression_end(tokens, position, after, part.operand)
                pending.append(_Pending(part, tokens[position:end], tokens[end]))
                position = end
        if not tokens[position].ends:
            raise _MismatchError(position, "the end of the line")
        return Matched(form, fixed, tuple(pending))

    def _single(self, operand: Operand, token: Token) -> FieldValue | None:
        if operand.kind == "register":
            return self._symbols.register(token)
        if token.kind is not Kind.NAME:
            return None
        if operand.kind == "condition":
            name = token.text.upper()
            return name if name in self._isa.condition_names else None
        name = token.text.lower()
        return name if name in operand.choices else None

    def _expression_end(
        self, tokens: Sequence[Token], start: int, after: str | None, operand: Operand
    ) -> int:
        """Return the index of the token after the expression that begins at `start`."""
        depth = 0
        position = start
        while not (token := tokens[position]).ends:
            text = token.text
            if depth == 0 and (text == after or text in {",", "]"}):
                break
            if token.kind is Kind.SIGN:
                depth += (text == "(") - (text == ")")
            # Two values side by side are no expression: the error points to the second.
            elif position > start and _ends_value(tokens[position - 1]):
                raise _MismatchError(position, f"'{after}'" if after else "the end of the line")
            if text in {"#", "["} or self._symbols.register(token) is not None:
                raise _MismatchError(position, describe(operand, self._isa))
            position += 1
        if position == start:
            raise _MismatchError(position, describe(operand, self._isa))
        return position

    def _blame(
        self, token: Token, wanted: list[str], tokens: Sequence[Token]
    ) -> SourceError | FollowUpError:
        register = next(each for each in self._isa.operands.values() if each.kind == "register")
        if describe(register, self._isa) in wanted and self._is_new_name(token):
            return self._symbols.unknown(token, partial(self._definition, register), register=True)
        is_register = self._symbols.register(token) is not None
        hint = operand_hint(token, wanted, tokens, self._isa, is_register=is_register)
        other = self._symbols.other_than_register(token)
        if wanted == [describe(register, self._isa)] and other:
            hint = f"{short_name(token.text)} is {other}, not a register"
        listed = " or ".join([", ".join(wanted[:-1]), wanted[-1]][len(wanted) == 1 :])
        return expected("NP005", listed, token, hint)


_SINGLE = frozenset({"register", "condition", "choice"})


def _ends_value(token: Token) -> bool:
    return token.kind is not Kind.SIGN or token.text == ")"


def describe(operand: Operand, isa: Isa) -> str:
    """Return an operand as messages about the expected syntax describe it."""
    match operand.kind:
        case "register":
            return "a register"
        case "condition":
            return f"a condition ({', '.join(isa.condition_names)})"
        case "choice":
            return " or ".join(operand.choices)
        case "label":
            return "a label"
    if operand.step > 1:
        steps = range(operand.least, operand.most + 1, operand.step)
        return f"a {operand.name} ({', '.join(map(str, steps))})"
    return f"a number from {-128 if operand.wraps else operand.least} to {operand.most}"


def _check_range(item: _Pending, number: int, isa: Isa) -> None:
    operand = item.slot.operand
    span = item.tokens[0].span
    if operand.kind == "label":
        limit = (1 << item.slot.width) - 1
        if not 0 <= number <= limit:
            message = f"expected an address from 0 to {limit}, found {number}"
            raise SourceError("NP006", message, span)
        return
    if operand.wraps and -128 <= number < 0:
        return
    hint = None
    if operand.step > 1:
        is_bank = 0 < number <= operand.most // operand.step
        bank = f"bank {number} begins at {number * operand.step}" if is_bank else None
        offset = offset_hint(span.line.text[: span.column], f"#{number}" * (0 < number < 256))
        hint = "; ".join(filter(None, (bank, offset))) or None
    elif operand.wraps:
        hint = f"the low 8 bits are {number & 0xFF}; write & 0xFF if that is meant"
    message = f"expected {describe(operand, isa)}, found {number}"
    raise SourceError("NP006", message, span, suggestion=hint)
