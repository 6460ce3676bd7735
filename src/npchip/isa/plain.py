"""Pages of the manual as plain text."""

from __future__ import annotations

import textwrap

from npchip.isa.manual import names_of_operation, plain_syntax
from npchip.isa.model import ConditionCode, Instruction, Isa

_WIDTH = 79


def plain_page(item: Instruction, isa: Isa) -> str:
    """Return the page of one instruction, without marks of Markdown."""
    syntaxes = [plain_syntax(form, isa) + " (alias)" * form.alias for form in item.forms]
    width = max(map(len, syntaxes))
    lines = [
        f"{item.name} - {item.title}",
        "",
        *textwrap.wrap(_unmarked(item.text), _WIDTH),
        "",
        *(
            f"  {syntax:<{width}}  {form.pattern}"
            for syntax, form in zip(syntaxes, item.forms, strict=True)
        ),
        "",
        "Operation:",
        *(f"  {line}" for line in item.semantics.splitlines()),
        "",
        *(_unmarked(line) for line in names_of_operation(item, isa)),
        (
            f"Flags written: {', '.join(item.flags) or 'none'}."
            f" Timing class (its cycles are the machine's): {item.timing}."
        ),
    ]
    return "\n".join(lines)


def condition_page(condition: ConditionCode, isa: Isa) -> str:
    """Return what a condition is, and which instructions take it."""
    users = [
        plain_syntax(form, isa).replace("cc", condition.name)
        for item in isa.instructions.values()
        for form in item.forms
        if any(slot.operand.kind == "condition" for slot in form.slots.values())
    ]
    names = " or ".join((condition.name, *condition.aliases))
    return (
        f"{names} - a condition: {condition.text}\n\n"
        f"It holds where {condition.when_text}, after a CMP or what else writes the flags.\n"
        f"Taken by {', '.join(users)}."
    )


def _unmarked(text: str) -> str:
    return text.replace("`", "").replace("**", "")
