"""One-line directives: names, outputs, places, budgets, loops, requirements, memory, errors."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from npchip.assembler.diagnostics import Note, SourceError, Span, did_you_mean, quoted
from npchip.assembler.lexer import Kind, Token
from npchip.assembler.macros import comma_hint, expected, is_empty, number, single_name, split
from npchip.assembler.requirements import HINT, folded, unmet
from npchip.assembler.symbols import ONCE, Symbols
from npchip.program.model import (
    MAX_AHEAD,
    OUTPUT_FORMS,
    OUTPUT_KINDS,
    PORTS,
    Budget,
    Initial,
    Output,
    Position,
    Requirement,
)


class Declarations:
    """The declarations of a source.

    Args:
        symbols: the table of names.
        find: returns where the file lies that a token names.

    Attributes:
        outputs: outputs, in the order of the source.
        output_spans: place of each output name and each port.
        positions: the outputs that are a place.
        position_spans: place of each position, by its frames ahead.
        budget: limits that the source sets itself.
        budget_spans: place of each limit.
        loops: least and most passes of loops, by the address of their first instruction.
        loop_spans: place of each of these bounds.
        requirements: conditions on the machine.
        memory: what the NPs' memories hold before a run.
        memory_spans: place of each of these addresses.
    """

    def __init__(self, symbols: Symbols, find: Callable[[str, Token], Path]) -> None:
        self.symbols = symbols
        self._find = find
        self.outputs: list[Output] = []
        self.output_spans: dict[str | int, Span] = {}
        self.positions: list[Position] = []
        self.position_spans: dict[int, Span] = {}
        self.budget = Budget()
        self.budget_spans: dict[str, Span] = {}
        self.loops: dict[int, tuple[int, int]] = {}
        self.loop_spans: dict[int, Span] = {}
        self.requirements: list[Requirement] = []
        self.memory: list[Initial] = []
        self.memory_spans: dict[int, Span] = {}

    def execute(self, word: str, tokens: list[Token], address: int) -> None:
        """Execute one of `npchip.assembler.blocks.SIMPLE` other than ``.include`` and ``.word``.

        Args:
            word: the directive, in lower case.
            tokens: the line, from the directive on.
            address: the address of the next instruction.

        Raises:
            SourceError: NP011 wrong arguments, NP006 out of range, NP008 declared before, NP031 an
                ``.error``, NP032 a ``.require`` that does not hold, NP033 a ``.position`` of what
                is no output, NP027 or NP028 a file that cannot be named, or an error in an
                expression.
        """
        match word:
            case ".equ":
                self._equ(tokens)
            case ".reg":
                self._reg(tokens)
            case ".output":
                self._output(tokens)
            case ".position":
                self._position(tokens)
            case ".budget":
                self._budget(tokens)
            case ".loop":
                self._loop(tokens, address)
            case ".require":
                self._require(tokens)
            case ".memory":
                self._memory(tokens)
            case ".error":
                message = string(tokens, '.error "MESSAGE"')
                raise SourceError("NP031", message, tokens[0].span)

    def _equ(self, tokens: list[Token]) -> None:
        name, value = _pair(tokens, ".equ NAME, VALUE")
        self.symbols.define_constant(single_name(name), value, tokens[-1])

    def _reg(self, tokens: list[Token]) -> None:
        name, value = _pair(tokens, ".reg NAME, REGISTER")
        register = self.symbols.register(value[0]) if len(value) == 1 else None
        if register is None:
            raise expected("a register, r0 to r15", value[0])
        self.symbols.define_register(single_name(name), register)

    def define_wrong(self, tokens: list[Token]) -> None:
        """Define the name of a wrong ``.equ`` or ``.reg``, so that its uses are not reported."""
        name = tokens[1]
        if name.kind is not Kind.NAME or self.symbols.knows(name.text):
            return
        if tokens[0].text.lower() == ".reg":
            self.symbols.define_register(name, 0)  # any, so that the other operands are checked
        elif tokens[0].text.lower() == ".equ":
            self.symbols.define_broken(name)

    def _output(self, tokens: list[Token]) -> None:
        arguments = split(tokens[1:])
        if len(arguments) != 3:
            raise usage(tokens, ".output NAME, PORT, KIND")
        name = single_name(arguments[0])
        if arguments[1][0].text in OUTPUT_KINDS:
            order = "the order is .output NAME, PORT, KIND"
            raise expected("a port", arguments[1][0], hint=order)
        port = number(arguments[1], tokens, self.symbols.value)
        if not 0 <= port < PORTS:
            message = f"expected a port from 0 to {PORTS - 1}, found {port}"
            raise SourceError("NP006", message, arguments[1][0].span)
        kind = arguments[2][0]
        if kind.text not in OUTPUT_KINDS or len(arguments[2]) != 1:
            hint = did_you_mean(kind.text, OUTPUT_KINDS)
            raise expected(f"one of {', '.join(OUTPUT_KINDS)}", kind, hint=hint)
        for key, at in ((name.text, name), (port, arguments[1][0])):
            if key in self.output_spans:
                what = f"the output {quoted(key)}" if isinstance(key, str) else f"port {key}"
                first = self.output_spans[key]
                note = Note("first declared here", first)
                hint = ONCE if at.span == first else None
                message = f"{what} is declared twice"
                raise SourceError("NP008", message, at.span, note, suggestion=hint)
        self.output_spans |= {name.text: name.span, port: arguments[1][0].span}
        self.outputs.append(Output(name.text, port, kind.text))

    def _position(self, tokens: list[Token]) -> None:
        arguments = split(tokens[1:])
        if len(arguments) not in {2, 3} or any(map(is_empty, arguments)):
            raise usage(tokens, ".position ROW, COLUMN or .position ROW, COLUMN, AHEAD")
        row, col = map(single_name, arguments[:2])
        for name in (row, col):
            self._check_place(name)
        if row.text == col.text:
            raise SourceError("NP033", "row and column are the same output", col.span)
        ahead = number(arguments[2], tokens, self.symbols.value) if len(arguments) == 3 else 0
        if not 0 <= ahead <= MAX_AHEAD:
            message = f"expected frames ahead from 0 to {MAX_AHEAD}, found {ahead}"
            raise SourceError("NP006", message, arguments[2][0].span)
        if ahead in self.position_spans:
            note = Note("first declared here", self.position_spans[ahead])
            message = f"the place {ahead} frames ahead is declared twice"
            raise SourceError("NP008", message, tokens[0].span, note)
        self.position_spans[ahead] = tokens[0].span
        self.positions.append(Position(row.text, col.text, ahead))

    def _check_place(self, name: Token) -> None:
        """Refuse the name of what is no output, or one that is no number."""
        kinds = {output.name: output.kind for output in self.outputs}
        if name.text not in kinds:
            hint = did_you_mean(name.text, kinds) or "declare it above with .output"
            message = f"no output is called {quoted(name.text)}"
            raise SourceError("NP033", message, name.span, suggestion=hint)
        if OUTPUT_FORMS[kinds[name.text]] != "integer":
            message = f"{quoted(name.text)} is a {kinds[name.text]}, a place needs scalars"
            note = Note("declared here", self.output_spans[name.text])
            raise SourceError("NP033", message, name.span, note)

    def _budget(self, tokens: list[Token]) -> None:
        what = tokens[1]
        if what.text not in {"words", "cycles"}:
            hint = did_you_mean(what.text, ("words", "cycles"))
            if what.kind is Kind.NUMBER:
                hint = "say of what: .budget words N or .budget cycles N"
            raise expected("words or cycles", what, hint=hint)
        limit = number(tokens[2:-1] or [tokens[-1]], tokens, self.symbols.value)
        if limit < 0:
            raise SourceError("NP006", f"expected a limit from 0, found {limit}", tokens[2].span)
        if what.text in self.budget_spans:
            first = self.budget_spans[what.text]
            hint = ONCE if what.span == first else None
            message = f"the budget of {what.text} is given twice"
            note = Note("first given here", first)
            raise SourceError("NP008", message, what.span, note, suggestion=hint)
        self.budget_spans[what.text] = what.span
        self.budget = self.budget._replace(**{what.text: limit})

    def _loop(self, tokens: list[Token], address: int) -> None:
        arguments = split(tokens[1:])
        if len(arguments) not in {1, 2} or any(map(is_empty, arguments)):
            raise usage(tokens, ".loop MOST or .loop LEAST, MOST")
        passes = [number(argument, tokens, self.symbols.value) for argument in arguments]
        least, most = passes if len(passes) == 2 else (1, passes[0])
        if not 1 <= least <= most:
            found = f"found {least}, {most}" if len(passes) == 2 else f"found {most}"
            message = f"expected passes from 1 on, the least first, {found}"
            raise SourceError("NP006", message, arguments[0][0].span)
        if address in self.loops:
            note = Note("first stated here", self.loop_spans[address])
            message = "the passes of this loop are stated twice"
            raise SourceError("NP008", message, tokens[0].span, note)
        self.loops[address] = least, most
        self.loop_spans[address] = tokens[0].span

    def _require(self, tokens: list[Token]) -> None:
        form = '.require CONDITION, "REASON"'
        condition, reason = _pair(tokens, form)
        if reason[0].kind is not Kind.STRING or len(reason) != 1:
            raise expected("a string", reason[-1], hint=f"write {form}")
        value, text = self.symbols.value, reason[0].text[1:-1]
        if not number(condition, tokens, value):
            message = unmet(condition, text, value)
            raise SourceError("NP032", message, tokens[0].span, suggestion=HINT)
        known = self.symbols.predefined
        if any(token.text in known for token in condition):
            self.requirements.append(Requirement(folded(condition, known, value), text))

    def _memory(self, tokens: list[Token]) -> None:
        form = '.memory ADDRESS, "FILE.npy"'
        where, file = _pair(tokens, form)
        token = file[0]
        if token.kind is not Kind.STRING or len(file) != 1:
            raise expected("a string", file[-1], hint=f"write {form}")
        address = number(where, tokens, self.symbols.value)
        if not 0 <= address <= 255:
            message = f"expected an address from 0 to 255, found {address}"
            raise SourceError("NP006", message, where[0].span)
        if address in self.memory_spans:
            note = Note("first named here", self.memory_spans[address])
            message = f"two files for the memory from {address} on"
            raise SourceError("NP008", message, where[0].span, note)
        path = self._find(token.text[1:-1], token)
        self.memory_spans[address] = where[0].span
        place = f"{token.line.file}:{token.line.number}"
        self.memory.append(Initial(address, str(path), place))


def string(tokens: list[Token], form: str) -> str:
    """Return the string that is the only argument of a directive."""
    if tokens[1].kind is not Kind.STRING:
        raise expected("a string", tokens[1], hint=f"write {form}")
    if not tokens[2].ends:
        raise expected("the end of the line", tokens[2])
    return tokens[1].text[1:-1]


def usage(tokens: list[Token], form: str) -> SourceError:
    """Make the error NP011 of a directive with another number of arguments than `form`."""
    count = len(split(tokens[1:]))
    found = {0: "nothing", 1: "1 argument"}.get(count, f"{count} arguments")
    hint = comma_hint(tokens[1:]) if count < form.count(",") + 1 else None
    at = tokens[1] if count else tokens[0]
    return SourceError("NP011", f"expected {form}, found {found}", at.span, suggestion=hint)


def _pair(tokens: list[Token], form: str) -> tuple[list[Token], list[Token]]:
    arguments = split(tokens[1:])
    if len(arguments) != 2:
        raise usage(tokens, form)
    if is_empty(arguments[1]):
        raise expected("a value", arguments[1][0])
    return arguments[0], arguments[1]
