"""Lines that the expansion of a source left out: branches not chosen, macros never used."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from npchip.assembler.blocks import CLOSERS, Node, all_tokens, names, walk
from npchip.assembler.diagnostics import Line
from npchip.assembler.lexer import Token
from npchip.assembler.macros import Macro


class LeftOut:
    """Records which lines are left out while a source is expanded.

    A line in a macro or an included file can be left out at one place and chosen at another.

    Args:
        macros: the macros by name, to which the expansion adds.

    Attributes:
        used_macros: names of the macros that were expanded.
    """

    def __init__(self, macros: Mapping[str, Macro]) -> None:
        self.used_macros: set[str] = set()
        self._macros = macros
        self._skipped: dict[int, Sequence[Node]] = {}
        self._chosen: set[int] = set()

    def skip(self, body: Sequence[Node]) -> None:
        """Record that a condition or a count of 0 has left out these lines."""
        self._skipped[id(body)] = body

    def choose(self, body: Sequence[Node]) -> None:
        """Record that a condition has chosen these lines."""
        self._chosen.add(id(body))

    def skipped_macros(self) -> set[str]:
        """Return the names of the macros in lines that conditions have left out so far."""
        inside = (node for body in self._skipped.values() for node in walk(body))
        return {node.branches[0][0][1].text for node in inside if node.word == ".macro"}

    def unused_macros(self, mentioned: Collection[str]) -> list[Token]:
        """Return the names of the macros that were not expanded, without those mentioned."""
        return [macro.name for macro in self._unused() if macro.name.text not in mentioned]

    def names(self) -> set[str]:
        """Return the names in the lines left out, which other conditions would use."""
        return {name for body in self._bodies() for name in names(body)}

    def lines(self) -> set[Line]:
        """Return the lines left out at some place, those of unused macros included."""
        return {token.line for body in self._bodies() for token in all_tokens(body)}

    def never_chosen(self) -> set[Line]:
        """Return the lines that conditions left out each time."""
        bodies = [body for key, body in self._skipped.items() if key not in self._chosen]
        for macro in self._unused():
            blocks = (node for node in walk(macro.body) if CLOSERS.get(node.word) == ".endif")
            bodies += [body for node in blocks for _, body in node.branches]
        return {token.line for body in bodies for token in all_tokens(body)}

    def _bodies(self) -> Iterator[Sequence[Node]]:
        yield from self._skipped.values()
        for macro in self._unused():
            yield macro.body

    def _unused(self) -> Iterator[Macro]:
        for name, macro in self._macros.items():
            if name not in self.used_macros:
                yield macro
