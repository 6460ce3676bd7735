"""The reference manual of an instruction set, in Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from npchip.isa.model import Form, Instruction, Isa, Operand

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
        "below run in order, each seeing what the earlier ones wrote; [isa-file.md](isa-file.md)",
        "describes their language. `mask_push`, `mask_invert` and `mask_pop` change the counters,",
        "which [decisions.md](decisions.md#decisions-masks) explains.",
        "",
        "An instruction adds the cycles of its timing class and goes on at the next address unless",
        "it jumps. How a run ends:",
        "",
        *_table(("event", "what is counted", "PC afterwards"), _ENDS),
        "",
        *_table(("trap", "when"), _TRAPS),
        "",
        "## Conditions",
        "",
        *_table(
            ("condition", "also", "code", "holds where", "meaning"),
            (
                (
                    f"`{c.name}`",
                    ", ".join(f"`{a}`" for a in c.aliases),
                    str(c.code),
                    f"`{c.when_text}`",
                    c.text,
                )
                for c in isa.conditions.values()
            ),
        ),
        "",
        "## Operands",
        "",
        "A letter of an encoding marks the bits of an operand, the highest bit first.",
        "",
        *_table(
            ("operand", "letter", "is", "in the word"),
            ((f"`{o.name}`", f"`{o.letter}`", o.text, _stored(o)) for o in isa.operands.values()),
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
        "",
        "## Undefined words",
        "",
        "A word is defined if it has one of the encodings below, with every 0 and 1 in its place,",
        f"and in no operand {_unused(isa)}. Any other is a trap when it is reached (NP303).",
        f"Of the 65,536 words {sum(isa.decode(word) is not None for word in range(1 << 16)):,} are",
        "defined.",
    ]
    group = ""
    for item in isa.instructions.values():
        if item.group != group:
            group = item.group
            lines += ["", f"## {group.capitalize()}"]
        lines += ["", page(item, isa)]
    return "\n".join(lines) + "\n"


_ENDS: Final = (
    ("`HALT`", "its cycles and itself", "behind it; the chip stays halted until a reset"),
    ("`EXPOSE` without a frame left", "nothing", "at the `EXPOSE`; a run with new frames goes on"),
    ("a trap", "nothing; no state changes", "at the instruction"),
    (
        "the [cycle limit](json.md#the-cycle-limit)",
        "what was executed",
        "at the instruction that was not executed",
    ),
)
_TRAPS: Final = (
    ("NP301", "a call finds the return stack full"),
    ("NP302", "a return finds it empty"),
    ("NP303", "the word is undefined"),
    (
        "NP304",
        "`mask_push` finds `mask_depth` regions open; `mask_invert` or `mask_pop` finds none",
    ),
    (
        "NP305",
        "the PC is behind the program's last word, even if the ROM is larger; it does not wrap",
    ),
    ("NP306", "`input` finds no partner, or nothing more sent to the port in this frame"),
)


def _stored(operand: Operand) -> str:
    """Return how a word holds an operand."""
    if operand.kind == "choice":
        return ", ".join(f"`{name}` {code}" for name, code in operand.choices.items())
    if operand.kind == "condition":
        return "the code of the opposite condition" if operand.opposite else "its code"
    if operand.kind == "label":
        return "the address"
    return f"the number ÷ {operand.step}" if operand.step > 1 else "the number"


def _unused(isa: Isa) -> str:
    """Return the codes that the fields of operands can hold and that mean nothing."""
    found: dict[str, str] = {}
    for item in isa.instructions.values():
        for name, operand, _, width in (s for form in item.forms for s in form.slots.values()):
            if operand.kind in {"condition", "choice"}:
                conditions = {c.code for c in isa.conditions.values()}
                known = conditions if operand.kind == "condition" else {*operand.choices.values()}
            else:
                known = {*range(operand.least // operand.step, operand.most // operand.step + 1)}
            codes = sorted({*range(1 << width)} - known)
            if codes and operand.kind not in {"register", "label"}:
                found.setdefault(operand.letter, f"`{name}` {', '.join(map(str, codes))}")
    return " or ".join(found.values())


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
        *_other_letters(item, isa),
        "Operation:",
        "",
        "```python",
        *item.semantics.splitlines(),
        "```",
        "",
        *names_of_operation(item, isa),
        (
            f"Flags written: {', '.join(item.flags) or 'none'}."
            f" Timing class (its cycles are the machine's): {item.timing}."
        ),
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


def _other_letters(item: Instruction, isa: Isa) -> Iterator[str]:
    """Name the operands that stand in the bits of another."""
    for form in item.forms:
        for name, operand, *_ in form.slots.values():
            if name in isa.operands and isa.operands[name].letter != operand.letter:
                bits = f"`{operand.letter}` of `{form.pattern}`"
                yield f"In `{plain_syntax(form, isa)}` the bits {bits} hold `{name}`."
                yield ""


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
