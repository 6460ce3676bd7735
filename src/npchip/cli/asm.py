"""``npchip asm``: check a source, list it, write it as a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_writable
from npchip.cli.options import bundled, path_option
from npchip.cli.output import emit
from npchip.cli.programs import load, program_options
from npchip.cli.running import given_memory, memory_option

if TYPE_CHECKING:
    from npchip.frames.memory import Planes
    from npchip.isa import Isa
    from npchip.machine import Machine
    from npchip.program.model import Program


@click.command("asm")
@click.argument("source", shell_complete=bundled("program"))
@path_option(
    "-o",
    "--output",
    help="Write the program: .npo (keeps names and lines), .hex ($readmemh), .bin, or .wasm "
    "(a module that any WebAssembly host can run).",
)
@click.option("--listing", is_flag=True, help="Print each line with address, word and cycles.")
@click.option(
    "--cycles", is_flag=True, help="Bounds of the cycles of frames, routines and straight code."
)
@program_options
@memory_option
def command(**options: Any) -> None:
    """Assemble SOURCE: check it, list it, write it.

    Without --listing, --cycles or -o it only checks, and says how much of the program ROM is
    used. All mistakes are shown in one go; exit code 2 if there are any.

    \b
    Examples:
      npchip asm trajectory
      npchip asm trajectory --listing
      npchip asm trajectory --cycles --machine conservative
      npchip asm trajectory --define THRESHOLD=16 -o trajectory16.npo
      npchip asm trajectory -o trajectory.wasm
    """
    from npchip.assembler.listing import listing, read_texts
    from npchip.formats import write_program
    from npchip.formats.files import MODULE
    from npchip.run.checks import check_fit

    if options["output"]:
        check_writable(options["output"])
    is_module = Path(options["output"] or "").suffix.lower() in MODULE
    if options["memory"] and not is_module:
        raise InputError(
            "NP244",
            "--memory is for a module: only -o FILE.wasm holds what is in the NPs' memory",
            hint="give --memory to npchip run instead",
        )
    isa, machine, program = load(options["source"], options)
    if is_module:
        check_fit(program, machine, isa)
    memory = _memory(options, program, machine)
    if options["output"]:
        write_program(program, options["output"], isa, machine, memory if is_module else ())
    if options["cycles"]:
        _emit_cycles(program, machine, isa, listed=options["listing"])
    elif options["listing"]:
        emit(listing(program, read_texts(program), [machine], isa))
    elif not options["output"]:
        emit(_summary(program, machine))


def _memory(options: dict[str, Any], program: Program, machine: Machine) -> list[Planes]:
    """Read what the NPs' memory holds before a run."""
    if not program.memory and not options["memory"]:
        return []  # without NumPy
    from npchip.frames.memory import initial_memory

    return initial_memory(program, machine, given_memory(options, machine))


def _emit_cycles(program: Program, machine: Machine, isa: Isa, *, listed: bool) -> None:
    from npchip.assembler.listing import read_texts
    from npchip.program.bounds import static_view
    from npchip.program.graph import TooManyPlacesError
    from npchip.report.bounds import listing, summary

    try:
        view = static_view(program, machine, isa)
    except TooManyPlacesError:
        raise InputError(
            "NP620",
            f"--cycles: {program.name} has too many ways to be followed",
            hint="each routine is looked at for each way of calling it: fewer calls in calls help",
        ) from None
    if listed:
        emit(listing(program, machine, view, read_texts(program), isa) + "\n")
    emit(summary(program, machine, view))


def _summary(program: Program, machine: Machine) -> str:
    used, room = len(program.words), machine.rom_words
    lines = [f"{program.name}: {used} words of {room}, {room - used} left"]
    lines += [f"  output {o.name}: port {o.port}, {o.kind}" for o in program.outputs]
    lines += [f"  {name} = {value}" for name, value in program.symbols.items()]
    return "\n".join(lines) + "\n"
