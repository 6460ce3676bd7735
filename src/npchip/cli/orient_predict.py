"""``npchip orient predict``: estimate positions from picture files."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.json import indented
from npchip.cli.options import Real, Whole, path_option
from npchip.cli.output import emit, table_text

if TYPE_CHECKING:
    from npchip.host.vision.orientation.models import Estimator
    from npchip.host.vision.orientation.predict import Direction, Estimate

SIZES = ("100x100", "64x80")
_MOST_ERRORS = 10


@click.command("predict", short_help="Tell where pictures were taken.")
@click.argument("source", type=click.Path(path_type=Path), metavar="PICTURE|FOLDER")
@click.option("--yaw", type=Real(), metavar="DEG", help="Where the camera looks; see --yaw-from.")
@click.option("--pitch", type=Real(), metavar="DEG", help="-90 straight down, 0 level.")
@path_option("--angles", metavar="FILE.csv", help="Both for each picture: name,yaw,pitch.")
@click.option(
    "--yaw-from",
    type=click.Choice(["x-axis", "compass"]),
    default="x-axis",
    help="Yaws count anticlockwise from +x, or clockwise from north, which is +y.",
)
@path_option("--network", metavar="FILE.json", help="From orient train; one comes with npchip.")
@click.option("--size", type=click.Choice(SIZES), help="Of the pictures.  [default: 100x100]")
@click.option(
    "--threshold",
    type=Whole(1, 255),
    default=44,
    help="Least level of an object pixel.",
)
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of a table.")
def predict(**options: Any) -> None:
    """Tell where pictures were taken: position in mm, radial distance, polar and azimuth angle.

    With the camera's yaw and pitch by the hybrid model, about 70 mm wrong; without them by the
    vertices model, about 250 mm wrong. Yaw 0 looks along +x and 90 along +y; with --yaw-from
    compass 0 is north (+y) and 90 east (+x). A picture that cannot be used has a line that says so,
    and the exit code is then 2.

    \b
    Examples:
      npchip orient predict shot.png --yaw 45 --pitch -67
      npchip orient predict shots --angles shots/angles.csv
    """
    from npchip.host.vision.orientation import predict as prediction

    directions = _directions(options)
    estimator = _estimator(options, directions is not None)
    found = prediction.predict(
        estimator,
        prediction.pictures(options["source"]),
        directions,
        threshold=options["threshold"],
    )
    failed = [item.error for item in found if item.error]
    if options["json_wanted"]:
        document = {"schema": 1, "model": estimator.model, "pictures": list(map(_plain, found))}
        emit(indented(document))
    elif len(failed) < len(found):
        from npchip.report import orientation

        emit(table_text(orientation.estimate_cells(found)))
    for error in failed[:_MOST_ERRORS]:
        click.echo(error, err=True)
    if len(failed) > _MOST_ERRORS:
        click.echo(f"and {len(failed) - _MOST_ERRORS} more pictures without a position", err=True)
    if failed:
        sys.exit(failed[0].exit_code)


def _directions(options: dict[str, Any]) -> Direction | dict[str, Direction] | None:
    from npchip.host.vision.orientation.predict import check_direction, read_angles

    yaw, pitch, table_file = options["yaw"], options["pitch"], options["angles"]
    if (yaw is None) != (pitch is None) or (table_file and yaw is not None):
        raise InputError(
            "NP457",
            "expected both --yaw and --pitch, or --angles alone, or none of them",
            hint="without angles the vertices model is used",
        )
    if table_file:
        return read_angles(table_file, options["yaw_from"])
    if yaw is None:
        return None
    return check_direction(yaw, pitch, "--yaw, --pitch", options["yaw_from"])


def _estimator(options: dict[str, Any], directed: bool) -> Estimator:
    from npchip.host.vision.orientation import models
    from npchip.host.vision.orientation.predict import bundled

    if options["network"] is None:
        return bundled("hybrid" if directed else "vertices", options["size"] or SIZES[0])
    found = models.load(options["network"])
    size = f"{found.camera.rows}x{found.camera.cols}"
    if options["size"] not in {None, size}:
        raise InputError(
            "NP457", f"--size {options['size']}, but {options['network']} is for pictures of {size}"
        )
    return found


def _plain(item: Estimate) -> dict[str, Any]:
    if item.position is None:
        error = item.error
        return {
            "name": item.name,
            "error": error and {"code": error.code, "message": error.message},
        }
    radial, polar, azimuth = item.spherical
    return {
        "name": item.name,
        "position_mm": item.position.round(2).tolist(),
        "radial_mm": round(radial, 2),
        "polar_deg": round(polar, 3),
        "azimuth_deg": round(azimuth, 3),
    }
