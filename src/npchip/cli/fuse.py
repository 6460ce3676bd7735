"""``npchip fuse``: two cameras, one position in space."""

from __future__ import annotations

import shutil
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.cli.complete import files
from npchip.cli.options import quantity
from npchip.cli.output import emit
from npchip.cli.programs import machine_option
from npchip.cli.running import engine_option, fit_option

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from npchip.host.vision.fusion.experiment import Row


@click.command("fuse")
@click.argument("left", required=False, shell_complete=files)
@click.argument("right", required=False, shell_complete=files)
@click.option(
    "--rig",
    type=click.Path(path_type=Path),
    metavar="RIG.yaml",
    help="Clips: where the two cameras stand.",
)
@click.option(
    "--algorithm",
    metavar="NAME",
    default="improved-2n",
    show_default=True,
    help="Clips: improved-2n, keep-y, extra-step; on a host any of docs/fusion.md.",
)
@click.option(
    "--link",
    type=click.Choice(["serial", "parallel", "host"]),
    default="serial",
    show_default=True,
    help="Clips: from camera 2 to 1, or both to a processor.",
)
@click.option(
    "--threshold",
    type=click.IntRange(1, 255),
    default=128,
    show_default=True,
    help="Clips: the object is this bright.",
)
@click.option("--dark", is_flag=True, help="Clips: or darker than that.")
@machine_option
@fit_option
@engine_option
@click.option(
    "--clock", callback=quantity, metavar="HZ", help="Clips: for frame rates.  [default: 10M]"
)
@click.option(
    "--csv", type=click.Path(path_type=Path), metavar="FILE", help="Clips: write positions."
)
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    metavar="FILE.png",
    help="Clips: draw them; needs npchip[plot].",
)
@click.option("--table", "table_wanted", is_flag=True, help="Reproduce table 2.1 of the thesis.")
@click.option(
    "--paths",
    metavar="N",
    default="1000",
    show_default=True,
    callback=quantity,
    help="Table: random paths of 20 positions, at most 20,000.",
)
@click.option(
    "--seed",
    metavar="N",
    type=click.IntRange(0, 2**32 - 1),
    default=1,
    show_default=True,
    help="Table: seed of the random paths.",
)
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of a table.")
def command(**options: Any) -> None:
    """Locate an object in space from what two cameras see.

    LEFT and RIGHT are the clips of camera 1 and 2 of the rig, in any form that run takes. Both
    cameras run on the emulated chip; camera 1, or a processor, works out the positions. Prints
    positions by frame and cycles by link. A frame without a position is marked and says why.

    --table measures the algorithms of thesis 2.2 on random paths, at the setting that was fitted
    to the thesis's table 2.1 and at the chip's own 64 x 80 pixels, and shows them beside the
    thesis's figures; last come algorithms that beat them.

    \b
    Examples:
      npchip fuse examples/rigs/ball.1.gif examples/rigs/ball.2.gif \\
          --rig examples/rigs/chip.yaml --algorithm extra-step --plot ball.png
      npchip fuse --table
      npchip fuse --table --paths 10000 --seed 7 --json
    """  # noqa: D301 - \b is click's mark for a paragraph that must not be wrapped
    if options["table_wanted"] == (options["left"] is not None):
        found = "both" if options["table_wanted"] else "neither"
        raise InputError(
            "NP512",
            f"expected two clips or --table, found {found}",
            hint="such as npchip fuse LEFT RIGHT --rig examples/rigs/chip.yaml",
        )
    if options["table_wanted"]:
        _table(options)
    else:
        from npchip.cli.watching import watch_clips

        watch_clips(options)


def _table(options: dict[str, Any]) -> None:
    from npchip.host.vision.fusion.experiment import SETTINGS, table
    from npchip.host.vision.fusion.registry import ALGORITHMS
    from npchip.report.fusion_table import headline, legend, plain_text, rows, to_text

    paths, seed = options["paths"], options["seed"]
    with row_progress(len(SETTINGS) * (len(ALGORITHMS) + 1)) as on_row:
        results = {
            name: (setting, table(setting, paths, seed, on_row=on_row))
            for name, setting in SETTINGS.items()
        }
    if options["json_wanted"]:
        emit(to_text(results, paths, seed))
    elif sys.stdout.isatty():
        from npchip.report.terminal import side_by_side

        width = shutil.get_terminal_size().columns
        for setting, measured in results.values():
            emit(f"{headline(setting, paths, seed)}\n")
            emit(side_by_side(rows(setting, measured), width))
            emit(f"{legend(setting, measured)}\n")
    else:
        emit(plain_text(results, paths, seed))


@contextmanager
def row_progress(total: int) -> Iterator[Callable[[Row], None] | None]:
    """Show a bar on standard error, if that is a terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from npchip.cli.progress import progress_bar

    with progress_bar() as progress:
        task = progress.add_task("algorithms", total=total)
        yield lambda _row: progress.advance(task)
