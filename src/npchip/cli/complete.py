"""What the shell completes: files, machines, mnemonics."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem


def files(_ctx: click.Context, _option: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Leave it to the shell to complete a file name."""
    return [CompletionItem(incomplete, type="file")]


def machines(ctx: click.Context, option: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Shipped machines, and files; each after a comma too."""
    from npchip.machine import BUILTIN

    listed, comma, last = incomplete.rpartition(",")
    names = [CompletionItem(f"{listed}{comma}{name}") for name in BUILTIN if name.startswith(last)]
    return names or files(ctx, option, incomplete)


def mnemonics(
    _ctx: click.Context, _option: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Instructions with their titles."""
    from npchip.isa import load_isa

    forms = {
        form.mnemonic: item.title
        for item in load_isa().instructions.values()
        for form in item.forms
    }
    return [
        CompletionItem(name, help=title)
        for name, title in forms.items()
        if name.startswith(incomplete.upper())
    ]
