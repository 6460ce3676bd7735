"""An instruction's tokens to one of its forms, and the value of each operand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from npchip.assembler.diagnostics import SourceError, did_you_mean
from npchip.assembler.expressions import OPERATORS, evaluate
from npchip.assembler.lexer import Kind, Token
from npchip.assembler.symbols import Symbols
from npchip.isa import FieldValue, Form, Isa, Operand, Slot

MAX_WORD = 0xFFFF


@dataclass(frozen=True)
class _Pending:
    """An operand whose tokens are found but not yet evaluated."""

    slot: Slot
    tokens: Sequence[Token]
    end: Token


@dataclass(frozen=True)
class Matched:
    """A form that fits a statement; `resolve` turns it into values once labels are placed."""

    form: Form
    fixed: dict[str, FieldValue]
    pending: tuple[_Pending, ...]

    def word(self, symbols: Symbols, isa: Isa) -> int:
        """The encoded instruction; raises as `resolve`."""
        return isa.encode(self.form, self.resolve(symbols, isa))

    def resolve(self, symbols: Symbols, isa: Isa) -> dict[str, FieldValue]:
        """Value of every slot.

        Raises:
            SourceError: an expression without a value, or a value that does not fit.
        """
        values = dict(self.fixed)
        for item in self.pending:
            number = evaluate(item.tokens, item.end, symbols.value)
            _check_range(item, number, isa)
            values[item.slot.name] = number
        return values


@dataclass(frozen=True)
class RawWord:
    """A word given as a number: ``.word 0x1234``."""

    tokens: Sequence[Token]
    end: Token

    def word(self, symbols: Symbols, isa: Isa) -> int:  # noqa: ARG002 - as `Matched.word`
        """The number.

        Raises:
            SourceError: an expression without a value, or more than 16 bits.
        """
        number = evaluate(self.tokens, self.end, symbols.value)
        if not 0 <= number <= MAX_WORD:
            raise SourceError(
                "NP006",
                f"expected a word from 0 to 0x{MAX_WORD:04X}, found {number}",
                self.tokens[0].span,
            )
        return number


class _MismatchError(Exception):
    def __init__(self, position: int, expected: str) -> None:
        super().__init__(expected)
        self.position = position
        self.expected = expected


def match(tokens: Sequence[Token], isa: Isa, symbols: Symbols) -> Matched | RawWord:
    """Find the form of an instruction that its operands have.

    Args:
        tokens: mnemonic (or ``.word``), operands, and an END token.
        isa: the instruction set.
        symbols: names of registers; expressions are not evaluated yet.

    Raises:
        SourceError: NP003 unknown mnemonic, NP005 operands that no form has.
    """
    name = tokens[0]
    if name.kind is Kind.DOTTED:
        return RawWord(tokens[1:-1], tokens[-1])
    forms = isa.forms.get(name.text.upper())
    if forms is None:
        raise SourceError(
            "NP003",
            f"unknown instruction '{name.text}'",
            name.span,
            suggestion=_INSTEAD.get(name.text.upper()) or did_you_mean(name.text, isa.forms),
        )
    mismatches: list[_MismatchError] = []
    for form in forms:
        try:
            return _match_form(form, tokens, isa, symbols)
        except _MismatchError as mismatch:
            mismatches.append(mismatch)
    furthest = max(item.position for item in mismatches)
    expected = [item.expected for item in mismatches if item.position == furthest]
    raise _blame(tokens[furthest], list(dict.fromkeys(expected)), isa, symbols, tokens)


# What people look for who come from other processors (thesis 2.1.2: only these are built in).
_INSTEAD = {
    "XOR": "there is no XOR: a ^ b is (a | b) - (a & b)",
    "EOR": "there is no EOR: a ^ b is (a | b) - (a & b)",
    "NOT": "there is no NOT: ~a is 255 - a",
    "NEG": "there is no NEG: -a is 0 - a",
    "MUL": "there is no MUL: multiply by shifts and additions",
    "DIV": "there is no DIV: divide by shifts, or by a table",
    "INC": "write ADD rd, #1",
    "DEC": "write SUB rd, #1",
    "CLR": "write MOV rd, #0",
    "LSL": "did you mean SHL?",
    "LSR": "did you mean SHR?",
    "LDR": "did you mean LD?",
    "STR": "did you mean ST?",
    "BL": "did you mean CALL?",
    "B": "did you mean JMP?",
    "JZ": "flow follows the global OR: JANY EQ, JNONE EQ or JALL EQ",
    "JNZ": "flow follows the global OR: JANY NE, JNONE NE or JALL NE",
    "BEQ": "flow follows the global OR: JANY EQ, JNONE EQ or JALL EQ",
    "BNE": "flow follows the global OR: JANY NE, JNONE NE or JALL NE",
    "IF": "masked regions are WHERE cc, ELSE and END",
    "ENDIF": "masked regions are WHERE cc, ELSE and END",
    "ENDWHERE": "did you mean END?",
}


def _match_form(form: Form, tokens: Sequence[Token], isa: Isa, symbols: Symbols) -> Matched:
    position = 1
    fixed: dict[str, FieldValue] = {}
    pending: list[_Pending] = []
    for index, part in enumerate(form.tokens):
        token = tokens[position]
        if isinstance(part, str):
            if token.text != part:
                raise _MismatchError(position, f"'{part}'")
            position += 1
            continue
        operand = part.operand
        if operand.kind in {"register", "condition", "choice"}:
            value = _single(operand, token, isa, symbols)
            if value is None:
                raise _MismatchError(position, describe(operand, isa))
            fixed[part.name] = value
            position += 1
            continue
        after = form.tokens[index + 1] if index + 1 < len(form.tokens) else None
        end = _expression_end(
            tokens, position, str(after) if after else None, symbols, operand, isa
        )
        pending.append(_Pending(part, tokens[position:end], tokens[end]))
        position = end
    if tokens[position].kind is not Kind.END:
        raise _MismatchError(position, "the end of the line")
    return Matched(form, fixed, tuple(pending))


def _single(operand: Operand, token: Token, isa: Isa, symbols: Symbols) -> FieldValue | None:
    if operand.kind == "register":
        return symbols.register(token)
    if token.kind is not Kind.NAME:
        return None
    if operand.kind == "condition":
        name = token.text.upper()
        return name if name in isa.condition_names else None
    name = token.text.lower()
    return name if name in operand.choices else None


def _expression_end(
    tokens: Sequence[Token],
    start: int,
    after: str | None,
    symbols: Symbols,
    operand: Operand,
    isa: Isa,
) -> int:
    """Index of the token that ends the expression from `start` on."""
    depth = 0
    position = start
    while tokens[position].kind is not Kind.END:
        token = tokens[position]
        if depth == 0 and token.text in {after, ",", "]"}:
            break
        if symbols.register(token) is not None or token.text in {"#", "["}:
            raise _MismatchError(position, describe(operand, isa))
        if token.kind is Kind.SIGN:
            depth += (token.text == "(") - (token.text == ")")
        # Two values side by side cannot be one expression: the second one is too much.
        if position > start and _is_value(token) and _ends_value(tokens[position - 1]):
            raise _MismatchError(position, f"'{after}'" if after else "the end of the line")
        position += 1
    if position == start:
        raise _MismatchError(position, describe(operand, isa))
    return position


def _is_value(token: Token) -> bool:
    return token.kind in {Kind.NUMBER, Kind.NAME, Kind.DOTTED, Kind.STRING}


def _ends_value(token: Token) -> bool:
    return _is_value(token) or token.text == ")"


def describe(operand: Operand, isa: Isa) -> str:
    """How a message calls what may stand in the place of an operand."""
    match operand.kind:
        case "register":
            return "a register"
        case "condition":
            return f"a condition ({', '.join(isa.conditions)})"
        case "choice":
            return " or ".join(operand.choices)
        case "label":
            return "a label"
    if operand.step > 1:
        steps = range(operand.least, operand.most + 1, operand.step)
        return f"a {operand.name} ({', '.join(map(str, steps))})"
    return f"a number from {operand.least} to {operand.most}"


def _blame(
    token: Token, expected: list[str], isa: Isa, symbols: Symbols, tokens: Sequence[Token]
) -> SourceError:
    wanted = " or ".join([", ".join(expected[:-1]), expected[-1]][len(expected) == 1 :])
    suggestion = None
    is_value = token.kind is Kind.NUMBER or token.text in OPERATORS or token.kind is Kind.NAME
    if any(item.startswith("a condition") for item in expected):
        suggestion = did_you_mean(token.text, isa.condition_names)
    elif "'#'" in expected and is_value and symbols.register(token) is None:
        rest = "".join(item.text for item in tokens if item.column >= token.column)
        suggestion = f"a constant begins with #: #{rest}"
    elif token.text == "#":
        suggestion = "this operand is written without #"
    elif token.kind is Kind.NAME:
        choices = [name for name in " ".join(expected).split(" or ") if name.isalpha()]
        suggestion = did_you_mean(token.text, choices)
    return SourceError(
        "NP005", f"expected {wanted}, found {token.shown()}", token.span, suggestion=suggestion
    )


def _check_range(item: _Pending, number: int, isa: Isa) -> None:
    operand = item.slot.operand
    span = item.tokens[0].span
    if operand.kind == "label":
        if not 0 <= number < 1 << item.slot.width:
            limit = (1 << item.slot.width) - 1
            raise SourceError(
                "NP006", f"expected an address from 0 to {limit}, found {number}", span
            )
        return
    if operand.wraps and -128 <= number < 0:
        return
    if operand.least <= number <= operand.most and number % operand.step == 0:
        return
    suggestion = None
    if operand.step > 1 and 0 < number <= operand.most // operand.step:
        suggestion = f"bank {number} begins at {number * operand.step}"
    elif operand.wraps and not operand.least <= number <= operand.most:
        suggestion = f"the low 8 bits are {number & 0xFF}; write & 0xFF if that is meant"
    raise SourceError(
        "NP006", f"expected {describe(operand, isa)}, found {number}", span, suggestion=suggestion
    )
