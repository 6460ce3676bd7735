"""The reference manual of an instruction set, in Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from npchip.isa.model import Form, Instruction, Isa

REGENERATE = "npchip isa --markdown > docs/isa.md"


def manual(isa: Isa) -> str:
    """Return the whole manual (``docs/isa.md``)."""
    lines = [
        f"# {isa.title}",
        "",
        f"Generated from the instruction-set file by `{REGENERATE}`; a test compares the two.",
        "The thesis fixes an 8-bit ALU with ADD, SUB, AND, OR and shifts, a compare, and data that",
        "moves between adjacent NPs. Mnemonics, encodings, flags, masks, flow and devices are",
        "decisions; [decisions.md](decisions.md) gives the reasons. Cycles stand in the machine",
        "file, by timing class ([machine.md](machine.md)).",
        "",
        "## State",
        "",
        "Each NP has registers `r0` to `r15` of 8 bits, the flags Z and C, an activity counter and",
        "a memory of 256 bytes, seen as four banks of 64: one byte for each of its pixels, pixel",
        "(y, x) at 8·y + x. An NP is active while its counter is 0. The GCU has a 9-bit PC, a",
        "program ROM of 512 words of 16 bits and a return stack. All state starts at 0.",
        "",
        "An inactive NP changes no register, flag, memory or output. Statements of an *operation*",
        "below run in order, each seeing what the earlier ones wrote.",
        "",
        "## Conditions",
        "",
        *_table(
            ("condition", "also", "holds where", "meaning"),
            (
                (f"`{c.name}`", ", ".join(f"`{a}`" for a in c.aliases), f"`{c.when_text}`", c.text)
                for c in isa.conditions.values()
            ),
        ),
        "",
        "## Operands",
        "",
        *_table(
            ("operand", "in the word", "is"),
            (
                (f"`{o.name}`", f"`{o.letter}`", o.text + ", stored as its opposite" * o.opposite)
                for o in isa.operands.values()
            ),
        ),
        "",
        "## Overview",
        "",
        *_table(
            ("instruction", "does", "flags", "timing class"),
            (
                (
                    " · ".join(f"`{plain_syntax(form, isa)}`" for form in item.forms),
                    f"[{item.title}](#{item.name.lower()})",
                    " ".join(item.flags) or "–",
                    item.timing,
                )
                for item in isa.instructions.values()
            ),
        ),
        "",
        "## Opcode map",
        "",
        *_table(
            ("bits 15–12", "forms"),
            (
                (f"`{major:04b}`", ", ".join(names) or "free, for instructions of your own")
                for major, names in _majors(isa).items()
            ),
        ),
    ]
    group = ""
    for item in isa.instructions.values():
        if item.group != group:
            group = item.group
            lines += ["", f"## {group.capitalize()}"]
        lines += ["", page(item, isa)]
    return "\n".join(lines) + "\n"


def page(item: Instruction, isa: Isa) -> str:
    """Return the page of one instruction."""
    lines = [
        f"### {item.name}",
        "",
        f"**{item.title}.** {item.text}",
        "",
        *_table(
            ("syntax", "encoding"),
            (
                (f"`{plain_syntax(form, isa)}`" + (" (alias)" * form.alias), f"`{form.pattern}`")
                for form in item.forms
            ),
        ),
        "",
        "Operation:",
        "",
        "```python",
        *item.semantics.splitlines(),
        "```",
        "",
        *names_of_operation(item, isa),
        f"Flags written: {', '.join(item.flags) or 'none'}. Timing class: {item.timing}.",
    ]
    return "\n".join(lines)


def names_of_operation(item: Instruction, isa: Isa) -> Iterator[str]:
    """Explain the names of the operation that are not operands of the syntax."""
    for name, meanings in _bindings(item, isa).items():
        yield f"Here `{name}` is {' or '.join(meanings)}."
        yield ""


def _bindings(item: Instruction, isa: Isa) -> dict[str, list[str]]:
    bound: dict[str, list[str]] = {}
    for form in item.forms:
        if form.alias:
            continue
        pairs = [(s.name, s.operand.name) for s in form.slots.values()] + list(form.let.items())
        for name, meaning in pairs:
            if name not in isa.operands and f"`{meaning}`" not in bound.setdefault(name, []):
                bound[name].append(f"`{meaning}`")
    return bound


def plain_syntax(form: Form, isa: Isa) -> str:
    """Return the syntax without braces: ``ADD rd, #imm`` for ``ADD {rd}, #{y:imm}``."""
    names = isa.operands
    return re.sub(r"\{(?:(\w+):)?(\w+)\}", lambda m: m[1] if m[1] in names else m[2], form.syntax)


def _majors(isa: Isa) -> Mapping[int, dict[str, None]]:
    names: dict[int, dict[str, None]] = {major: {} for major in range(16)}
    for item in isa.instructions.values():
        for form in item.forms:
            if not form.alias:
                names[form.match >> 12][item.name] = None
    return names


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield f"|{' --- |' * len(head)}"
    for row in rows:
        yield f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |"
