"""``npchip lsp``: the language server, for editors."""

from __future__ import annotations

import sys

import click

from npchip.cli.output import need


@click.command("lsp")
@click.option("--stdio", is_flag=True, help="As some editors say it; nothing else is offered.")
def command(stdio: bool) -> None:  # noqa: ARG001 - there is no other way
    """Serve an editor: mistakes while typing, cards, completion, names, layout.

    The editor starts it, and speaks the Language Server Protocol with it on standard input and
    output. The page "Editors and shells" says how to set up Neovim, Emacs, Helix and Zed.

    \b
    Example:
      npchip lsp
    """
    need("pygls", "NP672", "npchip lsp", "editors")
    from npchip.lsp.features import serve

    sys.exit(serve())
