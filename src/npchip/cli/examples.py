"""``npchip examples``: list or copy what comes with npchip."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import click

from npchip.base.errors import InputError
from npchip.base.files import write_new
from npchip.cli.options import path_option
from npchip.cli.output import emit

if TYPE_CHECKING:
    from pathlib import Path

    from npchip.bundle import What

_KINDS: Final[dict[What, str]] = {
    "program": "Programs, such as npchip run trajectory",
    "clip": "Clips, such as --frames coin_slide",
    "rig": "Two cameras, such as npchip fuse ball.1 ball.2 --rig chip",
    "scene": "Scenes, such as npchip scene three -o three.gif",
}


@click.command("examples")
@path_option("--copy", "folder", metavar="DIR", help="Write them there; nothing is overwritten.")
def command(folder: Path | None) -> None:
    """List the programs and clips that come with npchip.

    Wherever a program or a clip is asked for, its name will do, unless there is a file or folder
    of that name.

    \b
    Examples:
      npchip examples
      npchip run trajectory --frames coin_slide
      npchip examples --copy mine          writes sources and clips, to look at and change
    """
    from npchip import bundle

    if not bundle.bundled("program"):
        raise InputError("NP521", "this npchip was installed without its programs")
    if folder is not None:
        emit(_copy(folder))
        return
    lines: list[str] = []
    for kind, title in _KINDS.items():
        known = bundle.bundled(kind)
        width = max(map(len, known))
        lines += ["", f"{title}:"]
        lines += [f"  {name:<{width}}  {item.summary}" for name, item in known.items()]
    emit("\n".join(lines[1:]) + "\n")


def _copy(folder: Path) -> str:
    from npchip import bundle

    top = bundle.top()
    files = {folder / path.relative_to(top): path.read_bytes() for path in bundle.all_files()}
    write_new(files, "name another folder")
    return f"{folder}: {len(files)} files: programs in asm, all else in examples\n"
