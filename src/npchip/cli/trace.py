"""``npchip trace``: show the effect of every instruction on chosen NPs."""

from __future__ import annotations

import sys
from itertools import takewhile
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_writable, write_text
from npchip.base.numbers import whole_number
from npchip.cli.options import bundled, path_option, quantity
from npchip.cli.output import need
from npchip.cli.programs import load, program_options
from npchip.cli.running import (
    clip_is_missing,
    clip_options,
    given_memory,
    memory_option,
    open_clip,
    takes_frames,
    warn_of_frames,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from npchip.machine import Machine
    from npchip.run.chip import Chip
    from npchip.trace import Event

_LINES, _WAVES = 200, 100_000
_CHUNK = 50


@click.command("trace")
@click.argument("program", shell_complete=bundled("program"))
@clip_options
@program_options
@memory_option
@click.option(
    "--np",
    "nps",
    metavar="ROW,COL",
    multiple=True,
    help="An NP to look at; may be repeated.  [default: 0,0]",
)
@click.option(
    "--from",
    "begin",
    metavar="CYCLE|fFRAME",
    default="0",
    show_default=False,  # the help says it, and so the completion does too
    help="Where to begin.  [default: 0]",
)
@click.option("--to", "end", metavar="CYCLE|fFRAME", help="What not to trace any more.")
@click.option(
    "--limit",
    callback=quantity,
    metavar="N",
    help=f"Most instructions.  [default: {_LINES}, with --vcd {_WAVES}]",
)
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON Lines instead of text.")
@path_option("--vcd", help="Write waves for GTKWave or Surfer instead; needs npchip[trace].")
@click.option(
    "--signal",
    "names",
    metavar="NAME",
    multiple=True,
    help="What --vcd shows: pc, r3, Z, active, mem[18], ...; may be repeated.",
)
def command(**options: Any) -> None:
    """Trace PROGRAM: each instruction, and what it changes in chosen NPs.

    A frame such as f5 stands for its expose: --from f5 --to f6 is one frame. Up to where the
    trace begins the program runs compiled.

    \b
    Examples:
      npchip trace trajectory --frames coin_slide --np 3,4
      npchip trace trajectory --frames clip.npy --np 3,4 --np 3,5 --from f5 --to f6 --json
      npchip trace trajectory --frames clip.npy --from f5 --vcd frame5.vcd --signal r3
    """
    from npchip import Chip
    from npchip.engines.base import TrapError
    from npchip.run.chip import MAX_CYCLES
    from npchip.trace import Position, record, seek

    begin = Position.parse(options["begin"])
    end = Position.parse(options["end"]) if options["end"] else None
    if end is not None and end.is_frame == begin.is_frame and end.number <= begin.number:
        raise InputError(
            "NP610",
            f"--from {options['begin'][:40]} --to {options['end'][:40]} leaves nothing to trace",
            hint="--to names what is not traced any more, and comes after --from",
        )
    _refuse_early(options)
    isa, machine, program = load(options["program"], options)
    nps = [_np(text, machine) for text in options["nps"] or ["0,0"]]
    if options["frames"] is None and takes_frames(program, isa):
        raise clip_is_missing(options["program"])
    frames = open_clip(options, machine)
    chip = Chip(program, machine, isa=isa, memory=given_memory(options, machine))
    warn_of_frames(chip, options)
    limit = options["limit"] or (_WAVES if options["vcd"] else _LINES)
    try:
        seek(chip, frames, begin, MAX_CYCLES)
        events = record(chip, nps)
        wanted = takewhile(
            lambda event: end is None or not end.reached(event.cycle, event.frame),
            (event for event in events if begin.reached(event.cycle, event.frame)),
        )
        shown = _limited(wanted, limit)
        if options["vcd"]:
            count = _write_waves(options, chip, nps, shown)
        else:
            count = _print(options, nps, shown)
        if not count:
            click.echo("note: the run has no such part", err=True)
    except TrapError as fault:
        place = program.place(fault.address)
        where = f"{place.file}:{place.line}: " if place else ""
        click.echo(f"{where}error: at address {fault.address}: {fault} [{fault.code}]", err=True)
        sys.exit(1)


def _refuse_early(options: dict[str, Any]) -> None:
    """Raise before the run what would stop its output later."""
    if options["vcd"]:
        if options["json_wanted"]:
            raise InputError("NP613", "--json and --vcd exclude each other", hint="give one")
        need("vcd", "NP614", "--vcd", "trace")
        check_writable(options["vcd"])
    elif options["names"]:
        raise InputError("NP613", "--signal is about --vcd", hint="give --vcd FILE too")


def _np(text: str, machine: Machine) -> tuple[int, int]:
    parts = text.split(",")
    numbers = [whole_number(part) for part in parts]
    row, col = (*numbers, None, None)[:2]
    if len(parts) != 2 or row is None or col is None or min(row, col) < 0:
        raise InputError("NP615", f"--np {text[:40]}: expected ROW,COL", hint="such as --np 3,4")
    if row >= machine.np_rows or col >= machine.np_cols:
        raise InputError(
            "NP615",
            f"--np {text[:40]}: machine {machine.name} has NPs 0,0 to "
            f"{machine.np_rows - 1},{machine.np_cols - 1}",
        )
    return row, col


def _print(options: dict[str, Any], nps: list[tuple[int, int]], events: Iterator[Event]) -> int:
    """Print events and return their number."""
    from npchip.trace.text import header, json_line, line

    write = json_line if options["json_wanted"] else line
    lines = [] if options["json_wanted"] else [header(nps)]
    count = 0
    try:
        for event in events:
            count += 1
            lines.append(write(event))
            if len(lines) >= _CHUNK:
                click.echo("\n".join(lines))
                lines.clear()
    finally:
        if lines:
            click.echo("\n".join(lines))
    return count


def _write_waves(
    options: dict[str, Any], chip: Chip, nps: list[tuple[int, int]], events: Iterator[Event]
) -> int:
    """Write events as waves and return their number."""
    from npchip.trace.waves import Waves, signals

    waves = Waves(chip, nps, signals(options["names"], len(chip.memory)))
    count = 0
    try:
        for event in events:
            count += 1
            waves.add(event)
    except Exception:  # a trap shows what came before it; an interrupted trace is not half written
        write_text(options["vcd"], waves.text())
        raise
    write_text(options["vcd"], waves.text())
    return count


def _limited(events: Iterator[Event], limit: int) -> Iterator[Event]:
    """Yield the first `limit` events; print a note if there are more."""
    for count, event in enumerate(events):
        if count == limit:
            click.echo(f"note: {limit:,} instructions are shown; --limit N shows more", err=True)
            return
        yield event
