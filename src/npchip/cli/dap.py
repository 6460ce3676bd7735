"""``npchip dap``: the debug adapter, for editors."""

from __future__ import annotations

import sys

import click


@click.command("dap")
def command() -> None:
    """Serve an editor's debugger: breakpoints, steps forward and back, values, pictures.

    The editor starts it, and speaks the Debug Adapter Protocol with it on standard input and
    output. A launch takes program, frames, machine, defines, memory, stopOnEntry and more.

    \b
    Example:
      npchip dap
    """
    from npchip.dap.adapter import serve

    sys.exit(serve())
