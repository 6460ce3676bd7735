"""The card of a word: what an instruction does, what a name is worth, what a line costs."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from npchip.assembler.diagnostics import Span
from npchip.assembler.lexer import Kind, Token
from npchip.isa import Isa
from npchip.language.analysis import Analysis, Cost
from npchip.language.entries import OUTPUTS, Entry, entries
from npchip.language.lines import code_end, view, word_at
from npchip.language.names import Use

_SHOWN = 8


class Card(NamedTuple):
    """Text about a word, in Markdown, and the word's place in its line."""

    text: str
    column: int
    length: int


@lru_cache(maxsize=4)
def known_entries(isa: Isa) -> tuple[Entry, ...]:
    """Return the words of an instruction set."""
    return tuple(entries(isa))


def card(analysis: Analysis, file: str, line: int, column: int, text: str) -> Card | None:
    """Return the card of the word at a place, or None.

    Args:
        analysis: the program.
        file: the file's name in messages.
        line: the line's number, from 1.
        column: the column, from 0.
        text: the line.
    """
    token = word_at(text, column)
    if token is None or column > code_end(text):
        return None
    use = analysis.names.at(file, line, token.column)
    parts = [*(_name(analysis, use) if use else ())] or [*_word(analysis, token, text)]
    if not parts and use is None:
        return None
    shown = view(text)
    cost = analysis.costs.get((file, line))
    if cost is not None and token == shown.tokens[shown.at]:
        parts.append(_cost(cost, analysis))
    return Card("\n\n".join(parts), token.column, len(token.text)) if parts else None


def _cost(cost: Cost, analysis: Analysis) -> str:
    return f"This line: {counted(cost.words, 'word')}, {cycles(cost, analysis)}."


def counted(number: int, what: str) -> str:
    """Return a number with its noun."""
    return f"{number} {what}{'s' * (number != 1)}"


def cycles(cost: Cost, analysis: Analysis) -> str:
    """Return the cycles of a line that is passed once, and the machine."""
    return f"{counted(cost.cycles, 'cycle')} on {analysis.machine.name}"


# ---- names


def _name(analysis: Analysis, use: Use) -> Iterator[str]:
    name, examined = use.name, analysis.examined
    places = analysis.names.definitions(name)
    if examined is None:
        return
    if not places:
        if name.text in analysis.values:
            number = analysis.values[name.text]
            yield f"{_code(f'{name.text} = {number}')}\npredefined: the machine's geometry"
        return
    symbols, declared = examined.expander.symbols, examined.expander.declarations
    kind = places[0].kind
    where = _where(analysis, places[0].span)
    match kind:
        case "constant":
            value = analysis.values.get(name.text)
            shown = f" = {value}" + (f" (0x{value:02X})" if value and value > 9 else "")
            yield _code(f"{name.text}{shown if value is not None else ''}")
        case "register" if name.text in symbols.registers:
            yield _code(f"{name.text}: register r{symbols.registers[name.text][0]}")
        case "label" if name.text in symbols.labels:
            address = symbols.labels[name.text][0]
            yield _code(f"{name.text}: address {address} (0x{address:03X})")
        case "macro" if name.text in examined.expander.macros:
            macro = examined.expander.macros[name.text]
            yield _code(f".macro {name.text} {', '.join(macro.parameters)}".rstrip())
        case "output":
            found = [item for item in declared.outputs if item.name == name.text]
            for item in found:
                yield _code(f".output {item.name}, {item.port}, {item.kind}")
                yield OUTPUTS[item.kind]
        case _:
            yield _code(name.text)
    yield f"{kind}, {where}"
    yield from _remark(places[0].span)
    if kind == "register":
        yield from _uses(analysis, use)


def _code(text: str) -> str:
    return f"```npchip\n{text}\n```"


def _where(analysis: Analysis, span: Span) -> str:
    path = analysis.paths.get(span.line.file, Path(span.line.file))
    return f"{path.name}:{span.line.number}"


def _remark(span: Span) -> Iterator[str]:
    """Yield the comment of the line that defines a name."""
    comment = view(span.line.text).comment.lstrip("; ")
    if comment:
        yield comment


def _uses(analysis: Analysis, use: Use) -> Iterator[str]:
    lines = {
        (item.span.line.file, item.span.line.number): item.span
        for item in analysis.names.all(use.name)
        if item.kind is None
    }
    if not lines:
        yield "used nowhere"
        return
    shown = [_where(analysis, span) for span in lines.values()][:_SHOWN]
    more = ", ..." * (len(lines) > _SHOWN)
    yield f"used in {counted(len(lines), 'line')}: {', '.join(shown)}{more}"


# ---- words of the language


def _word(analysis: Analysis, token: Token, text: str) -> Iterator[str]:
    shown = view(text)
    first = token == shown.tokens[shown.at]
    lower = token.text.lower()
    kinds = {"instruction", "directive"} if first else {"condition", "register", "word"}
    if token.kind is Kind.NUMBER:
        yield f"{token.value} = 0x{token.value:02X} = 0b{token.value:08b}"
        return
    for entry in known_entries(analysis.isa):
        if entry.name.lower() == lower and entry.kind in kinds:
            yield from _entry(entry, analysis)
            return


def _entry(entry: Entry, analysis: Analysis) -> Iterator[str]:
    if entry.kind == "register":
        yield f"**{entry.name}** · {entry.summary}"
        yield from _also(entry.name, analysis)
        return
    yield f"**{entry.name}** · {entry.kind}: {entry.summary}"
    if entry.kind == "instruction":
        forms = analysis.isa.forms[entry.name]
        each = dict.fromkeys(analysis.machine.cycles(form.timing) for form in forms)
        numbers = " or ".join(map(str, each))
        noun = "cycle" if [*each] == [1] else "cycles"
        yield f"{numbers} {noun} on {analysis.machine.name}"
    if entry.kind in {"instruction", "condition"}:
        yield f"```text\n{entry.page}\n```"
    elif entry.syntax:
        yield _code("\n".join(entry.syntax))


def _also(register: str, analysis: Analysis) -> Iterator[str]:
    """Yield the names that a source gives to a register."""
    table = analysis.examined.expander.symbols.registers if analysis.examined else {}
    found = [
        f"{name} ({_where(analysis, span)})"
        for name, (number, span) in table.items()
        if f"r{number}" == register
    ]
    if found:
        yield f"named {', '.join(found)}"
