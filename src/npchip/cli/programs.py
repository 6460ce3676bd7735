"""Options that say how a program is assembled, and loading it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from npchip.cli.options import definitions, machines, path_option, together

if TYPE_CHECKING:
    from npchip.isa import Isa
    from npchip.language.settings import Settings
    from npchip.machine import Machine
    from npchip.program.model import Program

machine_option = click.option(
    "--machine",
    metavar="NAME|FILE.yaml",
    shell_complete=machines,
    help="Array, timing and sensor.  [default: default]",
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


def project_of(file: str | Path | None) -> Settings:
    """Return what the project of a program says, or of the present folder if there is none.

    Raises:
        InputError: NP670, the project file cannot be used.
    """
    from npchip import bundle
    from npchip.language.settings import settings_for

    return settings_for(bundle.find("program", file or "."))


def load_isa_option(file: Path | None, program: str | Path | None = None) -> Isa:
    """Return the instruction set of ``--isa``, else that of the project, else the built-in one.

    Args:
        file: the value of the option.
        program: whose project counts; None for that of the present folder.

    Raises:
        NpchipError: the file cannot be used.
    """
    from npchip.isa import read_isa

    return project_of(program).load_isa() if file is None else read_isa(file)


def load(file: str, options: dict[str, Any]) -> tuple[Isa, Machine, Program]:
    """Load the instruction set, the machine and the program; warnings go to standard error.

    What the options leave open, the project file of the program says, if there is one.

    Raises:
        NpchipError: a file cannot be used.
    """
    from npchip.language import loading

    return loading.load(
        file,
        machine=options["machine"],
        isa_file=options["isa_file"],
        include=options["include_paths"],
        defines=options["defines"],
        on_warning=lambda warning: click.echo(warning, err=True),
    )
