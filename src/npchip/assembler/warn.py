"""Warnings about a program that assembles: few, and each worth a look."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from npchip.assembler.diagnostics import Diagnostic, Line, Span, quoted
from npchip.assembler.expander import Expander
from npchip.assembler.expansion import with_backtrace
from npchip.isa import Isa, ir
from npchip.machine import Machine
from npchip.program.checks import check_flow
from npchip.program.graph import HALTED, Graph, Words
from npchip.program.reads import unwritten
from npchip.program.routines import Routines


class Assembled(NamedTuple):
    """A right program, as the warnings look at it.

    Attributes:
        expander: what expansion has left.
        code: the instructions, with the forms that are written.
        routines: of the program.
        machine: for the limits of its return stack and masks.
        isa: the instruction set.
        graph: its places; None where there are too many.
    """

    expander: Expander
    code: Words
    routines: Routines
    machine: Machine
    isa: Isa
    graph: Graph | None

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
    found += [*_flow(program), *_unsent(program)]
    if program.graph is not None:
        found += [*_never_written(program, program.graph), *_left_open(program, program.graph)]
        found += _idle_loops(program, program.graph)
    return _obey_allows(found, program.expander, main)


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
            is_live = address in reached or address == len(program.code)
            if address and is_live and name not in used and name not in symbols.used:
                yield _warning("NPW01", f"label {quoted(name)} is never used", span)


def _names(expander: Expander) -> Iterator[Diagnostic]:
    for what, span in expander.symbols.unused():
        yield _warning("NPW02", f"{what} is never used", span)
    for name in expander.unused_macros():
        yield _warning("NPW03", f"macro {quoted(name.text)} is never used", name.span)


def _flow(program: Assembled) -> Iterator[Diagnostic]:
    for fault in check_flow(program.code, program.routines, program.machine.stack_depth):
        hint = fault.hint
        if fault.code == "NPW04" and fault.address:
            before = program.expander.statements[fault.address - 1].tokens[0]
            hint = f"no way leads here after the {before.text.upper()} above"
        yield _at(program, fault.address, fault.code, fault.message, hint)


def _unsent(program: Assembled) -> Iterator[Diagnostic]:
    """Declared outputs to whose port no reachable instruction sends."""
    sent: set[int] = set()
    for address in program.reached():
        word = program.code[address]
        effect = word.form.effects.get("output") if word else None
        if word is not None and effect is not None:
            sent.add(ir.constant(effect.args[0], word.values))
    declared = program.expander.declarations
    for output in declared.outputs:
        if output.port not in sent:
            message = f"nothing is sent to port {output.port}, the output {quoted(output.name)}"
            yield _warning("NPW06", message, declared.output_spans[output.name])


def _at(program: Assembled, address: int, code: str, message: str, hint: str | None) -> Diagnostic:
    item = program.expander.statements[address]
    first = item.tokens[0]
    return with_backtrace(_warning(code, message, first.span, hint), first, item.expansion)


def _never_written(program: Assembled, graph: Graph) -> Iterator[Diagnostic]:
    """Reads of registers and flags that nothing before them writes, on no way.

    Code that takes no frames is mostly a piece of a program, whose registers are set from Python.
    """
    if not any(map(graph.exposes, graph.successors)):
        return
    after = {place: graph.following(place) for place in graph.successors}
    found = unwritten(graph.words, program.isa, after, on_every_way=True)
    for address, names in found.items():
        what = " and ".join(names)
        verb = "are" if len(names) > 1 else "is"
        message = f"{what} {verb} read here, but nothing has written {what} yet: always 0"
        hint = "is it the wrong register, or is its first value missing?"
        yield _at(program, address, "NPW10", message, hint)


def _left_open(program: Assembled, graph: Graph) -> Iterator[Diagnostic]:
    """Halts inside a masked region."""
    depths = {
        place.address: place.depth
        for place in sorted(graph.successors)
        if HALTED in graph.successors[place] and place.depth
    }
    for address, depth in depths.items():
        regions = "a masked region" if depth == 1 else f"{depth} masked regions"
        hint = "it halts all NPs, active or not: is an END missing above it?"
        yield _at(program, address, "NPW11", f"{regions} still open where the program halts", hint)


def _idle_loops(program: Assembled, graph: Graph) -> Iterator[Diagnostic]:
    """``.loop`` lines above something that no later instruction leads back to."""
    headers = {
        after.address
        for place in graph.successors
        for after in graph.following(place)
        if place.address >= after.address and place.stack == after.stack
    }
    declared = program.expander.declarations
    for address, span in declared.loop_spans.items():
        if address not in headers and (
            address in program.reached() or address >= len(program.code)
        ):
            message = "no loop begins with the instruction below"
            hint = "put it directly above the label that the loop jumps back to"
            yield _warning("NPW12", message, span, hint)


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
