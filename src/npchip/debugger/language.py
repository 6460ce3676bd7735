"""The parser of the debugger's language: conditions, quantities, places and numbers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import PurePath
from typing import Final, TypeVar

from npchip.assembler.diagnostics import Line, SourceError, Span, did_you_mean, quoted
from npchip.assembler.expressions import COMPARISONS, Op
from npchip.assembler.lexer import Kind, Syntax, Token, token_pattern
from npchip.assembler.reader import LineReader
from npchip.base.errors import NpchipError
from npchip.debugger.conditions import Changes, Compare, Condition, MaskEmpty, Sent, Test
from npchip.debugger.names import Names
from npchip.debugger.values import COUNTERS, Cell, Counter, Location, One, Pixel, Quantity
from npchip.program.model import PORTS

_T = TypeVar("_T")

_SHARED: Final = ("mem", "active", "Z", "C")
_KEYWORDS: Final = ("any", "all", "np", "pixel", "mask", "output", "line", *_SHARED)
_CELLS: Final = (*_SHARED, *(f"r{number}" for number in range(16)))
_SYNTAX: Final = Syntax(
    token_pattern(r"==|!=|<=|>=|[-+*=<>()\[\],.:]", name=r"[A-Za-z_.][\w./]*", comment=";#"),
    "NP350",
    "NP350",
)


class CommandError(NpchipError):
    """A condition or command that cannot be read.

    Attributes:
        diagnostic: the message, with its place in the line.
    """

    def __init__(self, fault: SourceError) -> None:
        found = fault.diagnostic
        super().__init__(found.code, found.message, hint=found.suggestion)
        self.diagnostic = found

    def __str__(self) -> str:
        return str(self.diagnostic)


@contextmanager
def understanding() -> Iterator[None]:
    """Turn a `SourceError` into a `CommandError`."""
    try:
        yield
    except SourceError as fault:
        raise CommandError(fault) from None


class Reader(LineReader):
    """Reads one line from left to right.

    Args:
        line: the line; messages show it.
        names: the names that it may use.

    Raises:
        SourceError: from every method. NP350, something else was expected; NP351, a name, place
            or number that the program does not have.
    """

    def __init__(self, line: Line, names: Names) -> None:
        super().__init__(line, _SYNTAX)
        self._names = names

    def again(self) -> Reader:
        """Return a reader of the same line, after its first word."""
        reader = Reader(self._line, self._names)
        reader.take()
        return reader

    # ---- conditions

    def condition(self) -> Condition:
        """Read ``PLACE [if TEST]``, ``TEST``, ``VALUE changes`` or ``output PORT [op NUMBER]``."""
        text = self.rest()
        if self.peek().ends:
            raise self.wrong("a place or a condition")
        writers = self._names.writers
        if self.accept("output"):
            sent = self._sent()
            return Condition(text, event=sent, triggers=writers.sends_to(sent.port))
        if self._place_comes():
            places = frozenset(self.place())
            test = self.test() if self.accept("if") else None
            if test is None and not self.peek().ends:
                raise self.wrong("'if' or the end of the line", ["if"])
            return Condition(text, places, test)
        if self.peek().text in {"any", "all", "mask"}:
            test = self.test()
            return Condition(text, test=test, triggers=writers.of(test.value))
        value = self.value()
        triggers = writers.of(value)
        if self.accept("changes"):
            return Condition(text, event=Changes(value), triggers=triggers)
        return Condition(text, test=self._comparison(value), triggers=triggers)

    def _place_comes(self) -> bool:
        token, after = self.peek(), self.peek(1)
        if token.kind in (Kind.NUMBER, Kind.STRING) or token.text == "line" or after.text == ":":
            return True
        if token.kind is not Kind.NAME or token.text in {"any", "all", "mask", "np", "pixel"}:
            return False
        if token.text in self._names.program.labels:
            return after.text not in {*COMPARISONS, "changes", "="}
        return after.ends or after.text in {"if", "+"}

    def _sent(self) -> Sent:
        token = self.peek()
        outputs = {output.name: output.port for output in self._names.program.outputs}
        if token.kind is Kind.NAME:
            if token.text not in outputs:
                hint = f"outputs: {', '.join(outputs) or 'none'}"
                raise self.unknown_name("the program has no output", token, outputs, hint)
            self.take()
            port = outputs[token.text]
        else:
            port = self.number("a port or the name of an output", PORTS - 1)
        if self.peek().ends:
            return Sent(port)
        return Sent(port, self.operation(), self.number())

    def test(self) -> Test:
        """Read ``[any|all] VALUE op NUMBER`` or ``mask empty``."""
        if self.accept("mask"):
            if not self.accept("empty"):
                raise self.wrong("'empty'", ["empty"])
            return MaskEmpty()
        quantifier = self.accept("any", "all")
        if quantifier is None:
            return self._comparison(self.value())
        token = self.peek()
        cell = self.value()
        if not isinstance(cell, Cell):
            raise self.unknown(
                f"'{quantifier}' asks all NPs, but {cell} is one number", token, "leave it out"
            )
        return Compare(cell, self.operation(), self.number(), quantifier)  # type: ignore[arg-type]

    def _comparison(self, value: Quantity) -> Compare:
        if isinstance(value, Cell):
            token = self.peek()
            text = f"{value} {token.text} ...".replace("  ", " ")
            raise self.wrong(
                "'changes'",
                ["changes"],
                f"every NP has one: any {text}, all {text} or np(0,0).{text}"
                if token.text in COMPARISONS
                else None,
            )
        return Compare(value, self.operation(), self.number())

    def operation(self) -> Op:
        """Read a comparison sign."""
        token = self.peek()
        if token.text not in COMPARISONS:
            hint = "did you mean ==?" if token.text == "=" else None
            raise self.wrong(f"one of {' '.join(COMPARISONS)}", ["changes"], hint)
        self.take()
        return token.text  # type: ignore[return-value]

    # ---- places of the program

    def place(self) -> list[int]:
        """Read a label with or without ``+ N``, ``FILE:LINE``, ``line N``, or an address."""
        token, after = self.peek(), self.peek(1)
        if self.accept("line"):
            return self._lines(self.peek().span, "", self._plain_number())
        if after.text == ":":
            self.take()
            self.take()
            return self._lines(token.span, token.text.strip('"'), self._plain_number())
        words, labels = len(self._names.program.words), self._names.program.labels
        if token.kind is Kind.NUMBER:
            address = self.number("an address")
        elif token.text in labels:
            self.take()
            address = labels[token.text]
            if self.accept("+"):
                address += self.number("how many instructions further")
        else:
            if token.kind is not Kind.NAME:
                raise self.wrong("a label, FILE:LINE, line N or an address")
            raise self.unknown_name("no label", token, [*labels, *_KEYWORDS])
        if address >= words:
            raise self.unknown(f"address {address}: the program ends at {words - 1}", token)
        return [address]

    def _plain_number(self) -> int:
        token = self.peek()
        if token.kind is not Kind.NUMBER or not token.text.isdecimal():
            raise self.wrong("the number of a line")
        self.take()
        return int(token.text)

    def _lines(self, span: Span, file: str, number: int) -> list[int]:
        source = self._names.program.source
        if not source:
            raise SourceError("NP351", "the program has no source: name an address", span)
        known = self._names.files_called(file) if file else [self._names.main_file]
        if not known:
            names = [PurePath(name).name for name in self._names.files]
            hint = did_you_mean(file, names) or f"files: {', '.join(names)}"
            raise SourceError("NP351", f"no source file {quoted(file)}", span, suggestion=hint)
        if len(known) > 1:
            message = f"{len(known)} source files are called {quoted(file)}"
            raise SourceError("NP351", message, span, suggestion=" or ".join(known[:4]))
        name = known[0]
        lines = self._names.lines(name)
        below = [line for line in lines if line >= number]
        if not below:
            raise SourceError("NP351", f"{name} has no instruction below line {lines[-1]}", span)
        return self._names.line_starts(name, below[0])

    # ---- values

    def value(self) -> Quantity:
        """Read ``np(R,C).CELL``, ``CELL``, ``pixel(R,C[,BANK])`` or a counter."""
        token = self.peek()
        if token.text == "np" and self.peek(1).text == "(":
            row, column = self.processor()
            self.first_sign(".")
            return One(self.cell(), row, column)
        if token.text == "pixel" and self.peek(1).text == "(":
            return self._pixel()
        is_register = token.text in self._names.program.registers
        if token.text in COUNTERS and not is_register:
            self.take()
            return Counter(token.text)
        return self.cell()

    def location(self) -> Location:
        """Read a register, flag or byte of one NP, or a pixel."""
        token = self.peek()
        value = self.value()
        if isinstance(value, Pixel):
            return value
        if isinstance(value, One) and value.cell.kind != "active":
            return value
        hint = f"name the NP: np(0,0).{value}" if isinstance(value, Cell) else None
        raise self.unknown(f"{value} is not a register, flag, byte or pixel of one NP", token, hint)

    def processor(self) -> tuple[int, int]:
        """Read ``np(ROW,COLUMN)``."""
        if not self.accept("np"):
            raise self.wrong("np(ROW,COLUMN)")
        pair = self._pair(self._names.machine.geometry, "NP")
        self.sign(")")
        return pair

    def _pair(self, shape: tuple[int, int], what: str) -> tuple[int, int]:
        self.sign("(")
        row = self.number(f"the {what}'s row", shape[0] - 1)
        self.sign(",")
        return row, self.number(f"the {what}'s column", shape[1] - 1)

    def _pixel(self) -> Quantity:
        self.take()
        machine = self._names.machine
        row, column = self._pair((machine.rows, machine.cols), "pixel")
        if not self.accept(","):
            self.sign(")")
            return Pixel(row, column)
        token = self.peek()
        bank = self.number("the first byte of a bank", machine.memory_bytes - 1)
        if bank % 64:
            raise self.unknown(
                f"{bank} is not the first byte of a bank", token, "0, 64, 128 or 192"
            )
        self.sign(")")
        return One(Cell("memory", bank + 8 * (row % 8) + column % 8), row // 8, column // 8)

    def cell(self) -> Cell:
        """Read a register by number or name, ``Z``, ``C``, ``mem[ADDRESS]`` or ``active``."""
        token = self.peek()
        registers = self._names.program.registers
        number = registers.get(token.text)
        if number is None and re.fullmatch(r"[rR]\d{1,2}", token.text):
            number = int(token.text[1:])
            if number > 15:
                raise self.unknown(f"no register {quoted(token.text)}", token, "they are r0 to r15")
        if number is not None:
            self.take()
            return Cell("register", number)
        if self.accept("mem"):
            self.sign("[")
            address = self.number("an address", self._names.machine.memory_bytes - 1)
            self.sign("]")
            return Cell("memory", address)
        if self.accept("active"):
            return Cell("active")
        flag = self.accept("Z", "C")
        if flag:
            return Cell("flag", flag)
        if token.kind is not Kind.NAME:
            raise self.wrong("a register, Z, C, mem[ADDRESS], np(R,C)., pixel(R,C) or a counter")
        before = self._tokens[self._at - 1].text if self._at else ""
        known = [*registers, *_CELLS]
        if before != ".":
            known += [*COUNTERS, *_KEYWORDS, *self._names.program.labels]
        raise self.unknown_name("no register or label", token, known)

    # ---- numbers

    def number(self, what: str = "a number", most: int | None = None) -> int:
        """Read a number, constant or label, or a sum or product of these, from 0 to `most`."""
        first = self.peek()
        value = self.expression(what, self._value_of)
        if most is not None and not 0 <= value <= most:
            raise self.unknown(f"expected {what} from 0 to {most}, found {value}", first)
        return value

    def _value_of(self, token: Token) -> int:
        program = self._names.program
        known = {**program.symbols, **program.labels}
        if token.text not in known:
            raise self.unknown_name("no constant or label", token, known)
        return known[token.text]

    def unknown(self, message: str, token: Token, hint: str | None = None) -> SourceError:
        """Return the error for something that the program does not have."""
        return SourceError("NP351", message, token.span, suggestion=hint)

    def unknown_name(
        self, what: str, token: Token, known: Iterable[str], otherwise: str | None = None
    ) -> SourceError:
        """Return the error for an unknown name; the hint is a near one, or `otherwise`."""
        hint = did_you_mean(token.text, known) or otherwise
        return self.unknown(f"{what} {quoted(token.text)}", token, hint)


def parse_condition(text: str, names: Names, file: str = "condition", number: int = 1) -> Condition:
    """Read a condition. Messages give its place as `file` and line `number`.

    Raises:
        CommandError: NP350, NP351.
    """
    return _parse(Reader.condition, Line(file, number, text), names)


def parse_test(text: str, names: Names) -> Test:
    """Read what may follow ``if`` in a condition; errors as for `parse_condition`."""
    return _parse(Reader.test, Line("test", 1, text), names)


def parse_value(text: str, names: Names) -> Quantity:
    """Read a quantity; errors as for `parse_condition`."""
    return _parse(Reader.value, Line("value", 1, text), names)


def parse_number(text: str, names: Names) -> int:
    """Read a number, constant or label, or a sum or product; errors as for `parse_condition`."""
    return _parse(Reader.number, Line("number", 1, text), names)


def _parse(read: Callable[[Reader], _T], line: Line, names: Names) -> _T:
    with understanding():
        reader = Reader(line, names)
        found = read(reader)
        reader.end()
    return found
