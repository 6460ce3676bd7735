"""``npchip fuse``: locate an object in space with two cameras."""

from __future__ import annotations

import sys
from itertools import count
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_suffix, check_writable, write_text
from npchip.cli.options import Whole, bundled, path_option, quantity
from npchip.cli.output import clock_of, emit, need, table_text
from npchip.cli.programs import machine_option
from npchip.cli.progress import frame_progress, step_progress
from npchip.cli.running import engine_option, fit_option

if TYPE_CHECKING:
    from npchip.host.rig import Observation
    from npchip.host.vision.fusion import Rig
    from npchip.report.table import Clock

_EXAMPLE = "npchip fuse LEFT RIGHT --rig chip"
_CALIBRATION = "npchip fuse --calibrate points.csv --rig chip"


@click.command("fuse")
@click.argument("left", required=False, shell_complete=bundled("clip"))
@click.argument("right", required=False, shell_complete=bundled("clip"))
@path_option(
    "--rig",
    metavar="RIG.yaml",
    shell_complete=bundled("rig"),
    help="Clips: where the two cameras stand.",
)
@click.option(
    "--algorithm",
    metavar="NAME",
    default="improved-2n",
    help="Clips: improved-2n, keep-y, extra-step; on a host any of --table.",
)
@click.option(
    "--link",
    type=click.Choice(["serial", "parallel", "host"]),
    default="serial",
    help="Clips: from camera 2 to 1, or both to a processor.",
)
@click.option(
    "--threshold",
    type=Whole(1, 255),
    help="Clips: the object is this bright.  [default: 128]",
)
@click.option("--dark", is_flag=True, help="Clips: or darker than that.")
@click.option("--follow", is_flag=True, help="Clips: follow what moves instead; --link host.")
@click.option("--predict", metavar="N", type=Whole(1, 100), help="Clips: N frames ahead, in space.")
@machine_option
@fit_option
@engine_option
@click.option(
    "--clock", callback=quantity, metavar="HZ", help="Clips: for frame rates.  [default: 10M]"
)
@path_option("--csv", help="Clips: write positions.")
@path_option("--plot", help="Clips: draw them: .png or .svg; needs npchip[plot].")
@click.option("--table", "table_wanted", is_flag=True, help="Reproduce table 2.1 of the thesis.")
@click.option(
    "--paths",
    metavar="N",
    default="1000",
    callback=quantity,
    help="Table: random paths of 20 positions, at most 20,000.",
)
@click.option(
    "--seed",
    metavar="N",
    type=Whole(0, 2**32 - 1),
    default=1,
    help="Table: seed of the random paths.",
)
@path_option("--calibrate", metavar="POINTS.csv", help="Find how the cameras of --rig are turned.")
@path_option("-o", "--output", metavar="RIG.yaml", help="Calibration: write the rig so turned.")
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of a table.")
def command(**options: Any) -> None:
    """Locate an object in space from what two cameras see.

    LEFT and RIGHT are the clips of camera 1 and 2 of the rig, in any form that run takes. Both
    cameras run on the emulated chip; camera 1, or a processor, works out the positions. Prints
    positions by frame and cycles by link. A frame without a position is marked and says why.

    --table measures the algorithms of thesis 2.2 on random paths, at the setting that was fitted
    to the thesis's table 2.1 and at the chip's own 64 x 80 pixels, and shows them beside the
    thesis's figures; last come algorithms that beat them.

    --calibrate takes known points: columns x, y, z (metres), row1, col1, row2, col2 (pixels; empty
    where a camera does not see it).

    \b
    Examples:
      npchip fuse ball.1 ball.2 --rig chip --algorithm extra-step --plot ball.png
      npchip fuse LEFT RIGHT --rig RIG.yaml --follow --link host --predict 4
      npchip fuse --calibrate points.csv --rig chip -o turned.yaml
      npchip fuse --table
      npchip fuse --table --paths 10000 --seed 7 --json
    """
    wanted = options["table_wanted"], options["left"], options["calibrate"]
    if (number := sum(bool(each) for each in wanted)) != 1:
        raise InputError(
            "NP512",
            "expected two clips, --table or --calibrate, found"
            f" {('neither', '', 'both', 'all')[number]}",
            hint=f"such as {_EXAMPLE}",
        )
    if options["output"] and not options["calibrate"]:
        raise InputError("NP512", "--output belongs to --calibrate", hint="positions go to --csv")
    if options["table_wanted"]:
        _table(options)
    elif options["calibrate"]:
        _calibrate(options)
    else:
        _watch(options)


