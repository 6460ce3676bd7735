"""The words of the language as an editor knows them before it sees a program."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal, NamedTuple

from npchip.assembler.symbols import REGISTERS
from npchip.assembler.usage import USAGE
from npchip.isa import Instruction, Isa
from npchip.isa.manual import plain_syntax
from npchip.isa.plain import condition_page, plain_page
from npchip.program.model import OUTPUT_KINDS, OutputKind

OUTPUTS: Final[dict[OutputKind, str]] = {
    "scalar": "a byte on which all active NPs agree; the last one sent in a frame counts",
    "scalar16": "two bytes in a frame, the low one first, on which all active NPs agree",
    "list": "every byte sent in a frame, on each of which all active NPs agree",
    "plane": "a byte of each NP; the last send of a frame counts",
    "picture": "a byte of each pixel: 64 sends in a frame, pixel after pixel of the NPs",
}
"""The kinds of outputs, a line each; docs/assembly.md describes them."""

EntryKind = Literal["instruction", "directive", "condition", "register", "word"]


class Entry(NamedTuple):
    """A word of the language.

    Attributes:
        name: the word.
        kind: what it is; a `word` is a choice of an operand, or a kind of output.
        summary: a line on it.
        syntax: how it is written.
        page: all there is to say, as plain text.
    """

    name: str
    kind: EntryKind
    summary: str
    syntax: tuple[str, ...]
    page: str


def entries(isa: Isa) -> Iterator[Entry]:
    """Yield the words of an instruction set and of the assembler."""
    for item in isa.instructions.values():
        yield from _instruction(item, isa)
    for name, (form, text) in USAGE.items():
        yield _entry("directive", name, text, f"{name}\n\n{text}", (form,))
    for name, condition in isa.condition_names.items():
        yield _entry("condition", name, condition.text, condition_page(condition, isa))
    for name in REGISTERS:
        yield _entry("register", name, "a register of every NP: a byte")
    for operand in isa.operands.values():
        for name in operand.choices:
            text = f"{operand.name}: {operand.text.replace('`', '')}"
            yield _entry("word", name, text)
    for kind in OUTPUT_KINDS:
        syntax = f".output NAME, PORT, {kind}"
        yield _entry("word", kind, f"an output: {OUTPUTS[kind]}", syntax=(syntax,))


def _instruction(item: Instruction, isa: Isa) -> Iterator[Entry]:
    """Yield an entry for each mnemonic of an instruction: its name, and those of its aliases."""
    for name in dict.fromkeys(form.mnemonic for form in item.forms):
        syntax = tuple(plain_syntax(form, isa) for form in item.forms if form.mnemonic == name)
        yield _entry("instruction", name, item.title, plain_page(item, isa), syntax)


def _entry(
    kind: EntryKind, name: str, summary: str, page: str = "", syntax: tuple[str, ...] = ()
) -> Entry:
    return Entry(name, kind, summary, syntax, page or summary)
