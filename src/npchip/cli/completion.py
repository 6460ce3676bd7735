"""``npchip completion``: print a shell's completion script."""

from __future__ import annotations

import click

from npchip.cli.output import emit

_SHELLS = ("bash", "zsh", "fish")


@click.command("completion")
@click.argument("shell", type=click.Choice(_SHELLS))
@click.pass_context
def command(ctx: click.Context, shell: str) -> None:
    """Print a script for SHELL that completes commands, options, machines, mnemonics and files.

    \b
    For bash:
      mkdir -p ~/.local/share/bash-completion/completions
      npchip completion bash > ~/.local/share/bash-completion/completions/npchip
    For zsh, in ~/.zshrc after compinit:
      eval "$(npchip completion zsh)"
    For fish:
      npchip completion fish > ~/.config/fish/completions/npchip.fish
    """
    from click.shell_completion import get_completion_class

    kind = get_completion_class(shell)
    assert kind is not None
    # click itself derives the name of the variable from the name of the program.
    emit(kind(ctx.find_root().command, {}, "npchip", "_NPCHIP_COMPLETE").source() + "\n")
