"""Completion: what may stand at a place of a line."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import Final, Literal, NamedTuple

from npchip.assembler.lexer import Kind, Token
from npchip.isa import Form, Slot
from npchip.language.analysis import Analysis
from npchip.language.cards import known_entries
from npchip.language.entries import Entry
from npchip.language.lines import view
from npchip.language.names import NameKind
from npchip.program.model import OUTPUT_KINDS, PORTS

_WORD: Final = re.compile(r"\.?\w*\Z", re.ASCII)

OfferKind = Literal["instruction", "directive", "condition", "word", "port"] | NameKind


class Offer(NamedTuple):
    """A word that may stand at a place.

    Attributes:
        text: the word.
        kind: what it is.
        detail: what it is worth, or how it goes on.
        page: more on it; empty for nothing.
    """

    text: str
    kind: OfferKind
    detail: str = ""
    page: str = ""


class Offers(NamedTuple):
    """Words that may stand at a place, and the column at which the word there begins."""

    column: int
    offers: list[Offer]


def completion(analysis: Analysis, file: str, line: int, before: str) -> Offers:
    """Return what may stand at the end of the text before the cursor."""
    found = _WORD.search(before)
    assert found is not None
    column = found.start()
    shown = view(before[:column])
    if shown.broken or shown.comment or (found[0] and found[0][0].isdigit()):
        return Offers(column, [])
    tokens = shown.tokens[shown.at : -1]
    offers = _Offers(analysis, file, line)
    items = offers.operands(tokens) if tokens else offers.statements()
    return Offers(column, list(dict.fromkeys(items)))


class _Offers:
    def __init__(self, analysis: Analysis, file: str, line: int) -> None:
        self._analysis = analysis
        self._entries = known_entries(analysis.isa)
        self._local = analysis.names.region(file, line)

    def statements(self) -> Iterator[Offer]:
        for entry in self._entries:
            if entry.kind in {"instruction", "directive"}:
                yield self._entry(entry, "; ".join(entry.syntax))
        yield from self._names("macro")

    def operands(self, tokens: Sequence[Token]) -> Iterator[Offer]:
        head, index = tokens[0], _index(tokens)
        forms = self._analysis.isa.forms.get(head.text.upper(), ())
        if head.kind is Kind.DOTTED:
            yield from self._directive(head.text.lower(), index)
        elif forms:
            yield from self._instruction(forms, index, tokens[-1].text)
        else:  # of a macro, or of a word that is none yet
            yield from self._names("register", "constant", "label")
            yield from self._registers()
            yield from self._locals()

    def _directive(self, word: str, index: int) -> Iterator[Offer]:
        match word, index:
            case ".reg", 1:
                yield from self._registers()
            case ".output", 1:
                yield from self._free_ports()
            case ".output", 2:
                yield from self._words(lambda entry: entry.name in OUTPUT_KINDS)
            case ".budget", 0:
                yield from (Offer("words", "word"), Offer("cycles", "word"))
            case (".equ" | ".reg" | ".output" | ".macro", 0) | (".error" | ".include", _):
                return
            case (".ifdef" | ".ifndef", _):
                yield from self._names("constant", "register", "label", "macro")
            case _:
                yield from self._names("constant", "label")
                yield from self._predefined()

    def _instruction(self, forms: Sequence[Form], index: int, last: str) -> Iterator[Offer]:
        slots = [slot for form in forms for slot in _slots(form, index)]
        kinds = {slot.operand.kind for slot in slots}
        inner = last not in {",", forms[0].mnemonic} and last.upper() != forms[0].mnemonic
        number = "number" in kinds
        if "condition" in kinds and not inner:
            yield from self._words(lambda entry: entry.kind == "condition")
        choices = {name for slot in slots for name in slot.operand.choices}
        if choices and not inner:
            yield from self._words(lambda entry: entry.kind == "word" and entry.name in choices)
        if "register" in kinds and last != "#":
            yield from self._names("register")
            yield from self._registers()
        if any(slot.operand.name == "port" for slot in slots) and not inner:
            yield from self._ports()
        if number:
            yield from self._names("constant")
            yield from self._predefined()
            yield from (offer for offer in self._locals() if offer.kind == "parameter")
        if "label" in kinds:
            yield from self._names("label")
            yield from self._locals()

    # ---- kinds of words

    def _words(self, wanted: Callable[[Entry], bool]) -> Iterator[Offer]:
        for entry in self._entries:
            if wanted(entry):
                yield self._entry(entry, entry.summary)

    def _entry(self, entry: Entry, detail: str) -> Offer:
        return Offer(entry.name, entry.kind, detail, entry.page)

    def _registers(self) -> Iterator[Offer]:
        for entry in self._entries:
            if entry.kind == "register":
                yield self._entry(entry, entry.summary)

    def _names(self, *kinds: NameKind) -> Iterator[Offer]:
        for use in self._analysis.names.defined():
            if use.kind in kinds and not use.name.region:
                yield Offer(use.name.text, use.kind, self._worth(use.name.text, use.kind))

    def _worth(self, name: str, kind: NameKind) -> str:
        examined = self._analysis.examined
        if examined is None:
            return ""
        symbols, macros = examined.expander.symbols, examined.expander.macros
        if kind == "constant" and name in self._analysis.values:
            return str(self._analysis.values[name])
        if kind == "register" and name in symbols.registers:
            return f"r{symbols.registers[name][0]}"
        if kind == "label" and name in symbols.labels:
            return f"address {symbols.labels[name][0]}"
        return ", ".join(macros[name].parameters) if kind == "macro" and name in macros else ""

    def _locals(self) -> Iterator[Offer]:
        for name in sorted(self._local):
            yield Offer(name.text, "local" if name.space == "local" else "parameter")

    def _predefined(self) -> Iterator[Offer]:
        examined = self._analysis.examined
        for name, value in (examined.expander.symbols.predefined if examined else {}).items():
            yield Offer(name, "constant", f"{value}, the machine's geometry")

    def _ports(self) -> Iterator[Offer]:
        examined = self._analysis.examined
        for item in examined.expander.declarations.outputs if examined else ():
            yield Offer(str(item.port), "port", f"output {item.name}, {item.kind}")

    def _free_ports(self) -> Iterator[Offer]:
        examined = self._analysis.examined
        outputs = examined.expander.declarations.outputs if examined else []
        for port in sorted({*range(PORTS)} - {item.port for item in outputs}):
            yield Offer(str(port), "port", "free")


def _index(tokens: Sequence[Token]) -> int:
    """Return which operand comes next, from 0."""
    depth = index = 0
    for token in tokens[1:]:
        depth += (token.text in {"(", "["}) - (token.text in {")", "]"})
        index += token.text == "," and depth <= 0
    return index


def _slots(form: Form, wanted: int) -> Iterator[Slot]:
    """Yield the slots of one operand of a form."""
    index = 0
    for part in form.tokens:
        if isinstance(part, str):
            index += part == ","
        elif index == wanted:
            yield part
