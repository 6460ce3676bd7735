"""``npchip run``: run a program on a clip."""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_writable, make_directory, write_text
from npchip.cli.options import path_option, quantity
from npchip.cli.output import clock_of, emit
from npchip.cli.programs import load
from npchip.cli.progress import step_progress
from npchip.cli.running import EXIT_CODES, execute, finish, given_memory, open_clip, program_command

if TYPE_CHECKING:
    from npchip.frames import FrameSource
    from npchip.program.model import Program
    from npchip.run.result import RunResult


@click.command("run")
@program_command
@click.option(
    "--clock", callback=quantity, metavar="HZ", help="Clock for frame rates.  [default: 10M]"
)
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of the table.")
@path_option("--json-to", help="Write JSON too.")
@path_option("--save", metavar="DIR", help="Write run.json and planes and pictures as .npy.")
@path_option("--render", help="Draw clip, outputs and path: .png or .gif.")
def command(**options: Any) -> None:
    """Run PROGRAM, an assembly source or an assembled file, on a clip.

    Prints the outputs and cycles of every frame. Exits with 0; 1 if the program failed or
    exceeds its .budget; 2 for bad input; 3 at the cycle limit.

    \b
    Examples:
      npchip run trajectory --frames coin_slide
      npchip run trajectory --frames clip.gif --fit crop --render path.gif
      npchip run trajectory --frames 'shots/*.png' --json > run.json
    """
    from npchip import Chip

    _refuse_early(options)
    isa, machine, program = load(options["program"], options)
    frames = open_clip(options, machine)
    chip = Chip(program, machine, options["engine"], isa, memory=given_memory(options, machine))
    result = execute(chip, options, frames)
    if machine.is_default:
        result = check_budget(result, program)
    _deliver(options, program, frames, result)
    finish(result, options["max_cycles"], chip)


def check_budget(result: RunResult, program: Program) -> RunResult:
    """Return a good run as failed (NP320) if its worst frame exceeds ``.budget cycles``."""
    from npchip.run.result import over_budget

    error = None if EXIT_CODES[result.status] else over_budget(result, program)
    return replace(result, status="failed", error=error) if error else result


def _refuse_early(options: dict[str, Any]) -> None:
    """Raise before the run what would stop its output later."""
    if options["json_wanted"] and options["json_to"]:
        raise InputError("NP244", "--json and --json-to exclude each other", hint="give one")
    if options["render"]:
        from npchip.report.picture import check_suffix

        check_suffix(options["render"])
    check_writable(*filter(None, (options["json_to"], options["render"])))
    if options["save"]:
        make_directory(options["save"])
        check_writable(options["save"] / "run.json")


def _deliver(
    options: dict[str, Any], program: Program, frames: FrameSource | None, result: RunResult
) -> None:
    from npchip.report.jsonform import array_files, save, to_document, to_text
    from npchip.report.table import plain_text

    clock = clock_of(options)
    text = ""
    if options["json_wanted"] or options["json_to"]:
        files = array_files(result) if options["save"] else {}
        text = to_text(to_document(result, clock.hz, files))
    if options["json_wanted"]:
        emit(text)
    elif sys.stdout.isatty():
        from shutil import get_terminal_size

        from npchip.report.terminal import terminal_text

        emit(terminal_text(result, clock, get_terminal_size().columns))
    else:
        emit(plain_text(result, clock))
    if options["json_to"]:
        write_text(options["json_to"], text)
    if options["save"]:
        save(result, clock.hz, options["save"])
    if options["render"]:
        from npchip.report.picture import is_animated, render

        clip = [] if frames is None else list(islice(frames, result.frames))
        if is_animated(options["render"]):
            with step_progress(result.frames) as on_step:
                on_picture = partial(on_step, "pictures")
                said = render(result, program, clip, options["render"], on_picture)
        else:
            said = render(result, program, clip, options["render"])
        if not options["json_wanted"]:
            emit(f"{'' if sys.stdout.isatty() else '# '}{said}\n")
