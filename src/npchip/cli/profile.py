"""``npchip profile``: show where the cycles go and what a run covers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_writable, write_text
from npchip.cli.options import path_option
from npchip.cli.output import check_chart, emit
from npchip.cli.programs import load
from npchip.cli.running import execute, finish, given_memory, open_clip, program_command

if TYPE_CHECKING:
    from npchip.isa import Isa
    from npchip.profile import Profile


@click.command("profile")
@program_command
@click.option("--listing", is_flag=True, help="Print the source with counts beside each line.")
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of text.")
@path_option("--lcov", help="Write coverage for genhtml and editors.")
@path_option("--speedscope", metavar="FILE.json", help="Write a flame graph for speedscope.app.")
@path_option("--plot", help="Draw where the cycles go: .png or .svg; needs npchip[plot].")
def command(**options: Any) -> None:
    """Run PROGRAM on a clip and show where its cycles go.

    Prints cycles by routine, label and line, of the cheapest, the median and the dearest frame,
    and what was not covered. Exits as run does.

    \b
    Examples:
      npchip profile trajectory --frames coin_slide
      npchip profile trajectory --frames clip.npy --listing
      npchip profile trajectory --frames clip.npy --lcov cov.info --plot cycles.png
    """
    from npchip import Chip
    from npchip.profile import profile_of

    _refuse_early(options)
    isa, machine, program = load(options["program"], options)
    if options["lcov"] and not program.source:
        raise InputError(
            "NP600",
            f"--lcov: {options['program']} has no source lines to report on",
            hint="a raw image has none: profile the source or a .npo file",
        )
    frames = open_clip(options, machine)
    memory = given_memory(options, machine)
    chip = Chip(program, machine, options["engine"], isa, profile=True, memory=memory)
    result = execute(chip, options, frames)
    _deliver(options, profile_of(chip, result), isa)
    finish(result, options["max_cycles"], chip)


def _refuse_early(options: dict[str, Any]) -> None:
    """Raise before the run what would stop its output later."""
    if options["json_wanted"] and options["listing"]:
        raise InputError("NP601", "--json and --listing exclude each other", hint="give one")
    if options["plot"]:
        check_chart(options["plot"], "--plot", "NP602", "pictures are", "NP603")
    check_writable(*filter(None, map(options.get, ("lcov", "speedscope", "plot"))))


def _deliver(options: dict[str, Any], profile: Profile, isa: Isa) -> None:
    from npchip.assembler.listing import read_texts
    from npchip.profile.exports import lcov, speedscope
    from npchip.profile.jsonform import to_text
    from npchip.profile.text import annotated, report

    if options["lcov"]:
        write_text(options["lcov"], lcov(profile))
    if options["speedscope"]:
        write_text(options["speedscope"], speedscope(profile))
    if options["plot"]:
        from npchip.profile.chart import draw

        draw(profile, options["plot"])
    if options["json_wanted"]:
        emit(to_text(profile))
    elif options["listing"]:
        emit(annotated(profile, read_texts(profile.program), isa))
    else:
        emit(report(profile))
