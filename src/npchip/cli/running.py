"""Options of the commands that run programs, running them, and reporting how they end."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, NoReturn

import click

from npchip.base.errors import InputError
from npchip.cli.options import bundled, memory_files, quantity, together
from npchip.cli.programs import program_options
from npchip.cli.progress import frame_progress

if TYPE_CHECKING:
    from npchip.frames import FrameSource
    from npchip.frames.memory import Planes
    from npchip.isa import Isa
    from npchip.machine import Machine
    from npchip.program.model import Program
    from npchip.run.chip import Chip
    from npchip.run.result import RunResult, Status

EXIT_CODES: dict[Status, int] = {
    "halted": 0,
    "frames-exhausted": 0,
    "failed": 1,
    "cycle-limit": 3,
}

fit_option = click.option(
    "--fit", type=click.Choice(["crop", "resize"]), help="What to do with another frame size."
)
engine_option = click.option(
    "--engine",
    type=click.Choice(["auto", "wasm", "reference"]),
    default="auto",
    help="What executes the program; results are the same.",
)
clip_options = together(
    click.option(
        "--frames",
        metavar="SOURCE",
        shell_complete=bundled("clip"),
        help="Clip: .npy, images (folder, 'glob'), GIF, video.",
    ),
    fit_option,
)
run_options = together(
    clip_options,
    engine_option,
    click.option(
        "--max-cycles",
        callback=quantity,
        metavar="N",
        default="50M",
        help="Limit for each frame.",
    ),
)
memory_option = click.option(
    "--memory",
    callback=memory_files,
    metavar="ADDR=FILE.npy",
    multiple=True,
    help="Write NP memory from ADDR on first; may be repeated.",
)


program_command = together(
    click.argument("program", shell_complete=bundled("program")),
    run_options,
    program_options,
    memory_option,
)
"""Argument and options of the commands that run one program."""


def open_clip(options: dict[str, Any], machine: Machine) -> FrameSource | None:
    """Open the clip of ``--frames``; return None if there is none.

    Raises:
        InputError: the clip cannot be used.
    """
    if options["frames"] is None:
        return None
    from npchip.frames import open_frames

    return open_frames(options["frames"], machine.rows, machine.cols, options["fit"])


def given_memory(options: dict[str, Any], machine: Machine) -> list[Planes]:
    """Read the files of ``--memory``.

    Raises:
        InputError: a file cannot be used.
    """
    from npchip.frames.memory import read_memory

    return [(address, read_memory(address, file, machine)) for address, file in options["memory"]]


def execute(
    chip: Chip, options: dict[str, Any], frames: FrameSource | None, note: str = ""
) -> RunResult:
    """Run a chip with a progress bar.

    Args:
        chip: a chip after reset.
        options: options of the command, with the program's file as ``program``.
        frames: the clip, if there is one.
        note: first words of a note that another engine runs the program than the requested one.

    Raises:
        InputError: an input cannot be used, or frames are missing.
    """
    warn_of_frames(chip, options)
    notice = chip.notice
    if notice:
        click.echo(f"note: {note}{notice}", err=True)
    with frame_progress(frames.count if frames else None) as on_frame:
        result = chip.run(frames, max_cycles=options["max_cycles"], on_frame=on_frame)
    if not notice and chip.notice:  # known only once the program was compiled
        click.echo(f"note: {note}{chip.notice}", err=True)
    if frames is None and result.status == "frames-exhausted":
        raise clip_is_missing(options["program"])
    return result


def finish(result: RunResult, max_cycles: int, chip: Chip) -> NoReturn:
    """Report a run that did not end well on standard error, and exit."""
    if result.error:
        click.echo(result.error, err=True)
    elif result.status == "cycle-limit":
        last = result.first_frame + result.frames - 1
        what = f"frame {last}" if result.frames else "the set-up"
        click.echo(limit_reached(what, max_cycles, chip), err=True)
    sys.exit(EXIT_CODES[result.status])


def limit_reached(what: str, max_cycles: int, chip: Chip) -> str:
    """Return the error that a run has reached its limit of cycles, and where (NP321)."""
    from npchip.run.stuck import stuck

    at = stuck(chip)
    return (
        f"{at.place}error: {what} reached the limit of {max_cycles:,} cycles [NP321]\n"
        f"  note: {at.loops}\n"
        "  hint: look for an endless loop, or give --max-cycles a higher limit"
    )


def takes_frames(program: Program, isa: Isa) -> bool:
    """Return whether a word of a program takes a frame."""
    return any(word is not None and word.form.exposes for word in program.decoded(isa))


def warn_of_frames(chip: Chip, options: dict[str, Any]) -> None:
    """Warn of a clip that the program never takes a frame of (NP257)."""
    if options["frames"] is not None and not takes_frames(chip.program, chip.isa):
        click.echo(
            f"warning: {options['program']} takes no frames: --frames {options['frames']} has no"
            " effect [NP257]\n"
            "  hint: an EXPOSE takes the next frame, and a SAMPLE converts it",
            err=True,
        )


def clip_is_missing(program: str) -> InputError:
    """Return the error for a program that takes frames when no clip is given (NP246)."""
    return InputError(
        "NP246",
        f"{program} takes frames, but --frames is missing",
        hint="such as --frames coin_slide",
    )