def _table(options: dict[str, Any]) -> None:
    from npchip.host.vision.fusion.experiment import SETTINGS, table
    from npchip.host.vision.fusion.registry import ALGORITHMS
    from npchip.report.fusion_table import text, to_text

    paths, seed = options["paths"], options["seed"]
    with step_progress(len(SETTINGS) * (len(ALGORITHMS) + 1)) as advance:
        done = count(1)
        results = {
            name: (
                setting,
                table(setting, paths, seed, on_row=lambda _: advance("algorithms", next(done))),
            )
            for name, setting in SETTINGS.items()
        }
    if options["json_wanted"]:
        emit(to_text(results, paths, seed))
    else:
        emit(text(results, paths, seed, table_text))


def _calibrate(options: dict[str, Any]) -> None:
    """Find how cameras are turned, and print and write the rig."""
    from npchip.host.rig.points import read_points
    from npchip.host.vision.fusion import calibrate, load_rig
    from npchip.host.vision.fusion.rigfile import rig_text
    from npchip.report.calibration import json_text, plain_text

    if options["rig"] is None:
        hint = f"such as {_CALIBRATION}"
        raise InputError("NP524", "--calibrate needs --rig RIG.yaml", hint=hint)
    check_writable(*filter(None, (options["output"],)))
    rig = load_rig(options["rig"])
    found = calibrate(rig, *read_points(options["calibrate"]))
    emit(json_text(found) if options["json_wanted"] else plain_text(found))
    if options["output"]:
        write_text(options["output"], rig_text(found.rig))


def _watch(options: dict[str, Any]) -> None:
    """Locate the object of two clips, and print and write the positions."""
    _refuse_early(options)
    from npchip.frames import open_frames
    from npchip.host.rig import watch
    from npchip.host.vision.fusion import load_rig
    from npchip.machine import load_machine

    rig = load_rig(options["rig"])
    machine = load_machine("default" if options["machine"] is None else options["machine"])
    clips = [
        open_frames(options[name], machine.rows, machine.cols, options["fit"])
        for name in ("left", "right")
    ]
    runs = 2 if options["link"] == "host" else 3  # camera 1 runs both programs
    length = clips[0].count
    with frame_progress(None if length is None else runs * length) as on_frame:
        seen = watch(
            rig,
            *clips,
            algorithm=options["algorithm"],
            link=options["link"],
            machine=machine,
            engine=options["engine"],
            threshold=options["threshold"],
            dark=options["dark"],
            follow=options["follow"],
            ahead=options["predict"] or 0,
            on_frame=on_frame,
        )
    _deliver(options, rig, seen)


def _refuse_early(options: dict[str, Any]) -> None:
    """Raise before the run what would stop it or its output later."""
    for name, what in (("right", "RIGHT, the clip of camera 2"), ("rig", "--rig RIG.yaml")):
        if options[name] is None:
            raise InputError("NP524", f"two clips need {what}", hint=f"such as {_EXAMPLE}")
    if options["plot"]:
        about = {"what": "the picture is", "example": "path.svg", "option": "--plot "}
        check_suffix(options["plot"], (".png", ".svg"), "NP525", **about)
        need("matplotlib", "NP291", "--plot", "plot")
    check_writable(*filter(None, (options["csv"], options["plot"])))


def _deliver(options: dict[str, Any], rig: Rig, seen: Observation) -> None:
    from npchip.report.rig import csv_text, doubt, json_text, plain_text

    if about := doubt(seen):
        click.echo(about, err=True)
    clock = clock_of(options)
    if options["json_wanted"]:
        emit(json_text(seen, rig, clock.hz))
    elif sys.stdout.isatty():
        emit(_terminal_text(seen, clock))
    else:
        emit(plain_text(seen, clock))
    if options["csv"]:
        write_text(options["csv"], csv_text(seen))
    if options["plot"]:
        from npchip.report.space import draw

        draw(rig, seen.positions, options["plot"])


def _terminal_text(seen: Observation, clock: Clock) -> str:
    from npchip.report.rig import LINK_HEADER, header, link_rows, rows, summary

    about, found, meaning = summary(seen, clock)
    return (
        f"{table_text([header(seen), *rows(seen)])}\n{about}\n{found}\n\n"
        f"{table_text([LINK_HEADER, *link_rows(seen, clock)])}\n{meaning}\n"
    )
