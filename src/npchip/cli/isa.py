"""``npchip isa``: show the instruction set, or the page of one instruction."""

from __future__ import annotations

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
        text = page(item, isa)
        _show(text if markdown else f"{text}\n\n{_cycles(item)}", raw=markdown)
    elif markdown:
        emit(manual(isa))
    else:
        emit(_overview(isa))


def _find(isa: Isa, mnemonic: str) -> Instruction:
    name = mnemonic.upper()
    for item in isa.instructions.values():
        if name in {item.name, *(form.mnemonic for form in item.forms)}:
            return item
    raise InputError("NP260", f"no instruction '{mnemonic}'", hint=_instead(isa, mnemonic))


def _instead(isa: Isa, word: str) -> str:
    """Return a hint for a word that is no instruction: a directive, a condition, another's name."""
    from npchip.assembler.blocks import DIRECTIVES
    from npchip.assembler.suggestions import INSTEAD

    name = word.upper()
    if word.lower() in DIRECTIVES:
        return f"{word.lower()} is a directive of the assembler: docs/assembly.md"
    if name in isa.condition_names:
        return f"{name} is a condition, as in WHERE {name} and JANY {name}: npchip isa JANY"
    near = near_miss(name, isa.forms)
    return INSTEAD.get(name) or (f"did you mean {near}?" if near else "npchip isa lists them all")


def _show(text: str, *, raw: bool) -> None:
    """Print a page, laid out if it goes to a terminal and `raw` is false."""
    if raw or not sys.stdout.isatty():
        emit(f"{text}\n")
        return
    from rich.markdown import Markdown

    from npchip.report.terminal import drawn

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
        forms = "  ".join(plain_syntax(form, isa) for form in item.forms if not form.alias)
        lines.append(f"  {item.name:<8}{item.title:<{width}}{forms}")
    lines.append("Conditions: " + " ".join(isa.condition_names))
    return "\n".join(lines) + "\n"
