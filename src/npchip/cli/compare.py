"""``npchip compare``: compare programs and machines."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_writable
from npchip.cli.options import bundled, machines, path_option, quantity
from npchip.cli.output import check_chart, clock_of, emit, table_text
from npchip.cli.programs import load, source_options
from npchip.cli.running import EXIT_CODES, execute, limit_reached, open_clip, run_options

if TYPE_CHECKING:
    from npchip.isa import Isa
    from npchip.machine import Machine
    from npchip.program.model import Program
    from npchip.report.comparison import Column


@click.command("compare")
@click.argument(
    "programs", metavar="PROGRAM...", nargs=-1, required=True, shell_complete=bundled("program")
)
@click.option(
    "--machine",
    "machines",
    metavar="NAME|FILE.yaml,...",
    shell_complete=machines,
    help="One or more machines, with commas between.  [default: default]",
)
@run_options
@source_options
@click.option(
    "--clock", callback=quantity, metavar="HZ", help="Show frame rates.  [JSON: default 10M]"
)
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of the table.")
@path_option("--chart", help="Draw cycles by task: .png or .svg; needs npchip[plot].")
def command(**options: Any) -> None:
    """Compare PROGRAMs, or one on several machines: words, cycles, what they go to.

    Exits as run does: 1 if one of the programs failed, 3 if one reached the cycle limit.

    \b
    Examples:
      npchip compare mine.s imaging --frames coin_slide
      npchip compare trajectory --machine default,conservative \\
          --frames mouse_run --chart machines.png
    """
    from npchip.report.comparison import rows, to_text

    if options["chart"]:
        check_chart(options["chart"], "--chart", "NP292", "charts are", "NP291")
        check_writable(options["chart"])
    found = _columns(options)
    columns = [column for column, _ in found]
    if options["json_wanted"]:
        emit(to_text(columns, options["frames"], clock_of(options)))
    else:
        emit(table_text(rows(columns, clock_of(options))))
    if options["chart"]:
        from npchip.report.chart import draw

        draw(columns, options["chart"])
    sys.exit(_exit_code(found))


def _columns(options: dict[str, Any]) -> list[tuple[Column, str]]:
    """Run all; return columns, each with the error if it has reached the limit."""
    listed = options["machines"]
    names = [None] if listed is None else [name.strip() for name in listed.split(",")]
    for given, what in ((names, "machine"), (options["programs"], "program")):
        twice = next((name for name in given if given.count(name) > 1), None)
        if twice is not None:
            raise InputError("NP290", f"{what} {twice or '(empty)'} is given twice")
    loaded = [
        (file, load(file, options | {"machine": name}))
        for file in options["programs"]
        for name in names
    ]
    stems = [Path(file).stem for file in options["programs"]]
    called = {
        file: stem if stems.count(stem) == 1 else file
        for file, stem in zip(options["programs"], stems, strict=True)
    }
    return [_column(options | {"program": file}, called[file], parts) for file, parts in loaded]


def _column(
    options: dict[str, Any], name: str, loaded: tuple[Isa, Machine, Program]
) -> tuple[Column, str]:
    from npchip import Chip
    from npchip.profile.tasks import cycles_by_task
    from npchip.report.comparison import Column

    isa, machine, program = loaded
    clip = open_clip(options, machine)
    chip = Chip(program, machine, options["engine"], isa)
    what = f"{name} on machine {machine.name}"
    result = execute(chip, options, clip, f"{what}: ")
    tasks = cycles_by_task(program, machine, isa, chip.executions)
    endless = result.status == "cycle-limit"
    error = limit_reached(what, options["max_cycles"], chip) if endless else ""
    return Column(name, options["program"], machine, len(program.words), result, tasks), error


def _exit_code(found: list[tuple[Column, str]]) -> int:
    """Report the runs that did not end well; return the lowest exit code among theirs, else 0."""
    codes = [EXIT_CODES[column.result.status] for column, _ in found]
    for (column, error), code in zip(found, codes, strict=True):
        if code:
            click.echo(column.result.error or error, err=True)
    return min(filter(None, codes), default=0)
