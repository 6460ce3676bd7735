"""Words to source text that assembles to the same words."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from npchip.base.frozen import FrozenMap
from npchip.isa import Decoded, Isa
from npchip.program.model import Program

_NAME: Final = re.compile(r"[^\W\d]\w*")


def disassemble_word(
    word: int,
    isa: Isa,
    labels: Mapping[int, str] | None = None,
    registers: Mapping[int, str] | None = None,
) -> str | None:
    """Return the text of one word, or None if it is undefined.

    Args:
        word: 16 bits.
        isa: the instruction set.
        labels: names of addresses; an address without a name is written as a number.
        registers: names of registers, which are ``r0`` to ``r15`` without.
    """
    decoded = isa.decode(word)
    return None if decoded is None else render(decoded, labels or {}, registers or {})


def registers_of(program: Program, address: int) -> dict[int, str]:
    """Return the names by which the source of a word calls registers."""
    line = program.place(address)
    found: dict[int, str] = {}
    for origin in () if line is None or not program.registers else line.origins:
        for name in _NAME.findall(origin.text.partition(";")[0]):
            if name in program.registers:
                found.setdefault(program.registers[name], name)
    return found


def render(
    decoded: Decoded, labels: Mapping[int, str], registers: Mapping[int, str] = FrozenMap()
) -> str:
    """Return the text of a decoded word, such as ``LD r1, [r2 + 64]``."""
    text = decoded.form.mnemonic
    glue = " "
    for part in decoded.form.tokens:
        if isinstance(part, str):
            text += {",": ",", "+": " +"}.get(part, glue + part)
            glue = " " if part in {",", "+"} else ""
        else:
            value = decoded.values[part.name]
            if part.operand.kind == "register":
                value = registers.get(int(value), f"r{value}")
            elif part.operand.kind == "label":
                value = labels.get(int(value), f"0x{int(value):03X}")
            text += f"{glue}{value}"
            glue = ""
    return text


def disassemble(program: Program, isa: Isa) -> str:
    """Return a source that assembles to the same words, with labels and outputs.

    A jump target without a label gets one made from its address. Undefined words become
    ``.word`` lines.
    """
    names = _labels(program, isa)
    lines = [f"; {program.name}: {len(program.words)} words", ""]
    lines += [f".output {item.name}, {item.port}, {item.kind}" for item in program.outputs]
    if program.outputs:
        lines.append("")
    first = {address: labels[0] for address, labels in names.items()}
    for address, word in enumerate(program.words):
        lines += [f"{label}:" for label in names.get(address, ())]
        text = disassemble_word(word, isa, first) or f".word 0x{word:04X}"
        lines.append(f"        {text:<32}; {address:03X} {word:04X}")
    # A label may follow the last word; jumping there is a trap.
    lines += [f"{label}:" for label in names.get(len(program.words), ())]
    return "\n".join(lines) + "\n"


def _labels(program: Program, isa: Isa) -> dict[int, list[str]]:
    """Return the labels of each address: the program's own, or one made for a jump target."""
    names: dict[int, list[str]] = {}
    for label, address in program.labels.items():
        names.setdefault(address, []).append(label)
    for word in program.decoded(isa):
        if word is not None and word.form.label is not None:
            address = int(word.values[word.form.label])
            if address <= len(program.words):
                names.setdefault(address, [f"L_{address:03X}"])
    return names
