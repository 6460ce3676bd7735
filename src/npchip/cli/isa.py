"""``npchip isa``: show the instruction set, or the page of one instruction."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from npchip.base.errors import InputError
from npchip.base.suggest import near_miss
from npchip.cli.options import mnemonics
from npchip.cli.output import emit
from npchip.cli.programs import isa_option, load_isa_option

if TYPE_CHECKING:
    from npchip.isa import Instruction, Isa

_CODE = re.compile(r"NPW?\d{2,3}")


@click.command("isa")
@click.argument("mnemonic", required=False, shell_complete=mnemonics)
@click.option("--markdown", is_flag=True, help="Print the page, or the whole manual, as Markdown.")
@click.option("--textmate", is_flag=True, help="Print the grammar that editors colour sources by.")
@isa_option
def command(mnemonic: str | None, *, markdown: bool, textmate: bool, isa_file: Path | None) -> None:
    """Show the instruction set, or the page of one MNEMONIC.

    \b
    Examples:
      npchip isa                 all instructions, a line each
      npchip isa ADD             syntax, encoding, operation, flags, cycles
      npchip isa --markdown      the whole manual
    """
    from npchip.isa.manual import manual, page

    isa = load_isa_option(isa_file)
    if textmate:
        from npchip.editors.textmate import grammar

        emit(grammar(isa))
    elif mnemonic is not None:
        item = _find(isa, mnemonic)
        if item is None:
            emit(f"{_explained(isa, mnemonic)}\n")
        elif markdown:
            emit(f"{page(item, isa)}\n")
        else:
            _show(item, isa)
    elif markdown:
        emit(manual(isa))
    else:
        emit(_overview(isa))


def _find(isa: Isa, mnemonic: str) -> Instruction | None:
    name = mnemonic.upper()
    for item in isa.instructions.values():
        if name in {item.name, *(form.mnemonic for form in item.forms)}:
            return item
    return None


def _explained(isa: Isa, word: str) -> str:
    """Return what a word means that is no instruction.

    It may be a condition, a directive, or an instruction of other processors, which comes with
    the page of the one to take instead.

    Raises:
        InputError: NP260, it means nothing.
    """
    from npchip.assembler.suggestions import INSTEAD
    from npchip.assembler.usage import USAGE
    from npchip.isa.plain import condition_page, plain_page

    name = word.upper()
    for condition in isa.conditions.values():
        if name in {condition.name, *condition.aliases}:
            return condition_page(condition, isa)
    if word.lower() in USAGE:
        form, text = USAGE[word.lower()]
        return f"{word.lower()} - a directive of the assembler\n\n  {form}\n\n{text}"
    if name in INSTEAD:
        words = re.findall(r"[A-Z]{2,}", INSTEAD[name].replace("global OR", ""))
        found = (_find(isa, each) for each in words if each != name)
        meant = next(filter(None, found), None)
        about = f"{name} is no instruction here: {INSTEAD[name]}"
        return about if meant is None else f"{about}\n\n{plain_page(meant, isa)}\n{_cycles(meant)}"
    if _CODE.fullmatch(name):
        hint = "a code of messages: docs/errors.md says what it means and what to do"
        raise InputError("NP260", f"no instruction '{name}'", hint=hint)
    if f".{word.lower()}" in USAGE:
        return _explained(isa, f".{word}")
    near = near_miss(name, [*isa.forms, *isa.condition_names]) or near_miss(word.lower(), USAGE)
    raise InputError(
        "NP260",
        f"no instruction '{word[:80]}'",
        hint=f"did you mean {near}?" if near else "npchip isa lists them all",
    )


def _show(item: Instruction, isa: Isa) -> None:
    """Print a page, laid out if it goes to a terminal."""
    from npchip.isa.manual import page
    from npchip.isa.plain import plain_page

    if not sys.stdout.isatty():
        emit(f"{plain_page(item, isa)}\n{_cycles(item)}\n")
        return
    from rich.markdown import Markdown

    from npchip.report.terminal import drawn

    text = f"{page(item, isa)}\n\n{_cycles(item)}"
    emit(drawn(Markdown(text), min(100, shutil.get_terminal_size().columns)))


def _cycles(item: Instruction) -> str:
    from npchip.machine import BUILTIN, load_machine

    shown = (f"{load_machine(name).cycles(item.timing)} ({name})" for name in BUILTIN)
    return f"Cycles (decision): {', '.join(shown)}."


def _overview(isa: Isa) -> str:
    from npchip.isa.manual import plain_syntax

    width = max(len(item.title) for item in isa.instructions.values()) + 2
    lines: list[str] = []
    group = ""
    for item in isa.instructions.values():
        if item.group != group:
            group = item.group
            lines += [f"{group.capitalize()}:"]
        others = {form.mnemonic: form for form in item.forms if form.mnemonic != item.name}
        shown = [*(form for form in item.forms if not form.alias), *others.values()]
        forms = "  ".join(plain_syntax(form, isa) for form in dict.fromkeys(shown))
        lines.append(f"  {item.name:<8}{item.title:<{width}}{forms}")
    lines.append("Conditions: " + " ".join(isa.condition_names))
    return "\n".join(lines) + "\n"
