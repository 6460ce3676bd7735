"""Options that say how a program is assembled, and loading it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from npchip.cli.options import definitions, machines, path_option, together

if TYPE_CHECKING:
    from pathlib import Path

    from npchip.isa import Isa
    from npchip.machine import Machine
    from npchip.program.model import Program

machine_option = click.option(
    "--machine",
    metavar="NAME|FILE.yaml",
    default="default",
    shell_complete=machines,
    help="Array, timing and sensor.",
)
isa_option = path_option(
    "--isa",
    "isa_file",
    metavar="FILE.yaml",
    help="Instruction set of your own.",
)
include_option = path_option(
    "-I",
    "include_paths",
    metavar="DIR",
    multiple=True,
    help="Where .include may look outside the source's folder.",
)
source_options = together(
    click.option(
        "--define",
        "defines",
        callback=definitions,
        metavar="NAME=VALUE",
        multiple=True,
        help="Set an .equ of the source; may be repeated.",
    ),
    include_option,
    isa_option,
)
program_options = together(machine_option, source_options)


def load_isa_option(file: Path | None) -> Isa:
    """Return the instruction set of ``--isa``, or the built-in one.

    Raises:
        IsaError: the file cannot be used.
    """
    from npchip.isa import load_isa, read_isa

    return load_isa() if file is None else read_isa(file)


def load(file: str, options: dict[str, Any]) -> tuple[Isa, Machine, Program]:
    """Load the instruction set, the machine and the program; warnings go to standard error.

    Raises:
        NpchipError: a file cannot be used.
    """
    from npchip.formats import load_program
    from npchip.machine import load_machine

    isa = load_isa_option(options["isa_file"])
    machine = load_machine(options["machine"], isa.timing_classes)
    program = load_program(
        file,
        machine,
        options["defines"],
        isa,
        include_paths=options["include_paths"],
        on_warning=lambda warning: click.echo(warning, err=True),
    )
    return isa, machine, program
