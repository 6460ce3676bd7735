"""``npchip network``: teach a network that runs on the array, and measure it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click
from click.shell_completion import CompletionItem

from npchip.base.errors import InputError
from npchip.base.files import check_suffix, check_writable
from npchip.cli.options import Whole, path_option
from npchip.cli.output import emit, table_text
from npchip.cli.progress import step_progress
from npchip.cli.threads import use_one_thread

if TYPE_CHECKING:
    from npchip.host.vision.networks.accuracy import Share
    from npchip.host.vision.networks.network import Network
    from npchip.host.vision.networks.pictures import PictureSet

_CONFUSIONS = 5


def _names(_ctx: click.Context, _option: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Complete the name of a subject."""
    from npchip.host.vision.networks.sets import SUBJECTS

    return [
        CompletionItem(name, help=subject.summary)
        for name, subject in SUBJECTS.items()
        if name.startswith(incomplete)
    ]


_NAME = click.argument("name", shell_complete=_names)
_SEED = click.option(
    "--seed",
    type=Whole(0, 2**32 - 1),
    default=1,
    metavar="N",
    show_default=True,
    help="Of parts, weights and variants.",
)


@click.group("network")
def command() -> None:
    """Teach a network that the program digits runs, and measure how often it is right.

    \b
    Try: npchip network report digits
    """


@command.command("train", short_help="Teach a network, and write its weights.")
@_NAME
@path_option("-o", "--output", required=True, metavar="WEIGHTS.npy", help="The weights to write.")
@click.option(
    "--neurons",
    type=Whole(8, 96),
    default=80,
    metavar="N",
    show_default=True,
    help="A multiple of 8.",
)
@click.option(
    "--rounds",
    type=Whole(1, 1000),
    default=24,
    metavar="N",
    show_default=True,
    help="With new variants.",
)
@_SEED
@click.option(
    "--validate", is_flag=True, help="Keep validation pictures aside, and measure on them."
)
def train(**options: Any) -> None:
    """Teach the network NAME, digits or signs, and write the weights for the program digits.

    A tenth of the pictures are for testing, and never used here. Another tenth is for validation:
    with --validate the network does not see it, and is measured on it; choose between settings with
    it. Without, the network learns from it too. --seed decides which pictures these are, the first
    weights and the variants. The same options give the same bytes on the same computer.

    \b
    Examples:
      npchip network train digits -o digits.npy
      npchip run digits --memory 128=digits.npy --frames CLIP
    """
    use_one_thread()
    output = options["output"]
    check_suffix(output, (".npy",), "NP542", what="weights are", example="digits.npy")
    check_writable(output)
    if options["neurons"] % 8:
        raise InputError("NP542", f"--neurons is a multiple of 8, found {options['neurons']}")
    from npchip.host.vision.networks import pictures, sets, training
    from npchip.host.vision.networks.accuracy import measure
    from npchip.host.vision.networks.files import save

    parts = pictures.split(sets.subject(options["name"]).load(), options["seed"])
    shown = pictures.joined(parts.training, parts.validation)
    settings = training.Settings(
        neurons=options["neurons"], rounds=options["rounds"], seed=options["seed"]
    )
    with step_progress(settings.rounds) as advance:
        network = training.train(
            parts.training if options["validate"] else shown, settings, advance
        )
    save(output, network)
    size = len(network.planes())
    text = f"{output}: {network.neurons} neurons, {size} bytes of each NP's memory\n"
    if options["validate"]:
        text += f"\non {len(parts.validation)} pictures for validation:\n"
        text += _shares(measure(network, parts.validation))
    else:
        text += f"npchip network report {options['name']} --weights {output} measures it\n"
    emit(text)


@command.command("report", short_help="Measure how often a network is right.")
@_NAME
@path_option("--weights", metavar="WEIGHTS.npy", help="Not those that come with npchip.")
@_SEED
@path_option("--frames", metavar="FILE.npy", help="Write the test pictures as a clip.")
def report(**options: Any) -> None:
    """Measure how often the network NAME, digits or signs, is right on its test pictures.

    It is the model in whole numbers that is measured; the program has the same scores. --seed must
    be that of the training: else the network has seen some of the pictures.

    \b
    Examples:
      npchip network report digits
      npchip network report signs --weights signs.npy
    """
    from npchip.host.vision.networks import accuracy, pictures, sets
    from npchip.host.vision.networks.files import bundled, load, save_frames

    frames = options["frames"]
    if frames is not None:
        check_suffix(frames, (".npy",), "NP542", what="a clip is", example="test.npy")
        check_writable(frames)
    subject = sets.subject(options["name"])
    path = options["weights"] or bundled(options["name"])
    network = load(path)
    test = pictures.split(subject.load(), options["seed"]).test
    text = f"{path.name}: {subject.summary}, {network.neurons} neurons\n"
    text += f"\non {len(test)} test pictures:\n" + _shares(accuracy.measure(network, test))
    text += "\n" + _confusions(network, test, subject.names)
    if frames is not None:
        save_frames(frames, accuracy.frames_of(test, accuracy.CONDITIONS[0]))
    emit(text)


def _shares(found: dict[str, Share]) -> str:
    rows = [["frames", "right", "interval of 95 %"]]
    for condition, share in found.items():
        low, high = share.interval()
        rows.append([condition, f"{share.value:.1%}", f"{low:.1%} to {high:.1%}"])
    return table_text(rows)


def _confusions(network: Network, data: PictureSet, names: tuple[str, ...]) -> str:
    """Return which pictures are taken most often for which others."""
    from npchip.host.vision.networks.accuracy import CONDITIONS, frames_of

    counts: dict[tuple[str, str], int] = {}
    answers = network.answers(frames_of(data, CONDITIONS[0]))
    for label, answer in zip(data.labels.tolist(), answers.tolist(), strict=True):
        if label != answer:
            pair = names[label], names[answer]
            counts[pair] = counts.get(pair, 0) + 1
    most = sorted(counts.items(), key=lambda item: -item[1])[:_CONFUSIONS]
    said = ", ".join(f"{label} for {answer} ({count})" for (label, answer), count in most)
    return f"taken most often: {said}\n" if said else ""
