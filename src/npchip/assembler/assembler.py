"""Source text to `Program`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TypeVar

from npchip import bundle
from npchip.assembler.definitions import Definition, find_definitions
from npchip.assembler.diagnostics import (
    AssemblyError,
    Diagnostic,
    Expansion,
    FollowUpError,
    Line,
    Note,
    SourceError,
    Span,
    with_backtrace,
)
from npchip.assembler.expander import Expander, Statement
from npchip.assembler.lexer import Kind
from npchip.assembler.operands import Matcher, raw_word
from npchip.assembler.requirements import CONSEQUENCES, geometry
from npchip.assembler.sources import MAX_BYTES, SourceFile, Sources, read_source
from npchip.assembler.symbols import Symbols
from npchip.assembler.warn import Assembled, find_warnings
from npchip.base.errors import InputError
from npchip.base.frozen import FrozenMap
from npchip.isa import Decoded, Isa, load_isa
from npchip.machine import Machine, load_machine
from npchip.program.checks import mask_depths
from npchip.program.graph import Graph, TooManyPlacesError
from npchip.program.model import Program, SourceLine
from npchip.program.routines import find_routines

_T = TypeVar("_T")

_MOST_LINES = 8
MAX_ERRORS = 100


def assemble(
    path: str | Path,
    machine: str | Path | Machine = "default",
    defines: Mapping[str, int] | None = None,
    isa: Isa | None = None,
    *,
    include_paths: Sequence[str | Path] = (),
    on_warning: Callable[[Diagnostic], None] | None = None,
    on_definition: Callable[[Definition], None] | None = None,
) -> Program:
    """Assemble a source file.

    Args:
        path: the ``.s`` file, UTF-8; or the name of a bundled program.
        machine: the machine; its geometry is predefined, and the program must fit its ROM.
        defines: values that replace those of the ``.equ`` constants with these names.
        isa: instruction set; the built-in one if not given.
        include_paths: folders besides the source's own from which ``.include`` may take files.
        on_warning: is called with each warning about a program without errors, such as ``print``.
        on_definition: is called with each name that a source without errors defines.

    Raises:
        InputError: NP025 the file cannot be read, NP026 a name in `defines` is no constant of the
            source, or the machine is unknown.
        AssemblyError: the source has errors.
    """
    file = bundle.find("program", path)
    text = read_source(file)
    assembly = Assembly(isa, machine, defines, include_paths)
    program = assembly.assemble(text, str(file), file.resolve(), file.stem, on_warning)
    if on_definition is not None:
        for item in find_definitions(assembly.expander):
            on_definition(item)
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
        file: the name of the source in messages; it need not exist.
        machine: as for `assemble`.
        defines: as for `assemble`.
        isa: as for `assemble`.
        name: the program's name.
        include_paths: the only folders from which ``.include`` may take files.
        on_warning: as for `assemble`.

    Raises:
        InputError: as for `assemble`; NP025 also if the text is too long.
        AssemblyError: the source has errors.
    """
    if len(text) > MAX_BYTES:
        raise InputError("NP025", f"{file}: more than {MAX_BYTES >> 10} KiB: this is no program")
    assembly = Assembly(isa, machine, defines, include_paths)
    return assembly.assemble(text, file, None, name, on_warning)


