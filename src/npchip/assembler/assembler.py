"""Source text to `Program`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import ParamSpec, TypeVar

from npchip.assembler.diagnostics import (
    AssemblyError,
    Diagnostic,
    Line,
    Note,
    SourceError,
    Span,
)
from npchip.assembler.expander import Expander, Expansion, Statement, with_backtrace
from npchip.assembler.lexer import tokenize
from npchip.assembler.masks import mask_depths
from npchip.assembler.operands import match
from npchip.assembler.symbols import Symbols
from npchip.errors import InputError
from npchip.isa import Isa, load_isa
from npchip.machine import Machine, load_machine
from npchip.program import Program, SourceLine

_P = ParamSpec("_P")
_T = TypeVar("_T")

MAX_ERRORS = 100
_MAX_BYTES = 4 << 20


def assemble(
    path: str | Path,
    machine: str | Path | Machine = "default",
    defines: Mapping[str, int] | None = None,
    isa: Isa | None = None,
) -> Program:
    """Assemble a source file.

    Args:
        path: the ``.s`` file, UTF-8.
        machine: whose geometry is predefined and whose ROM the program must fit.
        defines: values that take the place of ``.equ`` constants of the same name.
        isa: instruction set; the built-in one if not given.

    Raises:
        InputError: the file cannot be read (NP025) or the machine is unknown.
        AssemblyError: mistakes in the source; carries all of them.
    """
    file = Path(path)
    try:
        if file.stat().st_size > _MAX_BYTES:
            raise InputError("NP025", f"{file}: larger than {_MAX_BYTES >> 20} MiB: not a source")
        text = file.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError("NP025", f"cannot read {file}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise InputError(
            "NP025",
            f"{file}: not UTF-8 text (byte {error.start})",
            hint="a source is a text file, usually named .s",
        ) from None
    return assemble_text(text, str(file), machine, defines, isa, name=file.stem)


def assemble_text(
    text: str,
    file: str = "<text>",
    machine: str | Path | Machine = "default",
    defines: Mapping[str, int] | None = None,
    isa: Isa | None = None,
    *,
    name: str = "program",
) -> Program:
    """Assemble a source text; `file` is how messages call it. Otherwise as `assemble`."""
    isa = isa or load_isa()
    return _Assembly(isa, load_machine(machine), defines or {}).assemble(text, file, name)


class _Assembly:
    def __init__(self, isa: Isa, machine: Machine, defines: Mapping[str, int]) -> None:
        self._isa = isa
        self._machine = machine
        predefined = {
            "NP_ROWS": machine.np_rows,
            "NP_COLS": machine.np_cols,
            "ROWS": machine.rows,
            "COLS": machine.cols,
        }
        self._symbols = Symbols(predefined, defines)
        self._diagnostics: dict[tuple[str, str, Span], Diagnostic] = {}

    def assemble(self, text: str, file: str, name: str) -> Program:
        # Not str.splitlines: editors count line feeds only, not form feeds and the like.
        lines = [Line(file, n, t.rstrip("\r")) for n, t in enumerate(text.split("\n"), start=1)]
        tokens = [found for line in lines if (found := self._guard(None, tokenize, line))]
        expander = Expander(self._symbols, self._isa.forms, self._report)
        expander.expand(tokens)
        self._symbols.complete = True
        statements = expander.statements

        # Every instruction is one word, so an address is an index and labels are placed already.
        matched = [
            self._guard(item, match, item.tokens, self._isa, self._symbols) for item in statements
        ]
        words = [
            self._guard(item, found.word, self._symbols, self._isa) if found else None
            for item, found in zip(statements, matched, strict=True)
        ]
        for constant in self._symbols.constants():
            self._guard(None, self._symbols.value, constant)
        self._check_size(statements, expander)
        self._check_end(statements, lines)
        if not self._diagnostics:
            self._check_masks(statements, [word for word in words if word is not None])
        if self._diagnostics:
            raise AssemblyError(sorted(self._diagnostics.values(), key=_order)[:MAX_ERRORS])
        self._check_defines(file)
        return Program(
            name=name,
            words=tuple(word for word in words if word is not None),
            source=tuple(_source(item) for item in statements),
            labels=MappingProxyType({key: at for key, (at, _) in self._symbols.labels.items()}),
            symbols=MappingProxyType(
                {item.text: self._symbols.value(item) for item in self._symbols.constants()}
            ),
            outputs=tuple(expander.outputs),
            budget=expander.budget,
            geometry=self._machine.geometry,
        )

    def _guard(
        self,
        item: Statement | None,
        function: Callable[_P, _T],
        *args: _P.args,
        **kwargs: _P.kwargs,
    ) -> _T | None:
        """Call a step for one statement; a mistake is noted and the next one gets its turn."""
        try:
            return function(*args, **kwargs)
        except SourceError as error:
            self._report(with_backtrace(error.diagnostic, item.expansion if item else None))
            return None

    def _report(self, diagnostic: Diagnostic) -> None:
        # A mistake in a macro's body is one mistake, however often the macro is used.
        key = (diagnostic.code, diagnostic.message, diagnostic.span)
        self._diagnostics.setdefault(key, diagnostic)

    # ---- checks of the whole program

    def _check_size(self, statements: list[Statement], expander: Expander) -> None:
        size, room = len(statements), self._machine.rom_words
        if size > room:
            over = size - room
            self._report_at(
                statements[room],
                "NP018",
                f"the program has {size} words: {over} more than the {room} of the program ROM",
            )
        budget = expander.budget.words
        if budget is not None and size > budget and expander.budget_span:
            message = f"the program has {size} words: {size - budget} more than its budget"
            self._report(Diagnostic("error", "NP019", message, expander.budget_span))

    def _check_end(self, statements: list[Statement], lines: list[Line]) -> None:
        if not statements and not self._diagnostics:
            span = Span(lines[0], 0)
            self._report(Diagnostic("error", "NP024", "the source has no instructions", span))

    def _check_masks(self, statements: list[Statement], words: list[int]) -> None:
        _, faults = mask_depths(words, self._isa, self._machine.mask_depth)
        for fault in faults:
            notes: tuple[Note, ...] = ()
            if fault.other is not None:
                notes = (Note(fault.remark, statements[fault.other].tokens[0].span),)
            self._report_at(statements[fault.address], fault.code, fault.message, notes)

    def _report_at(
        self, item: Statement, code: str, message: str, notes: tuple[Note, ...] = ()
    ) -> None:
        diagnostic = Diagnostic("error", code, message, item.tokens[0].span, notes)
        self._report(with_backtrace(diagnostic, item.expansion))

    def _check_defines(self, file: str) -> None:
        for name, near in self._symbols.unknown_overrides():
            raise InputError(
                "NP026",
                f"{file} has no .equ constant '{name}' to define",
                hint=near or "the constants that can be defined are those of .equ lines",
            )


def _order(diagnostic: Diagnostic) -> tuple[int, int]:
    return diagnostic.span.line.number, diagnostic.span.column


def _source(item: Statement) -> SourceLine:
    return _line(item.tokens[0].line, item.expansion)


def _line(line: Line, expansion: Expansion | None) -> SourceLine:
    outer = _line(expansion.at.line, expansion.outer) if expansion else None
    return SourceLine(line.file, line.number, line.text, outer)
