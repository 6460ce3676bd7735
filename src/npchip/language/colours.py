"""The kinds of the words of a file, for an editor's colours.

The rules of `npchip.editors.rules` tell words apart by their looks; here the names say what they
are, such as a register's name or a macro's parameter.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

from npchip.editors.rules import rules
from npchip.isa import Isa
from npchip.language.names import NameKind, Names

NAMES: Final[dict[NameKind, str]] = {
    "label": "label",
    "local": "label",
    "constant": "constant",
    "register": "register",
    "macro": "macro",
    "output": "output",
    "parameter": "parameter",
}
_PLAIN: Final = frozenset({"name", "label", "register", "choice", "condition"})
"""Kinds by looks that a name may have."""
_UNCOLOURED: Final = frozenset({"punctuation", "name"})


class Coloured(NamedTuple):
    """A word with its kind: one of `npchip.editors.rules.KINDS`, or a value of `NAMES`."""

    line: int
    column: int
    length: int
    kind: str
    defines: bool = False


@lru_cache(maxsize=4)
def _pattern(isa: Isa) -> tuple[re.Pattern[str], tuple[str, ...]]:
    found = rules(isa)
    text = "|".join(f"(?P<k{index}>{rule.pattern})" for index, rule in enumerate(found))
    return re.compile(text, re.ASCII), tuple(rule.kind for rule in found)


def coloured(lines: Sequence[str], file: str, names: Names, isa: Isa) -> Iterator[Coloured]:
    """Yield the words of a file, in order; `line` counts from 0."""
    pattern, kinds = _pattern(isa)
    for number, line in enumerate(lines):
        for found in pattern.finditer(line):
            kind = kinds[int((found.lastgroup or "k0")[1:])]
            start, end = found.span()
            use = names.at(file, number + 1, start) if kind in _PLAIN else None
            known = names.kind(use.name) if use and use.span.column == start else None
            if use is not None and known is not None:
                yield Coloured(number, start, end - start, NAMES[known], use.kind is not None)
            elif kind not in _UNCOLOURED and end > start:
                yield Coloured(number, start, end - start, kind)
