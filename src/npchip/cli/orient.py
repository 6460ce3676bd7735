"""``npchip orient``: find a drone from the picture of one right triangle (thesis 3.4)."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Any

import click

from npchip.base.errors import InputError
from npchip.base.files import check_writable, make_directory
from npchip.base.json import indented
from npchip.cli.options import Whole, machines, path_option, together
from npchip.cli.orient_predict import SIZES, predict
from npchip.cli.output import emit, need, table_text
from npchip.cli.progress import step_progress
from npchip.cli.threads import use_one_thread

if TYPE_CHECKING:
    from npchip.host.vision.orientation.dataset import DataSet, Settings
    from npchip.machine import Machine

_MODELS = ("hybrid", "vertices", "spherical", "sides", "ratios", "chip")
_FIGURES = ("3.8", "3.9", "3.12", "3.13", "3.14", "3.15", "3.16", "3.17")
_NEURONS = 15


@click.group("orient")
def command() -> None:
    """Find where a drone is, from the picture of one right triangle (thesis 3.4).

    \b
    Try: npchip orient predict shots --angles shots/angles.csv
    """


command.add_command(predict)

_data_options = together(
    path_option("--data", metavar="FILE.npz", help="Take this data set instead of making one."),
    path_option("--save-data", metavar="FILE.npz", help="Keep the data set that was made."),
    click.option("--poses", type=Whole(), metavar="N", help="Camera positions.  [default: 4000]"),
    click.option(
        "--data-seed", type=Whole(), metavar="N", help="Seed of the camera positions.  [default: 1]"
    ),
    click.option(
        "--vertices",
        type=click.Choice(["rendered", "rounded", "exact"]),
        help="Where vertices come from.  [default: rendered]",
    ),
    click.option("--size", type=click.Choice(SIZES), help="Frame.  [default: 100x100]"),
)


def _settings(options: dict[str, Any]) -> Settings:
    from npchip.host.vision.orientation.dataset import Settings
    from npchip.host.vision.orientation.scene import CAMERAS

    given = {
        "poses": options["poses"],
        "seed": options["data_seed"],
        "source": options["vertices"],
        "camera": CAMERAS[options["size"]] if options["size"] else None,
    }
    return Settings(**{name: value for name, value in given.items() if value is not None})


def _data(options: dict[str, Any]) -> DataSet:
    from npchip.host.vision.orientation import dataset

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


# ---- train


@command.command("train", short_help="Train a network and write it.")
@click.option(
    "--model",
    type=click.Choice(_MODELS),
    default="hybrid",
    help="What to train.",
)
@path_option("-o", "--output", metavar="FILE.json", required=True, help="Where to write it.")
@click.option(
    "--neurons", type=Whole(), metavar="N", help="Of the hidden layer.  [default: 15; ratios 6]"
)
@click.option(
    "--seed",
    type=Whole(min=0),
    default=0,
    help="Of the split and the first weights.",
)
@path_option("--memory", metavar="FILE.npy", help="chip: weights for run --memory 208=FILE.npy.")
@click.option(
    "--machine",
    default="default",
    metavar="NAME|FILE.yaml",
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
    """
    use_one_thread()
    need("scipy", "NP455", "training", "orient")
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
    from npchip.host.vision.orientation import models
    from npchip.host.vision.orientation.network import MOST_STEPS, split
    from npchip.host.vision.orientation.scene import yaw_and_pitch

    parts = split(len(data), options["seed"])
    with step_progress(MOST_STEPS) as advance:
        steps = count()
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
    """Return the machine whose NPs become neurons."""
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

    from npchip.host.vision.orientation import eightbit
    from npchip.host.vision.orientation.network import split
    from npchip.host.vision.orientation.scene import spherical

    neurons = options["neurons"] or _NEURONS
    parts = split(len(data), options["seed"])
    network = eightbit.train_chip(data, parts, neurons=neurons, seed=options["seed"])
    pixels = np.rint(data.vertices[parts.test]).astype(np.int64)
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


@command.command("table", short_help="Measure table 3.1.")
@click.option("--seeds", type=Whole(1, 100), default=5, help="Trainings of each.")
@click.option("--json", "json_wanted", is_flag=True, help="Print JSON instead of the table.")
@_data_options
def table(**options: Any) -> None:
    """Measure table 3.1: the thesis's errors beside ours, and what each estimate costs.

    Five seeds take about half a minute of one core's time.
    """
    use_one_thread()
    from npchip.host.vision.orientation import experiment

    need("scipy", "NP455", "training", "orient")
    data = _data(options)
    with step_progress(options["seeds"] * experiment.STEPS) as advance:
        begun = count()
        found = experiment.measure(
            data, options["seeds"], progress=lambda name: advance(name, next(begun))
        )
    if options["json_wanted"]:
        emit(indented(found.document()))
        return
    from npchip.report import orientation

    foot = "".join(f"{line}\n" for line in orientation.table_foot(found))
    emit(table_text(orientation.table_cells(found)) + foot)


# ---- plot


@command.command("plot", short_help="Draw the thesis's figures.")
@path_option("-o", "--output", metavar="FOLDER", required=True, help="Where to write the files.")
@click.option(
    "--figure",
    "figures",
    type=click.Choice(_FIGURES),
    multiple=True,
    help="Only this one; may be repeated.",
)
@click.option("--seed", type=Whole(min=0), default=0, help="As train.")
@_data_options
def plot(**options: Any) -> None:
    """Draw figures 3.8, 3.9 and 3.12 to 3.17 of the thesis, with networks trained anew.

    Also sensitivity.svg: what errors of compass and pitch cost (with all figures). Plots are SVG,
    pictures PNG.
    """
    use_one_thread()
    wanted = list(options["figures"] or (*_FIGURES, "sensitivity"))
    need("matplotlib", "NP455", "drawing", "orient")
    trained = [name for name in wanted if name not in {"3.8", "3.9", "3.14"}]
    if trained:
        need("scipy", "NP455", "training", "orient")
    make_directory(options["output"])
    from npchip.report import orientation_figures as figures

    data = _data(options) if trained else None
    with step_progress(len(wanted)) as advance:
        for number, name in enumerate(wanted):
            file = figures.file_name(name)
            advance(file, number)
            figures.draw(name, options["output"] / file, data, options["seed"])
            emit(f"{options['output'] / file}\n")
