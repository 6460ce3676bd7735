"""``npchip orient``: where a drone is, from the picture of one right triangle (thesis 3.4)."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from npchip.cli.complete import files, machines
from npchip.cli.output import emit
from npchip.errors import InputError

if TYPE_CHECKING:
    from npchip.machine import Machine
    from npchip.vision.orientation.dataset import DataSet, Settings
    from npchip.vision.orientation.models import Estimator
    from npchip.vision.orientation.predict import Direction, Estimate

_F = TypeVar("_F", bound=Callable[..., Any])

_SIZES = ("100x100", "64x80")
_MODELS = ("hybrid", "vertices", "spherical", "sides", "ratios", "chip")
_FIGURES = ("3.8", "3.9", "3.12", "3.13", "3.14", "3.15", "3.16", "3.17")
_NEURONS = 15
_TOLD = 10
"""Errors of pictures that are written out."""

_PATH = click.Path(path_type=Path)


@click.group("orient")
def command() -> None:
    """Find where a drone is, from the picture of one right triangle (thesis 3.4).

    \b
    Try: npchip orient predict examples/orientation --angles examples/orientation/angles.csv
    """  # noqa: D301 - \b is click's mark for a paragraph that must not be wrapped


_DATA_OPTIONS = (
    click.option(
        "--data",
        type=_PATH,
        metavar="FILE.npz",
        shell_complete=files,
        help="Take this data set instead of making one.",
    ),
    click.option(
        "--save-data", type=_PATH, metavar="FILE.npz", help="Keep the data set that was made."
    ),
    click.option("--poses", type=int, metavar="N", help="Camera positions.  [default: 4000]"),
    click.option(
        "--data-seed", type=int, metavar="N", help="Seed of the camera positions.  [default: 1]"
    ),
    click.option(
        "--vertices",
        type=click.Choice(["rendered", "rounded", "exact"]),
        help="Where vertices come from.  [default: rendered]",
    ),
    click.option("--size", type=click.Choice(_SIZES), help="Frame.  [default: 100x100]"),
)


def _data_options(function: _F) -> _F:
    for option in reversed(_DATA_OPTIONS):
        function = option(function)
    return function


def _settings(options: dict[str, Any]) -> Settings:
    from npchip.vision.orientation.dataset import Settings
    from npchip.vision.orientation.scene import CAMERAS

    given = {
        "poses": options["poses"],
        "seed": options["data_seed"],
        "source": options["vertices"],
        "camera": CAMERAS[options["size"]] if options["size"] else None,
    }
    return Settings(**{name: value for name, value in given.items() if value is not None})


def _data(options: dict[str, Any]) -> DataSet:
    from npchip.atomic import check_writable
    from npchip.cli.progress import step_progress
    from npchip.vision.orientation import dataset

    if options["save_data"]:
        check_writable(options["save_data"])
    if options["data"]:
        for name in ("poses", "data_seed", "vertices", "size"):
            if options[name] is not None:
                raise InputError(
                    "NP453",
                    f"--{name.replace('_', '-')} is a setting of a new data set, but --data"
                    f" {options['data']} gives one",
                    hint="give one of the two",
                )
        return dataset.load(options["data"])
    settings = _settings(options)
    with step_progress(settings.poses) as advance:
        data = dataset.make(settings, lambda done: advance("pictures", done))
    if options["save_data"]:
        dataset.save(options["save_data"], data)
    return data


def _need(module: str, what: str) -> None:
    """Find before long work what would else be found after it."""
    if find_spec(module) is None:
        name = {"scipy": "SciPy", "matplotlib": "Matplotlib"}[module]
        raise InputError(
            "NP455", f"{what} needs {name}", hint="pip install 'npchip[orient]' installs it"
        )


# ---- train


@command.command("train")
@click.option(
    "--model",
    type=click.Choice(_MODELS),
    default="hybrid",
    show_default=True,
    help="What to train.",
)
@click.option(
    "-o", "--output", type=_PATH, metavar="FILE.json", required=True, help="Where to write it."
)
@click.option(
    "--neurons", type=int, metavar="N", help="Of the hidden layer.  [default: 15; ratios 6]"
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Of the split and the first weights.",
)
@click.option(
    "--memory", type=_PATH, metavar="FILE.npy", help="chip: weights for run --memory 208=FILE.npy."
)
@click.option(
    "--machine",
    default="default",
    metavar="NAME|FILE.yaml",
    show_default=True,
    shell_complete=machines,
    help="chip: whose array they are for.",
)
@_data_options
def train(**options: Any) -> None:
    """Train a network on pictures and write it; the same options give the same network.

    \b
    Examples:
      npchip orient train --model hybrid -o hybrid.json
      npchip orient train --model chip --size 64x80 -o chip.json --memory weights.npy
    """  # noqa: D301 - \b is click's mark for a paragraph that must not be wrapped
    from npchip.atomic import check_writable

    _need("scipy", "training")
    check_writable(options["output"])
    if options["memory"]:
        if options["model"] != "chip":
            raise InputError(
                "NP453",
                f"--memory is for --model chip, found --model {options['model']}",
                hint="only that network is in integers",
            )
        check_writable(options["memory"])
    neurons = options["neurons"]
    if neurons is not None and not 1 <= neurons <= 100:
        raise InputError("NP453", f"a network has 1 to 100 neurons, found {neurons}")
    if options["model"] == "chip":
        machine = _machine(options)
        emit(_train_chip(options, machine, _data(options)))
    else:
        emit(_train_model(options, _data(options)))


def _train_model(options: dict[str, Any], data: DataSet) -> str:
    from npchip.cli.progress import step_progress
    from npchip.vision.orientation import models
    from npchip.vision.orientation.network import MOST_STEPS, split
    from npchip.vision.orientation.scene import yaw_and_pitch

    parts = split(len(data), options["seed"])
    with step_progress(MOST_STEPS) as advance:
        steps = iter(range(MOST_STEPS + 1))
        found = models.train_model(
            options["model"],
            data,
            parts,
            neurons=options["neurons"],
            seed=options["seed"],
            progress=lambda: advance("steps", next(steps)),
        )
    true = data.positions[parts.test]
    errors = models.rms(found(data.vertices[parts.test], yaw_and_pitch(true)) - true)
    found.trained["rms_mm"] = [round(float(error), 2) for error in errors]
    models.save(options["output"], found)
    x, y, z = errors
    return (
        f"{options['output']}: model {found.model}, {len(found.network.bias)} neurons,"
        f" {found.trained['steps']} steps\n"
        f"RMS errors on {len(true)} unseen poses: x {x:.1f}, y {y:.1f}, z {z:.1f} mm,"
        f" together {float(errors @ errors) ** 0.5:.1f} mm\n"
    )


def _machine(options: dict[str, Any]) -> Machine:
    """The machine whose NPs are to be neurons."""
    from npchip.machine import load_machine

    machine = load_machine(options["machine"])
    neurons = options["neurons"] or _NEURONS
    if neurons > machine.np_rows * machine.np_cols:
        raise InputError(
            "NP453", f"{neurons} neurons need as many NPs, but machine {machine.name} has fewer"
        )
    return machine


def _train_chip(options: dict[str, Any], machine: Machine, data: DataSet) -> str:
    import numpy as np

    from npchip.vision.orientation import eightbit
    from npchip.vision.orientation.network import split
    from npchip.vision.orientation.scene import spherical

    neurons = options["neurons"] or _NEURONS
    parts = split(len(data), options["seed"])
    network = eightbit.train_chip(data, parts, neurons=neurons, seed=options["seed"])
    pixels = np.floor(data.vertices[parts.test]).astype(np.int64)
    wrong = (
        network.radial(eightbit.half_pixel_sides(pixels)) - spherical(data.positions)[parts.test, 0]
    )
    error = float(np.sqrt(np.mean(wrong**2)))
    network.trained["rms_mm"] = round(error, 2)
    eightbit.save(options["output"], network)
    text = (
        f"{options['output']}: 8-bit network, {len(network.out)} neurons\n"
        f"RMS error of the radial distance on {len(wrong)} unseen poses: {error:.1f} mm\n"
    )
    if options["memory"]:
        eightbit.save_planes(options["memory"], network, machine.np_rows, machine.np_cols)
        text += f"{options['memory']}: --memory {eightbit.ADDRESS}={options['memory']}\n"
    return text


# ---- table


@command.command("table")
@click.option(
    "--seeds", type=click.IntRange(1, 100), default=5, show_default=True, help="Trainings of each."
)
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of the table.")
@_data_options
def table(**options: Any) -> None:
    """Measure table 3.1: the thesis's errors beside ours, and what each estimate costs.

    Five seeds take some minutes.
    """
    from npchip.cli.progress import step_progress
    from npchip.vision.orientation import experiment

    _need("scipy", "training")
    data = _data(options)
    with step_progress(options["seeds"] * experiment.STEPS) as advance:
        begun = iter(range(options["seeds"] * experiment.STEPS))
        found = experiment.measure(
            data, options["seeds"], progress=lambda name: advance(name, next(begun))
        )
    if options["json_wanted"]:
        emit(json.dumps(found.document(), indent=1) + "\n")
        return
    from npchip.report import orientation

    foot = "".join(f"{line}\n" for line in orientation.table_foot(found))
    emit(_shown(orientation.table_cells(found)) + foot)


def _shown(cells: list[list[str]]) -> str:
    if sys.stdout.isatty():
        from npchip.report.terminal import side_by_side

        return side_by_side(cells, shutil.get_terminal_size().columns)
    from npchip.report.orientation import aligned

    return aligned(cells)


# ---- predict


@command.command("predict")
@click.argument("source", type=_PATH, metavar="PICTURE|FOLDER", shell_complete=files)
@click.option("--yaw", type=float, metavar="DEG", help="Where the camera looks: compass.")
@click.option("--pitch", type=float, metavar="DEG", help="-90 straight down, 0 level.")
@click.option(
    "--angles", type=_PATH, metavar="FILE.csv", help="Both for each picture: name,yaw,pitch."
)
@click.option(
    "--network",
    type=_PATH,
    metavar="FILE.json",
    shell_complete=files,
    help="From orient train; one comes with npchip.",
)
@click.option("--size", type=click.Choice(_SIZES), help="Of the pictures.  [default: 100x100]")
@click.option(
    "--threshold",
    type=click.IntRange(1, 255),
    default=44,
    show_default=True,
    help="Least level of an object pixel.",
)
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of a table.")
def predict(**options: Any) -> None:
    """Tell where pictures were taken: position in mm, radial distance, polar and azimuth angle.

    With the camera's yaw and pitch by the hybrid model, about 75 mm wrong; without them by the
    vertices model, about 260 mm wrong. A picture that cannot be used has a line that says so, and
    the exit code is then 2.

    \b
    Examples:
      npchip orient predict shot.png --yaw 45 --pitch -67
      npchip orient predict examples/orientation --angles examples/orientation/angles.csv
    """  # noqa: D301 - \b is click's mark for a paragraph that must not be wrapped
    from npchip.vision.orientation import predict as prediction

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
        emit(json.dumps(document, indent=1) + "\n")
    elif len(failed) < len(found):
        from npchip.report import orientation

        emit(_shown(orientation.estimate_cells(found)))
    for error in failed[:_TOLD]:
        click.echo(error, err=True)
    if len(failed) > _TOLD:
        click.echo(f"and {len(failed) - _TOLD} more pictures without a position", err=True)
    if failed:
        sys.exit(failed[0].exit_code)


def _directions(options: dict[str, Any]) -> Direction | dict[str, Direction] | None:
    from npchip.vision.orientation.predict import check_direction, read_angles

    yaw, pitch, table_file = options["yaw"], options["pitch"], options["angles"]
    if (yaw is None) != (pitch is None) or (table_file and yaw is not None):
        raise InputError(
            "NP457",
            "expected both --yaw and --pitch, or --angles alone, or none of them",
            hint="without angles the vertices model is used",
        )
    if table_file:
        return read_angles(table_file)
    return None if yaw is None else check_direction(yaw, pitch, "--yaw, --pitch")


def _estimator(options: dict[str, Any], directed: bool) -> Estimator:
    from npchip.vision.orientation import models
    from npchip.vision.orientation.predict import bundled

    if options["network"] is None:
        return bundled("hybrid" if directed else "vertices", options["size"] or _SIZES[0])
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


# ---- plot


@command.command("plot")
@click.option(
    "-o", "--output", type=_PATH, metavar="FOLDER", required=True, help="Where to write the PNGs."
)
@click.option(
    "--figure",
    "figures",
    type=click.Choice(_FIGURES),
    multiple=True,
    help="Only this one; may be repeated.",
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="As train.")
@_data_options
def plot(**options: Any) -> None:
    """Draw figures 3.8, 3.9 and 3.12 to 3.17 of the thesis, with networks trained anew.

    Also sensitivity.png: what errors of compass and pitch cost (with all figures).
    """
    from npchip.atomic import make_directory
    from npchip.cli.progress import step_progress

    wanted = list(options["figures"] or (*_FIGURES, "sensitivity"))
    _need("matplotlib", "drawing")
    trained = [name for name in wanted if name not in {"3.8", "3.9", "3.14"}]
    if trained:
        _need("scipy", "training")
    make_directory(options["output"])
    from npchip.report import orientation_figures as figures

    data = _data(options) if trained else None
    with step_progress(len(wanted)) as advance:
        for number, name in enumerate(wanted):
            file = "sensitivity.png" if name == "sensitivity" else f"figure-{name}.png"
            advance(file, number)
            figures.draw(name, options["output"] / file, data, options["seed"])
            emit(f"{options['output'] / file}\n")
