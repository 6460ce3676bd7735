"""``.require``: conditions on the machine, as text and in messages."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from npchip.assembler.lexer import Kind, Token
from npchip.machine import Machine

HINT = "take a machine for which the condition holds: npchip machine shows those that ship"

# They follow from a condition that does not hold, and would hide it.
CONSEQUENCES = frozenset({"NP006", "NP010", "NP014", "NP018", "NP019"})


def geometry(machine: Machine) -> dict[str, int]:
    """Return the constants that the assembler provides for a machine."""
    return {
        "NP_ROWS": machine.np_rows,
        "NP_COLS": machine.np_cols,
        "ROWS": machine.rows,
        "COLS": machine.cols,
    }


def folded(tokens: Sequence[Token], known: Mapping[str, int], value: Callable[[Token], int]) -> str:
    """Return a condition as text, every name but those in `known` replaced by its value."""
    words = (
        str(value(token)) if token.kind in _NAMES and token.text not in known else token.text
        for token in tokens
    )
    return " ".join(words).replace("( ", "(").replace(" )", ")")


def unmet(condition: Iterable[Token], reason: str, value: Callable[[Token], int]) -> str:
    """Return the message for a condition that does not hold."""
    tokens = list(condition)
    names = {token.text: value(token) for token in tokens if token.kind in _NAMES}
    text = folded(tokens, names, value)
    found = " and ".join(f"{name} is {number}" for name, number in names.items())
    return f"the program needs {text} ({reason}){f', but {found}' if found else ''}"


_NAMES = (Kind.NAME, Kind.DOTTED)
