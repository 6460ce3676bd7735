"""The part of ``npchip fuse`` that runs two clips on two emulated cameras."""

from __future__ import annotations

import shutil
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from npchip.base.errors import InputError
from npchip.cli.output import emit

if TYPE_CHECKING:
    from npchip.frames import FrameSource
    from npchip.host.rig import Observation
    from npchip.host.vision.fusion import Rig
    from npchip.report.table import Clock

_EXAMPLE = "npchip fuse LEFT RIGHT --rig examples/rigs/chip.yaml"


def watch_clips(options: dict[str, Any]) -> None:
    """Run what ``npchip fuse LEFT RIGHT --rig RIG.yaml`` asks for, and print and write it.

    Raises:
        InputError: NP524, an argument is missing; NP525, a picture of another kind; NP291, no
            Matplotlib; and whatever `npchip.host.rig.watch` refuses.
    """
    _refuse_early(options)
    from npchip.host.rig import watch
    from npchip.host.vision.fusion import load_rig
    from npchip.machine import load_machine

    rig = load_rig(options["rig"])
    machine = load_machine(options["machine"])
    clips = [_open(options[name], machine, options) for name in ("left", "right")]
    with _progress(clips, options) as on_frame:
        seen = watch(
            rig,
            *clips,
            algorithm=options["algorithm"],
            link=options["link"],
            machine=machine,
            engine=options["engine"],
            threshold=options["threshold"],
            dark=options["dark"],
            on_frame=on_frame,
        )
    _deliver(options, rig, seen)


def _refuse_early(options: dict[str, Any]) -> None:
    """Find before the run what would else be found after it."""
    from npchip.base.files import check_writable

    needed = (("right", "RIGHT, the clip of camera 2"), ("rig", "--rig RIG.yaml"))
    for name, what in needed:
        if options[name] is None:
            raise InputError("NP524", f"two clips need {what}", hint=f"such as {_EXAMPLE}")
    if options["plot"]:
        if options["plot"].suffix.lower() != ".png":
            raise InputError(
                "NP525",
                f"--plot {options['plot']}: the picture is written as .png",
                hint=f"such as --plot {options['plot'].with_suffix('').name or 'path'}.png",
            )
        if find_spec("matplotlib") is None:
            raise InputError(
                "NP291", "--plot needs Matplotlib", hint="pip install 'npchip[plot]' installs it"
            )
    for file in (options["csv"], options["plot"]):
        if file:
            check_writable(file)


def _open(source: str, machine: Any, options: dict[str, Any]) -> FrameSource:
    from npchip.frames import open_frames

    return open_frames(source, machine.rows, machine.cols, options["fit"])


def _progress(clips: list[FrameSource], options: dict[str, Any]) -> Any:
    from npchip.cli.progress import frame_progress

    runs = 2 if options["link"] == "host" else 3  # camera 1 runs both programs
    count = clips[0].count
    return frame_progress(None if count is None else runs * count)


def _deliver(options: dict[str, Any], rig: Rig, seen: Observation) -> None:
    from npchip.base.files import write_bytes
    from npchip.report.rig import csv_text, json_text, plain_text
    from npchip.report.table import ILLUSTRATIVE_CLOCK_HZ, Clock

    clock = Clock(options["clock"] or ILLUSTRATIVE_CLOCK_HZ, stated=options["clock"] is not None)
    if options["json_wanted"]:
        emit(json_text(seen, rig, clock.hz))
    elif sys.stdout.isatty():
        emit(_terminal_text(seen, clock))
    else:
        emit(plain_text(seen, clock))
    if options["csv"]:
        write_bytes(Path(options["csv"]), csv_text(seen).encode())
    if options["plot"]:
        from npchip.report.space import draw

        draw(rig, seen.positions, options["plot"])


def _terminal_text(seen: Observation, clock: Clock) -> str:
    from npchip.report.rig import HEADER, LINK_HEADER, link_rows, rows, summary
    from npchip.report.terminal import side_by_side

    width = shutil.get_terminal_size().columns
    about, found, meaning = summary(seen, clock)
    return (
        f"{side_by_side([HEADER, *rows(seen)], width)}\n{about}\n{found}\n\n"
        f"{side_by_side([LINK_HEADER, *link_rows(seen, clock)], width)}\n{meaning}\n"
    )
