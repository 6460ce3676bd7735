"""``npchip scene``: draw synthetic clips with their ground truth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, Field
from pathlib import Path
from typing import Any, TypeVar

import click

from npchip.base.errors import InputError
from npchip.base.files import check_writable
from npchip.cli.options import bundled, machines, path_option
from npchip.cli.output import emit
from npchip.host.scenes.files import DEFAULT_MOTION, read_scene, scene_of_options
from npchip.host.scenes.model import Object, Scene
from npchip.host.scenes.motions import MOTIONS
from npchip.host.scenes.output import check_suffix, truth_path, write_clip
from npchip.host.scenes.render import Truth, render
from npchip.host.scenes.rules import Rule, rule_of, settings
from npchip.host.scenes.shapes import SHAPES

_F = TypeVar("_F", bound=Callable[..., Any])

_WHOLE = settings(Scene)
_KINDS: tuple[type[Any], ...] = (Object, *SHAPES.values(), *MOTIONS.values())
_OBJECT = {name: item for kind in _KINDS for name, item in settings(kind).items()}
_METAVARS = {"pair": "ROW,COL", "pairs": "'R,C R,C ...'", "number": "NUMBER", "whole": "N"}


def _setting_options(function: _F) -> _F:
    """Add an option for each setting of a scene, its object, shapes and motions."""
    fields = {**_OBJECT, **_WHOLE}
    del fields["size"]  # that of the machine
    for name, item in reversed(fields.items()):
        rule = rule_of(item)
        function = click.option(
            f"--{name}", metavar=_METAVARS[rule.kind], callback=_reader(rule), help=_help(item)
        )(function)
    return function


def _help(item: Field[Any]) -> str:
    text = rule_of(item).text
    sentence = f"{text[0].upper()}{text[1:]}."
    if item.default in {MISSING, 0, (0.0, 0.0)}:
        return sentence
    return f"{sentence}  [default: {item.default:g}]"


def _reader(rule: Rule) -> Callable[[click.Context, click.Parameter, str | None], Any]:
    return lambda _ctx, _option, text: None if text is None else rule.read(text)


@click.command("scene")
@click.argument("file", metavar="[FILE.yaml]", required=False, shell_complete=bundled("scene"))
@path_option(
    "-o",
    "--output",
    metavar="CLIP",
    required=True,
    help="Where to write: .npy or .gif; the truth goes beside it.",
)
@click.option("--shape", type=click.Choice(list(SHAPES)), help="What moves.")
@click.option(
    "--motion", type=click.Choice(list(MOTIONS)), help=f"How.  [default: {DEFAULT_MOTION}]"
)
@_setting_options
@click.option("--background", metavar="LEVEL", help="Brightness behind it; YAML says more.")
@click.option(
    "--machine", metavar="NAME|FILE.yaml", help="Whose size the clip has.", shell_complete=machines
)
@click.option(
    "--rig",
    metavar="RIG.yaml",
    shell_complete=bundled("rig"),
    help="Two cameras: FILE.yaml is a ball in space, CLIP.1 and CLIP.2 are what they see.",
)
def command(**options: Any) -> None:
    """Draw a clip whose truth is known, of a FILE.yaml or of one object given by options.

    Writes the frames and, beside them, a .truth.json with centre, box and corners of every
    object in every frame. Options for the whole scene (frames, noise, seed, background,
    machine) change what FILE.yaml says.

    \b
    Examples:
      npchip scene --shape disc --radius 5 --start 20,10 --velocity 0.5,2 -o disc.npy
      npchip scene --shape dot --motion circular --center 32,40 --orbit 20 \\
          --period 30 --noise 2 --seed 7 -o dot.gif
      npchip scene ball.yaml --seed 2 -o ball.npy
      npchip scene space-bouncing --rig chip -o bouncing.npy
    """
    check_suffix(options["output"])
    if options["rig"] is not None:
        emit(_in_space(options))
        return
    check_writable(options["output"], truth_path(options["output"]))
    scene = _scene(options)
    clip, truth = render(scene)
    write_clip(options["output"], clip, scene, truth)
    emit(_summary(scene, truth, options["output"]))


def _scene(options: dict[str, Any]) -> Scene:
    item = _given(options, ("shape", "motion", *_OBJECT))
    whole = _given(options, tuple(_WHOLE)) | _size_and_background(options)
    if options["file"] is not None:
        if item:
            raise InputError(
                "NP289",
                f"--{next(iter(item))} describes an object, and so does {options['file']}",
                hint="give a file or an object, not both",
            )
        return read_scene(Path(options["file"]), whole)
    if "shape" not in item:
        raise InputError(
            "NP289",
            "nothing to draw: expected FILE.yaml or --shape",
            hint=f"such as --shape disc; the shapes are {', '.join(SHAPES)}",
        )
    return scene_of_options(item, whole)


def _in_space(options: dict[str, Any]) -> str:
    """Draw and write the clips of two cameras that see a ball; return a summary."""
    from npchip.host.scenes.stereo import pair_paths, read_space_scene, render_pair, write_pair
    from npchip.host.vision.fusion.rigfile import load_rig

    wrong = _given(options, ("shape", "motion", *_OBJECT, "machine"))
    if wrong or options["file"] is None:
        no_option = f", not from --{next(iter(wrong))}" if wrong else ""
        raise InputError(
            "NP289",
            f"--rig takes what moves from FILE.yaml{no_option}",
            hint="such as npchip scene space.yaml --rig rig.yaml -o ball.npy",
        )
    output = options["output"]
    files = pair_paths(output)
    check_writable(*files, truth_path(output))
    rig = load_rig(options["rig"])
    whole = _given(options, tuple(_WHOLE)) | _size_and_background(options)
    scene = read_space_scene(Path(options["file"]), whole)
    views = render_pair(scene, rig)
    write_pair(output, views, scene, rig)
    lines = [
        f"{file}: {scene.frames} frames of {camera.rows} x {camera.cols} pixels,"
        f" the ball is visible in {int(view.visible.sum())}"
        for file, camera, view in zip(files, (rig.camera1, rig.camera2), views, strict=True)
    ]
    ends = (", ".join(f"{v:.2f}" for v in place) for place in scene.positions()[[0, -1]])
    lines += [f"{truth_path(output)}: where it is, from ({') to ('.join(ends)}) m"]
    return "".join(f"{line}\n" for line in lines)


def _given(options: dict[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    return {name: options[name] for name in names if options.get(name) is not None}


def _size_and_background(options: dict[str, Any]) -> dict[str, Any]:
    from npchip.base.yaml import load_mapping
    from npchip.machine import load_machine

    values: dict[str, Any] = {}
    if options["machine"] is not None:
        machine = load_machine(options["machine"])
        values["size"] = [machine.rows, machine.cols]
    if options["background"] is not None:
        text = f"background: {options['background']}"
        values["background"] = load_mapping(text, "--background", "NP283")["background"]
    return values


def _summary(scene: Scene, truth: Truth, path: Path) -> str:
    rows, cols = scene.size
    lines = [
        f"{path}: {scene.frames} frames of {rows} x {cols} pixels",
        f"{truth_path(path)}: where the objects are",
    ]
    for n, item in enumerate(scene.objects):
        first, last = (f"({row:.2f}, {col:.2f})" for row, col in truth.centers[[0, -1], n])
        lines.append(
            f"object {n}: {type(item.shape).__name__.lower()},"
            f" {type(item.motion).__name__.lower()}, from {first} to {last},"
            f" visible in {int(truth.visible[:, n].sum())} frames"
        )
    return "".join(f"{line}\n" for line in lines)
