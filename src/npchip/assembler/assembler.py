"""Source text to `Program`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType
from typing import ParamSpec, TypeVar

from npchip.assembler.diagnostics import (
    AssemblyError,
    Diagnostic,
    FollowUpError,
    Line,
    Note,
    SourceError,
    Span,
    TooManyErrors,
)
from npchip.assembler.expander import Expander
from npchip.assembler.expansion import Expansion, Statement, with_backtrace
from npchip.assembler.lexer import Kind
from npchip.assembler.operands import Matcher, raw_word
from npchip.assembler.sources import MAX_BYTES, SourceFile, Sources, read_source
from npchip.assembler.symbols import Symbols
from npchip.assembler.warn import Assembled, find_warnings
from npchip.base.errors import InputError
from npchip.isa import Decoded, Isa, load_isa
from npchip.machine import Machine, load_machine
from npchip.program.checks import mask_depths
from npchip.program.graph import Graph, TooManyPlacesError
from npchip.program.model import Program, SourceLine
from npchip.program.routines import find_routines

_P = ParamSpec("_P")
_T = TypeVar("_T")

MAX_ERRORS = 100


def assemble(
    path: str | Path,
    machine: str | Path | Machine = "default",
    defines: Mapping[str, int] | None = None,
    isa: Isa | None = None,
    *,
    include_paths: Sequence[str | Path] = (),
    on_warning: Callable[[Diagnostic], None] | None = None,
) -> Program:
    """Assemble a source file.

    Args:
        path: the ``.s`` file, UTF-8.
        machine: whose geometry is predefined and whose ROM the program must fit.
        defines: values that take the place of ``.equ`` constants of the same name.
        isa: instruction set; the built-in one if not given.
        include_paths: folders from which ``.include`` may take files, besides the source's own.
        on_warning: is called with each warning, such as ``print``; only for a right program.

    Raises:
        InputError: the file cannot be read (NP025), the machine is unknown, or a name to
            define is no constant of the source (NP026).
        AssemblyError: mistakes in the source; carries all of them.
    """
    file = Path(path)
    text = read_source(file)
    assembly = _Assembly(isa or load_isa(), load_machine(machine), defines or {}, include_paths)
    program = assembly.assemble(text, str(file), file.resolve(), file.stem)
    assembly.warn(on_warning)
    return program


def assemble_text(
    text: str,
    file: str = "<text>",
    machine: str | Path | Machine = "default",
    defines: Mapping[str, int] | None = None,
    isa: Isa | None = None,
    *,
    name: str = "program",
    include_paths: Sequence[str | Path] = (),
    on_warning: Callable[[Diagnostic], None] | None = None,
) -> Program:
    """Assemble a source text.

    Args:
        text: the source.
        file: how messages call it; it need not exist.
        machine: as for `assemble`, and so are the others.
        defines: ...
        isa: ...
        name: the program's name.
        include_paths: the only folders from which ``.include`` may take files.
        on_warning: ...

    Raises:
        InputError: as for `assemble`; also a text that is longer than a source file may be.
        AssemblyError: mistakes in the source.
    """
    if len(text) > MAX_BYTES:
        raise InputError("NP025", f"{file}: more than {MAX_BYTES >> 10} KiB: this is no program")
    assembly = _Assembly(isa or load_isa(), load_machine(machine), defines or {}, include_paths)
    program = assembly.assemble(text, file, None, name)
    assembly.warn(on_warning)
    return program


class _Assembly:
    def __init__(
        self,
        isa: Isa,
        machine: Machine,
        defines: Mapping[str, int],
        include_paths: Sequence[str | Path],
    ) -> None:
        self._isa = isa
        self._machine = machine
        predefined = {
            "NP_ROWS": machine.np_rows,
            "NP_COLS": machine.np_cols,
            "ROWS": machine.rows,
            "COLS": machine.cols,
        }
        self._symbols = Symbols(predefined, defines)
        self._sources = Sources(tuple(map(Path, include_paths)))
        self._expander = Expander(self._symbols, self._sources, isa.forms, self._report)
        self._diagnostics: dict[tuple[str, str, Span | None], Diagnostic] = {}
        self._again: dict[tuple[str, str, Span | None], list[Span]] = {}
        self._code: list[Decoded | None] = []  # with the forms that are written

    def assemble(self, text: str, file: str, path: Path | None, name: str) -> Program:
        try:
            words = self._words(self._sources.add(text, file, path, self._report))
        except TooManyErrors:
            raise AssemblyError(self._sorted(), stopped=True) from None
        if self._diagnostics:
            raise AssemblyError(self._sorted())
        self._check_defines(file)
        declared = self._expander.declarations
        self._program = Program(
            name=name,
            words=tuple(words),
            source=tuple(map(_source, self._expander.statements)),
            labels=MappingProxyType({key: at for key, (at, _) in self._symbols.labels.items()}),
            symbols=MappingProxyType(self._symbols.constants()),
            registers=MappingProxyType(
                {key: number for key, (number, _) in self._symbols.registers.items()}
            ),
            outputs=tuple(declared.outputs),
            budget=declared.budget,
            loops=MappingProxyType(dict(declared.loops)),
            geometry=self._machine.geometry,
        )
        return self._program

    def warn(self, on_warning: Callable[[Diagnostic], None] | None) -> None:
        """Pass on the warnings about the program that was assembled."""
        if on_warning is None:
            return
        graph = None
        with suppress(TooManyPlacesError):
            graph = Graph(self._program.decoded(self._isa), self._machine)
        routines = find_routines(self._code, self._machine.mask_depth)
        program = Assembled(self._expander, self._code, routines, self._machine, self._isa, graph)
        for item in sorted(find_warnings(program), key=self._order):
            on_warning(item)

    def _words(self, file: SourceFile) -> list[int]:
        self._expander.expand(file)
        self._symbols.complete = True
        # Every instruction is one word, so an address is an index and labels are placed already.
        matcher = Matcher(self._isa, self._symbols)
        coded = [self._instruction(item, matcher) for item in self._expander.statements]
        self._code = [decoded for decoded, _ in coded]
        for constant in self._symbols.waiting():
            self._guard(None, self._symbols.settle, constant)
        if not self._symbols.doubtful:
            self._check_size(file)
        if self._expander.intact:
            self._check_masks()
        if self._diagnostics:
            return []
        return [word for _, word in coded]

    def _instruction(self, item: Statement, matcher: Matcher) -> tuple[Decoded | None, int]:
        """What a statement stands for and its word; of a wrong one what is known, and 0."""
        first, last = item.tokens[0], item.tokens[-1]
        if first.kind is Kind.DOTTED:
            word = self._guard(item, raw_word, item.tokens, self._symbols)
            return (None, 0) if word is None else (self._isa.decode(word), word)
        forms = self._isa.forms.get(first.text.upper())
        if forms is None:
            return None, 0  # reported
        found = None
        if last.kind is not Kind.BROKEN:
            found = self._guard(item, matcher.match, item.tokens, forms)
        if found is None:
            return Decoded(forms[0], {}), 0  # all its forms have the same effect on the flow
        values = dict(found.fixed)
        for pending in found.pending:
            value = self._guard(item, found.value, pending, self._symbols, self._isa)
            if value is not None:
                values[pending.slot.name] = value
        is_whole = len(values) == len(found.form.slots)
        word = self._isa.encode(found.form, values) if is_whole else 0
        return Decoded(found.form, values), word

    # ---- mistakes

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
            first = item.tokens[0] if item else None
            expansion = item.expansion if item else None
            self._report(with_backtrace(error.diagnostic, first, expansion))
        except FollowUpError:
            pass
        return None

    def _report(self, diagnostic: Diagnostic) -> None:
        """Note a mistake, once: a macro's body and an unknown name may be used many times."""
        span = None if diagnostic.code == "NP007" else diagnostic.span
        key = (diagnostic.code, diagnostic.message, span)
        if key in self._diagnostics:
            self._again.setdefault(key, []).append(diagnostic.span)
            return
        if len(self._diagnostics) >= MAX_ERRORS:
            raise TooManyErrors
        self._diagnostics[key] = diagnostic

    def _sorted(self) -> list[Diagnostic]:
        """The mistakes in the order of the source."""
        told: list[Diagnostic] = []
        for key, diagnostic in self._diagnostics.items():
            spans = self._again.get(key, []) if key[2] is None else []
            lines = dict.fromkeys(span.line.number for span in spans)
            lines.pop(diagnostic.span.line.number, None)
            if lines:
                shown = ", ".join(map(str, list(lines)[:8])) + ", ..." * (len(lines) > 8)
                where = f"also in line{'s' * (len(lines) > 1)} {shown}"
                diagnostic = diagnostic.with_notes([Note(where)])  # noqa: PLW2901 - the same one
            told.append(diagnostic)
        return sorted(told, key=self._order)

    def _order(self, diagnostic: Diagnostic) -> tuple[int, int, int]:
        span = diagnostic.span
        return self._sources.order[span.line.file], span.line.number, span.column

    # ---- checks of the whole program

    def _check_size(self, file: SourceFile) -> None:
        statements = self._expander.statements
        size, room = len(statements), self._machine.rom_words
        declared = self._expander.declarations
        if size > room:
            message = f"the program has {size} words: {size - room} more than the ROM's {room}"
            self._report_at(statements[room], "NP018", message, None)
        budget = declared.budget.words
        if budget is not None and size > budget:
            message = f"the program has {size} words: {size - budget} more than its budget"
            span = declared.budget_spans["words"]
            self._report(Diagnostic("error", "NP019", message, span))
        if not statements and not self._diagnostics:
            span = Span(file.first, 0)
            self._report(Diagnostic("error", "NP024", "the source has no instructions", span))

    def _check_masks(self) -> None:
        statements = self._expander.statements
        _, faults = mask_depths(self._code, self._machine.mask_depth)
        for fault in faults:
            notes: tuple[Note, ...] = ()
            if fault.other is not None and fault.other >= 0:
                notes = (Note(fault.remark, statements[fault.other].tokens[0].span),)
            item = statements[fault.address]
            self._report_at(item, fault.code, fault.message, fault.hint, notes)

    def _report_at(
        self,
        item: Statement,
        code: str,
        message: str,
        hint: str | None,
        notes: tuple[Note, ...] = (),
    ) -> None:
        first = item.tokens[0]
        diagnostic = Diagnostic("error", code, message, first.span, notes, hint)
        self._report(with_backtrace(diagnostic, first, item.expansion))

    def _check_defines(self, file: str) -> None:
        for name, near in self._symbols.unknown_overrides():
            raise InputError(
                "NP026",
                f"{file} has no .equ constant '{name}' to define",
                hint=near or "the constants that can be defined are those of .equ lines",
            )


def _source(item: Statement) -> SourceLine:
    return _line(item.tokens[0].line, item.expansion)


def _line(line: Line, expansion: Expansion | None) -> SourceLine:
    # A line of an included file is written there, and not where the file is included.
    outer = None
    if expansion is not None and expansion.generates:
        outer = _line(expansion.at.line, expansion.outer)
    return SourceLine(line.file, line.number, line.text, outer)
