"""The names that a source defines, each with its place and what it stands for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from npchip.assembler.diagnostics import Span
from npchip.assembler.expander import Expander

DefinitionKind = Literal["label", "constant", "register", "macro", "output"]


class Definition(NamedTuple):
    """A name that a source defines; `text` says in a line what it is."""

    name: str
    kind: DefinitionKind
    span: Span
    text: str


def find_definitions(expander: Expander) -> Iterator[Definition]:
    """Yield the names that a source without errors defines; local labels are left out."""
    symbols, declared = expander.symbols, expander.declarations
    for name, (address, span) in symbols.labels.items():
        yield Definition(name, "label", span, f"{name}: address {address} (0x{address:03X})")
    for name, value in symbols.constants().items():
        place = symbols.definition(name)
        assert place is not None
        yield Definition(name, "constant", place, f"{name} = {value}")
    for name, (number, span) in symbols.registers.items():
        yield Definition(name, "register", span, f"{name}: register r{number}")
    for name, macro in expander.macros.items():
        text = " ".join(("macro", name, ", ".join(macro.parameters))).rstrip()
        yield Definition(name, "macro", macro.name.span, text)
    for output in declared.outputs:
        text = f"{output.name}: output on port {output.port}, {output.kind}"
        yield Definition(output.name, "output", declared.output_spans[output.name], text)
