"""Words back to text that assembles to the same words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from npchip.isa import Decoded, Isa


def disassemble_word(word: int, isa: Isa, labels: Mapping[int, str] | None = None) -> str | None:
    """Text of one word; None where it is undefined.

    Args:
        word: 16 bits.
        isa: the instruction set.
        labels: names of addresses; an address without one is written as a number.
    """
    decoded = isa.decode(word)
    return None if decoded is None else render(decoded, labels or {})


def render(decoded: Decoded, labels: Mapping[int, str]) -> str:
    """Text of a decoded word, such as ``LD r1, [r2 + 64]``."""
    text = decoded.form.mnemonic
    glue = " "
    for part in decoded.form.tokens:
        if isinstance(part, str):
            text += {",": ",", "+": " +"}.get(part, glue + part)
            glue = " " if part in {",", "+"} else ""
        else:
            value = decoded.values[part.name]
            if part.operand.kind == "register":
                value = f"r{value}"
            elif part.operand.kind == "label":
                value = labels.get(int(value), str(value))
            text += f"{glue}{value}"
            glue = ""
    return text


def jump_labels(words: Iterable[int], isa: Isa) -> dict[int, str]:
    """A made-up label, ``L_017``, for each address that the words jump to or call."""
    targets: set[int] = set()
    for word in words:
        decoded = isa.decode(word)
        if decoded is not None and decoded.form.target is not None:
            targets.add(int(decoded.values[decoded.form.target]))
    return {address: f"L_{address:03d}" for address in sorted(targets)}
