"""Programs read from and written to files; the suffix names the format."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from npchip import bundle
from npchip.assembler import Diagnostic, assemble
from npchip.base.errors import InputError
from npchip.base.files import open_input, write_bytes, write_text
from npchip.formats import npo, rom
from npchip.isa import Isa, load_isa
from npchip.machine import Machine, load_machine
from npchip.program.checks import mask_depths
from npchip.program.model import Program

if TYPE_CHECKING:
    from npchip.formats.module import Memory

OBJECT: Final = (".npo",)
READMEMH: Final = (".hex", ".mem")
BINARY: Final = (".bin",)
MODULE: Final = (".wasm",)
ASSEMBLED: Final = OBJECT + READMEMH + BINARY

_MAX_BYTES = 16 << 20


def load_program(
    path: str | Path,
    machine: str | Path | Machine = "default",
    defines: Mapping[str, int] | None = None,
    isa: Isa | None = None,
    *,
    include_paths: Sequence[str | Path] = (),
    on_warning: Callable[[Diagnostic], None] | None = None,
) -> Program:
    """Return an assembled program (``.npo``, ``.hex``, ``.mem``, ``.bin``), or that of a source.

    Args:
        path: the file, or the name of a bundled program.
        machine: the machine to assemble for; masks may nest as deep as it allows.
        defines: values for ``.equ`` constants of a source.
        isa: instruction set; the built-in one if not given.
        include_paths: folders besides its own from which a source may include files.
        on_warning: called with each warning about a source.

    Raises:
        InputError: the file cannot be used; NP110 an assembled file without words, or whose masks
            do not nest; NP032 an object that is not for this machine; NP113 constants defined for
            an assembled file.
        AssemblyError: a source has errors.
    """
    file = bundle.find("program", path)
    suffix = file.suffix.lower()
    isa = isa or load_isa()
    if suffix not in ASSEMBLED:
        return assemble(
            file, machine, defines, isa, include_paths=include_paths, on_warning=on_warning
        )
    if defines:
        raise InputError(
            "NP113",
            f"{file} is assembled: its constants cannot be defined any more",
            hint="define them when assembling: npchip asm SOURCE --define NAME=VALUE -o FILE",
        )
    data = _read(file)
    if suffix in BINARY:
        program = Program(file.stem, tuple(rom.from_binary(data, str(file))))
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            message = f"{file}: not text (byte {error.start})"
            raise InputError("NP111" if suffix in OBJECT else "NP112", message) from None
        if suffix in OBJECT:
            program = npo.from_text(text, str(file), isa)
            npo.check_requirements(program, load_machine(machine), str(file))
        else:
            program = Program(file.stem, tuple(rom.from_readmemh(text, str(file))))
    depth = load_machine(machine).mask_depth
    if not program.words:
        raise InputError("NP110", f"{file}: holds no words")
    _, faults = mask_depths(program.decoded(isa), depth)
    if faults:
        message = f"{file}: address {faults[0].address}: {faults[0].message}"
        raise InputError("NP110", message)
    return program


def write_program(
    program: Program,
    path: str | Path,
    isa: Isa | None = None,
    machine: str | Path | Machine = "default",
    memory: Memory = (),
) -> None:
    """Write a program in the format that the suffix names.

    Args:
        program: the program.
        path: the file.
        isa: the program's instruction set; the built-in one if not given.
        machine: the machine of a module (``.wasm``), and that of an object whose program has
            ``.memory`` lines; other formats do not need it.
        memory: what the NPs' memory of a module holds at reset, besides what ``.memory`` lines
            say; see `npchip.formats.module`.

    Raises:
        InputError: NP114 unknown suffix; NP243 a file of a ``.memory`` line cannot be read, or
            does not fit; NP116 a program that cannot be a module; or the file
            cannot be written.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    isa = isa or load_isa()
    if suffix in OBJECT:
        if program.memory:
            from npchip.frames.memory import with_bytes  # noqa: PLC0415 - needs NumPy

            program = with_bytes(program, load_machine(machine))
        write_text(file, npo.to_text(program, isa))
    elif suffix in READMEMH:
        write_text(file, rom.to_readmemh(program, isa))
    elif suffix in BINARY:
        write_bytes(file, rom.to_binary(program))
    elif suffix in MODULE:
        from npchip.formats.module import to_module  # noqa: PLC0415 - the translator takes long

        of = load_machine(machine)
        held: Any = memory
        if program.memory:
            from npchip.frames.memory import initial_memory  # noqa: PLC0415 - needs NumPy

            held = initial_memory(program, of, held)
        write_bytes(file, to_module(program, of, isa, held))
    else:
        raise InputError(
            "NP114",
            f"{file}: unknown format '{suffix}': expected one of {', '.join(ASSEMBLED + MODULE)}",
            hint=".npo keeps names and lines; .hex is for $readmemh; .bin is raw words; .wasm is a "
            "module that any host can run",
        )


def _read(file: Path) -> bytes:
    try:
        with open_input(file) as stream:
            data = stream.read(_MAX_BYTES + 1)
    except OSError as error:
        raise InputError("NP115", f"cannot read {file}: {error.strerror or error}") from None
    if len(data) > _MAX_BYTES:
        raise InputError("NP115", f"{file}: larger than {_MAX_BYTES >> 20} MiB: not a program")
    return data