class Assembly:
    """One assembly of one source.

    Args:
        isa: as for `assemble`.
        machine: as for `assemble`.
        defines: as for `assemble`.
        include_paths: as for `assemble`.
        texts: as for `Sources`.

    Attributes:
        expander: the source expanded, as far as its errors allow.
    """

    def __init__(
        self,
        isa: Isa | None,
        machine: str | Path | Machine,
        defines: Mapping[str, int] | None,
        include_paths: Sequence[str | Path],
        texts: Mapping[Path, str] = MappingProxyType({}),
    ) -> None:
        self._isa = isa or load_isa()
        self._machine = load_machine(machine)
        self._symbols = Symbols(geometry(self._machine), defines or {})
        self._sources = Sources(tuple(map(Path, include_paths)), texts)
        self.expander = Expander(self._symbols, self._sources, self._isa.forms, self._report)
        self._diagnostics: dict[tuple[str, str, Span | None], Diagnostic] = {}
        self._again: dict[tuple[str, str, Span | None], list[Span]] = {}
        self._code: list[Decoded | None] = []  # with the forms that are written

    def assemble(
        self,
        text: str,
        file: str,
        path: Path | None,
        name: str,
        on_warning: Callable[[Diagnostic], None] | None,
    ) -> Program:
        """Assemble a text.

        Args:
            text: the source.
            file: its name in messages.
            path: the file with symbolic links resolved; None for a text that is no file.
            name: the program's name.
            on_warning: as for `assemble`.

        Raises:
            InputError: NP026, as for `assemble`.
            AssemblyError: the source has errors.
        """
        words = self._words(self._sources.add(text, file, path, self._report))
        if self._diagnostics:
            raise AssemblyError(self._sorted())
        self._check_defines(file)
        declared, symbols = self.expander.declarations, self._symbols
        lines = _SourceLines()
        program = Program(
            name=name,
            words=tuple(words),
            source=tuple(
                lines.of(item.tokens[0].line, item.expansion) for item in self.expander.statements
            ),
            labels=FrozenMap({key: at for key, (at, _) in symbols.labels.items()}),
            symbols=FrozenMap(symbols.constants()),
            registers=FrozenMap({key: at for key, (at, _) in symbols.registers.items()}),
            outputs=tuple(declared.outputs),
            budget=declared.budget,
            loops=FrozenMap(declared.loops),
            requirements=tuple(dict.fromkeys(declared.requirements)),
            positions=tuple(declared.positions),
            geometry=self._machine.geometry,
            memory=tuple(declared.memory),
        )
        if on_warning is not None:
            for item in sorted(self._warnings(program), key=self._order):
                on_warning(item)
        return program

    def _warnings(self, program: Program) -> list[Diagnostic]:
        graph = None
        with suppress(TooManyPlacesError):
            graph = Graph(program.decoded(self._isa), self._machine)
        routines = find_routines(self._code, self._machine.mask_depth)
        return find_warnings(
            Assembled(self.expander, self._code, routines, self._machine, self._isa, graph)
        )

    def _words(self, file: SourceFile) -> list[int]:
        self.expander.expand(file)
        left_out = self.expander.left_out.never_chosen() if self._sources.unread else set()
        for diagnostic, report in self._sources.unread:
            if diagnostic.span.line not in left_out:
                report(diagnostic)
        self._symbols.complete = True
        # Every instruction is one word, so an address is an index and labels are placed already.
        statements = [item.tokens for item in self.expander.statements]
        ports = {output.name: output.port for output in self.expander.declarations.outputs}
        matcher = Matcher(self._isa, self._symbols, statements, ports)
        coded = [self._instruction(item, matcher) for item in self.expander.statements]
        self._code = [decoded for decoded, _ in coded]
        for constant in self._symbols.waiting():
            self._guard(None, partial(self._symbols.evaluate_unused, constant))
        if not self._symbols.doubtful:
            self._check_size(file)
        if self.expander.intact:
            self._check_masks()
        if self._diagnostics:
            return []
        return [word for _, word in coded]

    def _instruction(self, item: Statement, matcher: Matcher) -> tuple[Decoded | None, int]:
        """Return a statement decoded, and its word; a wrong one has missing operands and word 0."""
        first, last = item.tokens[0], item.tokens[-1]
        if first.kind is Kind.DOTTED:
            word = self._guard(item, partial(raw_word, item.tokens, self._symbols))
            return (None, 0) if word is None else (self._isa.decode(word), word)
        forms = self._isa.forms.get(first.text.upper())
        if forms is None:
            return None, 0  # reported
        found = None
        if last.kind is not Kind.BROKEN:
            found = self._guard(item, partial(matcher.match, item.tokens, forms))
        if found is None:
            return Decoded(forms[0], {}), 0  # all its forms have the same effect on the flow
        values = dict(found.fixed)
        for pending in found.pending:
            value = self._guard(item, partial(matcher.value, pending))
            if value is not None:
                values[pending.slot.name] = value
        is_whole = len(values) == len(found.form.slots)
        word = self._isa.encode(found.form, values) if is_whole else 0
        return Decoded(found.form, values), word

    # ---- errors

    def _guard(self, item: Statement | None, step: Callable[[], _T]) -> _T | None:
        """Return the result of a step for a statement; report its error and return None."""
        try:
            return step()
        except SourceError as error:
            start = item.tokens[0].span if item else None
            expansion = item.expansion if item else None
            self._report(with_backtrace(error.diagnostic, start, expansion))
        except FollowUpError:
            pass
        return None

    def _report(self, diagnostic: Diagnostic) -> None:
        """Note an error, once: a macro's body and an unknown name may be used many times."""
        span = None if diagnostic.code == "NP007" else diagnostic.span
        key = (diagnostic.code, diagnostic.message, span)
        if key in self._diagnostics:
            self._again.setdefault(key, []).append(diagnostic.span)
            return
        if len(self._diagnostics) >= MAX_ERRORS:
            raise AssemblyError(self._sorted(), stopped=True) from None
        self._diagnostics[key] = diagnostic

    def _sorted(self) -> list[Diagnostic]:
        """Return the errors in the order of the source."""
        found: list[Diagnostic] = []
        refused = any(code == "NP032" for code, _, _ in self._diagnostics)
        for key, diagnostic in self._diagnostics.items():
            if refused and key[0] in CONSEQUENCES:
                continue
            spans = self._again.get(key, []) if key[2] is None else []
            where = _also({span.line: None for span in spans}, diagnostic.span.line)
            if where:
                diagnostic = diagnostic.with_notes([Note(where)])  # noqa: PLW2901 - the same one
            found.append(diagnostic)
        return sorted(found, key=self._order)

    def _order(self, diagnostic: Diagnostic) -> tuple[int, int, int]:
        span = diagnostic.span
        return self._sources.order[span.line.file], span.line.number, span.column

    # ---- checks of the whole program

    def _check_size(self, file: SourceFile) -> None:
        statements = self.expander.statements
        size, room = len(statements), self._machine.rom_words
        declared = self.expander.declarations
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
        statements = self.expander.statements
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
        start = item.tokens[0].span
        diagnostic = Diagnostic("error", code, message, start, notes, hint)
        self._report(with_backtrace(diagnostic, start, item.expansion))

    def _check_defines(self, file: str) -> None:
        for name, near in self._symbols.unknown_overrides():
            raise InputError(
                "NP026",
                f"{file} has no .equ constant '{name}' to define",
                hint=near or "the constants that can be defined are those of .equ lines",
            )


def _also(lines: Mapping[Line, None], shown: Line) -> str:
    """Return where else an error is than in the line that its message shows."""
    others = [line for line in lines if line != shown]
    here = [str(line.number) for line in others if line.file == shown.file]
    there = [f"{line.file}:{line.number}" for line in others if line.file != shown.file]
    if not others:
        return ""
    more = ", ..." * (len(others) > _MOST_LINES)
    if not here:
        return f"also in {', '.join(there[:_MOST_LINES])}{more}"
    named = ", ".join([*here, *there][:_MOST_LINES])
    return f"also in line{'s' * (len(here) > 1)} {named}{more}"


class _SourceLines:
    """The source lines of statements, whose copies are counted."""

    def __init__(self) -> None:
        self._copies: dict[SourceLine, dict[int, int]] = {}

    def of(self, line: Line, expansion: Expansion | None) -> SourceLine:
        """Return a line as it came from an expansion, if any."""
        # A line of an included file counts as written there.
        outer = None
        if expansion is not None and expansion.generates:
            outer = self.of(expansion.at.line, expansion.outer)
        first = SourceLine(line.file, line.number, line.text, outer)
        copies = self._copies.setdefault(first, {})
        return first._replace(copy=copies.setdefault(id(expansion), len(copies)))
