"""Examine a source that may have errors: what is wrong, and all that is known nevertheless."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from npchip.assembler.assembler import Assembly
from npchip.assembler.diagnostics import Diagnostic
from npchip.assembler.expander import Expander
from npchip.assembler.sources import read_source
from npchip.base.errors import NpchipError
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.model import Program


class Examined(NamedTuple):
    """All that is known of a source.

    Attributes:
        program: the program; None if the source has errors.
        error: why there is none.
        warnings: the warnings about a program without errors.
        expander: the source expanded, as far as its errors allow.
    """

    program: Program | None
    error: NpchipError | None
    warnings: Sequence[Diagnostic]
    expander: Expander


def examine(
    path: Path,
    machine: Machine,
    defines: Mapping[str, int],
    isa: Isa,
    *,
    include_paths: Sequence[str | Path] = (),
    texts: Mapping[Path, str],
) -> Examined:
    """Assemble a source as `npchip.assembler.assemble` does, and keep what its errors leave.

    Args:
        path: the file.
        machine: as for `assemble`.
        defines: as for `assemble`.
        isa: as for `assemble`.
        include_paths: as for `assemble`.
        texts: texts that stand for files; see `npchip.assembler.sources.Sources`.

    Raises:
        InputError: NP025, the file cannot be read.
    """
    real = path.resolve()
    text = read_source(real, str(path), texts=texts)
    assembly = Assembly(isa, machine, defines, include_paths, texts)
    warnings: list[Diagnostic] = []
    program, error = None, None
    try:
        program = assembly.assemble(text, str(path), real, path.stem, warnings.append)
    except NpchipError as found:
        error = found
    return Examined(program, error, warnings, assembly.expander)
