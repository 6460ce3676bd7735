"""``npchip sweep``: many runs, on all cores or on a cluster, as one table."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import click

from npchip.cli.options import Whole, files, path_option
from npchip.cli.output import emit
from npchip.cli.progress import step_progress

if TYPE_CHECKING:
    from pathlib import Path

    from npchip.sweep import Sweep


@click.command("sweep")
@click.argument("file", metavar="SWEEP.yaml", shell_complete=files)
@path_option("-o", "--output", metavar="DIR", help="Where the tables go.  [default: SWEEP]")
@click.option(
    "--jobs", type=Whole(min=0), metavar="N", help="Processes; 0: this one.  [default: all cores]"
)
@click.option("--scheduler", metavar="tcp://HOST:PORT", help="A Dask cluster that runs it.")
@click.option("--dry-run", is_flag=True, help="Show the runs and how long they may take.")
@path_option("--plot", help="Draw errors or cycles along the axes: .png or .svg.")
def command(**options: Any) -> None:
    """Run programs on clips and machines with all combinations of settings.

    Writes runs.parquet and runs.csv, a row for every run, and what they were made with. Runs
    that are done already are not computed again. Exits with 1 if a run failed, 2 for a sweep
    that makes no sense.

    \b
    Examples:
      npchip sweep thresholds.yaml --dry-run
      npchip sweep thresholds.yaml --plot thresholds.png
      npchip sweep thresholds.yaml --scheduler tcp://10.0.0.1:8786
    """
    from npchip.sweep import load

    file, jobs, plot = options["file"], options["jobs"], options["plot"]
    if plot is not None:
        from npchip.cli.output import check_chart

        check_chart(plot, "--plot", "NP652", "charts are", "NP640")
    sweep = load(file)
    folder = options["output"] or sweep.folder
    if options["dry_run"]:
        emit(_outlook(sweep, folder, jobs))
        return
    with step_progress(len({run.key for run in sweep.missing(folder)})) as on_step:
        count = 0

        def on_run(_done: object) -> None:
            nonlocal count
            count += 1
            on_step("runs", count)

        outcome = sweep.complete(jobs, folder=folder, scheduler=options["scheduler"], on_run=on_run)
    if plot is not None:
        from npchip.sweep.plot import draw

        draw(sweep.definition, outcome.folder, plot)
    emit(
        f"{outcome.folder}: {outcome.rows} rows, {outcome.computed} computed,"
        f" {outcome.failed} failed\n"
    )
    sys.exit(1 if outcome.failed else 0)


def _outlook(sweep: Sweep, folder: Path, jobs: int | None) -> str:
    from npchip.base.columns import aligned
    from npchip.sweep.estimate import seconds
    from npchip.sweep.local import cores

    missing = sweep.missing(folder)
    axes: dict[str, dict[str, None]] = {}
    for run in sweep.runs:
        for name, value in run.axes:
            axes.setdefault(name, {})["-" if value is None else str(value)] = None
    rows = [("axis", "values", "")]
    rows += [(name, str(len(found)), _few([*found])) for name, found in axes.items()]
    lines = aligned(rows)
    lines = [*lines, f"{len(sweep.runs)} runs, {len(sweep.runs) - len(missing)} of them done"]
    if missing:
        workers = cores() if jobs is None else jobs
        lines.append(f"about {_time(seconds(sweep.definition, missing, workers))} to go")
    return "".join(f"{line}\n" for line in lines)


def _few(values: list[str]) -> str:
    return ", ".join(values if len(values) <= 6 else [*values[:3], "...", values[-1]])


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{max(1, round(seconds))} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"
