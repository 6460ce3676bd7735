"""Meanings of all names in a set of files, found in their text, even while a line is wrong.

The assembler knows names by what it has expanded; here a macro's body is read as it is written, so
that a name in it has one place. Labels that a macro makes of its arguments are not followed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Literal, NamedTuple

from npchip.assembler.blocks import Node, walk
from npchip.assembler.diagnostics import Span
from npchip.assembler.lexer import Kind, Token, after_labels
from npchip.assembler.macros import split
from npchip.assembler.symbols import REGISTERS
from npchip.isa import Form, Isa

NameKind = Literal["label", "local", "constant", "register", "macro", "output", "parameter"]
Space = Literal["name", "macro", "output", "local", "parameter"]
"""Names of different spaces may be spelt alike. Labels, constants and registers share one."""


class Name(NamedTuple):
    """A name; `region` is 0 but for those that hold in a part of a file only."""

    space: Space
    text: str
    region: int = 0


class Use(NamedTuple):
    """A place where a name stands; `kind` is what it is defined as here, None for a mere use."""

    name: Name
    span: Span
    kind: NameKind | None = None


@dataclass(eq=False)
class _Region:
    """A region in which local labels hold: between two labels, a macro, or a repetition."""

    number: int
    parent: _Region | None = None
    labels: set[str] = field(default_factory=set)

    def of(self, label: str) -> _Region:
        """Return the region that defines a local label, this one if none does."""
        region: _Region | None = self
        while region is not None:
            if label in region.labels:
                return region
            region = region.parent
        return self


class _Place(NamedTuple):
    region: _Region
    parameters: Mapping[str, Name] = MappingProxyType({})
    generated: bool = False  # in a macro or repetition, whose labels open no region


_NO_NAMES: Final = frozenset({".include", ".error", ".endm", ".endr", ".endif", ".else"})


class Names:
    """The names of files.

    Args:
        files: the lines and blocks of each file.
        isa: the instruction set, which says what is no name.
    """

    def __init__(self, files: Iterable[Sequence[Node]], isa: Isa) -> None:
        self._isa = isa
        self._files = list(files)
        self._words: dict[str, list[set[str]]] = {}
        self._macros = {
            node.branches[0][0][1].text
            for nodes in self._files
            for node in walk(nodes)
            if node.word == ".macro"
        }
        self._regions = 0
        self._local: list[tuple[Token, _Region, bool]] = []
        self._open: list[Token] = []  # a global name or a macro's: which, is known at the end
        self.uses: list[Use] = []
        for nodes in self._files:
            self._walk(nodes, _Place(self._region()))
        self._settle()
        self._by_name: dict[Name, list[Use]] = {}
        self._by_line: dict[tuple[str, int], list[Use]] = {}
        for use in self.uses:
            self._by_name.setdefault(use.name, []).append(use)
            self._by_line.setdefault((use.span.line.file, use.span.line.number), []).append(use)

    # ---- answers

    def at(self, file: str, line: int, column: int) -> Use | None:
        """Return the name at a place, or that ends there; `line` counts from 1, `column` from 0."""
        for use in self._by_line.get((file, line), ()):
            if use.span.column <= column <= use.span.column + use.span.length:
                return use
        return None

    def all(self, name: Name) -> Sequence[Use]:
        """Return the places of a name."""
        return self._by_name.get(name, ())

    def definitions(self, name: Name) -> list[Use]:
        """Return the places that define a name; more than one where conditions choose."""
        return [use for use in self.all(name) if use.kind is not None]

    def kind(self, name: Name) -> NameKind | None:
        """Return what a name is, if it is defined."""
        return next((use.kind for use in self.definitions(name)), None)

    def defined(self, file: str | None = None) -> list[Use]:
        """Return the definitions, those of one file only if it is given, in their order."""
        return [u for u in self.uses if u.kind and file in {None, u.span.line.file}]

    def region(self, file: str, line: int) -> set[Name]:
        """Return the local labels and parameters that hold near a line."""
        near: dict[int, int] = {}
        for use in self.uses:
            if use.name.region and use.span.line.file == file:
                distance = abs(use.span.line.number - line)
                near[use.name.region] = min(distance, near.get(use.name.region, distance))
        closest = sorted(near, key=lambda region: near[region])[:2]
        return {use.name for use in self.uses if use.name.region in closest and use.name.region}

    # ---- the walk

    def _region(self, parent: _Region | None = None) -> _Region:
        self._regions += 1
        return _Region(self._regions, parent)

    def _walk(self, nodes: Iterable[Node], place: _Place) -> _Place:
        """Read lines and return the place after them."""
        for node in nodes:
            at = after_labels(node.tokens)
            for token in node.tokens[:at:2]:
                place = self._label(token, place)
            if node.word:
                place = self._block(node, node.tokens[at:], place)
            else:
                self._line(node.tokens[at:], place)
        return place

    def _label(self, token: Token, place: _Place) -> _Place:
        if token.kind is Kind.DOTTED:
            place.region.labels.add(token.text)
            self._local.append((token, place.region, True))
            return place
        if token.text in place.parameters:
            self.uses.append(Use(place.parameters[token.text], token.span))
            return place
        self._define("name", token, "label")
        return place if place.generated else place._replace(region=self._region())

    def _block(self, node: Node, tokens: list[Token], place: _Place) -> _Place:
        body = node.branches[0][1]
        if node.word == ".macro":
            region = self._region()
            given = [token for token in tokens[1:] if token.kind is Kind.NAME]
            for name in given[:1]:
                self._define("macro", name, "macro")
            inner = self._parameters(given[1:], region, {})
            self._walk(body, _Place(region, inner, generated=True))
            return place
        if node.word == ".rept":
            region = self._region(place.region)
            count, *counter = split(tokens[1:]) or [[]]
            self._expression(count, place)
            names = [part[0] for part in counter if part[0].kind is Kind.NAME]
            inner = self._parameters(names, region, place.parameters)
            self._walk(body, _Place(region, inner, generated=True))
            return place
        after = place
        for opening, lines in node.branches:
            self._line(tokens if lines is body else opening, place)
            end = self._walk(lines, place)
            after = end if end.region is not place.region else after
        return after

    def _parameters(
        self, tokens: Iterable[Token], region: _Region, outer: Mapping[str, Name]
    ) -> Mapping[str, Name]:
        names = dict(outer)
        for token in tokens:
            names[token.text] = Name("parameter", token.text, region.number)
            self.uses.append(Use(names[token.text], token.span, "parameter"))
        return names

    def _line(self, tokens: list[Token], place: _Place) -> None:
        first = tokens[0]
        if first.kind is Kind.DOTTED:
            self._directive(first.text.lower(), tokens, place)
        elif first.kind is Kind.NAME:
            forms = self._isa.forms.get(first.text.upper())
            if first.text in place.parameters:
                self.uses.append(Use(place.parameters[first.text], first.span))
            elif forms is None:
                self._open.append(first)
            words = self._choices(first.text.upper(), forms) if forms else []
            for index, argument in enumerate(split(tokens[1:])):
                if (
                    index < len(words)
                    and len(argument) == 1
                    and _is_word(argument[0], words[index])
                ):
                    if argument[0].text in place.parameters:
                        self._expression(argument, place)
                    continue
                self._expression(argument, place)

    def _directive(self, word: str, tokens: list[Token], place: _Place) -> None:
        if word in _NO_NAMES:
            return
        arguments = split(tokens[1:])
        first = arguments[0][0] if arguments else None
        defines = {".equ": "constant", ".reg": "register", ".output": "output"}.get(word)
        if defines and first is not None and first.kind is Kind.NAME:
            if first.text in place.parameters:
                self.uses.append(Use(place.parameters[first.text], first.span))
            elif defines == "output":
                self._define("output", first, "output")
                arguments = arguments[:2]  # the third is the kind
            else:
                self._define("name", first, "constant" if defines == "constant" else "register")
            arguments = arguments[1:]
        elif word == ".budget" and first is not None:
            arguments = [arguments[0][1:], *arguments[1:]]  # words or cycles
        elif word == ".position":
            self._outputs(arguments[:2], place)
            arguments = arguments[2:]
        for argument in arguments:
            self._expression(argument, place)

    def _outputs(self, arguments: Iterable[list[Token]], place: _Place) -> None:
        for token in (token for argument in arguments for token in argument):
            if token.kind is Kind.NAME:
                name = place.parameters.get(token.text, Name("output", token.text))
                self.uses.append(Use(name, token.span))

    def _define(self, space: Space, token: Token, kind: NameKind) -> None:
        self.uses.append(Use(Name(space, token.text), token.span, kind))

    def _expression(self, tokens: Iterable[Token], place: _Place) -> None:
        for token in tokens:
            if token.kind is Kind.DOTTED:
                self._local.append((token, place.region, False))
            elif token.kind is not Kind.NAME:
                continue
            elif token.text in place.parameters:
                self.uses.append(Use(place.parameters[token.text], token.span))
            elif token.text.lower() not in REGISTERS:
                self._open.append(token)

    def _choices(self, mnemonic: str, forms: Sequence[Form]) -> list[set[str]]:
        """Return for each operand the words that are no names there, in lower case."""
        if mnemonic not in self._words:
            found: list[set[str]] = []
            for form in forms:
                index = 0
                for part in form.tokens:
                    if isinstance(part, str):
                        index += part == ","
                        continue
                    while index >= len(found):
                        found.append(set())
                    if part.operand.kind == "condition":
                        found[index] |= {name.lower() for name in self._isa.condition_names}
                    elif part.operand.kind == "choice":
                        found[index] |= {name.lower() for name in part.operand.choices}
            self._words[mnemonic] = found
        return self._words[mnemonic]

    def _settle(self) -> None:
        """Decide what the names are whose definitions may come later."""
        globals_ = {use.name.text for use in self.uses if use.name.space == "name"}
        for token in self._open:
            is_macro = token.text in self._macros and token.text not in globals_
            if is_macro or (token.text in self._macros and _is_first(token)):
                self.uses.append(Use(Name("macro", token.text), token.span))
            else:
                self.uses.append(Use(Name("name", token.text), token.span))
        for token, region, defines in self._local:
            name = Name("local", token.text, region.of(token.text).number)
            self.uses.append(Use(name, token.span, "local" if defines else None))
        self.uses.sort(key=lambda use: (use.span.line.file, use.span.line.number, use.span.column))


def _is_word(token: Token, words: set[str]) -> bool:
    return token.kind is Kind.NAME and token.text.lower() in words


def _is_first(token: Token) -> bool:
    before = token.line.text[: token.column].rstrip()
    return not before or before.endswith(":")
