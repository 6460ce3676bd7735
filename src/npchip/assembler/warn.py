"""Warnings about a program that assembles: few, and each worth a look."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from npchip.assembler.diagnostics import Diagnostic, Line, Span, quoted
from npchip.assembler.expander import Expander
from npchip.assembler.expansion import with_backtrace
from npchip.assembler.flow import Routines, check_flow
from npchip.assembler.masks import Step
from npchip.isa import FieldValue, ir


@dataclass(eq=False)
class Assembled:
    """A right program, as the warnings look at it.

    Attributes:
        expander: what expansion has left.
        steps: the instructions, by address.
        values: the operands of each.
        routines: where flow can go.
        stack: entries of the return stack.
    """

    expander: Expander
    steps: Sequence[Step | None]
    values: Sequence[Mapping[str, FieldValue]]
    routines: Routines
    stack: int

    def reached(self) -> frozenset[int]:
        """Addresses that some way leads to."""
        return frozenset().union(*self.routines.values())


def find_warnings(program: Assembled) -> list[Diagnostic]:
    """Everything that is hardly meant, without what a comment allows."""
    program.expander.mention()
    main = next(iter(program.expander.sources.files))
    found = [
        item
        for item in (*_labels(program), *_names(program.expander))
        if item.span.line.file == main  # a library has more than one program uses
    ]
    return _obey_allows([*found, *_flow(program), *_unsent(program)], program.expander, main)


def _warning(code: str, message: str, span: Span, hint: str | None = None) -> Diagnostic:
    return Diagnostic("warning", code, message, span, suggestion=hint)


def _labels(program: Assembled) -> Iterator[Diagnostic]:
    symbols = program.expander.symbols
    reached = program.reached()
    tables = [(symbols.labels, symbols.used)]
    tables += [(scope.labels, scope.used) for scope in program.expander.local_scopes]
    for labels, used in tables:
        for name, (address, span) in labels.items():
            # The first address has a name for the reader's sake; of dead code NPW04 speaks.
            is_live = address in reached or address == len(program.steps)
            if address and is_live and name not in used and name not in symbols.used:
                yield _warning("NPW01", f"label {quoted(name)} is never used", span)


def _names(expander: Expander) -> Iterator[Diagnostic]:
    for what, span in expander.symbols.unused():
        yield _warning("NPW02", f"{what} is never used", span)
    for name in expander.unused_macros():
        yield _warning("NPW03", f"macro {quoted(name.text)} is never used", name.span)


def _flow(program: Assembled) -> Iterator[Diagnostic]:
    for fault in check_flow(program.steps, program.routines, program.stack):
        item = program.expander.statements[fault.address]
        first = item.tokens[0]
        hint = fault.hint
        if fault.code == "NPW04" and fault.address:
            before = program.expander.statements[fault.address - 1].tokens[0]
            hint = f"no way leads here after the {before.text.upper()} above"
        diagnostic = _warning(fault.code, fault.message, first.span, hint)
        yield with_backtrace(diagnostic, first, item.expansion)


def _unsent(program: Assembled) -> Iterator[Diagnostic]:
    """Declared outputs to whose port no reachable instruction sends."""
    sent: set[FieldValue] = set()
    for address in program.reached():
        step = program.steps[address]
        effect = step.form.effects.get("output") if step else None
        if effect is not None and isinstance(effect.args[0], ir.Field):
            sent.add(program.values[address][effect.args[0].name])
    declared = program.expander.declarations
    for output in declared.outputs:
        if output.port not in sent:
            message = f"nothing is sent to port {output.port}, the output {quoted(output.name)}"
            yield _warning("NPW06", message, declared.output_spans[output.name])


def _obey_allows(found: list[Diagnostic], expander: Expander, main: str) -> list[Diagnostic]:
    allows = {allow.line: allow for allow in expander.sources.allows}
    if not allows:
        return found
    useful: set[tuple[Line, str]] = set()
    left: list[Diagnostic] = []
    for item in found:
        spans = (item.span, *(note.span for note in item.notes if note.span))
        lines = [span.line for span in spans if span.line in allows]
        silent = {(line, item.code) for line in lines if item.code in allows[line].codes}
        useful |= silent
        if not silent:
            left.append(item)
    skipped = expander.skipped_lines()
    for line, allow in allows.items():
        for code in allow.codes:
            # A library's comment is for programs that use less of it.
            if line.file == main and line not in skipped and (line, code) not in useful:
                message = f"there is no {code} here to allow"
                left.append(_warning("NPW09", message, allow.span, "delete the comment"))
    return left
