"""``npchip disasm``: turn a program back into source."""

from __future__ import annotations

from typing import Any

import click

from npchip.base.files import check_writable, write_text
from npchip.cli.options import bundled, path_option
from npchip.cli.output import emit
from npchip.cli.programs import load, program_options


@click.command("disasm")
@click.argument("program", shell_complete=bundled("program"))
@path_option("-o", "--output", help="Write to a file.")
@program_options
def command(**options: Any) -> None:
    """Turn PROGRAM back into a source that assembles to the same words.

    Labels are those of an .npo file, or made up from their address.

    \b
    Examples:
      npchip disasm program.npo
      npchip disasm rom.hex -o rom.s
    """
    from npchip.assembler import disassemble

    if options["output"]:
        check_writable(options["output"])
    isa, _, program = load(options["program"], options)
    text = disassemble(program, isa)
    if options["output"]:
        write_text(options["output"], text)
    else:
        emit(text)
