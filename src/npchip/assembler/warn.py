"""Warnings about a program that assembles."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from npchip.assembler.diagnostics import Diagnostic, Line, Span, quoted, with_backtrace
from npchip.assembler.expander import Expander
from npchip.isa import Isa, ir
from npchip.machine import Machine
from npchip.program.checks import check_flow
from npchip.program.graph import HALTED, Graph, Words
from npchip.program.reads import unwritten
from npchip.program.routines import Routines


class Assembled(NamedTuple):
    """A program without errors, and what the warnings need to know of it.

    Attributes:
        expander: the expanded source.
        code: the instructions, with the forms that are written.
        routines: the program's routines.
        machine: the machine, with the limits of its return stack and masks.
        isa: the instruction set.
        graph: the program's graph; None if it has too many places.
    """

    expander: Expander
    code: Words
    routines: Routines
    machine: Machine
    isa: Isa
    graph: Graph | None

    def reached(self) -> frozenset[int]:
        """Return the addresses that some path reaches."""
        return frozenset().union(*self.routines.values())


def find_warnings(program: Assembled) -> list[Diagnostic]:
    """Return the warnings about a program, without those that a comment allows."""
    program.expander.symbols.used.update(program.expander.left_out.names())
    main = next(iter(program.expander.sources.files))
    found = [
        item
        for item in _unused(program)
        if item.span.line.file == main  # a library has more than one program uses
    ]
    found += [*_flow(program), *_unsent(program), *_unseen(program)]
    if program.graph is not None:
        found += [*_never_written(program, program.graph), *_left_open(program, program.graph)]
        found += _idle_loops(program, program.graph)
    return _without_allowed(found, program.expander, main)


def _warning(code: str, message: str, span: Span, hint: str | None = None) -> Diagnostic:
    return Diagnostic("warning", code, message, span, suggestion=hint)


def _unused(program: Assembled) -> Iterator[Diagnostic]:
    symbols = program.expander.symbols
    reached = program.reached()
    tables = [(symbols.labels, symbols.used)]
    tables += [(scope.labels, scope.used) for scope in program.expander.local_scopes]
    for labels, used in tables:
        for name, (address, span) in labels.items():
            # A label of the first address is for the reader; NPW04 reports dead code.
            is_live = address in reached or address == len(program.code)
            if address and is_live and name not in used and name not in symbols.used:
                yield _warning("NPW01", f"label {quoted(name)} is never used", span)
    for what, span in symbols.unused():
        yield _warning("NPW02", f"{what} is never used", span)
    for macro in program.expander.left_out.unused_macros(symbols.used):
        yield _warning("NPW03", f"macro {quoted(macro.text)} is never used", macro.span)


def _flow(program: Assembled) -> Iterator[Diagnostic]:
    for fault in check_flow(program.code, program.routines, program.machine.stack_depth):
        hint = fault.hint
        if fault.code == "NPW04" and fault.address:
            before = program.expander.statements[fault.address - 1].tokens[0]
            hint = f"no way leads here after the {before.text.upper()} above"
        yield _at(program, fault.address, fault.code, fault.message, hint)


def _unsent(program: Assembled) -> Iterator[Diagnostic]:
    """Yield a warning for each output to whose port no reachable instruction sends."""
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


def _unseen(program: Assembled) -> Iterator[Diagnostic]:
    """Yield a warning where frames are taken and not looked at, or looked at and not taken.

    A program that receives bytes may take frames to be in step with its partner.
    """
    reached = [(at, word) for at in sorted(program.reached()) if (word := program.code[at])]
    exposes = [at for at, word in reached if word.form.exposes]
    samples = [at for at, word in reached if "sample" in word.form.effects]
    receives = any(any(word.form.operations("input")) for _, word in reached)
    if exposes and not samples and not receives:
        message = "frames are taken, but no instruction samples them: the program sees no pixel"
        hint = "SAMPLE signal, 0 stores the 64 pixels of every NP from address 0 on"
        yield _at(program, exposes[0], "NPW13", message, hint)
    if samples and not exposes:
        message = "no instruction takes a frame, so the sensor stays dark"
        yield _at(program, samples[0], "NPW14", message, "put an EXPOSE above it, for each frame")


def _at(program: Assembled, address: int, code: str, message: str, hint: str | None) -> Diagnostic:
    item = program.expander.statements[address]
    start = item.tokens[0].span
    return with_backtrace(_warning(code, message, start, hint), start, item.expansion)


def _never_written(program: Assembled, graph: Graph) -> Iterator[Diagnostic]:
    """Yield a warning for each register or flag that is read but written on no path before.

    Code that exposes no frame is exempt: it is usually a fragment, and Python sets its registers.
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
    """Yield a warning for each halt inside a masked region."""
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
    """Yield a warning for each ``.loop`` above an instruction to which no later one jumps back."""
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


def _without_allowed(found: list[Diagnostic], expander: Expander, main: str) -> list[Diagnostic]:
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
    skipped = expander.left_out.lines()
    for line, allow in allows.items():
        for code in allow.codes:
            # Other programs may need the comment of an included file.
            if line.file == main and line not in skipped and (line, code) not in useful:
                message = f"there is no {code} here to allow"
                left.append(_warning("NPW09", message, allow.span, "delete the comment"))
    return left
