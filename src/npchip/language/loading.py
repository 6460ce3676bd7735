"""A program with what it is assembled for: what is given, else its project's, else the built-in."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from npchip import bundle
from npchip.formats import load_program
from npchip.formats.files import ASSEMBLED
from npchip.isa import Isa, read_isa
from npchip.language.settings import settings_for
from npchip.machine import Machine, load_machine

if TYPE_CHECKING:
    from npchip.assembler import Diagnostic
    from npchip.program.model import Program


def load(
    file: str,
    *,
    machine: str | None = None,
    isa_file: Path | None = None,
    include: Sequence[Path] = (),
    defines: Mapping[str, int],
    on_warning: Callable[[Diagnostic], None],
) -> tuple[Isa, Machine, Program]:
    """Load the instruction set, the machine and the program.

    Args:
        file: the program's file, or the name of a bundled one.
        machine: a shipped name or a file.
        isa_file: the file of an instruction set.
        include: folders besides its own and the project's from which it may include files.
        defines: values for ``.equ`` constants.
        on_warning: called with each warning about the source.

    Raises:
        NpchipError: a file cannot be used.
    """
    project = settings_for(bundle.find("program", file))
    isa = project.load_isa() if isa_file is None else read_isa(isa_file)
    made_for = (
        project.load_machine(isa) if machine is None else load_machine(machine, isa.timing_classes)
    )
    assembled = Path(file).suffix.lower() in ASSEMBLED  # its constants are what they are
    program = load_program(
        file,
        made_for,
        defines if assembled else {**project.defines, **defines},
        isa,
        include_paths=(*include, *project.include),
        on_warning=on_warning,
    )
    return isa, made_for, program
