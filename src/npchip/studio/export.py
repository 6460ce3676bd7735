"""A page that runs one program, as one file that is opened from disk."""

from __future__ import annotations

import base64
import zlib
from pathlib import Path, PurePath
from typing import Any, Final, NamedTuple

import numpy as np

from npchip.base.errors import InputError
from npchip.formats.module import to_module
from npchip.frames import FrameSource
from npchip.frames.memory import Memory, initial_memory
from npchip.isa import Isa
from npchip.machine import Machine
from npchip.program.model import Program
from npchip.studio.places import PLAYER, need_site
from npchip.studio.player import fill
from npchip.studio.toolchain.described import described

MOST_BYTES: Final = 100_000_000
"""Most bytes of the frames in a page: browsers take long to open larger files."""


class Clip(NamedTuple):
    """The frames of a page.

    Attributes:
        name: what the page calls them.
        frames: the frames.
    """

    name: str
    frames: FrameSource


def export_page(
    program: Program,
    machine: Machine,
    isa: Isa,
    *,
    clip: Clip | None = None,
    memory: Memory = (),
    max_cycles: int,
    title: str,
    guide: tuple[int, int] | None = None,
) -> str:
    """Return a page that runs a program.

    Args:
        program: the program.
        machine: the machine.
        isa: the program's instruction set.
        clip: frames that the page shows first; None for those of its reader only.
        memory: what the NPs' memory holds at reset, besides what ``.memory`` lines say; at the
            address of such a line, instead of it.
        max_cycles: limit for each frame.
        title: the page's title.
        guide: rows and columns of a frame about the middle of the picture, in which the page's
            reader is to hold something; None for none.

    Raises:
        InputError: NP243 a file of a ``.memory`` line cannot be read, or does not fit; NP630 the
            page of the studio was not built; NP636 the clip is too long; a frame
            or the program cannot be used.
    """
    held = initial_memory(program, machine, memory)
    template = (need_site() / PLAYER).read_text(encoding="utf-8")
    data = {
        "title": title,
        # The player has no editor, so it needs no places of definitions.
        "program": _without_folders(described(program, machine, (), isa)),
        "module": _packed(to_module(program, machine, isa, held)),
        "maxCycles": max_cycles,
        "guide": guide,
        "clip": None if clip is None else _clip(clip),
    }
    return fill(template, title, data)


def _without_folders(program: dict[str, Any]) -> dict[str, Any]:
    """Drop the folders of sources: they say more of the writer's disk than a page should."""
    for word in program["words"]:
        for origin in word["origins"]:
            origin["file"] = PurePath(origin["file"]).name
    return program


def _clip(clip: Clip) -> dict[str, Any]:
    source = clip.frames
    most = MOST_BYTES // (source.rows * source.cols)
    packer = zlib.compressobj(9)
    parts = []
    count = 0
    for frame in source:
        count += 1
        if count > most:
            raise InputError(
                "NP636",
                f"--frames {source.name}: more than {most:,} frames, which is too many for a page",
                hint="export without --frames, and open the clip in the page",
            )
        parts.append(packer.compress(np.ascontiguousarray(frame).tobytes()))
    packed = b"".join((*parts, packer.flush()))
    return {
        "name": clip.name,
        "count": count,
        "rows": source.rows,
        "cols": source.cols,
        "fps": None,
        "data": base64.b64encode(packed).decode(),
    }


def _packed(data: bytes) -> str:
    return base64.b64encode(zlib.compress(data, 9)).decode()


def title_of(program: Program, clip: Clip | None) -> str:
    """Return the title of a page without one: its program and its clip."""
    return program.name if clip is None else f"{program.name} · {clip.name}"


def clip_name(given: str) -> str:
    """Return what a page calls a clip: the name of its file or folder."""
    return Path(given).name or given
